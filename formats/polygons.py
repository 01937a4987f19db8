"""Polygons given by their corners -> triangles, or a refusal that says what to do."""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError

Place: TypeAlias = Callable[[int], str]


def triangles(
    lengths: npt.NDArray[Any], corners: npt.NDArray[Any], *, triangulate: bool, place: Place
) -> tuple[npt.NDArray[Any], npt.NDArray[np.intp] | None]:
    """Faces (m, 3) from polygons of `lengths` corners each, in order.

    Returns the faces, and the polygon that each face came from (None where they are the same).
    A polygon of k corners becomes the fan (0, 1, 2), (0, 2, 3) ... (0, k - 2, k - 1).
    Raises MeshError, at `place(polygon)`, for fewer than three corners, and for more than three
    unless `triangulate`.
    """
    if not lengths.size or (lengths == 3).all():
        return corners.reshape(-1, 3), None
    if lengths.min() < 3:
        bad = int(np.argmax(lengths < 3))
        n = int(lengths[bad])
        raise MeshError(f"{place(bad)} has {n} corner{'s' * (n != 1)}: a face has at least three")
    if not triangulate:
        bad = int(np.argmax(lengths > 3))
        raise MeshError(
            f"{place(bad)} has {lengths[bad]} corners: only triangles are kept as they are; "
            "--triangulate cuts polygons into fans of triangles"
        )
    return _fans(lengths.astype(np.intp), corners)


def _fans(
    lengths: npt.NDArray[np.intp], corners: npt.NDArray[Any]
) -> tuple[npt.NDArray[Any], npt.NDArray[np.intp]]:
    first = np.cumsum(lengths) - lengths
    n_fan = lengths - 2
    origin = np.repeat(np.arange(len(lengths)), n_fan)
    step = np.arange(len(origin)) - np.repeat(np.cumsum(n_fan) - n_fan, n_fan)
    base = first[origin]
    corner = np.stack([base, base + step + 1, base + step + 2], axis=1)
    return corners[corner], origin


def check_indices(faces: npt.NDArray[Any], n_vertices: int, place: Place) -> None:
    """Raises MeshError at the first face that refers to a vertex outside 0 .. n_vertices - 1."""
    if not faces.size or (faces.min() >= 0 and faces.max() < n_vertices):
        return
    row, corner = np.argwhere((faces < 0) | (faces >= n_vertices))[0]
    there = "there are" if n_vertices != 1 else "there is"
    raise MeshError(
        f"{place(int(row))} refers to vertex {faces[row, corner]}, but {there} {n_vertices}"
    )
