"""The chunks of one mesh <-> the encoded mesh, in decode order; FORMAT.md describes every byte."""

import math
from collections.abc import Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from ebz.codec.connectivity import WordCounts
from ebz.codec.encoded import EncodedArray, EncodedElement, EncodedMesh, EncodedText, Streams
from ebz.codec.errors import CorruptError, VersionError, corrupt_at
from ebz.codec.lattice import (
    MAX_BITS,
    MAX_DIGITS,
    MAX_SINGLE_DIGITS,
    BoxLattice,
    DecimalLattice,
    FloatLattice,
    GridLattice,
    Lattice,
    SingleLattice,
    StepLattice,
)
from ebz.codec.mesh import MAX_FACES, MAX_VERTICES
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable
from ebz.codec.order import OrderStreams
from ebz.codec.polygons import PolygonCounts
from ebz.codec.positions import FLOAT_METHODS, Coding, Cut, Method, can_cut
from ebz.formats import chunks, layout, records, tables
from ebz.formats.chunks import Chunk

# The order of chunks in a file.
ORDER = list(layout.NAMES)
ORDER_CHUNKS = (layout.VERTEX_ORDER, layout.FACE_ORDER, layout.ROTATIONS)
ATTRIBUTES = (layout.VERTEX_ATTRIBUTE, layout.FACE_ATTRIBUTE, layout.CORNER_ATTRIBUTE)
REPEATED = {*ATTRIBUTES, layout.ELEMENT}
MAX_COUNT = 2**63
N_METHODS = 64  # the byte of the method is that, plus this for each further way to cut polygons


def write(encoded: EncodedMesh, *, embed_model: bool = False) -> list[bytes]:
    """The chunks: those that hold nothing are left out, but for the header and the end."""
    model = tables.number_of(encoded.model)
    table = encoded.model if isinstance(encoded.model, AnyTable) else None
    inline = table is not None and (embed_model or model == layout.INLINE_MODEL)
    streams = encoded.streams
    parts = [
        chunks.write(layout.HEADER, _header(encoded, layout.INLINE_MODEL if inline else model))
    ]
    optional = [
        (layout.MODEL, tables.write(table) if table and inline else b""),
        (layout.WORD, streams.word if encoded.counts.n_symbols else b""),
        (layout.SPECIALS, streams.special_integers),
        (layout.GLUING, streams.gluing),
        (layout.SPLITS, streams.splits),
        (layout.POSITIONS, streams.positions),
        (layout.POINTS, streams.points),
        (layout.EXCEPTIONS, _exceptions(streams) if encoded.n_exceptions else b""),
        (layout.VERTEX_ORDER, streams.order.vertices),
        (layout.FACE_ORDER, streams.order.faces),
        (layout.ROTATIONS, streams.order.rotations),
    ]
    parts += [chunks.write(kind, payload) for kind, payload in optional if payload]
    carried = encoded.vertex_attributes, encoded.face_attributes, encoded.corner_attributes
    for kind, arrays in zip(ATTRIBUTES, carried, strict=True):
        parts += [chunks.write(kind, records.attribute(array)) for array in arrays]
    parts += [chunks.write(layout.ELEMENT, records.element(rows)) for rows in encoded.elements]
    if encoded.metadata:
        text = layout.build(layout.Text, records.text(encoded.metadata))
        parts.append(chunks.write(layout.METADATA, text))
    return [*parts, chunks.write(layout.END, encoded.digest)]


def read(data: memoryview, offset: int) -> tuple[EncodedMesh, int]:
    """The encoded mesh from there on, and where its chunks end.

    Raises VersionError, TruncatedError or CorruptError.
    """
    found: dict[bytes, Chunk] = {}
    arrays: dict[bytes, list[EncodedArray]] = {kind: [] for kind in ATTRIBUTES}
    elements: list[EncodedElement] = []
    for chunk in _in_order(data, offset):
        found[chunk.type] = chunk
        if chunk.type in ATTRIBUTES:
            array = records.parse_attribute(chunk)
            _check_names(array.names, [n for a in arrays[chunk.type] for n in a.names], chunk)
            arrays[chunk.type].append(array)
        elif chunk.type == layout.ELEMENT:
            element = records.parse_element(chunk)
            _check_names([element.name], [other.name for other in elements], chunk)
            elements.append(element)
    end = found[layout.END]
    return _parse(found, arrays, elements), end.offset + end.size


def _check_names(names: Sequence[str], others: list[str], chunk: Chunk) -> None:
    with corrupt_at(chunk.where):
        records.check_names(names, others)


def _in_order(data: memoryview, offset: int) -> Iterator[Chunk]:
    """The chunks that this reader knows."""
    last: Chunk | None = None
    for chunk in chunks.sequence(data, offset):
        if chunk.type in ORDER:
            if last:
                _check_order(last, chunk)
            elif chunk.type != layout.HEADER:
                raise CorruptError(f"{chunk.where}: the header does not come first")
            yield (last := chunk)
        elif not chunk.type.islower():
            raise VersionError(f"{chunk.where}: unknown, and required to decode the file")


