"""Attributes by name <-> streams, entries in output order, bit for bit."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.arrays import Attributes
from ebz.codec.encoded import EncodedArray


def encode(attributes: Attributes, order: npt.NDArray[Any]) -> list[EncodedArray]:
    """A stream per attribute; `order` gives the source entry of each output entry."""
    return [_encode(name, values[order]) for name, values in attributes.items()]


def decode(arrays: list[EncodedArray], n: int) -> Attributes:
    """The attributes of n entries; whatever the bytes are, arrays of that shape come back."""
    return {array.name: _decode(array, n) for array in arrays}


def keeps_rotation(face_attributes: Attributes) -> bool:
    """Whether the first corner of a face matters: several values may stand for its corners."""
    return any(values.ndim > 1 for values in face_attributes.values())


def _encode(name: str, values: npt.NDArray[Any]) -> EncodedArray:
    little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    stride = little[:1].nbytes
    rows = little.view(np.uint8).reshape(-1) if stride else np.zeros(0, np.uint8)
    data = _kernels.encode_rows(rows, stride) if stride else b""
    return EncodedArray(name, values.dtype.newbyteorder("="), values.shape[1:], data)


def _decode(array: EncodedArray, n: int) -> npt.NDArray[Any]:
    shape, stride = (n, *array.shape), array.entry_size
    if not n or not stride:
        return np.zeros(shape, array.dtype)
    rows = _kernels.decode_rows(np.frombuffer(array.data, np.uint8), n, stride)
    return rows.view(array.dtype.newbyteorder("<")).reshape(shape).astype(array.dtype, copy=False)
