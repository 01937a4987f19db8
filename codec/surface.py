"""Triangles in output order, as both sides know them, and where they come from."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, polygons
from ebz.codec.polygons import Cut, PolygonCorners, PolygonSource, Triangles

Int32s = npt.NDArray[np.int32]
Int64s = npt.NDArray[np.int64]
# From a corner of a triangle, by its number there, to each of the three in turn.
_TURNS = np.array([[0, 1, 2], [0, 1, -1], [0, -2, -1]], np.int32)


@dataclass(frozen=True)
class Surface:
    """Corners of triangles in output order: half-edge 3i is the gate of triangle i.

    opposite: (3m,) the half-edge across, -1 on a boundary.  piece_vertex: (3m,) vertices of the
    manifold pieces.  vertex_of_piece: the mesh vertex of each, numbered by first use.
    n_vertices: of the mesh, those that faces use.
    polygons: the faces that the triangles make; None where they are the faces.
    """

    opposite: Int32s
    piece_vertex: Int32s
    vertex_of_piece: Int32s
    n_vertices: int
    polygons: PolygonCorners | None = None

    @cached_property
    def vertex(self) -> Int32s:
        """(3m,) the mesh vertex of each corner."""
        if not self.has_copies:
            return self.piece_vertex
        return _kernels.glue(self.piece_vertex, self.vertex_of_piece)

    @cached_property
    def triangles(self) -> Triangles:
        """Along which to predict, by few operations."""
        return self.cut(Cut.COMPLETING)

    def cut(self, way: Cut) -> Triangles:
        """Along which to predict: polygons are cut anew."""
        if self.polygons is None:
            return Triangles(self.opposite)
        return polygons.cut(self.polygons, self.opposite, self.vertex, self.n_vertices, way)

    @property
    def has_copies(self) -> bool:
        """Whether a piece vertex is glued; if not, vertices are numbered as those of the pieces."""
        return self.n_vertices < len(self.vertex_of_piece)


class OutputOrder(NamedTuple):
    """Where the faces and vertices of the decoded mesh come from.

    corners: (t,) the corner of the source that becomes the first corner of each triangle.
    vertices: (n,) the source vertex of each vertex; those that no face uses come last.
    polygons: None where triangles are the faces.
    """

    corners: Int32s
    vertices: Int64s
    polygons: PolygonSource | None = None

    @property
    def faces(self) -> Int32s:
        """(m,) the source face of each face."""
        return self.corners // 3 if self.polygons is None else self.polygons.faces

    @property
    def rotations(self) -> Int32s:
        """(m,) which corner of the source face comes first in each face."""
        return self.corners % 3 if self.polygons is None else self.polygons.rotations

    def number_of(self, vertices: npt.NDArray[Any]) -> Int64s:
        """The numbers of source vertices in the output."""
        number = np.empty(len(self.vertices), np.int64)
        number[self.vertices] = np.arange(len(self.vertices))
        return np.take(number, vertices)

    @property
    def all_corners(self) -> Int32s:
        """(3t,) the corner of the source that becomes each corner of a triangle."""
        if self.polygons is not None:
            return self.polygons.corners
        return (self.corners[:, None] + _TURNS[self.corners % 3]).reshape(-1)
