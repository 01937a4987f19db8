"""Attributes and elements <-> the payloads of their chunks, which describe themselves."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ebz.codec.arrays import MAX_DIMENSIONS, MAX_ENTRY, NUMBERS
from ebz.codec.encoded import EncodedArray, EncodedElement
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.formats.ebz import declarations, heads, plans
from ebz.formats.ebz.chunks import Chunk

# Longer floats exist on some machines only.
MAX_ITEMSIZE = 8
MAX_COUNT = 2**63


def attribute(array: EncodedArray) -> bytes:
    """The payload of an attribute chunk."""
    return declarations.build(declarations.Attribute, _attribute(array))


def parse_attribute(chunk: Chunk) -> EncodedArray:
    """The attribute of a chunk; raises CorruptError."""
    with corrupt_at(chunk):
        return _parse_attribute(
            declarations.parse(declarations.Attribute, chunk.payload), str(chunk)
        )


def element(rows: EncodedElement) -> bytes:
    """The payload of an element's chunk."""
    return declarations.build(
        declarations.Element,
        {
            "name": _to_bytes(rows.name),
            "n_rows": rows.n_rows,
            "n_corners": rows.n_corners,
            "lengths": [_attribute(rows.lengths)] if rows.lengths else [],
            "corners": [_attribute(rows.corners)] if rows.corners else [],
            "links": rows.links,
            "attributes": [_attribute(array) for array in rows.attributes],
            "corner_attributes": [_attribute(array) for array in rows.corner_attributes],
        },
    )


def parse_element(chunk: Chunk) -> EncodedElement:
    """The element of a chunk; raises CorruptError."""
    where = str(chunk)
    with corrupt_at(where):
        parsed = declarations.parse(declarations.Element, chunk.payload)
        if max(parsed.n_rows, parsed.n_corners) >= MAX_COUNT or len(parsed.lengths) > 1:
            raise CorruptError("more rows or corners than there can be")
        if len(parsed.corners) > 1 or (parsed.corners and parsed.links):
            raise CorruptError("corners are told twice")
        lengths = [_parse_attribute(array, where) for array in parsed.lengths]
        corners = [_parse_attribute(array, where) for array in parsed.corners]
        return EncodedElement(
            name=_parse_name(parsed.name),
            n_rows=parsed.n_rows,
            n_corners=parsed.n_corners,
            lengths=_of_integers(lengths[0], np.dtype(np.int64), 0) if lengths else None,
            corners=_of_integers(corners[0], np.dtype(np.int32), 1) if corners else None,
            links=parsed.links,
            attributes=_parse_all(parsed.attributes, where),
            corner_attributes=_parse_all(parsed.corner_attributes, where),
            place=where,
        )


def check_names(names: Sequence[str], others: Iterable[str]) -> None:
    """Raise CorruptError where a name is there already."""
    known = set(others)
    for name in names:
        if name in known:
            raise CorruptError(f"there is a {name!r} already")
        known.add(name)


def _attribute(array: EncodedArray) -> dict[str, Any]:
    head = declarations.build(
        declarations.AttributeHead,
        {
            "names": [_to_bytes(name) for name in array.names],
            "kind": array.dtype.kind.encode(),
            "itemsize": array.dtype.itemsize,
            "shape": array.shape,
            "plan": plans.build(array.plan),
            "seams_size": len(array.seams),
        },
    )
    streams = array.plan.labels + array.seams + array.data
    return {"n_head": len(head), "head": heads.encode(head), "streams": streams}


def _parse_attribute(parsed: Any, where: str) -> EncodedArray:
    head = declarations.parse(declarations.AttributeHead, heads.decode(parsed.head, parsed.n_head))
    dtype, shape = _parse_dtype(head), tuple(head.shape)
    if len(shape) >= MAX_DIMENSIONS or math.prod(filter(None, shape)) >= MAX_ENTRY:
        raise CorruptError(f"an attribute of shape {shape}")
    names = tuple(_parse_name(name) for name in head.names)
    check_names(names, [])
    if len(names) != 1 and shape != (len(names),):
        raise CorruptError(f"{len(names)} names for entries of shape {shape}")
    labels, seams, data = _streams(parsed.streams, head.plan.labels_size or 0, head.seams_size)
    plan = plans.parse(head.plan, dtype, math.prod(shape), labels)
    return EncodedArray(names, dtype, shape, data, plan, seams, where)


def _streams(streams: bytes, labels_size: int, seams_size: int) -> tuple[bytes, bytes, bytes]:
    """Labels, seams, data."""
    start = labels_size + seams_size
    if start > len(streams):
        raise CorruptError(f"{len(streams)} bytes where labels and seams take {start}")
    return streams[:labels_size], streams[labels_size:start], streams[start:]


def _parse_all(parsed: list[Any], where: str) -> list[EncodedArray]:
    arrays: list[EncodedArray] = []
    for one in parsed:
        array = _parse_attribute(one, where)
        check_names(array.names, [name for other in arrays for name in other.names])
        arrays.append(array)
    return arrays


def _of_integers(array: EncodedArray, dtype: np.dtype[Any], n_dimensions: int) -> EncodedArray:
    if array.dtype != dtype or len(array.shape) != n_dimensions or 0 in array.shape:
        raise CorruptError(f"corners or lengths of {array.dtype} by {array.shape}")
    return array


def _to_bytes(name: str) -> bytes:
    return name.encode("utf-8", "surrogatepass")


def _parse_name(name: bytes) -> str:
    try:
        return name.decode("utf-8", "surrogatepass")
    except UnicodeDecodeError as error:
        raise CorruptError(f"name: {error}") from None


def _parse_dtype(parsed: Any) -> np.dtype[Any]:
    kind = parsed.kind.decode("latin-1")
    try:
        if kind in NUMBERS and parsed.itemsize <= MAX_ITEMSIZE:
            return np.dtype(f"{kind}{parsed.itemsize}")
    except TypeError:
        pass
    raise CorruptError(f"an attribute of type {kind!r} with {parsed.itemsize} bytes")
