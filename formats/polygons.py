"""Polygons given by their corners: checked, or cut into fans of triangles."""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped

Place: TypeAlias = Callable[[int], str]


def offsets_of(lengths: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
    """(m + 1,) where the corners of each row begin, from how many each has."""
    return np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)])


def row_of(offsets: npt.NDArray[np.int64], corner: int) -> int:
    """The row that a corner belongs to."""
    return int(np.searchsorted(offsets, corner, side="right")) - 1


def check_indices(
    corners: npt.NDArray[Any], lengths: npt.NDArray[Any], n_vertices: int, place: Place
) -> None:
    """Raises MeshError at the first row that refers to a vertex outside 0 .. n_vertices - 1."""
    if not corners.size or (corners.min() >= 0 and corners.max() < n_vertices):
        return
    at = int(np.argmax((corners < 0) | (corners >= n_vertices)))
    there = "there are" if n_vertices != 1 else "there is"
    row = row_of(offsets_of(lengths), at)
    raise MeshError(f"{place(row)} refers to vertex {corners[at]}, but {there} {n_vertices}")


def triangulated(mesh: Mesh, format: str) -> Mesh:
    """The mesh for a format of triangles alone; warns of what is cut up."""
    n_polygons = int(np.count_nonzero(np.diff(mesh.offsets) != 3))
    if not n_polygons:
        return mesh
    warn_dropped(f"{format} holds triangles only: {n_polygons} polygons are cut up")
    return fanned(mesh)


def fanned(mesh: Mesh) -> Mesh:
    """The mesh with each polygon (0, 1, ..., k - 1) cut into (0, 1, 2), (0, 2, 3), ...

    Attributes of faces are repeated, those of corners follow. Warns of faces with fewer than three
    corners, which leave no triangle.
    """
    if mesh.is_triangles:
        return mesh
    lengths = np.diff(mesh.offsets)
    n_short = int(np.count_nonzero(lengths < 3))
    if n_short:
        warn_dropped(f"{n_short} faces with fewer than three corners")
    corner, origin = _fans(mesh.offsets, np.maximum(lengths - 2, 0))
    return Mesh(
        mesh.vertices,
        mesh.faces[corner],
        mesh.vertex_attributes,
        {name: values[origin] for name, values in mesh.face_attributes.items()},
        mesh.metadata,
        corner_attributes={
            name: values[corner.ravel()] for name, values in mesh.corner_attributes.items()
        },
        elements=mesh.elements,
    )


def _fans(
    offsets: npt.NDArray[np.int64], n_fan: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.intp]]:
    """The corners (m, 3) of the triangles, and the polygon that each came from."""
    origin = np.repeat(np.arange(len(n_fan)), n_fan)
    step = np.arange(len(origin)) - np.repeat(np.cumsum(n_fan) - n_fan, n_fan)
    base = offsets[origin]
    return np.stack([base, base + step + 1, base + step + 2], axis=1), origin
