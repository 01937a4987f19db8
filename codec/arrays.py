"""What arrays of a mesh must be: shapes, dtypes and indices, checked where a mesh is made."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError

Attributes = dict[str, npt.NDArray[Any]]
# Those of every numpy.
MAX_DIMENSIONS = 32
# Of the extents of one entry that are not zero: every numpy can make the array.
MAX_ENTRY = 2**31
NUMBERS = "biuf"  # kinds of dtypes
INT32_VERTICES = 2**31


def face_dtype(n_vertices: int) -> np.dtype[Any]:
    """The dtype of vertex indices for `n_vertices`: int32, int64 from 2^31 vertices on."""
    return np.dtype(np.int32 if n_vertices < INT32_VERTICES else np.int64)


def native(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The same values in the byte order of this machine."""
    if array.dtype.isnative:
        return array
    return array.byteswap().view(array.dtype.newbyteorder("="))


def checked_attributes(owner: str, attributes: Attributes, n: int) -> Attributes:
    """The attributes as contiguous arrays of n entries; raises MeshError where one has others."""
    if not isinstance(attributes, Mapping) or not all(isinstance(n, str) for n in attributes):
        raise MeshError(f"{owner} attributes are not a dict of arrays by name")
    checked = {}
    for name, values in attributes.items():
        array = np.ascontiguousarray(values)
        if array.ndim < 1 or len(array) != n:
            raise MeshError(f"{owner} attribute {name!r}: shape {array.shape} is not ({n}, ...)")
        if array.dtype.kind not in NUMBERS:
            raise MeshError(f"{owner} attribute {name!r}: dtype {array.dtype} is not a number")
        if array.ndim > MAX_DIMENSIONS:
            raise MeshError(f"{owner} attribute {name!r}: more than {MAX_DIMENSIONS} dimensions")
        if math.prod(filter(None, array.shape[1:])) >= MAX_ENTRY:
            raise MeshError(f"{owner} attribute {name!r}: entries of shape {array.shape[1:]}")
        checked[name] = native(array)
    return checked


def checked_offsets(owner: str, values: npt.ArrayLike, n_corners: int) -> npt.NDArray[np.int64]:
    """(m + 1,) where the corners of each row begin; raises MeshError."""
    offsets = np.asarray(values)
    if offsets.ndim != 1 or not len(offsets) or not np.issubdtype(offsets.dtype, np.integer):
        raise MeshError(f"{owner} offsets: shape {offsets.shape} of {offsets.dtype} is no (m + 1,)")
    if offsets[0] != 0 or offsets[-1] != n_corners or (np.diff(offsets) < 0).any():
        raise MeshError(f"{owner} offsets do not ascend from 0 to the {n_corners} corners")
    return np.ascontiguousarray(offsets, np.int64)


def check_indices(
    owner: str,
    corners: npt.NDArray[Any],
    offsets: npt.NDArray[np.int64] | None,
    n_vertices: int,
) -> None:
    """Raises MeshError where a corner is no vertex; offsets None: rows of three."""
    if corners.dtype.kind not in "iu":
        raise MeshError(f"{owner}s: dtype {corners.dtype} is not an integer")
    # As unsigned integers, negative ones are the largest.
    unsigned = corners.view(f"{corners.dtype.byteorder}u{corners.itemsize}")
    if not corners.size or unsigned.max() < n_vertices:
        return
    flat = corners.reshape(-1)
    at = int(np.flatnonzero((flat < 0) | (flat >= n_vertices))[0])
    row = at // 3 if offsets is None else int(np.searchsorted(offsets, at, side="right")) - 1
    raise MeshError(f"{owner} {row}: vertex {flat[at]} is out of range (there are {n_vertices})")