def _check_order(last: Chunk, chunk: Chunk) -> None:
    if chunk.type == last.type and chunk.type not in REPEATED:
        raise CorruptError(f"{chunk.where}: there is one already")
    if ORDER.index(chunk.type) < ORDER.index(last.type):
        raise CorruptError(f"{chunk.where}: it must come before {last.where}")


def _parse(
    found: dict[bytes, Chunk],
    arrays: dict[bytes, list[EncodedArray]],
    elements: list[EncodedElement],
) -> EncodedMesh:
    with corrupt_at(found[layout.HEADER].where):
        header = SimpleNamespace(**layout.parse(layout.Header, found[layout.HEADER].payload))
        _check_header(header)
        coordinates, polygons = _parse_lattice(header), _parse_polygons(header)
        coding = _parse_coding(header, coordinates)
    _check_presence(header, found)

    def payload(kind: bytes) -> bytes:
        return found[kind].payload if kind in found else b""

    places = {layout.NAMES[kind]: chunk.where for kind, chunk in found.items()}
    exception_rows, exception_values = _parse_exceptions(found.get(layout.EXCEPTIONS))
    return EncodedMesh(
        dtype=np.dtype(f"f{header.itemsize}"),
        counts=WordCounts(
            header.n_symbols,
            header.n_closed,
            header.n_single,
            header.n_specials,
            header.n_copies,
            polygons,
        ),
        n_vertices=header.n_vertices,
        n_exceptions=header.n_exceptions,
        lattice=coordinates,
        coding=coding,
        model=tables.read(header.model, found.get(layout.MODEL)),
        streams=Streams(
            word=payload(layout.WORD),
            special_integers=payload(layout.SPECIALS),
            gluing=payload(layout.GLUING),
            splits=found[layout.SPLITS].payload if layout.SPLITS in found else None,
            positions=payload(layout.POSITIONS),
            points=found[layout.POINTS].payload if layout.POINTS in found else None,
            exception_rows=exception_rows,
            exception_values=exception_values,
            order=OrderStreams(
                *(found[kind].payload if kind in found else None for kind in ORDER_CHUNKS)
            ),
        ),
        vertex_attributes=arrays[layout.VERTEX_ATTRIBUTE],
        face_attributes=arrays[layout.FACE_ATTRIBUTE],
        corner_attributes=arrays[layout.CORNER_ATTRIBUTE],
        elements=elements,
        metadata=_text(found.get(layout.METADATA)),
        digest=payload(layout.END),
        places=places,
    )


def _parse_exceptions(chunk: Chunk | None) -> tuple[bytes, bytes]:
    if chunk is None:
        return b"", b""
    with corrupt_at(chunk.where):
        parsed = layout.parse(layout.Exceptions, chunk.payload)
    return parsed.rows, parsed.exact


def _text(chunk: Chunk | None) -> EncodedText | None:
    if chunk is None:
        return None
    with corrupt_at(chunk.where):
        return records.parse_text(layout.parse(layout.Text, chunk.payload))


def _header(encoded: EncodedMesh, model: int) -> bytes:
    counts = encoded.counts
    return layout.build(
        layout.Header,
        {
            "itemsize": encoded.dtype.itemsize,
            "n_vertices": encoded.n_vertices,
            "n_symbols": counts.n_symbols,
            "n_closed": counts.n_closed,
            "n_single": counts.n_single,
            "n_specials": counts.n_specials,
            "n_copies": counts.n_copies,
            "n_exceptions": encoded.n_exceptions,
            "face_size": _face_size(counts),
            "polygons": counts.polygons and vars(counts.polygons),
            "model": model,
            "method": encoded.coding.method + encoded.coding.cut * N_METHODS,
            "lattice": layout.LATTICE_KINDS.index(encoded.lattice.kind),
            "parameters": vars(encoded.lattice),
        },
    )


def _face_size(counts: WordCounts) -> int:
    """Where it tells the counts of polygons."""
    if counts.polygons is None:
        return layout.TRIANGLES
    size = counts.polygons.n_corners // max(counts.polygons.n_faces, 1)
    is_told = 3 < size < 256 and counts.polygons == _polygons_of(size, counts.n_triangles)
    return size if is_told else layout.MIXED


def _polygons_of(size: int, n_triangles: int) -> PolygonCounts:
    n_faces = n_triangles // (size - 2)
    return PolygonCounts(n_faces, 0, size * n_faces)


def _check_header(header: Any) -> None:
    if header.itemsize not in layout.DTYPE_SIZES:
        raise CorruptError(f"coordinates of {header.itemsize} bytes")
    if header.model not in tables.NUMBERS:
        raise VersionError(f"header: unknown model {header.model}")
    if header.lattice >= len(layout.LATTICE_KINDS):
        raise VersionError(f"header: unknown lattice {header.lattice}")
    for name, count in vars(header).items():
        if name.startswith("n_") and count >= MAX_COUNT:
            raise CorruptError(f"{name} is {count}, past the limit of 2^63")
    if header.n_vertices > MAX_VERTICES:
        raise CorruptError(f"{header.n_vertices} vertices, past the limit of 2^31 - 1")
    if header.n_symbols + header.n_closed > MAX_FACES:
        raise CorruptError(f"more faces than the limit of {MAX_FACES}")
    if header.n_closed + header.n_single > header.n_symbols:
        raise CorruptError("more components than symbols")


