"""What the entries of an attribute stand for, and how they lie along the surface."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.connectivity import Int32s
from ebz.codec.polygons import PolygonCorners

Floats = npt.NDArray[np.float64]
NOTHING = np.zeros(0, np.int32)
NOWHERE = np.zeros((0, 3))


@dataclass(frozen=True)
class Sites:
    """The decoded surface that all attributes share, in output order.

    opposite, vertex: (3t,) the half-edge across, and the vertex of each corner of the triangles.
    vertices: (n, 3) float32 or float64, as decoded.  site: (n,) that of each vertex: those of one
    site have the same coordinates; None where each has its own.
    polygons: None where triangles are the faces.
    """

    opposite: Int32s
    vertex: Int32s
    vertices: npt.NDArray[Any]
    site: npt.NDArray[Any] | None
    polygons: PolygonCorners | None = None

    @property
    def n_vertices(self) -> int:
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        return len(self.vertex) // 3 if self.polygons is None else self.polygons.n_faces

    def of_faces(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values of the triangles' corners as those of the corners of the faces."""
        return values if self.polygons is None else values[self.polygons.corner]

    @cached_property
    def by_vertex(self) -> "Items":
        """A vertex each."""
        return Items(self.n_vertices, self.opposite, self.vertex, self, np.arange(self.n_vertices))

    @cached_property
    def by_face(self) -> "Items":
        """A face each."""
        if self.polygons is None:
            return Items(self.n_faces, self.opposite, sites=self)
        offsets = self.polygons.offsets.astype(np.int32)
        return Items(self.n_faces, self.polygons.across(self.opposite), sites=self, offsets=offsets)

    def by_wedge(self, wedge: Int32s, n_wedges: int) -> "Items":
        """The corners of one wedge each: those at a vertex that have the same value."""
        vertex = np.zeros(n_wedges, np.int32)
        vertex[wedge] = self.vertex
        return Items(n_wedges, self.opposite, wedge, self, vertex)

    @cached_property
    def points(self) -> Floats:
        """(n, 3) the coordinates of the vertices."""
        with np.errstate(invalid="ignore"):
            return self.vertices.astype(np.float64)

    @cached_property
    def corner_points(self) -> Floats:
        """(3t, 3) where the corners of the triangles are."""
        return self.points[self.vertex]

    @cached_property
    def face_products(self) -> Floats:
        """(t, 3) the products of edges: normals of the triangles, as long as twice the area."""
        a, b, c = (self.corner_points[i::3] for i in range(3))
        with np.errstate(all="ignore"):
            return np.cross(b - a, c - a)

    @cached_property
    def polygon_products(self) -> Floats:
        """(m, 3) of each face the sum over its triangles."""
        if self.polygons is None:
            return self.face_products
        sizes = np.diff(self.polygons.offsets)
        n_triangles = np.where(sizes > 0, np.maximum(sizes - 2, 1), 0)
        face = np.repeat(np.arange(len(sizes)), n_triangles)
        columns = (np.bincount(face, column, len(sizes)) for column in self.face_products.T)
        return np.stack(list(columns), axis=1)


@dataclass(frozen=True)
class Items:
    """n entries, along a surface where there is one.

    opposite, item: (3m,) the half-edge across and the entry of each corner; without item, entries
    are those of the faces; without both they are rows.  at: (n,) the vertex of each entry.
    offsets: (n + 1,) where the half-edges of each face begin; nothing where faces are triangles.
    """

    n: int
    opposite: Int32s = field(default_factory=lambda: NOTHING)
    item: Int32s = field(default_factory=lambda: NOTHING)
    sites: Sites | None = None
    at: npt.NDArray[Any] = field(default_factory=lambda: NOTHING)
    offsets: Int32s = field(default_factory=lambda: NOTHING)

    @property
    def has_surface(self) -> bool:
        return len(self.opposite) > 0

    @property
    def is_by_corner(self) -> bool:
        """Whether entries are those of corners, not of faces."""
        return len(self.item) > 0

    @property
    def points(self) -> Floats:
        """(n, 3) where entries are, nothing where they are nowhere."""
        return NOWHERE if self.sites is None else self.sites.points[self.at]

    @property
    def corner_points(self) -> Floats:
        """(3m, 3) where the corners of the surface are."""
        return NOWHERE if self.sites is None else self.sites.corner_points

    @property
    def face_products(self) -> Floats:
        """Normals as long as twice the area: of triangles, or of the faces that entries are of."""
        if self.sites is None:
            return NOWHERE
        return self.sites.face_products if self.is_by_corner else self.sites.polygon_products

    @property
    def site(self) -> Int32s:
        """(n,) entries of one site are at one place; nothing where none are."""
        if self.sites is None or not len(self.at):
            return NOTHING
        numbers = self.sites.site
        site = (self.at if numbers is None else numbers[self.at]).astype(np.int32)
        return site if int(site.max()) + 1 < len(site) else NOTHING


def rows(n: int) -> Items:
    """Entries one after another, on no surface."""
    return Items(n)
