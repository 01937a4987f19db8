"""Rows of a mesh besides its vertices and faces: lines, edges, points, whatever a file has."""

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
)


@dataclass(eq=False)
class Element:
    """Rows in their order, each with any number of vertices, and attributes.

    corners: (k,) int32 (int64 as Mesh.faces), the vertices of all rows one after another; they
    follow the vertices where those are renumbered.  offsets: (r + 1,) int64, as Mesh.face_offsets.
    attributes, corner_attributes: arrays by name whose first axis has r or k entries.
    """

    offsets: npt.NDArray[np.int64]
    corners: npt.NDArray[Any] = field(default_factory=lambda: np.zeros(0, np.int32))
    attributes: Attributes = field(default_factory=dict)
    corner_attributes: Attributes = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def check(self, name: str, n_vertices: int) -> None:
        """Raises MeshError where shapes, dtypes or indices do not fit."""
        corners = np.ascontiguousarray(self.corners).reshape(-1)
        self.offsets = checked_offsets(name, self.offsets, len(corners))
        check_indices(name, corners, self.offsets, n_vertices)
        self.corners = corners.astype(face_dtype(n_vertices), copy=False)
        self.attributes = checked_attributes(name, self.attributes, len(self))
        self.corner_attributes = checked_attributes(
            f"{name} corner", self.corner_attributes, len(self.corners)
        )


def rows(n: int, attributes: Attributes) -> Element:
    """An element of n rows that refer to no vertex."""
    return Element(np.zeros(n + 1, np.int64), attributes=attributes)