def _parse_polygons(header: Any) -> PolygonCounts | None:
    if header.face_size == layout.TRIANGLES:
        return None
    if header.face_size in layout.NO_SIZES:
        raise VersionError(f"header: faces of unknown kind {header.face_size}")
    if layout.ADAPTIVE_MODELS.get(header.model, Effort.DIRECT) == Effort.DIRECT:
        raise CorruptError(f"polygons under model {header.model}")
    n_triangles = header.n_symbols + header.n_closed
    if header.face_size != layout.MIXED:
        return _polygons_of(header.face_size, n_triangles)
    n_faces, n_empty, n_corners = (header.polygons[k] for k in ("n_faces", "n_empty", "n_corners"))
    n_runs = n_faces - n_empty
    if n_faces > MAX_FACES or not 0 <= n_runs <= n_triangles:
        raise CorruptError(f"{n_faces} polygons, {n_empty} of them empty")
    if n_corners > n_triangles + 2 * n_runs:
        raise CorruptError(f"{n_corners} corners of {n_runs} polygons")
    return PolygonCounts(n_faces, n_empty, n_corners)


def _check_presence(header: Any, found: dict[bytes, Chunk]) -> None:
    """A chunk is there where the header says that it holds something, and not otherwise."""
    has_faces, keeps_order = header.n_symbols > 0, layout.VERTEX_ORDER in found
    needed = {
        layout.MODEL: header.model == layout.INLINE_MODEL,
        layout.WORD: header.n_symbols > 0,
        layout.SPECIALS: header.n_specials > 0 and header.model not in layout.ADAPTIVE_MODELS,
        layout.GLUING: header.n_copies > 0,
        layout.POSITIONS: has_faces or (header.n_vertices > 0 and layout.POINTS not in found),
        layout.POINTS: header.n_vertices > 0 and layout.POINTS in found,
        layout.EXCEPTIONS: header.n_exceptions > 0,
        layout.VERTEX_ORDER: keeps_order and header.n_vertices > 0,
        layout.FACE_ORDER: keeps_order and has_faces,
        layout.ROTATIONS: has_faces and (keeps_order or layout.ROTATIONS in found),
    }
    for kind, is_needed in needed.items():
        if is_needed and kind not in found:
            name, where = layout.NAMES[kind], found[layout.HEADER].where
            raise CorruptError(f"{where}: it calls for a {name} chunk, which is missing")
        if kind in found and not is_needed:
            raise CorruptError(f"{found[kind].where}: the header has no use for it")


def _parse_coding(header: Any, lattice: Lattice) -> Coding:
    way, number = divmod(header.method, N_METHODS)
    in_floats = FLOAT_METHODS[4 if isinstance(lattice, SingleLattice) else header.itemsize]
    if number in FLOAT_METHODS.values() and number != in_floats:
        raise CorruptError(f"positions of {header.itemsize} bytes by method {number}")
    try:
        coding = Coding(Method(number), Cut(way))
    except ValueError:
        raise VersionError(f"header: unknown method {header.method} of positions") from None
    if way and not (header.face_size and can_cut(header.n_symbols + header.n_closed, coding.cut)):
        raise CorruptError("faces that cannot be cut otherwise")
    return coding


def _parse_lattice(header: Any) -> Lattice:
    kind, parameters = layout.LATTICE_KINDS[header.lattice], header.parameters
    if kind == "decimal":
        if parameters.digits > MAX_DIGITS[header.itemsize]:
            raise CorruptError(f"a lattice of {parameters.digits} decimals")
        return DecimalLattice(parameters.digits)
    if kind == "single":
        if header.itemsize != 8 or parameters.digits > MAX_SINGLE_DIGITS:
            raise CorruptError(f"float32 of {parameters.digits} digits in {header.itemsize} bytes")
        return SingleLattice(parameters.digits)
    if kind == "box":
        origin = tuple(parameters.origin)
        if not 1 <= parameters.bits <= MAX_BITS:
            raise CorruptError(f"a lattice of {parameters.bits} bits")
        if not all(map(math.isfinite, (*origin, parameters.side))):
            raise CorruptError("the box of the lattice is not finite")
        return BoxLattice(parameters.bits, origin, parameters.side)
    if kind == "step":
        if not math.isfinite(parameters.max_error) or parameters.max_error <= 0:
            raise CorruptError(f"a maximal error of {parameters.max_error}")
        return StepLattice(parameters.max_error)
    if kind == "grid":
        origin = tuple(parameters.origin)
        if not all(map(math.isfinite, (*origin, parameters.step))) or parameters.step <= 0:
            raise CorruptError(f"a grid of origin {origin} and step {parameters.step}")
        return GridLattice(origin, parameters.step)
    return FloatLattice()


def _exceptions(streams: Streams) -> bytes:
    values = {"rows": streams.exception_rows, "exact": streams.exception_values}
    return layout.build(layout.Exceptions, values)
