"""The chunks of one mesh <-> the encoded mesh, in decode order; FORMAT.md describes every byte.

records, for attributes and elements, is imported where a mesh has any: see declarations.
"""

from collections.abc import Iterator

from ebz.codec.encoded import EncodedArray, EncodedElement, EncodedMesh, Streams
from ebz.codec.errors import CorruptError, VersionError, corrupt_at
from ebz.codec.listing import Listing
from ebz.codec.mesh import VERTEX_DTYPES
from ebz.codec.models.load import AnyTable
from ebz.codec.order import OrderStreams
from ebz.formats import tables
from ebz.formats.ebz import chunks, header, layout, payloads
from ebz.formats.ebz.chunks import Chunk
from ebz.formats.ebz.header import Header

# The order of chunks in a file.
RANKS = {kind: rank for rank, kind in enumerate(layout.NAMES)}
ORDER_CHUNKS = (layout.VERTEX_ORDER, layout.FACE_ORDER, layout.ROTATIONS)
ATTRIBUTES = (layout.VERTEX_ATTRIBUTE, layout.FACE_ATTRIBUTE, layout.CORNER_ATTRIBUTE)
REPEATED = {*ATTRIBUTES, layout.ELEMENT}
DTYPES = {dtype.itemsize: dtype for dtype in VERTEX_DTYPES}


def write(encoded: EncodedMesh, *, embed_model: bool = False) -> list[bytes]:
    """The chunks: those that hold nothing are left out, but for the header and the end."""
    model = tables.number_of(encoded.model)
    table = encoded.model if isinstance(encoded.model, AnyTable) else None
    inline = table is not None and (embed_model or model == layout.INLINE_MODEL)
    streams = encoded.streams
    parts = [
        chunks.write(layout.HEADER, header.write(encoded, layout.INLINE_MODEL if inline else model))
    ]
    optional = [
        (layout.MODEL, tables.write(table) if table and inline else b""),
        (layout.WORD, streams.word if encoded.counts.n_symbols else b""),
        (layout.SPECIALS, streams.special_integers),
        (layout.GLUING, streams.gluing),
        (layout.SPLITS, streams.splits),
        (layout.POSITIONS, _positions(streams)),
        (layout.POINTS, streams.points),
        (layout.EXCEPTIONS, _exceptions(streams) if encoded.n_exceptions else b""),
        (layout.VERTEX_ORDER, streams.order.vertices),
        (layout.FACE_ORDER, streams.order.faces),
        (layout.ROTATIONS, streams.order.rotations),
    ]
    parts += [chunks.write(kind, payload) for kind, payload in optional if payload]
    return [*parts, *_write_carried(encoded), chunks.write(layout.END, encoded.digest)]


def _write_carried(encoded: EncodedMesh) -> list[bytes]:
    """The chunks of what a mesh has besides its surface."""
    carried = encoded.vertex_attributes, encoded.face_attributes, encoded.corner_attributes
    parts = []
    if any(carried) or encoded.elements:
        from ebz.formats.ebz import records

        for kind, arrays in zip(ATTRIBUTES, carried, strict=True):
            parts += [chunks.write(kind, records.attribute(array)) for array in arrays]
        parts += [chunks.write(layout.ELEMENT, records.element(rows)) for rows in encoded.elements]
    if encoded.metadata:
        parts.append(chunks.write(layout.METADATA, payloads.text(encoded.metadata)))
    return parts


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
            _add_attribute(chunk, arrays[chunk.type])
        elif chunk.type == layout.ELEMENT:
            _add_element(chunk, elements)
    end = found[layout.END]
    return _parse(found, arrays, elements), end.offset + end.size


def _add_attribute(chunk: Chunk, arrays: list[EncodedArray]) -> None:
    from ebz.formats.ebz import records

    array = records.parse_attribute(chunk)
    with corrupt_at(chunk):
        records.check_names(array.names, [name for other in arrays for name in other.names])
    arrays.append(array)


def _add_element(chunk: Chunk, elements: list[EncodedElement]) -> None:
    from ebz.formats.ebz import records

    element = records.parse_element(chunk)
    with corrupt_at(chunk):
        records.check_names([element.name], [other.name for other in elements])
    elements.append(element)


def _in_order(data: memoryview, offset: int) -> Iterator[Chunk]:
    """The chunks that this reader knows."""
    last: Chunk | None = None
    for chunk in chunks.sequence(data, offset):
        if chunk.type in RANKS:
            if last:
                _check_order(last, chunk)
            elif chunk.type != layout.HEADER:
                raise CorruptError(f"{chunk}: the header does not come first")
            yield (last := chunk)
        elif not chunk.type.islower():
            raise VersionError(f"{chunk}: unknown, and required to decode the file")


