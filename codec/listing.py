"""Integers of which few are different -> a list of these, and which of them, ascending; and back.

Entries are told by magnitude, x or -1 - x, so that what is mirrored, as floats with the other sign
are by their order, is told once.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.errors import CorruptError
from ebz.codec.integers import decode_columns, encode_columns
from ebz.codec.lattice import Integers

Unsigned = npt.NDArray[np.uint64]

# What there is of a magnitude.
PLAIN, MIRRORED, BOTH = range(3)
MAX_PLAIN_BITS = 63
HAS_BOTH = 64


class Listing(NamedTuple):
    """n different integers and their stream."""

    n: int
    data: bytes

    @property
    def size(self) -> int:
        """The bytes of the stream."""
        return len(self.data)

    def at(self, which: Integers) -> Integers:
        """The integers of those numbers; raises CorruptError where there is none."""
        if which.size and (which.min() < 0 or which.max() >= self.n):
            raise CorruptError(f"a number that is none of the {self.n} listed")
        return _decode(self.n, self.data)[which]


def listing_of(found: Integers) -> Listing:
    """The list of ascending, different integers."""
    magnitudes, row = np.unique(np.where(found < 0, ~found, found), return_inverse=True)
    has_plain, has_mirrored = np.zeros((2, len(magnitudes)), bool)
    has_plain[row[found >= 0]] = True
    has_mirrored[row[found < 0]] = True
    kinds = np.where(has_plain, np.where(has_mirrored, BOTH, PLAIN), MIRRORED).astype(np.uint64)
    steps = np.diff(magnitudes, prepend=0).astype(np.uint64)
    return Listing(len(found), min((_encode(kinds, steps, k) for k in _widths(steps)), key=len))


def listed(integers: Integers) -> tuple[Listing, Integers] | None:
    """The list, and which is where; None if many are different, or there are none."""
    found, which = _kernels.list_different(integers.reshape(-1))
    return (listing_of(found), which.reshape(integers.shape)) if len(found) else None


def _widths(steps: Unsigned) -> list[int]:
    """How many bits of each step may be plain: none, or nearly those of the middle one."""
    middle = int(np.median(steps)) if len(steps) else 0
    most = min(middle.bit_length(), MAX_PLAIN_BITS)
    return sorted({0, max(0, most - 3), max(0, most - 1)})


def _encode(kinds: Unsigned, steps: Unsigned, n_plain: int) -> bytes:
    n_both = int(np.count_nonzero(kinds == BOTH))
    head = [n_plain + HAS_BOTH, *n_both.to_bytes(2, "little")] if n_both else [n_plain]
    bits = (steps[:, None] >> _shifts(n_plain) & np.uint64(1)).astype(np.uint8)
    coded = encode_columns(kinds, steps >> np.uint64(n_plain))
    return bytes(head) + np.packbits(bits).tobytes() + coded


def _decode(n: int, data: bytes) -> Integers:
    if not data:
        raise CorruptError("an empty list")
    n_plain, n_both, start = data[0] & ~HAS_BOTH, 0, 1
    if data[0] & HAS_BOTH:
        n_both, start = int.from_bytes(data[1:3], "little"), 3
    n_rows = n - n_both
    end = start + -(-n_rows * n_plain // 8)
    if n_both > n or n_plain > MAX_PLAIN_BITS or end > len(data):
        raise CorruptError(f"a list of {n} integers with {n_plain} plain bits each")
    kinds, steps = decode_columns(data[end:], n_rows, 2)
    bits = np.unpackbits(np.frombuffer(data[start:end], np.uint8), count=n_rows * n_plain)
    low = bits.reshape(n_rows, n_plain).astype(np.uint64) << _shifts(n_plain)
    steps = (steps << np.uint64(n_plain)) + low.sum(axis=1, dtype=np.uint64)
    magnitudes: Integers = np.cumsum(steps).astype(np.int64)
    found = np.concatenate([magnitudes[kinds != MIRRORED], ~magnitudes[kinds != PLAIN]])
    if len(found) != n or (kinds > BOTH).any():
        raise CorruptError(f"a list of {len(found)} integers, not {n}")
    return np.sort(found)


def _shifts(n: int) -> Unsigned:
    return np.arange(n, dtype=np.uint64)[::-1]
