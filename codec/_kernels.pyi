"""
The loops of ebz, in C++; arguments are checked by the modules that call them.
"""

from typing import Annotated, overload

import numpy
from numpy.typing import NDArray


def forbid_extensions(forbidden: bool) -> None:
    """
    Take the baseline instructions on every machine, or no more; for tests.
    """

def encode_connectivity(faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int) -> tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], int, int, Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    symbols, specials (position, meets), n_closed, n_single, gates, opposite, piece_vertex, source_vertex of 3m vertex indices.
    """

class AutomatonModel:
    """Frozen frequencies per state."""

class StackModel:
    """Frozen frequencies per class of stacks."""

def automaton(frequencies: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', device='cpu', writable=False)], successors: Annotated[NDArray[numpy.uint16], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> AutomatonModel:
    """A model from checked tables, flattened: 5 entries per state."""

def stack(frequencies: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', device='cpu', writable=False)], top: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], n_conflicts: int, step: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], n_lengths: int, bottom: int) -> StackModel:
    """A model from checked tables, flattened: 5 frequencies per row."""

@overload
def encode_symbols(symbols: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], model: AutomatonModel) -> bytes: ...

@overload
def encode_symbols(symbols: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], model: StackModel) -> bytes:
    """The word in reverse order under a model."""

@overload
def decode_connectivity(data: bytes, n_symbols: int, n_closed: int, n_single: int, specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], model: AutomatonModel) -> tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], int]: ...

@overload
def decode_connectivity(data: bytes, n_symbols: int, n_closed: int, n_single: int, specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], model: StackModel) -> tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], int]:
    """symbols, opposite, piece_vertex, n_piece_vertices of an encoded word."""

def encode_adaptive(symbols: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], n_closed: int, n_single: int, specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], effort: int) -> bytes:
    """The word in reverse order under an adaptive model."""

def decode_adaptive(data: bytes, n_symbols: int, n_closed: int, n_single: int, n_specials: int, effort: int) -> tuple[tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], int], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
    """
    What decode_connectivity gives and the specials, of a word under an adaptive model.
    """

def encode_polygons(corners: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int) -> tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], int, int, Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], int, Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    symbols, specials (position, meets), n_closed, n_single, marks, opposite, piece_vertex, n_piece_vertices, source_corner of faces of three corners at least.
    """

def encode_polygon_word(symbols: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], marks: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], n_closed: int, n_single: int, specials: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], effort: int) -> bytes:
    """The word and its marks in reverse order under an adaptive model."""

def decode_polygon_word(data: bytes, n_symbols: int, n_closed: int, n_single: int, n_specials: int, effort: int) -> tuple[tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], int], Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.uint8], dict(shape=(None,))]]:
    """What decode_adaptive gives, and the marks."""

def corners_of_polygons(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], marks: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    offsets, and the corner of a triangle that each corner of the polygons is.
    """

def cut_polygons(vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], across: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int, way: int) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    The half-edge across each of the triangles that predict positions, and the polygons' corner of each corner.
    """

