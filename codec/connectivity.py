"""Faces <-> a CLRSE word, the integers beside it, and the gluing of its pieces.

The word codes oriented manifold pieces; where the mesh is not a manifold, several vertices of the
pieces are one vertex of the mesh, and the gluing says which.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, polygons, threads
from ebz.codec.errors import CorruptError, MeshError, OptionError, corrupt_at
from ebz.codec.mesh import MAX_FACES, MAX_VERTICES
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable
from ebz.codec.models.table import Table
from ebz.codec.polygons import Cut, PolygonCorners, PolygonCounts, PolygonSource, Triangles
from ebz.codec.specials import decode_specials, encode_specials

Int32s = npt.NDArray[np.int32]
Int64s = npt.NDArray[np.int64]
WordModel = AnyTable | Effort
# From a corner of a triangle, by its number there, to each of the three in turn.
_TURNS = np.array([[0, 1, 2], [0, 1, -1], [0, -2, -1]], np.int32)

# Of a symbol; less than what the certified tables take, on any mesh that is not tiny.
SURE_BITS = 1.5


class WordCounts(NamedTuple):
    """The integers that frame a word.

    n_symbols: its length.  n_closed: components without a boundary, whose first triangle has no
    symbol.  n_single: components of one face.  n_specials: special S.  n_copies: piece vertices
    that are glued to an earlier one.  polygons: None where all faces are triangles.
    """

    n_symbols: int
    n_closed: int
    n_single: int
    n_specials: int
    n_copies: int
    polygons: PolygonCounts | None = None

    @property
    def n_triangles(self) -> int:
        return self.n_symbols + self.n_closed

    @property
    def n_faces(self) -> int:
        return self.n_triangles if self.polygons is None else self.polygons.n_faces

    @property
    def n_corners(self) -> int:
        return 3 * self.n_triangles if self.polygons is None else self.polygons.n_corners


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


class EncodedWord(NamedTuple):
    """A word and what stands beside it."""

    counts: WordCounts
    model: WordModel
    symbols: npt.NDArray[np.uint8]  # C, L, R, S, E as 0 to 4, first triangle first
    specials: Int64s  # (2 n_specials,) position in the word, half-edge met
    word: bytes  # the symbols from the last to the first, under the model, and marks of polygons
    special_integers: bytes  # b"" where an adaptive model codes them in the word
    gluing: bytes

    @property
    def size(self) -> int:
        """Bytes of the symbols and special S."""
        return len(self.word) + len(self.special_integers)


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


def encode(
    faces: npt.NDArray[Any],
    n_vertices: int,
    models: Sequence[WordModel],
    offsets: Int64s | None = None,
) -> tuple[EncodedWord, Surface, OutputOrder]:
    """The word of any list of faces under the model that makes it shortest.

    faces: (m, 3), or (k,) corners of polygons beside (m + 1,) offsets, for which tables are no
    models.  models: the others are tried where the first takes more than SURE_BITS.  Linear time
    but for sorting what is not manifold.

    Raises MeshError where there are more faces or vertices than can be coded, OptionError where
    there is no model for polygons.
    """
    traversal, surface, order = _traverse(faces, n_vertices, offsets)
    n_copies = len(surface.vertex_of_piece) - surface.n_vertices
    counts = traversal.counts._replace(n_copies=n_copies)
    gluing = _encode_gluing(surface, n_copies)
    if offsets is not None:
        models = _models_of_polygons(models)

    def under(model: WordModel) -> EncodedWord:
        streams = _encode_word(traversal, model)
        symbols, specials = traversal.symbols, traversal.specials
        return EncodedWord(counts, model, symbols, specials, *streams, gluing)

    words = [under(models[0])]
    if 8 * words[0].size > SURE_BITS * counts.n_symbols:
        words += threads.run(under, models[1:])
    return min(words, key=lambda word: word.size), surface, order


def decode(
    word: bytes,
    special_integers: bytes,
    gluing: bytes,
    counts: WordCounts,
    model: WordModel,
    *,
    place: Callable[[str], object] = str,
) -> tuple[EncodedWord, Surface]:
    """The symbols and the surface of an encoded word; raises CorruptError where they contradict.

    place: what errors call the parts of the file.
    """
    (symbols, opposite, piece_vertex, n_pieces), specials, corners = _decode_word(
        word, special_integers, counts, model, place
    )
    with corrupt_at(place("gluing")):
        vertex_of_piece = _decode_gluing(gluing, opposite, piece_vertex, n_pieces, counts.n_copies)
    encoded = EncodedWord(counts, model, symbols, specials, word, special_integers, gluing)
    n_used = n_pieces - counts.n_copies
    return encoded, Surface(opposite, piece_vertex, vertex_of_piece, n_used, corners)


def traverse(
    faces: npt.NDArray[Any], n_vertices: int, offsets: Int64s | None = None
) -> tuple[Surface, OutputOrder]:
    """The order in which a mesh with these faces would be decoded."""
    _, surface, order = _traverse(faces, n_vertices, offsets)
    return surface, order


def _models_of_polygons(models: Sequence[WordModel]) -> list[WordModel]:
    adaptive = [model for model in models if isinstance(model, Effort)]
    if not adaptive:
        raise OptionError("tables are for triangles: polygons need an adaptive model")
    return [max(model, Effort.FAST) for model in adaptive]


class _Traversal(NamedTuple):
    """What the kernels find; marks: none for triangles."""

    counts: WordCounts
    symbols: npt.NDArray[np.uint8]
    specials: Int64s
    marks: npt.NDArray[np.uint8]


def _encode_word(traversal: _Traversal, model: WordModel) -> tuple[bytes, bytes]:
    """The word and the integers of its special S, which adaptive models code within the word."""
    counts, symbols, specials = traversal.counts, traversal.symbols, traversal.specials
    if isinstance(model, AnyTable):
        word = _kernels.encode_symbols(symbols, specials, _frozen(model))
        return word, encode_specials(specials, counts.n_symbols)
    sizes = counts.n_closed, counts.n_single
    if counts.polygons is not None:
        marks = traversal.marks
        return _kernels.encode_polygon_word(symbols, marks, *sizes, specials, model), b""
    return _kernels.encode_adaptive(symbols, *sizes, specials, model), b""


def _decode_word(
    word: bytes,
    special_integers: bytes,
    counts: WordCounts,
    model: WordModel,
    place: Callable[[str], object],
) -> tuple[tuple[npt.NDArray[np.uint8], Int32s, Int32s, int], Int64s, PolygonCorners | None]:
    sizes = counts.n_symbols, counts.n_closed, counts.n_single
    if isinstance(model, AnyTable):
        with corrupt_at(place("special S")):
            specials = decode_specials(special_integers, counts.n_specials, counts.n_symbols)
        with corrupt_at(place("word")):
            frozen = _frozen(model)
            return _kernels.decode_connectivity(word, *sizes, specials, frozen), specials, None
    with corrupt_at(place("word")):
        if counts.polygons is None:
            return *_kernels.decode_adaptive(word, *sizes, counts.n_specials, model), None
        found = _kernels.decode_polygon_word(word, *sizes, counts.n_specials, model)
        arrays, specials, marks = found
        return arrays, specials, _decode_corners(arrays[1], marks, counts.polygons)


def _decode_corners(
    opposite: Int32s, marks: npt.NDArray[np.uint8], declared: PolygonCounts
) -> PolygonCorners:
    offsets, corner = _kernels.corners_of_polygons(opposite, marks)
    n_faces = len(offsets) - 1 + declared.n_empty
    if n_faces != declared.n_faces or len(corner) != declared.n_corners:
        raise CorruptError(
            f"{n_faces} polygons of {len(corner)} corners, where the header has "
            f"{declared.n_faces} of {declared.n_corners}"
        )
    return PolygonCorners(polygons.with_empty(offsets, declared.n_empty), corner)


def _frozen(table: AnyTable) -> _kernels.AutomatonModel | _kernels.StackModel:
    frequencies = table.frequencies.reshape(-1)
    if isinstance(table, Table):
        return _kernels.automaton(frequencies, table.successors.reshape(-1))
    top, step = table.top, table.step
    return _kernels.stack(
        frequencies, top.reshape(-1), top.shape[1], step.reshape(-1), step.shape[1], table.bottom
    )


def _traverse(
    faces: npt.NDArray[Any], n_vertices: int, offsets: Int64s | None
) -> tuple[_Traversal, Surface, OutputOrder]:
    _require_codable(faces, n_vertices, offsets)
    used, compact = _compact(faces, n_vertices)
    n_compact = n_vertices if used is None else len(used)
    corners = compact.reshape(-1)
    if offsets is None:
        traversal, surface, order = _traverse_triangles(corners, n_compact)
    else:
        traversal, surface, order = _traverse_polygons(corners, n_compact, offsets)
    vertices = order.vertices if used is None else used[order.vertices]
    return traversal, surface, order._replace(vertices=_with_isolated(vertices, n_vertices))


def _require_codable(faces: npt.NDArray[Any], n_vertices: int, offsets: Int64s | None) -> None:
    n_faces = len(faces) if offsets is None else max(len(faces), len(offsets))
    if n_faces > MAX_FACES or n_vertices > MAX_VERTICES:
        raise MeshError(
            f"{n_faces} faces and {n_vertices} vertices: at most {MAX_FACES} and {MAX_VERTICES}"
        )


def _traverse_triangles(
    compact: Int32s, n_vertices: int
) -> tuple[_Traversal, Surface, OutputOrder]:
    symbols, specials, n_closed, n_single, gates, opposite, piece_vertex, source = (
        _kernels.encode_connectivity(compact, n_vertices)
    )
    vertex_of_piece, firsts = _kernels.number_by_first_use(source, n_vertices)
    return (
        _Traversal(
            WordCounts(len(symbols), n_closed, n_single, len(specials) // 2, 0),
            symbols,
            specials,
            np.zeros(0, np.uint8),
        ),
        Surface(opposite, piece_vertex, vertex_of_piece, len(firsts)),
        OutputOrder(gates, firsts.astype(np.int64)),
    )


def _traverse_polygons(
    compact: Int32s, n_vertices: int, offsets: Int64s
) -> tuple[_Traversal, Surface, OutputOrder]:
    padded = polygons.padded(offsets)
    symbols, specials, n_closed, n_single, marks, opposite, piece_vertex, n_pieces, corners = (
        _kernels.encode_polygons(compact[padded.corner], padded.offsets, n_vertices)
    )
    padded.mark_short(marks, corners[::3], n_closed)
    new_offsets, corner = _kernels.corners_of_polygons(opposite, marks)
    first = corners[corner[new_offsets[:-1]]]
    own = padded.face_of(first)
    n_empty = len(offsets) - 1 - len(padded.faces)
    empty = np.flatnonzero(np.diff(offsets) == 0).astype(np.int32)
    source = np.zeros(n_pieces, np.int32)
    source[piece_vertex] = compact[padded.corner[corners]]
    vertex_of_piece, firsts = _kernels.number_by_first_use(source, n_vertices)
    counts = PolygonCounts(len(offsets) - 1, n_empty, len(compact))
    return (
        _Traversal(
            WordCounts(len(symbols), n_closed, n_single, len(specials) // 2, 0, counts),
            symbols,
            specials,
            marks,
        ),
        Surface(
            opposite,
            piece_vertex,
            vertex_of_piece,
            len(firsts),
            PolygonCorners(polygons.with_empty(new_offsets, n_empty), corner),
        ),
        OutputOrder(
            padded.corner[corners[::3]],
            firsts.astype(np.int64),
            PolygonSource(
                np.concatenate([padded.faces[own], empty]),
                np.concatenate([first - padded.offsets[own], np.zeros(n_empty, np.int32)]),
                padded.corner[corners],
            ),
        ),
    )


def _compact(faces: npt.NDArray[Any], n_vertices: int) -> tuple[Int64s | None, Int32s]:
    """Indices of 32 bits; where many vertices are unused, only the used ones are numbered."""
    if n_vertices <= max(4 * faces.size, 1024):
        return None, np.ascontiguousarray(faces, np.int32)
    used, compact = np.unique(faces, return_inverse=True)
    return used.astype(np.int64), compact.astype(np.int32)


def _with_isolated(order: Int64s, n_vertices: int) -> Int64s:
    if len(order) == n_vertices:
        return order
    isolated = np.ones(n_vertices, bool)
    isolated[order] = False
    return np.concatenate([order, np.flatnonzero(isolated)])


def _encode_gluing(surface: Surface, n_copies: int) -> bytes:
    if not n_copies:
        return b""
    opposite, vertex = surface.opposite, surface.piece_vertex
    return _kernels.encode_gluing(opposite, vertex, n_copies, surface.vertex_of_piece)


def _decode_gluing(
    data: bytes, opposite: Int32s, vertex: Int32s, n_vertices: int, n_copies: int
) -> Int32s:
    if not n_copies:
        return np.arange(n_vertices, dtype=np.int32)
    return _kernels.decode_gluing(data, opposite, vertex, n_vertices, n_copies)
