"""Integers of which few are different -> a list of these, and which of them, ascending; and back.

Entries are told by magnitude, x or -1 - x, so that what is mirrored, as floats with the other sign
are by their order, is told once.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.integers import encode_columns
from ebz.codec.lattice import Integers

Unsigned = npt.NDArray[np.uint64]

# What there is of a magnitude.
PLAIN, MIRRORED, BOTH = range(3)
MAX_PLAIN_BITS = 57
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
        found = _kernels.decode_list(self.data, self.n)
        rows = which if which.ndim == 2 else which.reshape(-1, 1)
        return _kernels.look_up(found, rows).reshape(which.shape)


def listing_of(found: Integers) -> Listing:
    """The list of ascending, different integers."""
    n_negative = int(np.searchsorted(found, 0))
    plain, mirrored = found[n_negative:], ~found[:n_negative]
    magnitudes = np.union1d(plain, mirrored)
    kinds = np.full(len(magnitudes), PLAIN, np.uint64)
    kinds[np.searchsorted(magnitudes, mirrored)] = MIRRORED
    kinds[np.searchsorted(magnitudes, np.intersect1d(plain, mirrored))] = BOTH
    steps = np.diff(magnitudes, prepend=0).astype(np.uint64)
    return Listing(len(found), min((_encode(kinds, steps, k) for k in _widths(steps)), key=len))


def listed(integers: Integers) -> tuple[Listing, Integers] | None:
    """The list, and which is where; None if many are different, or there are none."""
    found, which = _kernels.list_different(integers.reshape(-1))
    return (listing_of(found), which.reshape(integers.shape)) if len(found) else None


def _widths(steps: Unsigned) -> list[int]:
    """How many bits of each step may be plain: none, or nearly those of the middle one."""
    half = len(steps) // 2
    middle = int(np.partition(steps, half)[half]) if len(steps) else 0
    most = min(middle.bit_length(), MAX_PLAIN_BITS)
    return sorted({0, max(0, most - 3), max(0, most - 1)})


def _encode(kinds: Unsigned, steps: Unsigned, n_plain: int) -> bytes:
    n_both = int(np.count_nonzero(kinds == BOTH))
    head = [n_plain + HAS_BOTH, *n_both.to_bytes(2, "little")] if n_both else [n_plain]
    bits = (steps[:, None] >> np.arange(n_plain, dtype=np.uint64) & np.uint64(1)).astype(np.uint8)
    coded = encode_columns(kinds, steps >> np.uint64(n_plain))
    return bytes(head) + np.packbits(bits, bitorder="little").tobytes() + coded
