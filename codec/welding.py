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
    source = faces.reshape(-1)[order.all_corners]
    vertex, firsts = _kernels.number_by_first_use(
        source.astype(np.int32, copy=False), len(order.vertices)
    )
    n_sites = surface.n_vertices
    isolated = np.ones(len(order.vertices), bool)
    isolated[source] = False
    unused = np.flatnonzero(isolated)
    splits = _kernels.encode_splits(surface.opposite, surface.vertex, n_sites, vertex)
    return Arrangement(
        vertex,
        np.concatenate([firsts, unused]),
        np.concatenate([order.vertices[:n_sites], unused]),
        splits,
    )


class Split(NamedTuple):
    """The decoder's side: the vertex of each corner, and the coded site of each vertex.

    site: (n,), None where each vertex is the site of its number.
    """

    vertex: Int32s
    site: Int32s | None
    n_sites: int

    def at_sites(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values per site, for each vertex."""
        return values if self.site is None else np.take(values, self.site, axis=0, mode="clip")


def split(surface: Surface, splits: bytes | None, n_vertices: int) -> Split:
    """Which vertex each corner has; raises CorruptError where there are more than n_vertices."""
    n_sites, n_used = surface.n_vertices, surface.n_vertices
    vertex: Int32s = surface.vertex
    site: Int32s | None = None
    if splits is not None:
        data = np.frombuffer(splits, np.uint8)
        vertex, site = _kernels.decode_splits(data, surface.opposite, surface.vertex, n_sites)
        n_used = len(site)
    n_isolated = n_vertices - n_used
    if n_isolated < 0:
        raise CorruptError(f"more vertices than the {n_vertices} declared")
    if site is not None and n_isolated:
        site = np.append(site, n_sites + np.arange(n_isolated, dtype=np.int32))
    return Split(vertex, site, n_sites + n_isolated)
