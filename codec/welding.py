"""Vertices at equal positions: coded as one site of the surface, and split again afterwards.

Seams (of texture coordinates, of sharp edges) and triangle soups repeat positions.  The word and
the positions are those of the welded surface; the splits stream tells which corners at a site
belong to which vertex, so that the decoded mesh has its own vertices again.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.connectivity import Int32s, Int64s, OutputOrder, Surface
from ebz.codec.errors import CorruptError


class Arrangement(NamedTuple):
    """What is coded of the vertices, and where it comes from.

    vertex: (3m,) the output vertex of each corner in output order.  vertices: (n,) the source of
    each output vertex; those that no face uses come last.  sites: the source vertex of each
    position that is coded.  splits: None where sites are vertices.
    """

    vertex: Int32s
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
    compact = np.ascontiguousarray(faces, np.int32).reshape(-1)
    small = np.zeros(0, np.int32) if offsets is None else offsets.astype(np.int32)
    first = _kernels.weld(compact, small, bits)
    return faces if not len(first) else first[faces]


def arrange(
    faces: npt.NDArray[Any], welded: npt.NDArray[Any], surface: Surface, order: OutputOrder
) -> Arrangement:
    """The vertices of `faces` along the surface of the welded faces, in their output order."""
    if welded is faces:
        return Arrangement(surface.vertex, order.vertices, order.vertices, None)
    source = faces.reshape(-1)[order.all_corners].astype(np.int32, copy=False)
    splits, vertex = _kernels.encode_splits(*fans(surface), source)
    vertices = np.empty(int(vertex.max()) + 1, np.int64)
    vertices[vertex] = source
    is_unused = np.ones(len(order.vertices), bool)
    is_unused[vertices] = False
    unused = np.flatnonzero(is_unused)
    return Arrangement(
        vertex,
        np.concatenate([vertices, unused]),
        np.concatenate([order.vertices[: surface.n_vertices], unused]),
        splits,
    )


def fans(surface: Surface) -> tuple[Int32s, Int32s, Int32s, Int32s, int]:
    """The half-edge across each corner, its fan and its site; the site of each fan; n_sites."""
    sites = surface.vertex, surface.vertex_of_piece, surface.n_vertices
    return surface.opposite, surface.piece_vertex, *sites


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
        used, isolated = values[: self.n_used], values[self.n_used :]
        return np.concatenate([used, np.take(used, self.more, axis=0, mode="clip"), isolated])


def split(surface: Surface, splits: bytes | None, n_vertices: int) -> Split:
    """Which vertex each corner has; raises CorruptError where there are more than n_vertices."""
    vertex, more = surface.vertex, np.zeros(0, np.int32)
    if splits is not None:
        data = np.frombuffer(splits, np.uint8)
        vertex, more = _kernels.decode_splits(data, *fans(surface))
    n_isolated = n_vertices - surface.n_vertices - len(more)
    if n_isolated < 0:
        raise CorruptError(f"more vertices than the {n_vertices} declared")
    return Split(vertex, surface.n_vertices, more, n_isolated)
