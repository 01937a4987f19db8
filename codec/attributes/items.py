"""What the entries of an attribute stand for, and how they lie along the surface."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.connectivity import Int32s

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sites:
    """The decoded surface that all attributes share, in output order.

    opposite, vertex: (3m,) the half-edge across, and the vertex of each corner.
    vertices: (n, 3) float32 or float64, as decoded.
    """

    opposite: Int32s
    vertex: Int32s
    vertices: npt.NDArray[Any]

    @property
    def n_vertices(self) -> int:
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        return len(self.vertex) // 3

    @cached_property
    def by_vertex(self) -> "Items":
        """A vertex each."""
        return Items(self.n_vertices, self.opposite, self.vertex)

    @cached_property
    def by_face(self) -> "Items":
        """A face each."""
        return Items(self.n_faces, self.opposite)

    def by_wedge(self, wedge: Int32s, n_wedges: int) -> "Items":
        """The corners of one wedge each: those at a vertex that have the same value."""
        return Items(n_wedges, self.opposite, wedge)


@dataclass(frozen=True)
class Items:
    """n entries; item: (3m,) that of each corner, None where entries are those of faces or rows."""

    n: int
    opposite: Int32s | None = None
    item: Int32s | None = None


def rows(n: int) -> Items:
    """Entries one after another, on no surface."""
    return Items(n)
