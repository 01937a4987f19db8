"""The mesh: arrays of vertices and triangles, and everything else that it carries, by name."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError

VERTEX_DTYPES = (np.dtype(np.float32), np.dtype(np.float64))
INT32_VERTICES = 2**31
# What can be coded: half-edges and vertices have indices of 32 bits inside the kernels.
MAX_FACES = (2**31 - 1) // 3
MAX_VERTICES = 2**31 - 1
# Those of every numpy.
MAX_DIMENSIONS = 32
# Of the extents of one entry that are not zero: every numpy can make the array.
MAX_ENTRY = 2**31
NUMBERS = "biuf"  # kinds of dtypes


def face_dtype(n_vertices: int) -> np.dtype[Any]:
    """The dtype of face indices for `n_vertices`: int32, int64 from 2^31 vertices on."""
    return np.dtype(np.int32 if n_vertices < INT32_VERTICES else np.int64)


@dataclass(eq=False)
class Mesh:
    """A triangle mesh.

    vertices: (n, 3) float32 or float64, in model units; the dtype is kept.
    faces: (m, 3) int32 (int64 from 2^31 vertices on), counter-clockwise from outside.
    vertex_attributes, face_attributes: arrays by name whose first axis has n or m entries.
    metadata: JSON-like values by name (None, bool, int, float, str, bytes, list, dict).

    Raises MeshError where shapes, dtypes or indices do not fit.
    """

    vertices: npt.NDArray[Any]
    faces: npt.NDArray[Any]
    vertex_attributes: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    face_attributes: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    metadata: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.vertices = _vertices(self.vertices)
        self.faces = _faces(self.faces, len(self.vertices))
        self.vertex_attributes = _attributes("vertex", self.vertex_attributes, len(self.vertices))
        self.face_attributes = _attributes("face", self.face_attributes, len(self.faces))

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} faces)"


def _vertices(values: npt.ArrayLike) -> npt.NDArray[Any]:
    array = _native(np.ascontiguousarray(values))
    if array.size == 0 and array.ndim < 2:
        array = np.zeros((0, 3), np.float32)
    if array.dtype not in VERTEX_DTYPES:
        if not np.issubdtype(array.dtype, np.number) or np.issubdtype(
            array.dtype, np.complexfloating
        ):
            raise MeshError(f"vertices: dtype {array.dtype} is not a real number")
        array = array.astype(np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"vertices: shape {array.shape} is not (n, 3)")
    return array


def _native(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The same values in the byte order of this machine."""
    if array.dtype.isnative:
        return array
    return array.byteswap().view(array.dtype.newbyteorder("="))


def _faces(values: npt.ArrayLike, n_vertices: int) -> npt.NDArray[Any]:
    array = np.asarray(values)
    if array.size == 0 and array.ndim < 2:
        array = np.zeros((0, 3), np.int32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"faces: shape {array.shape} is not (m, 3)")
    if not np.issubdtype(array.dtype, np.integer):
        raise MeshError(f"faces: dtype {array.dtype} is not an integer")
    if array.size and (array.min() < 0 or array.max() >= n_vertices):
        row, corner = np.argwhere((array < 0) | (array >= n_vertices))[0]
        index = array[row, corner]
        raise MeshError(f"face {row}: vertex {index} is out of range (there are {n_vertices})")
    return np.ascontiguousarray(array, face_dtype(n_vertices))


def _attributes(
    owner: str, attributes: dict[str, npt.NDArray[Any]], n: int
) -> dict[str, npt.NDArray[Any]]:
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
        checked[str(name)] = _native(array)
    return checked
