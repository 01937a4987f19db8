"""Triangles <-> a CLRSE word, the integers beside it, and the gluing of its pieces.

The word codes oriented manifold pieces; where the mesh is not a manifold, several vertices of the
pieces are one vertex of the mesh, and the gluing says which.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, threads
from ebz.codec.errors import CorruptError, MeshError, corrupt_at
from ebz.codec.integers import decode_columns, encode_columns, from_gaps, gaps, unzigzag, zigzag
from ebz.codec.mesh import MAX_FACES, MAX_VERTICES
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable
from ebz.codec.models.table import Table
from ebz.codec.specials import decode_specials, encode_specials

Int32s = npt.NDArray[np.int32]
Int64s = npt.NDArray[np.int64]
WordModel = AnyTable | Effort


@dataclass(frozen=True)
class WordCounts:
    """The integers that frame a word.

    n_symbols: its length.  n_closed: components without a boundary, whose first triangle has no
    symbol.  n_single: components of one triangle.  n_specials: special S.  n_copies: piece vertices
    that are glued to an earlier one.
    """

    n_symbols: int
    n_closed: int
    n_single: int
    n_specials: int
    n_copies: int

    @property
    def n_faces(self) -> int:
        return self.n_symbols + self.n_closed


@dataclass(frozen=True)
class Surface:
    """Corners in output order: half-edge 3i is the gate of face i.

    opposite: (3m,) the half-edge across, -1 on a boundary.  piece_vertex: (3m,) vertices of the
    manifold pieces.  vertex_of_piece: the mesh vertex of each, numbered by first use.
    n_vertices: of the mesh, those that faces use.
    """

    opposite: Int32s
    piece_vertex: Int32s
    vertex_of_piece: Int32s
    n_vertices: int

    @cached_property
    def vertex(self) -> Int32s:
        """(3m,) the mesh vertex of each corner."""
        if not self.has_copies:
            return self.piece_vertex
        # All indices are in range: "clip" spares the buffer of the other modes.
        return np.take(self.vertex_of_piece, self.piece_vertex, mode="clip")

    @property
    def has_copies(self) -> bool:
        """Whether a piece vertex is glued; if not, vertices are numbered as those of the pieces."""
        return self.n_vertices < len(self.vertex_of_piece)


@dataclass(frozen=True)
class EncodedWord:
    """A word and what stands beside it."""

    counts: WordCounts
    model: WordModel
    symbols: npt.NDArray[np.uint8]  # C, L, R, S, E as 0 to 4, first triangle first
    specials: Int64s  # (2 n_specials,) position in the word, half-edge met
    word: bytes  # the symbols from the last to the first, under the model
    special_integers: bytes  # b"" where an adaptive model codes them in the word
    gluing: bytes


@dataclass(frozen=True)
class OutputOrder:
    """Where the faces and vertices of the decoded mesh come from.

    corners: (m,) the corner of the source that becomes the first corner of each face.
    vertices: (n,) the source vertex of each vertex; those that no face uses come last.
    """

    corners: Int32s
    vertices: Int64s

    @property
    def faces(self) -> Int32s:
        """(m,) the source face of each face."""
        return self.corners // 3

    def number_of(self, vertices: npt.NDArray[Any]) -> Int64s:
        """The numbers of source vertices in the output."""
        number = np.empty(len(self.vertices), np.int64)
        number[self.vertices] = np.arange(len(self.vertices))
        return np.take(number, vertices)

    @property
    def all_corners(self) -> Int32s:
        """(3m,) the source corner of each corner."""
        second = _next(self.corners)
        return np.stack([self.corners, second, _next(second)], axis=1).reshape(-1)


def encode(
    faces: npt.NDArray[Any], n_vertices: int, models: Sequence[WordModel]
) -> tuple[EncodedWord, Surface, OutputOrder]:
    """The word of any list of triangles under the model that makes it shortest.

    Linear time but for sorting what is not manifold.

    Raises MeshError where there are more faces or vertices than can be coded.
    """
    kernel, surface, order = _traverse(faces, n_vertices)
    symbols, specials, n_closed, n_single = kernel
    copies = _copies(surface)
    counts = WordCounts(len(symbols), n_closed, n_single, len(specials) // 2, len(copies))
    gluing = _encode_gluing(copies, surface.vertex_of_piece)

    def under(model: WordModel) -> EncodedWord:
        streams = _encode_word(symbols, specials, counts, model)
        return EncodedWord(counts, model, symbols, specials, *streams, gluing)

    words = threads.run(under, models)
    return min(words, key=lambda word: len(word.word) + len(word.special_integers)), surface, order


def decode(
    word: bytes,
    special_integers: bytes,
    gluing: bytes,
    counts: WordCounts,
    model: WordModel,
    *,
    place: Callable[[str], str] = str,
) -> tuple[EncodedWord, Surface]:
    """The symbols and the surface of an encoded word; raises CorruptError where they contradict.

    place: what errors call the parts of the file.
    """
    (symbols, opposite, piece_vertex, n_pieces), specials = _decode_word(
        word, special_integers, counts, model, place
    )
    with corrupt_at(place("gluing")):
        vertex_of_piece = _decode_gluing(gluing, counts.n_copies, n_pieces)
    encoded = EncodedWord(counts, model, symbols, specials, word, special_integers, gluing)
    return encoded, Surface(opposite, piece_vertex, vertex_of_piece, n_pieces - counts.n_copies)


def traverse(faces: npt.NDArray[Any], n_vertices: int) -> tuple[Surface, OutputOrder]:
    """The order in which a mesh with these faces would be decoded."""
    _, surface, order = _traverse(faces, n_vertices)
    return surface, order


def _encode_word(
    symbols: npt.NDArray[np.uint8], specials: Int64s, counts: WordCounts, model: WordModel
) -> tuple[bytes, bytes]:
    """The word and the integers of its special S, which adaptive models code within the word."""
    if isinstance(model, AnyTable):
        word = _kernels.encode_symbols(symbols, specials, _frozen(model))
        return word, encode_specials(specials, counts.n_symbols)
    sizes = counts.n_closed, counts.n_single
    return _kernels.encode_adaptive(symbols, *sizes, specials, model), b""


def _decode_word(
    word: bytes,
    special_integers: bytes,
    counts: WordCounts,
    model: WordModel,
    place: Callable[[str], str],
) -> tuple[tuple[npt.NDArray[np.uint8], Int32s, Int32s, int], Int64s]:
    data = np.frombuffer(word, np.uint8)
    sizes = counts.n_symbols, counts.n_closed, counts.n_single
    if isinstance(model, AnyTable):
        with corrupt_at(place("special S")):
            specials = decode_specials(special_integers, counts.n_specials, counts.n_symbols)
        with corrupt_at(place("word")):
            frozen = _frozen(model)
            return _kernels.decode_connectivity(data, *sizes, specials, frozen), specials
    with corrupt_at(place("word")):
        return _kernels.decode_adaptive(data, *sizes, counts.n_specials, model)


def _frozen(table: AnyTable) -> _kernels.AutomatonModel | _kernels.StackModel:
    frequencies = table.frequencies.reshape(-1)
    if isinstance(table, Table):
        return _kernels.automaton(frequencies, table.successors.reshape(-1))
    top, step = table.top, table.step
    return _kernels.stack(
        frequencies, top.reshape(-1), top.shape[1], step.reshape(-1), step.shape[1], table.bottom
    )


def _traverse(
    faces: npt.NDArray[Any], n_vertices: int
) -> tuple[tuple[npt.NDArray[np.uint8], Int64s, int, int], Surface, OutputOrder]:
    if len(faces) > MAX_FACES or n_vertices > MAX_VERTICES:
        raise MeshError(
            f"{len(faces)} faces and {n_vertices} vertices: at most {MAX_FACES} and {MAX_VERTICES}"
        )
    used, compact = _compact(faces, n_vertices)
    n_compact = n_vertices if used is None else len(used)
    symbols, specials, n_closed, n_single, corners, opposite, piece_vertex, source = (
        _kernels.encode_connectivity(compact.reshape(-1), n_compact)
    )
    vertex_of_piece, firsts = _kernels.number_by_first_use(source, n_compact)
    order = firsts.astype(np.int64) if used is None else used[firsts]
    return (
        (symbols, specials, n_closed, n_single),
        Surface(opposite, piece_vertex, vertex_of_piece, len(firsts)),
        OutputOrder(corners, _with_isolated(order, n_vertices)),
    )


def _copies(surface: Surface) -> Int64s:
    """The piece vertices that are glued to an earlier one; the others have ascending numbers."""
    if not surface.has_copies:
        return np.zeros(0, np.int64)
    latest = np.maximum.accumulate(surface.vertex_of_piece)
    return np.flatnonzero(np.diff(latest, prepend=-1) == 0)


def _compact(faces: npt.NDArray[Any], n_vertices: int) -> tuple[Int64s | None, Int32s]:
    """Indices of 32 bits; where many vertices are unused, only the used ones are numbered."""
    if n_vertices <= max(4 * faces.size, 1024):
        return None, np.ascontiguousarray(faces, np.int32)
    used, compact = np.unique(faces, return_inverse=True)
    return used.astype(np.int64), compact.astype(np.int32)


def _next(corners: Int32s) -> Int32s:
    return np.where(corners % 3 == 2, corners - 2, corners + 1)


def _with_isolated(order: Int64s, n_vertices: int) -> Int64s:
    if len(order) == n_vertices:
        return order
    isolated = np.ones(n_vertices, bool)
    isolated[order] = False
    return np.concatenate([order, np.flatnonzero(isolated)])


def _encode_gluing(copies: Int64s, vertex_of_piece: Int32s) -> bytes:
    """Gaps between the copies, and each copy's vertex as a step from the copy's before it."""
    vertices = vertex_of_piece[copies].astype(np.int64)
    return encode_columns(gaps(copies), zigzag(np.diff(vertices, prepend=0)))


def _decode_gluing(data: bytes, n_copies: int, n_pieces: int) -> Int32s:
    if not n_copies:
        return np.arange(n_pieces, dtype=np.int32)
    gap, steps = decode_columns(data, n_copies, 2)
    copies, vertices = from_gaps(gap), np.cumsum(unzigzag(steps))
    if (np.diff(copies, prepend=-1) <= 0).any() or (copies >= n_pieces).any():
        raise CorruptError("copies do not ascend within the vertices of the pieces")
    is_first = np.ones(n_pieces, bool)
    is_first[copies] = False
    number = np.cumsum(is_first, dtype=np.int32) - np.int32(1)
    if ((vertices < 0) | (vertices > number[copies])).any():
        raise CorruptError("a copy of a vertex that is not yet there")
    number[copies] = vertices
    return number
