"""Vertices at equal positions: coded as one site of the surface, and split again afterwards.

Seams (of texture coordinates, of sharp edges) and triangle soups repeat positions.  The word and
the positions are those of the welded surface; the splits stream tells which corners at a site
belong to which vertex, so that the decoded mesh has its own vertices again.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.errors import CorruptError
from ebz.codec.surface import Int32s, Int64s, OutputOrder, Surface


class Split(NamedTuple):
    """The decoder's side: the vertex of each corner, and the coded sites.

    n_used: sites in faces, each with the vertex of its number.  more: (k,) the sites of the
    vertices that follow.  n_isolated: vertices that come last, sites of their own.
    """

    vertex: Int32s
    n_used: int
    more: Int32s
    n_isolated: int

    @property
    def n_sites(self) -> int:
        return self.n_used + self.n_isolated

    @property
    def site(self) -> Int32s | None:
        """(n,) that of each vertex; None where each vertex is the site of its number."""
        return self.at_sites(np.arange(self.n_sites, dtype=np.int32)) if len(self.more) else None

    def at_sites(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values per site, for each vertex."""
        if not len(self.more):
            return values
        n = self.n_used + len(self.more)
        placed = np.empty((n + self.n_isolated, *values.shape[1:]), values.dtype)
        placed[: self.n_used], placed[n:] = values[: self.n_used], values[self.n_used :]
        np.take(values, self.more, axis=0, out=placed[self.n_used : n], mode="clip")
        return placed


class Arrangement(NamedTuple):
    """What is coded of the vertices, and where it comes from.

    split: what decoding yields.  vertices: (n,) the source of each output vertex.  sites: the
    source vertex of each position that is coded.  splits: None where sites are vertices.
    """

    split: Split
    vertices: Int64s
    sites: Int64s
    splits: bytes | None


def weld(
    faces: npt.NDArray[Any], stored: npt.NDArray[Any], offsets: Int64s | None = None
) -> npt.NDArray[Any]:
    """The faces with one vertex for all at a seam's position; the same array if there are none.

    stored: (n, 3) the coordinates as they will be decoded.  offsets: of polygons.
    """
    bits = np.ascontiguousarray(stored).view(f"i{stored.dtype.itemsize}").reshape(-1)
    small = np.zeros(0, np.int32) if offsets is None else offsets.astype(np.int32)
    first = _kernels.weld(_compact(faces), small, bits)
    return faces if not len(first) else np.take(first, faces, mode="clip")


def arrange(
    faces: npt.NDArray[Any], welded: npt.NDArray[Any], surface: Surface, order: OutputOrder
) -> Arrangement:
    """The vertices of `faces` along the surface of the welded faces, in their output order."""
    n_vertices, n_sites = len(order.vertices), surface.n_vertices
    if welded is faces:
        whole = _unsplit(surface, n_vertices)
        return Arrangement(whole, order.vertices, order.vertices, None)
    source = np.take(_compact(faces), order.all_corners, mode="clip")
    splits, vertex, more, used = _kernels.encode_splits(*fans(surface), source)
    is_unused = np.ones(n_vertices, bool)
    is_unused[used] = False
    unused = np.flatnonzero(is_unused)
    return Arrangement(
        Split(vertex, n_sites, more, len(unused)),
        np.concatenate([used, unused]),
        np.concatenate([order.vertices[:n_sites], unused]),
        splits,
    )


def _unsplit(surface: Surface, n_vertices: int) -> Split:
    n_sites = surface.n_vertices
    return Split(surface.vertex, n_sites, np.zeros(0, np.int32), n_vertices - n_sites)


def _compact(faces: npt.NDArray[Any]) -> Int32s:
    return np.ascontiguousarray(faces, np.int32).reshape(-1)


def fans(surface: Surface) -> tuple[Int32s, Int32s, Int32s, Int32s, int]:
    """The half-edge across each corner, its fan and its site; the site of each fan; n_sites."""
    sites = surface.vertex, surface.vertex_of_piece, surface.n_vertices
    return surface.opposite, surface.piece_vertex, *sites


def split(surface: Surface, splits: bytes | None, n_vertices: int) -> Split:
    """Which vertex each corner has; raises CorruptError where there are more than n_vertices."""
    found = _unsplit(surface, n_vertices)
    if splits is not None:
        vertex, more = _kernels.decode_splits(splits, *fans(surface))
        found = Split(vertex, found.n_used, more, found.n_isolated - len(more))
    if found.n_isolated < 0:
        raise CorruptError(f"more vertices than the {n_vertices} declared")
    return found