def _check_order(last: Chunk, chunk: Chunk) -> None:
    if chunk.type == last.type and chunk.type not in REPEATED:
        raise CorruptError(f"{chunk}: there is one already")
    if RANKS[chunk.type] < RANKS[last.type]:
        raise CorruptError(f"{chunk}: it must come before {last}")


def _parse(
    found: dict[bytes, Chunk],
    arrays: dict[bytes, list[EncodedArray]],
    elements: list[EncodedElement],
) -> EncodedMesh:
    with corrupt_at(found[layout.HEADER]):
        head = header.read(found[layout.HEADER].payload)
    _check_presence(head, found)
    contents = {kind: chunk.payload for kind, chunk in found.items()}
    exception_rows, exception_values = _parse_exceptions(found.get(layout.EXCEPTIONS))
    listing, positions = _parse_positions(found.get(layout.POSITIONS), head)
    return EncodedMesh(
        dtype=DTYPES[head.itemsize],
        counts=head.counts,
        n_vertices=head.n_vertices,
        n_exceptions=head.n_exceptions,
        lattice=head.lattice,
        coding=head.coding,
        model=tables.read(head.model, found.get(layout.MODEL)),
        streams=Streams(
            word=contents.get(layout.WORD, b""),
            special_integers=contents.get(layout.SPECIALS, b""),
            gluing=contents.get(layout.GLUING, b""),
            splits=contents.get(layout.SPLITS),
            positions=positions,
            listing=listing,
            points=contents.get(layout.POINTS),
            exception_rows=exception_rows,
            exception_values=exception_values,
            order=OrderStreams(*map(contents.get, ORDER_CHUNKS)),
        ),
        vertex_attributes=arrays[layout.VERTEX_ATTRIBUTE],
        face_attributes=arrays[layout.FACE_ATTRIBUTE],
        corner_attributes=arrays[layout.CORNER_ATTRIBUTE],
        elements=elements,
        metadata=payloads.parse_text(found[layout.METADATA]) if layout.METADATA in found else None,
        digest=contents[layout.END],
        places={layout.NAMES[kind]: chunk for kind, chunk in found.items()},
    )


def _parse_exceptions(chunk: Chunk | None) -> tuple[bytes, bytes]:
    if chunk is None:
        return b"", b""
    return payloads.parse_exceptions(chunk)


def _check_presence(head: Header, found: dict[bytes, Chunk]) -> None:
    """A chunk is there where the header says that it holds something, and not otherwise."""
    has_faces, keeps_order = head.n_symbols > 0, layout.VERTEX_ORDER in found
    needed = {
        layout.MODEL: head.model == layout.INLINE_MODEL,
        layout.WORD: head.n_symbols > 0,
        layout.SPECIALS: head.n_specials > 0 and head.model not in layout.ADAPTIVE_MODELS,
        layout.GLUING: head.n_copies > 0,
        layout.POSITIONS: has_faces or (head.n_vertices > 0 and layout.POINTS not in found),
        layout.POINTS: head.n_vertices > 0 and layout.POINTS in found,
        layout.EXCEPTIONS: head.n_exceptions > 0,
        layout.VERTEX_ORDER: keeps_order and head.n_vertices > 0,
        layout.FACE_ORDER: keeps_order and has_faces,
        layout.ROTATIONS: has_faces and (keeps_order or layout.ROTATIONS in found),
    }
    for kind, is_needed in needed.items():
        if is_needed and kind not in found:
            name, where = layout.NAMES[kind], found[layout.HEADER]
            raise CorruptError(f"{where}: it calls for a {name} chunk, which is missing")
        if kind in found and not is_needed:
            raise CorruptError(f"{found[kind]}: the header has no use for it")


def _positions(streams: Streams) -> bytes:
    """The list of coordinates before the stream, if there is one."""
    if streams.listing is None:
        return streams.positions
    data = streams.listing.data
    head = layout.varint(streams.listing.n) + layout.varint(len(data))
    return head + data + streams.positions


def _parse_positions(chunk: Chunk | None, head: header.Header) -> tuple[Listing | None, bytes]:
    if chunk is None or not head.coding.is_listed:
        return None, chunk.payload if chunk else b""
    data = chunk.payload
    try:
        n, start = layout.read_varint(data)
        length, size = layout.read_varint(data, start)
    except (IndexError, ValueError) as error:
        raise CorruptError(f"{chunk}: no list of coordinates: {error}") from None
    end = start + size + length
    if end > len(data):
        raise CorruptError(f"{chunk}: {length} bytes for a list of coordinates, past its end")
    return Listing(n, bytes(data[start + size : end])), bytes(data[end:])


def _exceptions(streams: Streams) -> bytes:
    return payloads.exceptions(streams.exception_rows, streams.exception_values)