def encode_gluing(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_copies: int, site: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """
    Which vertices of the pieces are one site; site: of each, numbered by first use.
    """

def decode_gluing(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int, n_copies: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The site of each vertex of the pieces."""

def glue(vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], site: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The site of each corner."""

def encode_splits(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], fan: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], point_of_fan: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_points: int, label: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[bytes, Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    Which corners at each point belong to which vertex; what decoding yields; the label of each vertex.
    """

def decode_splits(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], fan: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], point_of_fan: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_points: int) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    The vertex of each corner, and the point of each vertex beyond the first n_points.
    """

def fans_at_points(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """The fan of each corner, and the point of each fan."""

@overload
def weld(faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]: ...

@overload
def weld(faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    For each vertex the first that stands for it, empty if nothing is welded; no offsets: triangles.
    """

def number_by_first_use(entries: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_items: int) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """The number of each entry's item, and the items by number."""

def describe(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[int, int, int, int]:
    """
    Numbers of components, boundary loops, boundary edges and edges of a surface.
    """

def encode_positions(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int, values: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], method: int) -> bytes:
    """The bytes of 3n lattice values along a surface."""

def decode_positions(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int, method: int) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The 3n lattice values of another method."""

def decode_positions_fast(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None, None))]:
    """The (n, 3) lattice values of the fast method."""

def decode_positions_medium(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n_vertices: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None, None))]:
    """The (n, 3) lattice values of the medium method."""

def encode_points(values: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[bytes, Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    The bytes of a set of points, 3n lattice values, and where those decoded come from.
    """

def decode_points(data: bytes, n: int) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The 3n lattice values."""

@overload
def decimal_digits(values: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], max_digits: int, max_misses: int) -> int: ...

@overload
def decimal_digits(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], max_digits: int, max_misses: int) -> int:
    """
    The fewest decimals that all values but max_misses have, -1 if there are too many.
    """

def single_digits(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], max_misses: int) -> int:
    """
    The significant digits of float32 that all values but max_misses are, 0 if all of them, -1 if they are none.
    """

def write_singles(singles: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], digits: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    The float64 nearest to each rounded to significant digits, 0 for all of them.
    """

def list_different(values: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
    """
    The different ones, ascending, and which each is; nothing where many are.
    """

@overload
def bounds(coordinates: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...

@overload
def bounds(coordinates: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """
    The least and the greatest of each axis, infinite where some are not finite.
    """

@overload
def to_multiples(coordinates: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], origin: tuple[float, float, float], step: float) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]: ...

@overload
def to_multiples(coordinates: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], origin: tuple[float, float, float], step: float) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The nearest integers to (x - origin) / step."""

@overload
def from_multiples(multiples: Annotated[NDArray[numpy.int32], dict(shape=(None, None), device='cpu', writable=False)], origin: tuple[float, float, float], step: float, coordinates: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu')]) -> None: ...

@overload
def from_multiples(multiples: Annotated[NDArray[numpy.int64], dict(shape=(None, None), device='cpu', writable=False)], origin: tuple[float, float, float], step: float, coordinates: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu')]) -> None: ...

@overload
def from_multiples(multiples: Annotated[NDArray[numpy.int32], dict(shape=(None, None), device='cpu', writable=False)], origin: tuple[float, float, float], step: float, coordinates: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None: ...

@overload
def from_multiples(multiples: Annotated[NDArray[numpy.int64], dict(shape=(None, None), device='cpu', writable=False)], origin: tuple[float, float, float], step: float, coordinates: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Fills coordinates with origin + step * integer."""

def encode_attribute(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], item: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n: int, n_components: int, points: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], site: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], guess: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], method: int, space: int, relation: int, total: float, heights: bool, by_area: bool, values: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """
    The bytes of n rows of integers, of items of a surface, of its faces, or of a list.
    """

def decode_attribute(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], item: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n: int, n_components: int, points: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], site: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], guess: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], method: int, space: int, relation: int, total: float, heights: bool, by_area: bool) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The rows, flattened."""

def normals(points: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], item: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], n: int, by_area: bool, by_angle: bool, as_sums: bool, by_corner: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Normals of n items of corners, or of n faces, flattened."""

def encode_links(vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], face_offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """The vertices of rows, of which many are joined by edges of the faces."""

def decode_links(data: bytes, vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], face_offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The vertices of all rows."""

def encode_vertex_order(opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], visits: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool, source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """The bytes of each vertex's index in the source."""

def decode_vertex_order(data: bytes, opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], visits: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The indices, a permutation."""

def encode_face_order(offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool, source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """The bytes of each face's index in the source."""

def decode_face_order(data: bytes, offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The indices, a permutation."""

def encode_rotations(offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], face_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool, rotations: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bytes:
    """The bytes of which corner of each face is first in the source."""

def decode_rotations(data: bytes, offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], opposite: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], positions: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], face_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertex_source: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uniform: bool) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """The corners, from 0 on."""

def encode_integers(values: Annotated[NDArray[numpy.uint64], dict(shape=(None,), order='C', device='cpu', writable=False)], n_columns: int) -> bytes:
    """Rows of unsigned integers, a model per column."""

def decode_integers(data: bytes, n_rows: int, n_columns: int) -> Annotated[NDArray[numpy.uint64], dict(shape=(None,))]:
    """The rows, flattened."""

def decode_list(data: bytes, n: int) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The n integers of a list, ascending."""

@overload
def look_up(list: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int32], dict(shape=(None, None), device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]: ...

@overload
def look_up(list: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None, None), device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """The listed integers of rows of numbers, flattened."""

class TextCoder:
    """Of text like a prior."""

    def __init__(self, prior: bytes) -> None: ...

    def encode(self, text: bytes) -> bytes:
        """The coded text."""

    def decode(self, data: bytes, n_bytes: int) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """The text."""
