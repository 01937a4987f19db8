"""The source's order of vertices and faces and the first corner of each face <-> streams.

Vertices help to predict faces where faces are sorted by them; faces tell everything about vertices
that are numbered by first use.  Both ways are tried.
"""

import enum
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, polygons
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.codec.polygons import PolygonCorners
from ebz.codec.surface import Int32s, Int64s, OutputOrder

Array = npt.NDArray[Any]
NOTHING = np.zeros(0, np.int32)


class Method(enum.IntEnum):
    """How a stream is coded: its first byte."""

    IDENTITY = 0  # nothing follows
    UNIFORM = 1
    ADAPTIVE = 2
    ALONG_FACES = 3  # of vertices only: adaptive, in the order in which the source's faces use them


@dataclass(frozen=True)
class Permutation:
    """Where the items of a decoded mesh come from.

    vertices: (n,) int64, the original index of each decoded vertex.
    faces: (m,) int64, the original index of each decoded face.
    """

    vertices: Int64s
    faces: Int64s


class OrderStreams(NamedTuple):
    """What is kept of the source's order; None where the decoder's own order stands."""

    vertices: bytes | None = None
    faces: bytes | None = None
    rotations: bytes | None = None

    @property
    def any(self) -> bool:
        """Whether anything is kept."""
        return (self.vertices, self.faces, self.rotations) != (None, None, None)


@dataclass(frozen=True)
class SourceOrder:
    """The source's order, None where it is not kept.

    vertices, faces: the source index of each item of the output; both or neither.
    rotations: (m,) which corner of each face of the output is first in the source.
    offsets: (m + 1,) where the corners of polygons begin in the output; None for triangles.
    """

    vertices: Int32s | None = None
    faces: Int32s | None = None
    rotations: Int32s | None = None
    offsets: Int64s | None = None

    @property
    def any(self) -> bool:
        """Whether anything is kept."""
        return self.vertices is not None or self.rotations is not None

    @property
    def has_all(self) -> bool:
        """Whether the order of vertices and faces is kept."""
        return self.vertices is not None

    def place_vertices(self, values: Array) -> Array:
        """Values per vertex of the output, in the order of the source."""
        return _placed(values, self.vertices)

    def place_faces(self, values: Array) -> Array:
        """Values per face of the output, in the order of the source."""
        return _placed(values, self.faces)

    def place_values(self, values: Array) -> Array:
        """Values per corner of the output, in the order of the source."""
        if self.rotations is None and self.faces is None:
            return values
        return values[self._corners_of_source[0]]

    def source_vertices(self, vertices: Array) -> Array:
        """Vertices of the output, as the source numbers them."""
        return vertices if self.vertices is None else self.vertices[vertices]

    @property
    def source_offsets(self) -> Int64s | None:
        """Where the corners of polygons begin in the source."""
        if self.faces is None or self.offsets is None:
            return self.offsets
        return self._corners_of_source[1]

    @cached_property
    def _corners_of_source(self) -> tuple[Int64s, Int64s | None]:
        """The corner of the output that each one of the source is, and the offsets there."""
        some = self.faces if self.faces is not None else self.rotations
        faces = self.place_faces(_counting(0 if some is None else len(some)))
        rotations = self.rotations[faces] if self.rotations is not None else np.zeros_like(faces)
        if self.offsets is not None:
            return polygons.corner_index(self.offsets, faces, rotations)
        turned = (rotations[:, None] + np.arange(3)) % 3
        return (3 * faces.astype(np.int64)[:, None] + turned).reshape(-1), None


def kept(
    order: OutputOrder,
    output: PolygonCorners | None = None,
    *,
    keep_order: bool,
    keep_rotation: bool,
) -> SourceOrder:
    """What is to be kept of an order; output: the polygons, None for triangles."""
    sizes = 3 if output is None else np.maximum(np.diff(output.offsets), 1)
    return SourceOrder(
        order.vertices.astype(np.int32) if keep_order else None,
        order.faces if keep_order else None,
        (-order.rotations % sizes).astype(np.int32) if keep_order or keep_rotation else None,
        None if output is None else output.offsets,
    )


def encode(source: SourceOrder, known: "Known") -> OrderStreams:
    """The streams; together they cost the uniform bound, 1 % and 32 bytes at most."""
    vertices, faces, rotations = source.vertices, source.faces, source.rotations
    if vertices is None or faces is None:
        return OrderStreams(None, None, _rotations_alone(known, rotations))
    if rotations is None or not len(known.corners):
        return OrderStreams(_IDENTITY if len(vertices) else None)
    before = known.encode_vertices(vertices)
    first = OrderStreams(
        before,
        known.encode_faces(faces, vertices),
        known.encode_rotations(rotations, faces, vertices),
    )
    along = known.encode_vertices_along(vertices, faces, rotations)
    if len(before) <= len(along):  # and faces gain by knowing the vertices
        return first
    second = OrderStreams(
        along,
        known.encode_faces(faces, NOTHING),
        known.encode_rotations(rotations, faces, NOTHING),
    )
    return min(first, second, key=_size)


