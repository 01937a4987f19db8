"""Faces of any number of corners: all corners in one array, and where those of a face begin."""

import enum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels

Int32s = npt.NDArray[np.int32]
Int64s = npt.NDArray[np.int64]

# Of triangles that stand for one and two corners, as in the kernels.
MARKS = np.array([0, 3, 2], np.uint8)


class PolygonCorners(NamedTuple):
    """The polygons of a surface, in output order; those without corners come last.

    offsets: (m + 1,) where the corners of each begin.  corner: (k,) the corner of a triangle that
    each of their corners is.
    """

    offsets: Int64s
    corner: Int32s

    @property
    def n_faces(self) -> int:
        return len(self.offsets) - 1

    def across(self, opposite: Int32s) -> Int32s:
        """(k,) the corner whose edge lies across that of each corner, -1 on a boundary."""
        number = np.full(len(opposite) + 1, -1, np.int32)
        number[self.corner] = np.arange(len(self.corner), dtype=np.int32)
        across: Int32s = number[opposite[self.corner]]  # -1 is the last entry
        return across


class Cut(enum.IntEnum):
    """How polygons are cut to predict along; the numbers are those of Cut in the kernels."""

    COMPLETING = 0
    REGULAR = 1
    TWICE = 2


class Triangles(NamedTuple):
    """The triangles along which values are predicted.

    opposite: (3t,) the half-edge across.  corner: (3t,) the corner of the surface's triangles that
    each is; None where these are the triangles.
    """

    opposite: Int32s
    corner: Int32s | None = None

    def at_corners(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Those of the corners of the surface's triangles, of the corners here."""
        return values if self.corner is None else values[self.corner]

    def numbered(self, item: Int32s, n: int, *, as_they_are: bool) -> tuple[Int32s, Int32s | None]:
        """Of n items by corner, new numbers by corner here, and the item of each number.

        Numbers are by first corner here, then of what has none; None where they are as they were.
        as_they_are: whether they were by first corner of the surface's triangles.
        """
        if self.corner is None and as_they_are:
            return item, None
        number, first = _kernels.number_by_first_use(self.at_corners(item), n)
        is_left = np.ones(n, bool)
        is_left[first] = False
        return number, np.concatenate([first, np.flatnonzero(is_left).astype(np.int32)])


def cut(
    polygons: PolygonCorners, opposite: Int32s, vertex: Int32s, n_vertices: int, way: Cut
) -> Triangles:
    """Polygons cut in another way; opposite, vertex: of the corners of the surface's triangles."""
    offsets = polygons.offsets.astype(np.int32)
    across, own = polygons.across(opposite), vertex[polygons.corner]
    opposite, corner = _kernels.cut_polygons(own, offsets, across, n_vertices, way)
    return Triangles(opposite, polygons.corner[corner])


class PolygonCounts(NamedTuple):
    """What a file says of polygons: faces, those without corners among them, and corners."""

    n_faces: int
    n_empty: int
    n_corners: int


class PolygonSource(NamedTuple):
    """Where the polygons of the output come from.

    faces: (m,) the source face of each.  rotations: (m,) which corner of that comes first.
    corners: (3t,) the source corner of each corner of a triangle.
    """

    faces: Int32s
    rotations: Int32s
    corners: Int32s


class Padded(NamedTuple):
    """The faces that have corners, with three at least: the last corner is repeated.

    faces: their numbers.  offsets: (m' + 1,).  corner: which corner each one is.
    """

    faces: Int32s
    offsets: Int32s
    corner: Int32s
    sizes: Int32s  # before

    def face_of(self, corners: Int32s) -> Int32s:
        """Among those that have corners, the face of each padded corner."""
        return (np.searchsorted(self.offsets, corners, side="right") - 1).astype(np.int32)

    def mark_short(self, marks: npt.NDArray[np.uint8], gates: Int32s, n_closed: int) -> None:
        """Sets the marks of faces that were padded; gates: a padded corner of each triangle.

        These are among the single faces, before whose triangles all n_closed without a symbol come.
        """
        if (self.sizes < 3).any():
            sizes = self.sizes[self.face_of(gates)]
            short = np.flatnonzero(sizes < 3)
            marks[short - n_closed] = MARKS[sizes[short]]


def padded(offsets: Int64s) -> Padded:
    """The faces of (m + 1,) offsets as the kernels take them."""
    sizes = np.diff(offsets)
    faces = np.flatnonzero(sizes)
    sizes = sizes[faces]
    starts = np.concatenate([[0], np.cumsum(np.maximum(sizes, 3))])
    place = positions_within(starts)
    corner = np.repeat(offsets[faces], np.diff(starts))
    corner += np.minimum(place, np.repeat(sizes - 1, np.diff(starts)))
    return Padded(*(a.astype(np.int32) for a in (faces, starts, corner, sizes)))


def with_empty(offsets: npt.NDArray[Any], n_empty: int) -> Int64s:
    """Offsets of n_empty more faces."""
    return np.concatenate([offsets, np.full(n_empty, offsets[-1])]).astype(np.int64)


def positions_within(offsets: npt.NDArray[Any]) -> Int64s:
    """(k,) the place of each corner within its face."""
    place: Int64s = np.arange(offsets[-1]) - np.repeat(offsets[:-1], np.diff(offsets))
    return place


def corner_index(
    offsets: npt.NDArray[Any], faces: npt.NDArray[Any], rotations: npt.NDArray[Any]
) -> tuple[Int64s, Int64s]:
    """The corners of `faces` in that order, each from its corner `rotations` on; their offsets."""
    sizes = np.diff(offsets)[faces]
    taken = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    turned = positions_within(taken) + np.repeat(rotations, sizes)
    turned %= np.repeat(np.maximum(sizes, 1), sizes)
    return np.repeat(offsets[:-1][faces], sizes) + turned, taken
