"""The integers of special S: where they are in the word, and which half-edge each meets.

Two forms, of which the encoder takes the shorter.  Adaptive columns learn from what repeats, as the
short way around many small holes.  Plain bits know nothing, but their length is bounded: gaps are
split into low bits and unary quotients (P. Elias, "Efficient storage and retrieval by content and
address of static files", 1974), which for s positions among n takes less than s (2 + log2(n / s))
bits, and the rest has a fixed width.
"""

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import CorruptError
from ebz.codec.integers import Columns, decode_columns, encode_columns, from_gaps, gaps

Int64s = npt.NDArray[np.int64]
Bits = npt.NDArray[np.uint8]

ADAPTIVE, PLAIN = b"\0", b"\1"


def encode_specials(specials: Int64s, n_symbols: int) -> bytes:
    """Gaps between positions, and how far on in the word the half-edge is that each meets.

    specials: (2 s,) position in the word and half-edge met; positions ascend.
    """
    if not len(specials):
        return b""
    positions, meets = specials[0::2], specials[1::2]
    gap, ahead = gaps(positions), meets - 2 * positions - 2
    forms = ADAPTIVE + encode_columns(gap, ahead), PLAIN + _encode_plain(gap, ahead, n_symbols)
    return min(forms, key=len)


def decode_specials(data: bytes, n_specials: int, n_symbols: int) -> Int64s:
    """The specials; raises CorruptError unless the positions ascend within the word."""
    if not n_specials:
        return np.zeros(0, np.int64)
    form, body = bytes(data[:1]), data[1:]
    if form == ADAPTIVE:
        gap, ahead = decode_columns(body, n_specials, 2)
    elif form == PLAIN:
        gap, ahead = _decode_plain(body, n_specials, n_symbols)
    else:
        raise CorruptError(f"form {form.hex()} of the integers, not 00 or 01")
    positions = from_gaps(gap)
    if (np.diff(positions, prepend=-1) <= 0).any() or (positions >= n_symbols).any():
        raise CorruptError("positions do not ascend within the word")
    meets = ahead.astype(np.int64) + 2 * positions + 2
    return np.column_stack([positions, meets]).reshape(-1)


def _widths(n_specials: int, n_symbols: int) -> tuple[int, int]:
    """Low bits of a gap and bits of an `ahead`, which is below 2 n_symbols."""
    return max(n_symbols // n_specials, 1).bit_length() - 1, (2 * n_symbols).bit_length()


def _encode_plain(gap: Int64s, ahead: Int64s, n_symbols: int) -> bytes:
    low, width = _widths(len(gap), n_symbols)
    quotients = np.zeros(len(gap) + int((gap >> low).sum()), np.uint8)
    quotients[np.cumsum((gap >> low) + 1) - 1] = 1
    fixed = np.hstack([_bits_of(gap, low), _bits_of(ahead, width)])
    return np.packbits(np.concatenate([fixed.reshape(-1), quotients])).tobytes()


def _decode_plain(data: bytes, n_specials: int, n_symbols: int) -> list[Columns]:
    low, width = _widths(n_specials, n_symbols)
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    n_fixed = n_specials * (low + width)
    ends = np.flatnonzero(bits[n_fixed:])
    if len(ends) != n_specials:
        raise CorruptError(f"{len(ends)} quotients for {n_specials} special S")
    fixed = bits[:n_fixed].reshape(n_specials, low + width)
    quotients = gaps(ends.astype(np.int64)).astype(np.uint64)
    return [(quotients << np.uint64(low)) + _from_bits(fixed[:, :low]), _from_bits(fixed[:, low:])]


def _bits_of(values: Int64s, width: int) -> Bits:
    """(n, width) the low bits of each value, highest first."""
    octets = values.astype(">u8").view(np.uint8).reshape(-1, 8)
    return np.unpackbits(octets, axis=1)[:, 64 - width :]


def _from_bits(bits: Bits) -> Columns:
    """The inverse of _bits_of."""
    wide = np.zeros((len(bits), 64), np.uint8)
    wide[:, 64 - bits.shape[1] :] = bits
    return np.packbits(wide, axis=1).view(">u8").reshape(-1).astype(np.uint64)
