"""Rows of floats, as corners of loose triangles -> the distinct ones, equal bits being one."""

from typing import Any

import numpy as np
import numpy.typing as npt

# Odd constants of splitmix64 (Steele, Lea and Flood, 2014): a hash only, collisions are caught.
_MULTIPLIERS = np.array(
    [0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB], dtype=np.uint64
)


def weld(corners: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[np.intp]]:
    """The distinct rows (n, width) in the order of their first use, and the one of each row.

    corners: (k, width), width up to 3, float32 or float64.
    Bits decide: -0.0 and 0.0 stay apart, equal NaN are one.
    """
    bits = np.ascontiguousarray(corners).view(f"u{corners.dtype.itemsize}").astype(np.uint64)
    mixed = bits ^ (bits >> np.uint64(29))
    keys = (mixed * _MULTIPLIERS[: bits.shape[1]]).sum(axis=1, dtype=np.uint64)
    keys ^= keys >> np.uint64(32)
    first, inverse = _unique(keys)
    if not np.array_equal(bits[first[inverse]], bits):
        record = ",".join(["u8"] * bits.shape[1] + [""])  # a comma makes it one, even of one
        first, inverse = _unique(np.ascontiguousarray(bits).view(record)[:, 0])
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return corners[first[order]], rank[inverse]


def _unique(keys: npt.NDArray[Any]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """The first index of each distinct key, and which of them each key is."""
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    return first, inverse.ravel()
