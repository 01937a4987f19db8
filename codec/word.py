"""A CLRSE word <-> its bytes under a model, and the integers beside it."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, polygons
from ebz.codec.errors import CorruptError, OptionError, corrupt_at
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable
from ebz.codec.models.table import Table
from ebz.codec.polygons import PolygonCorners, PolygonCounts
from ebz.codec.specials import decode_specials, encode_specials
from ebz.codec.surface import Int32s, Int64s

WordModel = AnyTable | Effort


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


def models_of_polygons(models: Sequence[WordModel]) -> list[WordModel]:
    """Those of the models that code polygons; raises OptionError where none does."""
    adaptive = [model for model in models if isinstance(model, Effort)]
    if not adaptive:
        raise OptionError("tables are for triangles: polygons need an adaptive model")
    return [max(model, Effort.FAST) for model in adaptive]


class Traversal(NamedTuple):
    """What the kernels find; marks: none for triangles."""

    counts: WordCounts
    symbols: npt.NDArray[np.uint8]
    specials: Int64s
    marks: npt.NDArray[np.uint8]


def encode_word(traversal: Traversal, model: WordModel) -> tuple[bytes, bytes]:
    """The word and the integers of its special S, which adaptive models code within the word."""
    counts, symbols, specials = traversal.counts, traversal.symbols, traversal.specials
    if isinstance(model, AnyTable):
        word = _kernels.encode_symbols(symbols, specials, kernel_model(model))
        return word, encode_specials(specials, counts.n_symbols)
    sizes = counts.n_closed, counts.n_single
    if counts.polygons is not None:
        marks = traversal.marks
        return _kernels.encode_polygon_word(symbols, marks, *sizes, specials, model), b""
    return _kernels.encode_adaptive(symbols, *sizes, specials, model), b""


def decode_word(
    word: bytes,
    special_integers: bytes,
    counts: WordCounts,
    model: WordModel,
    place: Callable[[str], object],
) -> tuple[tuple[npt.NDArray[np.uint8], Int32s, Int32s, int], Int64s, PolygonCorners | None]:
    """What the kernels decode, the special S, and the polygons; raises CorruptError.

    The former are symbols, opposite and piece_vertex as of a Surface, and how many piece vertices
    there are.
    """
    sizes = counts.n_symbols, counts.n_closed, counts.n_single
    if isinstance(model, AnyTable):
        with corrupt_at(place("special S")):
            specials = decode_specials(special_integers, counts.n_specials, counts.n_symbols)
        with corrupt_at(place("word")):
            table = kernel_model(model)
            return _kernels.decode_connectivity(word, *sizes, specials, table), specials, None
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


def kernel_model(table: AnyTable) -> _kernels.AutomatonModel | _kernels.StackModel:
    """The probabilities of a table and what they depend on."""
    frequencies = table.frequencies.reshape(-1)
    if isinstance(table, Table):
        return _kernels.automaton(frequencies, table.successors.reshape(-1))
    top, step = table.top, table.step
    return _kernels.stack(
        frequencies, top.reshape(-1), top.shape[1], step.reshape(-1), step.shape[1], table.bottom
    )
