"""Vertices that no face uses: a set of points in an order of its own."""

import numpy as np

from ebz.codec import _kernels
from ebz.codec.errors import CorruptError
from ebz.codec.lattice import Integers
from ebz.codec.welding import Arrangement


def encode(arrangement: Arrangement, integers: Integers) -> tuple[Arrangement, bytes | None]:
    """The points in the coder's order, and their stream, None where there is no such vertex.

    integers: (n, 3) the lattice coordinates of the source's vertices.
    """
    n_used = len(arrangement.vertices) - arrangement.split.n_isolated
    free = arrangement.vertices[n_used:]
    if not len(free):
        return arrangement, None
    stream, order = _kernels.encode_points(integers[free].reshape(-1))
    free = free[order]
    n_along = len(arrangement.sites) - len(free)
    arranged = arrangement._replace(
        vertices=np.concatenate([arrangement.vertices[:n_used], free]),
        sites=np.concatenate([arrangement.sites[:n_along], free]),
    )
    return arranged, stream


def decode(stream: bytes | None, n: int) -> Integers:
    """(n, 3) coordinates; raises CorruptError where the stream holds another number of points."""
    if stream is None:
        return np.zeros((0, 3), np.int64)
    if not n:
        raise CorruptError("every vertex is in a face")
    return _kernels.decode_points(stream, n).reshape(-1, 3)
