"""Entries of one attribute <-> its stream, bit for bit."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.arrays import Attributes
from ebz.codec.attributes.items import Items
from ebz.codec.encoded import EncodedArray


def encode(attributes: Attributes, order: npt.NDArray[Any], items: Items) -> list[EncodedArray]:
    """A stream per attribute; `order` gives the source entry of each output entry."""
    return [encode_array(name, values[order], items) for name, values in attributes.items()]


def decode(arrays: list[EncodedArray], items: Items) -> Attributes:
    """The attributes by name; whatever the bytes are, arrays of n entries come back."""
    return {array.name: decode_array(array, items) for array in arrays}


def encode_array(name: str, values: npt.NDArray[Any], items: Items) -> EncodedArray:
    little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    stride = little[:1].nbytes
    data = little.view(np.uint8).reshape(-1) if stride else np.zeros(0, np.uint8)
    stream = _kernels.encode_rows(data, stride) if stride else b""
    return EncodedArray(name, values.dtype.newbyteorder("="), values.shape[1:], stream)


def decode_array(array: EncodedArray, items: Items) -> npt.NDArray[Any]:
    shape, stride = (items.n, *array.shape), array.entry_size
    if not items.n or not stride:
        return np.zeros(shape, array.dtype)
    data = _kernels.decode_rows(np.frombuffer(array.data, np.uint8), items.n, stride)
    return data.view(array.dtype.newbyteorder("<")).reshape(shape).astype(array.dtype, copy=False)
