"""Accessors of glTF <-> arrays, their dtype kept.

Source: The Khronos Group, glTF 2.0 Specification, section 3.6.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError

Array = npt.NDArray[Any]

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COMPONENT_OF = {np.dtype(text).newbyteorder("="): number for number, text in COMPONENTS.items()}
SHAPES: dict[str, tuple[int, ...]] = {
    "SCALAR": (),
    "VEC2": (2,),
    "VEC3": (3,),
    "VEC4": (4,),
    "MAT2": (2, 2),
    "MAT3": (3, 3),
    "MAT4": (4, 4),
}
TYPE_OF = {shape: name for name, shape in SHAPES.items()}
ALIGNMENT = 4
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def read_accessor(document: Any, body: bytes | bytearray, number: int) -> Array:
    """(count, ...) values; matrices are lists of their columns. Raises MeshError."""
    accessor = _entry(document, "accessors", number, f"glTF: there is no accessor {number!r}")
    dtype, shape = _type(accessor, number)
    count = _natural(accessor["count"], number)
    if "bufferView" in accessor:
        place = accessor["bufferView"], accessor.get("byteOffset", 0)
        values = _rows(document, body, place, count, dtype, shape, number)
    elif count <= len(body) + 1024:  # zeros for which there is nothing in the file
        values = np.zeros((count, *shape), dtype)
    else:
        raise MeshError(f"glTF: accessor {number}: {count} values without a buffer view")
    if "sparse" in accessor:
        values = _with_sparse(values, document, body, accessor["sparse"], number)
    return values.astype(dtype.newbyteorder("="))


def _type(accessor: Any, number: int) -> tuple[np.dtype[Any], tuple[int, ...]]:
    component, kind = accessor["componentType"], accessor["type"]
    if component not in COMPONENTS or kind not in SHAPES:
        raise MeshError(f"glTF: accessor {number}: {kind!r} of components {component!r}")
    return np.dtype(COMPONENTS[component]), SHAPES[kind]


def _with_sparse(
    values: Array, document: Any, body: bytes | bytearray, sparse: Any, number: int
) -> Array:
    count = _natural(sparse["count"], number)
    at, new = sparse["indices"], sparse["values"]
    index_type = np.dtype(COMPONENTS[at["componentType"]])
    place = at["bufferView"], at.get("byteOffset", 0)
    rows = _rows(document, body, place, count, index_type, (), number)
    place = new["bufferView"], new.get("byteOffset", 0)
    changed = _rows(document, body, place, count, values.dtype, values.shape[1:], number)
    if count and rows.max() >= len(values):
        raise MeshError(f"glTF: accessor {number}: sparse index {rows.max()} is out of range")
    values = values.copy()
    values[rows] = changed
    return values


def _entry(document: Any, name: str, number: Any, missing: str) -> Any:
    entries = document.get(name, [])
    if type(number) is not int or not 0 <= number < len(entries):
        raise MeshError(missing)
    return entries[number]


def _natural(value: Any, number: int) -> int:
    if type(value) is not int or value < 0:
        raise MeshError(f"glTF: accessor {number}: a count of {value!r}")
    return value


def _rows(
    document: Any,
    body: bytes | bytearray,
    place: tuple[int, int],
    count: int,
    dtype: np.dtype[Any],
    shape: tuple[int, ...],
    number: int,
) -> Array:
    """`count` entries of a buffer view, which may stand apart."""
    missing = f"glTF: accessor {number}: there is no buffer view {place[0]!r}"
    view = _entry(document, "bufferViews", place[0], missing)
    packed, strides = _layout(dtype, shape)
    stride = view.get("byteStride", packed)
    begin, end = place[1], place[1] + (count - 1) * stride + packed
    if not count:
        return np.zeros((0, *shape), dtype)
    if begin < 0 or stride < packed or end > view["byteLength"]:
        raise MeshError(f"glTF: accessor {number}: {count} values past the end of its buffer view")
    return np.ndarray((count, *shape), dtype, body, view["byteOffset"] + begin, (stride, *strides))


def _layout(dtype: np.dtype[Any], shape: tuple[int, ...]) -> tuple[int, tuple[int, ...]]:
    """Bytes of an entry and strides within it: columns of matrices are aligned."""
    size = dtype.itemsize
    if len(shape) < 2:
        return size * (shape[0] if shape else 1), (size,) * len(shape)
    column = -(-size * shape[1] // ALIGNMENT) * ALIGNMENT
    return column * shape[0], (column, size)


def packed_rows(values: Array) -> tuple[bytes, int | None]:
    """The bytes of an array of vertices, and the stride where entries had to be padded."""
    size, strides = _layout(values.dtype, values.shape[1:])
    stride = -(-size // ALIGNMENT) * ALIGNMENT
    packed = np.zeros(len(values) * stride, np.uint8)
    little = values.dtype.newbyteorder("<")
    np.ndarray(values.shape, little, packed.data, 0, (stride, *strides))[...] = values
    return packed.tobytes(), stride if stride != size else None
