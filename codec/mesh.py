"""The mesh: arrays of vertices and faces, and everything else that it carries, by name."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import (
    Attributes,
    check_indices,
    checked_attributes,
    checked_offsets,
    face_dtype,
    native,
)
from ebz.codec.elements import Element
from ebz.codec.errors import MeshError

VERTEX_DTYPES = (np.dtype(np.float32), np.dtype(np.float64))
# What can be coded: half-edges and vertices have indices of 32 bits inside the kernels.
MAX_FACES = (2**31 - 1) // 3
MAX_VERTICES = 2**31 - 1


@dataclass(eq=False)
class Mesh:
    """A mesh of triangles or of polygons.

    vertices: (n, 3) float32 or float64, in model units; the dtype is kept.
    faces: (m, 3) int32 (int64 from 2^31 vertices on), counter-clockwise from outside; where some
    face is no triangle, (k,) the corners of all faces one after another.
    face_offsets: None for triangles; else (m + 1,) int64: face i has the corners
    faces[face_offsets[i]:face_offsets[i + 1]].  Faces given as (m, d) have d corners each.
    vertex_attributes, face_attributes, corner_attributes: arrays by name whose first axis has n, m
    or k entries (3 m for triangles), corners in the order of the faces.
    elements: what else refers to vertices or stands beside them (lines, edges, ...), by name.
    metadata: JSON-like values by name (None, bool, int, float, str, bytes, list, dict).

    Raises MeshError where shapes, dtypes or indices do not fit.
    """

    vertices: npt.NDArray[Any]
    faces: npt.NDArray[Any]
    vertex_attributes: Attributes = field(default_factory=dict)
    face_attributes: Attributes = field(default_factory=dict)
    metadata: dict[str, Any] = field(default_factory=dict)
    face_offsets: npt.NDArray[np.int64] | None = None
    corner_attributes: Attributes = field(default_factory=dict)
    elements: dict[str, Element] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.vertices = _vertices(self.vertices)
        self.faces, self.face_offsets = _faces(self.faces, self.face_offsets, len(self.vertices))
        self.check_carried()

    @classmethod
    def of_triangles(cls, vertices: npt.NDArray[Any], faces: npt.NDArray[Any]) -> "Mesh":
        """A mesh of arrays that are known to be as it has them: nothing is checked."""
        mesh = cls.__new__(cls)
        mesh.vertices, mesh.faces, mesh.face_offsets = vertices, faces, None
        mesh.vertex_attributes, mesh.face_attributes, mesh.corner_attributes = {}, {}, {}
        mesh.elements, mesh.metadata = {}, {}
        return mesh

    def check_carried(self) -> None:
        """Makes attributes contiguous; raises MeshError where they or the elements do not fit."""
        self.vertex_attributes = checked_attributes(
            "vertex", self.vertex_attributes, self.n_vertices
        )
        self.face_attributes = checked_attributes("face", self.face_attributes, self.n_faces)
        self.corner_attributes = checked_attributes(
            "corner", self.corner_attributes, self.n_corners
        )
        for name, element in self.elements.items():
            element.check(name, len(self.vertices))

    def __repr__(self) -> str:
        return f"Mesh({self.n_vertices} vertices, {self.n_faces} faces)"

    @property
    def n_vertices(self) -> int:
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        return len(self.faces) if self.face_offsets is None else len(self.face_offsets) - 1

    @property
    def n_corners(self) -> int:
        return self.faces.size

    @property
    def is_triangles(self) -> bool:
        """Whether all faces are triangles."""
        return self.face_offsets is None

    @property
    def corners(self) -> npt.NDArray[Any]:
        """(k,) the vertex of each corner, face after face."""
        return self.faces.reshape(-1)

    @property
    def offsets(self) -> npt.NDArray[np.int64]:
        """(m + 1,) where the corners of each face begin."""
        if self.face_offsets is None:
            return np.arange(0, 3 * len(self.faces) + 1, 3, dtype=np.int64)
        return self.face_offsets


def _vertices(values: npt.ArrayLike) -> npt.NDArray[Any]:
    array = native(np.ascontiguousarray(values))
    if array.size == 0 and array.ndim < 2:
        array = np.zeros((0, 3), np.float32)
    if array.dtype not in VERTEX_DTYPES:
        if array.dtype.kind not in "iuf":
            raise MeshError(f"vertices: dtype {array.dtype} is not a real number")
        array = array.astype(np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(f"vertices: shape {array.shape} is not (n, 3)")
    return array


def _faces(
    values: npt.ArrayLike, offsets: npt.NDArray[Any] | None, n_vertices: int
) -> tuple[npt.NDArray[Any], npt.NDArray[np.int64] | None]:
    try:
        array = np.asarray(values)
    except ValueError:
        raise MeshError("faces: rows of several lengths need face_offsets") from None
    if array.size == 0 and array.ndim < 2 and offsets is None:
        array = np.zeros((0, 3), np.int32)
    if array.ndim != (2 if offsets is None else 1):
        shape = "(m, 3)" if offsets is None else "(k,) beside face_offsets"
        raise MeshError(f"faces: shape {array.shape} is not {shape}")
    if offsets is None:
        width = array.shape[1]
        offsets = None if width == 3 else np.arange(len(array) + 1, dtype=np.int64) * width
    else:
        offsets = checked_offsets("face", offsets, array.size)
        offsets = None if (np.diff(offsets) == 3).all() else offsets
    check_indices("face", array, offsets, n_vertices)
    corners = np.ascontiguousarray(array, face_dtype(n_vertices))
    return corners.reshape(-1) if offsets is not None else corners.reshape(-1, 3), offsets
