"""Faces <-> a CLRSE word, the integers beside it, and the gluing of its pieces.

The word codes oriented manifold pieces; where the mesh is not a manifold, several vertices of the
pieces are one vertex of the mesh, and the gluing says which.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, polygons, threads
from ebz.codec.errors import MeshError, corrupt_at
from ebz.codec.mesh import MAX_FACES, MAX_VERTICES
from ebz.codec.polygons import PolygonCorners, PolygonCounts, PolygonSource
from ebz.codec.surface import Int32s, Int64s, OutputOrder, Surface
from ebz.codec.word import (
    EncodedWord,
    Traversal,
    WordCounts,
    WordModel,
    decode_word,
    encode_word,
    models_of_polygons,
)

# Of a symbol; less than what the certified tables take, on any mesh that is not tiny.
SURE_BITS = 1.5


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
        models = models_of_polygons(models)

    def under(model: WordModel) -> EncodedWord:
        streams = encode_word(traversal, model)
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
    (symbols, opposite, piece_vertex, n_pieces), specials, corners = decode_word(
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


def _traverse(
    faces: npt.NDArray[Any], n_vertices: int, offsets: Int64s | None
) -> tuple[Traversal, Surface, OutputOrder]:
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


def _traverse_triangles(compact: Int32s, n_vertices: int) -> tuple[Traversal, Surface, OutputOrder]:
    symbols, specials, n_closed, n_single, gates, opposite, piece_vertex, source = (
        _kernels.encode_connectivity(compact, n_vertices)
    )
    vertex_of_piece, firsts = _kernels.number_by_first_use(source, n_vertices)
    return (
        Traversal(
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
) -> tuple[Traversal, Surface, OutputOrder]:
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
        Traversal(
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
