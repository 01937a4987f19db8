"""What the entries of an attribute stand for, and how they lie along the surface."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.errors import CorruptError
from ebz.codec.order import SourceOrder
from ebz.codec.polygons import PolygonCorners, Triangles
from ebz.codec.surface import Int32s, Surface
from ebz.codec.welding import Split

Floats = npt.NDArray[np.float64]
NOTHING = np.zeros(0, np.int32)
NOWHERE = np.zeros((0, 3))


@dataclass(frozen=True)
class Sites:
    """The decoded surface that all attributes share, in output order.

    vertices: (n, 3) float32 or float64, as decoded.
    source: the order that is kept.
    """

    surface: Surface
    split: Split
    vertices: npt.NDArray[Any]
    source: SourceOrder

    @property
    def vertex(self) -> Int32s:
        """(3t,) that of each corner of the surface's triangles."""
        return self.split.vertex

    @property
    def opposite(self) -> Int32s:
        """(3t,) the half-edge across each corner of the surface's triangles."""
        return self.surface.opposite

    @property
    def polygons(self) -> PolygonCorners | None:
        """None where triangles are the faces."""
        return self.surface.polygons

    @property
    def triangles(self) -> Triangles:
        """Along which values are predicted."""
        return self.surface.triangles

    @property
    def n_vertices(self) -> int:
        return len(self.vertices)

    @property
    def n_used(self) -> int:
        """Vertices in faces, which come first."""
        return int(self.vertex.max(initial=-1)) + 1

    @property
    def n_faces(self) -> int:
        return len(self.vertex) // 3 if self.polygons is None else self.polygons.n_faces

    def of_faces(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values of the triangles' corners as those of the corners of the faces."""
        return values if self.polygons is None else values[self.polygons.corner]

    @cached_property
    def face_offsets(self) -> Int32s:
        """(m + 1,) where the corners of each face begin; nothing where faces are triangles."""
        return NOTHING if self.polygons is None else self.polygons.offsets.astype(np.int32)

    @cached_property
    def by_vertex(self) -> "Items":
        """A vertex each."""
        numbers = np.arange(self.n_vertices)
        placed = self.source.place_vertices(numbers) if self.source.has_all else None
        return self._by_corner(self.vertex, numbers, placed)

    @cached_property
    def by_face(self) -> "Items":
        """A face each."""
        numbers, across = np.arange(self.n_faces), self.opposite
        placed = self.source.place_faces(numbers) if self.source.has_all else None
        if self.polygons is not None:
            across = self.polygons.across(self.opposite)
        return Items(self.n_faces, across, sites=self, offsets=self.face_offsets, of_source=placed)

    def by_wedge(self, wedge: Int32s, n_wedges: int) -> "Items":
        """The corners of one wedge each: those at a vertex that have the same value."""
        vertex = np.zeros(n_wedges, np.int32)
        vertex[wedge] = self.vertex
        placed = None
        if self.source.has_all:
            corners = self.source.place_values(self.of_faces(wedge))
            placed = _kernels.number_by_first_use(corners, n_wedges)[1]
        return self._by_corner(wedge, vertex, placed)

    def _by_corner(
        self, item: Int32s, at: npt.NDArray[Any], of_source: npt.NDArray[Any] | None
    ) -> "Items":
        """item: (3t,) of each corner of the surface's triangles.  at: the vertex of each item."""
        n, opposite = len(at), self.triangles.opposite
        is_split = int(item.max(initial=-1)) >= self.surface.n_vertices
        along, order = self.triangles.numbered(item, n, as_they_are=not is_split)
        if order is None:
            return Items(n, opposite, along, self, at, corners=item, of_source=of_source)
        number = np.empty(n, np.int32)
        number[order] = np.arange(n, dtype=np.int32)
        corners = number[self.of_faces(item)]
        return Items(
            n, opposite, along, self, at[order], corners=corners, order=order, of_source=of_source
        )

    @cached_property
    def points(self) -> Floats:
        """(n, 3) the coordinates of the vertices."""
        with np.errstate(invalid="ignore"):
            return self.vertices.astype(np.float64)


class Items(NamedTuple):
    """n entries, along a surface where there is one.

    opposite, item: (3m,) the half-edge across and the entry of each corner; without item, entries
    are those of the faces; without both they are rows.  at: (n,) the vertex of each entry.
    offsets: (n + 1,) where the half-edges of each face begin; nothing where faces are triangles.
    corners: (k,) the entry of each corner of the faces; nothing where entries are no corners.
    order: (n,) the number that each entry has elsewhere; None where it is the same.
    of_source: (n,) these numbers as the source has the entries; None where its order is not kept.
    """

    n: int
    opposite: Int32s = NOTHING
    item: Int32s = NOTHING
    sites: Sites | None = None
    at: npt.NDArray[Any] = NOTHING
    offsets: Int32s = NOTHING
    corners: Int32s = NOTHING
    order: npt.NDArray[Any] | None = None
    of_source: npt.NDArray[Any] | None = None

    @property
    def rows_of_source(self) -> "Items":
        """The entries one after another as the source has them; raises CorruptError."""
        if self.of_source is None or len(self.of_source) != self.n:
            raise CorruptError("entries in an order that is not kept")
        return Items(self.n, order=self.of_source)

    def arranged(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """(n, ...) values as entries are ordered here."""
        return values if self.order is None else values[self.order]

    def rearranged(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """(n, ...) values as they are elsewhere."""
        if self.order is None:
            return values
        placed = np.empty_like(values)
        placed[self.order] = values
        return placed

    @property
    def has_surface(self) -> bool:
        return len(self.opposite) > 0

    @property
    def is_by_corner(self) -> bool:
        """Whether entries are those of corners, not of faces."""
        return len(self.item) > 0

    @property
    def has_places(self) -> bool:
        """Whether entries are somewhere: those of corners, and of vertices where no face is."""
        return self.is_by_corner or (not self.has_surface and len(self.at) > 0)

    @property
    def points(self) -> Floats:
        """(n, 3) where entries are, nothing where they are nowhere."""
        return NOWHERE if self.sites is None else self.sites.points[self.at]

    @property
    def is_of_polygons(self) -> bool:
        """Whether not all faces of the surface are triangles."""
        return self.sites is not None and self.sites.polygons is not None

    def normals(self, *, by_area: bool, by_angle: bool, as_sums: bool, by_corner: bool) -> Floats:
        """(n, 3) normals of the faces, or means of those around; nothing on no surface."""
        if self.sites is None:
            return NOWHERE
        vertex = self.sites.of_faces(self.sites.vertex)
        of = (self.sites.points.reshape(-1), vertex, self.sites.face_offsets, self.corners, self.n)
        return _kernels.normals(*of, by_area, by_angle, as_sums, by_corner).reshape(-1, 3)

    @property
    def site(self) -> Int32s:
        """(n,) entries of one site are at one place; nothing where none are."""
        if self.sites is None or not len(self.at):
            return NOTHING
        numbers = self.sites.split.site
        site = (self.at if numbers is None else numbers[self.at]).astype(np.int32)
        return site if int(site.max()) + 1 < len(site) else NOTHING


def rows(n: int) -> Items:
    """Entries one after another, on no surface."""
    return Items(n)