def decode(
    streams: OrderStreams, known: "Known", *, place: Callable[[str], object] = str
) -> SourceOrder:
    """The order; whatever the bytes are, permutations come back or CorruptError is raised.

    place: what errors call the streams.
    """
    vertices, faces, rotations = NOTHING, _counting(known.n_faces), None
    if streams.vertices is not None:
        with corrupt_at(place("vertex order")):
            method, rest = _split(streams.vertices)
            if method != Method.ALONG_FACES:
                vertices = known.decode_vertices(method, rest)
    if streams.faces is not None:
        with corrupt_at(place("face order")):
            faces = known.decode_faces(streams.faces, vertices)
    if streams.rotations is not None:
        with corrupt_at(place("rotations")):
            numbers = vertices if streams.vertices is not None else _counting(known.n_vertices)
            rotations = known.decode_rotations(streams.rotations, faces, numbers)
    if streams.vertices is None:
        return SourceOrder(None, None, rotations, known.offsets)
    if method == Method.ALONG_FACES:
        with corrupt_at(place("vertex order")):
            vertices = known.decode_vertices_along(rest, faces, rotations)
    return SourceOrder(vertices, faces, rotations, known.offsets)


class Known:
    """What both sides know when an order is coded.

    opposite, vertex: (3t,) the half-edge across each, and the vertex of each corner of triangles,
    in output order.  integers: (n, 3) the positions on their lattice.  output: the polygons.
    """

    def __init__(
        self,
        opposite: Int32s,
        vertex: Int32s,
        integers: Int64s,
        output: PolygonCorners | None = None,
    ) -> None:
        self.corners = np.ascontiguousarray(vertex)
        positions = np.ascontiguousarray(integers, np.int64).reshape(-1)
        self.arrays = opposite, self.corners, positions
        self.n_vertices, self.n_faces = len(integers), len(vertex) // 3
        self.offsets = None
        self.face_arrays = NOTHING, *self.arrays
        if output is not None:
            self.offsets, self.n_faces = output.offsets, output.n_faces
            self.corners = self.corners[output.corner]
            across = output.across(opposite)
            self.face_arrays = output.offsets.astype(np.int32), across, self.corners, positions

    def encode_vertices(self, vertices: Int32s) -> bytes:
        def code(uniform: bool) -> bytes:
            return _kernels.encode_vertex_order(*self.arrays, NOTHING, uniform, vertices)

        return _shortest(_is_counting(vertices), code)

    def decode_vertices(self, method: Method, data: bytes) -> Int32s:
        if method == Method.IDENTITY:
            return _counting(self.n_vertices)
        uniform = method == Method.UNIFORM
        return _kernels.decode_vertex_order(data, *self.arrays, NOTHING, uniform)

    def encode_vertices_along(self, vertices: Int32s, faces: Int32s, rotations: Int32s) -> bytes:
        visits = self._first_uses(faces, rotations)
        stream = _kernels.encode_vertex_order(*self.arrays, visits, False, vertices)
        return bytes([Method.ALONG_FACES]) + stream

    def decode_vertices_along(self, data: bytes, faces: Int32s, rotations: Int32s | None) -> Int32s:
        visits = self._first_uses(faces, rotations)
        return _kernels.decode_vertex_order(data, *self.arrays, visits, False)

    def encode_faces(self, faces: Int32s, vertices: Int32s) -> bytes:
        def code(uniform: bool) -> bytes:
            return _kernels.encode_face_order(*self.face_arrays, vertices, uniform, faces)

        return _shortest(_is_counting(faces), code)

    def decode_faces(self, stream: bytes, vertices: Int32s) -> Int32s:
        method, data = _split(stream)
        if method == Method.IDENTITY:
            return _counting(self.n_faces)
        uniform = method == Method.UNIFORM
        return _kernels.decode_face_order(data, *self.face_arrays, vertices, uniform)

    def encode_rotations(self, rotations: Int32s, faces: Int32s, vertices: Int32s) -> bytes:
        def code(uniform: bool) -> bytes:
            return _kernels.encode_rotations(*self.face_arrays, faces, vertices, uniform, rotations)

        return _shortest(not rotations.any(), code)

    def decode_rotations(self, stream: bytes, faces: Int32s, vertices: Int32s) -> Int32s:
        method, data = _split(stream)
        if method == Method.IDENTITY:
            return np.zeros(self.n_faces, np.int32)
        uniform = method == Method.UNIFORM
        return _kernels.decode_rotations(data, *self.face_arrays, faces, vertices, uniform)

    def _first_uses(self, faces: Int32s, rotations: Int32s | None) -> Int32s:
        """The vertices in the order in which the source's faces use them."""
        corners = SourceOrder(None, faces, rotations, self.offsets).place_values(self.corners)
        return _kernels.number_by_first_use(corners, self.n_vertices)[1]


def _rotations_alone(known: Known, rotations: Int32s | None) -> bytes | None:
    if rotations is None or not len(known.corners):
        return None
    numbers = _counting(known.n_faces), _counting(known.n_vertices)
    return known.encode_rotations(rotations, *numbers)


def _shortest(is_identity: bool, code: Callable[[bool], bytes]) -> bytes:
    if is_identity:
        return _IDENTITY
    streams = (bytes([Method.ADAPTIVE]) + code(False), bytes([Method.UNIFORM]) + code(True))
    return min(streams, key=len)


def _split(stream: bytes) -> tuple[Method, bytes]:
    try:
        return Method(stream[0]), stream[1:]
    except (IndexError, ValueError):
        raise CorruptError(f"unknown method {stream[:1].hex() or 'of no byte'}") from None


def _size(streams: OrderStreams) -> int:
    return sum(len(stream or b"") for stream in streams)


def _counting(n: int) -> Int32s:
    return np.arange(n, dtype=np.int32)


def _is_counting(values: Int32s) -> bool:
    return np.array_equal(values, _counting(len(values)))


def _placed(values: Array, source: Int32s | None) -> Array:
    if source is None:
        return values
    placed = np.empty_like(values)
    placed[source] = values
    return placed


_IDENTITY = bytes([Method.IDENTITY])
