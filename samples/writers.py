"""Mesh files in every flavour, so that ebz's readers meet files that ebz did not write."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

PLY_TYPES = {
    **{"i1": "char", "i2": "short", "i4": "int", "f4": "float"},
    **{"u1": "uchar", "u2": "ushort", "u4": "uint", "f8": "double"},
}


def ply(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    flavour: str = "binary_little_endian",
    vertex_properties: Mapping[str, Array] | None = None,
    face_properties: Mapping[str, Array] | None = None,
    comments: Sequence[str] = (),
) -> bytes:
    """PLY with x, y, z first, then the given properties; the face list first, then its own."""
    points = _points(vertices)
    columns = {axis: points[:, i] for i, axis in enumerate("xyz")} | dict(vertex_properties or {})
    corners = np.asarray(faces, np.int32).reshape(-1, 3)
    header = ["ply", f"format {flavour} 1.0", *(f"comment {line}" for line in comments)]
    header += [f"element vertex {len(points)}", *_properties(columns)]
    header += [f"element face {len(corners)}", "property list uchar int vertex_indices"]
    header += [*_properties(face_properties or {}), "end_header"]
    count = np.full(len(corners), 3, np.uint8)
    indices = {f"corner {i}": corners[:, i] for i in range(3)}
    tables = [_table(columns), _table({"count": count} | indices | dict(face_properties or {}))]
    if flavour == "ascii":
        rows = [" ".join(map(str, row)) for table in tables for row in _rows(table)]
        return "".join(f"{line}\n" for line in [*header, *rows]).encode()
    order = ">" if flavour == "binary_big_endian" else "<"
    body = b"".join(table.astype(table.dtype.newbyteorder(order)).tobytes() for table in tables)
    return "".join(f"{line}\n" for line in header).encode() + body


def obj(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> bytes:
    lines = [f"v {_numbers(point)}" for point in _points(vertices)]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in np.asarray(faces)]
    return "".join(f"{line}\n" for line in lines).encode()


def off(vertices: npt.ArrayLike, faces: Sequence[Sequence[int]] | Array) -> bytes:
    points = _points(vertices)
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [_numbers(point) for point in points]
    lines += [" ".join(map(str, [len(face), *face])) for face in faces]
    return "".join(f"{line}\n" for line in lines).encode()


def binary_stl(vertices: npt.ArrayLike, faces: npt.ArrayLike, name: str) -> bytes:
    corners = _points(vertices)[np.asarray(faces)]
    layout = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    table = np.zeros(len(corners), np.dtype(layout))
    table["normal"], table["corners"] = _normals(corners), corners
    return name.encode().ljust(80) + len(corners).to_bytes(4, "little") + table.tobytes()


def ascii_stl(vertices: npt.ArrayLike, faces: npt.ArrayLike, name: str) -> bytes:
    corners = _points(vertices)[np.asarray(faces)]
    lines = [f"solid {name}"]
    for normal, triangle in zip(_normals(corners), corners, strict=True):
        lines += [f"facet normal {_numbers(normal)}", "  outer loop"]
        lines += [f"    vertex {_numbers(corner)}" for corner in triangle]
        lines += ["  endloop", "endfacet"]
    lines += [f"endsolid {name}"]
    return "".join(f"{line}\n" for line in lines).encode()


def glb(document: dict[str, Any], arrays: Sequence[Array]) -> bytes:
    """The document with an accessor for each array, one after another in the buffer."""
    kinds = {"f4": 5126, "u2": 5123, "u1": 5121}
    body, accessors, views = b"", [], []
    for array in arrays:
        data = np.ascontiguousarray(array).tobytes()
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": len(data)})
        shape = "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}"
        entry = {"bufferView": len(accessors), "componentType": kinds[array.dtype.str[1:]]}
        accessors.append(entry | {"count": len(array), "type": shape})
        body += data + bytes(-len(data) % 4)
    document = document | {"accessors": accessors, "bufferViews": views}
    text = json.dumps(document | {"buffers": [{"byteLength": len(body)}]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = b"".join(
        len(chunk).to_bytes(4, "little") + kind + chunk
        for kind, chunk in ((b"JSON", text), (b"BIN\0", body))
    )
    return b"glTF\2\0\0\0" + (12 + len(chunks)).to_bytes(4, "little") + chunks


def _points(vertices: npt.ArrayLike) -> Array:
    """Float32 unless given as a float64 array."""
    points = vertices if isinstance(vertices, np.ndarray) else np.array(vertices, np.float32)
    return points.reshape(-1, 3)


def _properties(columns: Mapping[str, Array]) -> list[str]:
    return [
        f"property {PLY_TYPES[column.dtype.str[1:]]} {name}" for name, column in columns.items()
    ]


def _table(columns: Mapping[str, Array]) -> Array:
    dtype = np.dtype([(name, column.dtype) for name, column in columns.items()])
    table = np.empty(len(next(iter(columns.values()))), dtype)
    for name, column in columns.items():
        table[name] = column
    return table


def _rows(table: Array) -> list[tuple[Any, ...]]:
    """Numpy scalars, which print as their shortest decimal in their own precision."""
    return list(zip(*(table[name] for name in table.dtype.names or ()), strict=True))


def _numbers(values: Array) -> str:
    """The shortest decimals in their own precision, which format() does not give."""
    return " ".join(map(str, values))


def _normals(corners: Array) -> Array:
    a, b, c = (corners[:, i].astype(np.float64) for i in range(3))
    normal = np.cross(b - a, c - a)
    x, y, z = normal.T
    return (normal / np.sqrt(x * x + y * y + z * z)[:, None] + 0.0).astype(np.float32)
