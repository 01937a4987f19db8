"""Attributes <-> the payloads of their chunks, which describe themselves."""

import math
from typing import Any

import numpy as np

from ebz.codec.arrays import MAX_DIMENSIONS, MAX_ENTRY, NUMBERS
from ebz.codec.encoded import EncodedArray
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.formats import layout
from ebz.formats.chunks import Chunk

# Longer floats exist on some machines only.
MAX_ITEMSIZE = 8


def attribute(array: EncodedArray) -> bytes:
    """The payload of an attribute chunk."""
    return layout.build(
        layout.Attribute,
        {
            "name": array.name.encode("utf-8", "surrogatepass"),
            "kind": array.dtype.kind.encode(),
            "itemsize": array.dtype.itemsize,
            "shape": array.shape,
            "data": array.data,
        },
    )


def parse_attribute(chunk: Chunk) -> EncodedArray:
    """The attribute of a chunk; raises CorruptError."""
    with corrupt_at(chunk.where):
        parsed = layout.parse(layout.Attribute, chunk.payload)
        dtype = _parse_dtype(parsed)
        shape = tuple(parsed.shape)
        if len(shape) >= MAX_DIMENSIONS or math.prod(filter(None, shape)) >= MAX_ENTRY:
            raise CorruptError(f"an attribute of shape {shape}")
        try:
            name = parsed.name.decode("utf-8", "surrogatepass")
        except UnicodeDecodeError as error:
            raise CorruptError(f"name: {error}") from None
    return EncodedArray(name, dtype, shape, parsed.data, chunk.where)


def _parse_dtype(parsed: Any) -> np.dtype[Any]:
    kind = parsed.kind.decode("latin-1")
    try:
        if kind in NUMBERS and parsed.itemsize <= MAX_ITEMSIZE:
            return np.dtype(f"{kind}{parsed.itemsize}")
    except TypeError:
        pass
    raise CorruptError(f"an attribute of type {kind!r} with {parsed.itemsize} bytes")
