"""The header of a mesh <-> its bytes: counts, model, method and lattice.

Without construct, which takes longer than a small mesh does to decode.
"""

import struct
from collections.abc import Sequence
from typing import NamedTuple

from ebz.codec.encoded import EncodedMesh
from ebz.codec.errors import CorruptError, VersionError
from ebz.codec.lattice import Lattice, SingleLattice
from ebz.codec.mesh import MAX_FACES, MAX_VERTICES
from ebz.codec.models.adaptive import Effort
from ebz.codec.polygons import Cut, PolygonCounts
from ebz.codec.positions import FLOAT_METHODS, Coding, Method, can_cut
from ebz.codec.word import WordCounts
from ebz.formats import tables
from ebz.formats.ebz import lattices, layout

MAX_COUNT = 2**63
COUNTS = (
    "vertices",
    "symbols",
    "closed components",
    "single triangles",
    "special S",
    "copies",
    "exceptions",
)
POLYGON_COUNTS = ("polygons", "empty polygons", "corners of polygons")
# Of faces: all are triangles, or of any size; else the size of all.
TRIANGLES, MIXED = range(2)
NO_SIZES = (2, 3)
# The byte of the method is that, plus 32 if positions are listed, plus 64 for each further way to
# cut polygons.
N_METHODS, LISTED = 64, 32
METHODS = {method.value: method for method in Method}
CUTS = {cut.value: cut for cut in Cut}
DTYPE_SIZES = (4, 8)


class Header(NamedTuple):
    """The fields in the order of the file.

    polygons: as face_size and counts tell, None where all faces are triangles.
    """

    itemsize: int
    n_vertices: int
    n_symbols: int
    n_closed: int
    n_single: int
    n_specials: int
    n_copies: int
    n_exceptions: int
    polygons: PolygonCounts | None
    model: int
    coding: Coding
    lattice: Lattice

    @property
    def counts(self) -> WordCounts:
        """What frames the word."""
        sizes = self.n_symbols, self.n_closed, self.n_single, self.n_specials, self.n_copies
        return WordCounts(*sizes, self.polygons)


def write(encoded: EncodedMesh, model: int) -> bytes:
    """The payload; model: the number of the model."""
    counts, lattice, itemsize = encoded.counts, encoded.lattice, encoded.dtype.itemsize
    integers = (
        encoded.n_vertices,
        counts.n_symbols,
        counts.n_closed,
        counts.n_single,
        counts.n_specials,
        counts.n_copies,
        encoded.n_exceptions,
    )
    size = _face_size(counts)
    polygons = counts.polygons if counts.polygons and size == MIXED else ()
    numbers = bytes([model, _byte_of(encoded.coding)])
    sizes = [*map(layout.varint, integers), bytes([size]), *map(layout.varint, polygons)]
    return bytes([itemsize]) + b"".join(sizes) + numbers + lattices.write(lattice, itemsize)


def read(payload: bytes) -> Header:
    """The fields, checked; raises CorruptError and VersionError."""
    try:
        return _Reader(payload).header()
    except (IndexError, struct.error):
        raise CorruptError("the header ends too early") from None


class _Reader:
    """Reads one field after another; raises IndexError or struct.error where the data ends."""

    def __init__(self, payload: bytes) -> None:
        self._data = payload
        self._at = 0

    def header(self) -> Header:
        itemsize = self._byte()
        if itemsize not in DTYPE_SIZES:
            raise CorruptError(f"coordinates of {itemsize} bytes")
        sizes = self._counts(COUNTS)
        n_vertices, n_symbols, n_closed, n_single, n_specials, n_copies, n_exceptions = sizes
        _check_counts(n_vertices, n_symbols, n_closed, n_single)
        polygons = self._polygons(n_symbols + n_closed)
        model, number = self._byte(), self._byte()
        if model not in tables.NUMBERS:
            raise VersionError(f"header: unknown model {model}")
        if polygons and layout.ADAPTIVE_MODELS.get(model, Effort.DIRECT) == Effort.DIRECT:
            raise CorruptError(f"polygons under model {model}")
        lattice = lattices.read(self._data[self._at :], itemsize)
        coding = _coding(number, itemsize, lattice)
        if coding.cut and not (polygons and can_cut(n_symbols + n_closed, coding.cut)):
            raise CorruptError("faces that cannot be cut otherwise")
        return Header(
            itemsize,
            n_vertices,
            n_symbols,
            n_closed,
            n_single,
            n_specials,
            n_copies,
            n_exceptions,
            polygons,
            model,
            coding,
            lattice,
        )

    def _byte(self) -> int:
        self._at += 1
        return self._data[self._at - 1]

    def _counts(self, names: Sequence[str]) -> list[int]:
        values = []
        for _ in names:
            try:
                value, size = layout.read_varint(self._data, self._at)
            except ValueError as error:
                raise CorruptError(str(error)) from None
            self._at += size
            values.append(value)
        for name, value in zip(names, values, strict=True):
            if value >= MAX_COUNT:
                raise CorruptError(f"{value} {name}, past the limit of 2^63")
        return values

    def _polygons(self, n_triangles: int) -> PolygonCounts | None:
        face_size = self._byte()
        if face_size in NO_SIZES:
            raise VersionError(f"header: faces of unknown kind {face_size}")
        if face_size == TRIANGLES:
            return None
        if face_size != MIXED:
            return _polygons_of(face_size, n_triangles)
        n_faces, n_empty, n_corners = self._counts(POLYGON_COUNTS)
        n_runs = n_faces - n_empty
        if n_faces > MAX_FACES or not 0 <= n_runs <= n_triangles:
            raise CorruptError(f"{n_faces} polygons, {n_empty} of them empty")
        if n_corners > n_triangles + 2 * n_runs:
            raise CorruptError(f"{n_corners} corners of {n_runs} polygons")
        return PolygonCounts(n_faces, n_empty, n_corners)


def _check_counts(n_vertices: int, n_symbols: int, n_closed: int, n_single: int) -> None:
    if n_vertices > MAX_VERTICES:
        raise CorruptError(f"{n_vertices} vertices, past the limit of 2^31 - 1")
    if n_symbols + n_closed > MAX_FACES:
        raise CorruptError(f"more faces than the limit of {MAX_FACES}")
    if n_closed + n_single > n_symbols:
        raise CorruptError("more components than symbols")


def _face_size(counts: WordCounts) -> int:
    """Where it tells the counts of polygons."""
    if counts.polygons is None:
        return TRIANGLES
    size = counts.polygons.n_corners // max(counts.polygons.n_faces, 1)
    is_told = 3 < size < 256 and counts.polygons == _polygons_of(size, counts.n_triangles)
    return size if is_told else MIXED


def _polygons_of(size: int, n_triangles: int) -> PolygonCounts:
    n_faces = n_triangles // (size - 2)
    return PolygonCounts(n_faces, 0, size * n_faces)


def _byte_of(coding: Coding) -> int:
    return coding.method + coding.is_listed * LISTED + coding.cut * N_METHODS


def _coding(byte: int, itemsize: int, lattice: Lattice) -> Coding:
    way, number = divmod(byte & ~LISTED, N_METHODS)
    if number not in METHODS or way not in CUTS:
        raise VersionError(f"header: unknown method {byte} of positions")
    method = METHODS[number]
    in_floats = FLOAT_METHODS[4 if isinstance(lattice, SingleLattice) else itemsize]
    if method in FLOAT_METHODS.values() and method != in_floats:
        raise CorruptError(f"positions of {itemsize} bytes by method {number}")
    return Coding(method, CUTS[way], bool(byte & LISTED))
