"""Primitives of glTF -> meshes: attributes by their names, strips and fans as triangles.

Source: The Khronos Group, glTF 2.0 Specification, section 3.7.
"""

from collections import Counter, defaultdict
from typing import Any

import numpy as np

from ebz.codec.elements import Element
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped
from ebz.formats.gltf.accessors import Array, read_accessor

POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, STRIP, FAN = range(7)
# What a primitive has besides: in the metadata of its part.
PRIMITIVE = "gltf_primitive"
COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
# Primitives may share accessors, but no more than this, as a share of the file.
MAX_REPEATED = 64


def read_primitives(document: Any, body: bytes | bytearray) -> list[Mesh]:
    """A mesh for each primitive, in the order of the document. Raises MeshError."""
    found = [
        (number, mesh, primitive)
        for number, mesh in enumerate(document.get("meshes", []))
        for primitive in mesh["primitives"]
    ]
    uses = Counter(primitive["attributes"].get("POSITION") for _, _, primitive in found)
    parts, n_bytes = [], 0
    used: defaultdict[int, list[Array]] = defaultdict(list)
    for number, mesh, primitive in found:
        part = _read_primitive(document, body, number, mesh, primitive)
        n_bytes += part.vertices.nbytes + part.corners.nbytes
        if n_bytes > MAX_REPEATED * len(body) + (1 << 20):
            raise MeshError("glTF: its primitives repeat too much of its buffers")
        position = primitive["attributes"]["POSITION"]
        if uses[position] > 1:
            rows = _used(part)
            used[position].append(rows)
            part = _taken(part, rows)
        parts.append(part)
    unused = [
        document["accessors"][position]["count"] - len(np.unique(np.concatenate(rows)))
        for position, rows in used.items()
    ]
    if any(unused):
        warn_dropped(f"glTF: vertices of shared buffers that no primitive uses ({sum(unused)})")
    return parts


def _read_primitive(
    document: Any, body: bytes | bytearray, number: int, mesh: Any, primitive: Any
) -> Mesh:
    place = f"glTF: mesh {number}"
    attributes = {
        name: read_accessor(document, body, at) for name, at in primitive["attributes"].items()
    }
    if "POSITION" not in attributes:
        raise MeshError(f"{place}: a primitive without positions")
    targets = [
        (f"target {i}/{name}", read_accessor(document, body, at))
        for i, target in enumerate(primitive.get("targets", []))
        for name, at in target.items()
    ]
    position = attributes.pop("POSITION")
    vertices = position.astype(np.float32)
    faces, elements = _connectivity(document, body, primitive, len(vertices), place)
    rest = {key: primitive[key] for key in ("material", "extras", "extensions") if key in primitive}
    normalized = [
        name
        for name, at in primitive["attributes"].items()
        if document["accessors"][at].get("normalized")
    ]
    kept: dict[str, Any] = {"mesh": number} | rest
    kept |= {"normalized": normalized} if normalized else {}
    kept |= {"positions": position.dtype.name} if position.dtype != vertices.dtype else {}
    kept |= {"indexed": True} if primitive.get("mode") == POINTS and "indices" in primitive else {}
    name = mesh.get("name")
    return Mesh(
        vertices,
        faces,
        vertex_attributes=attributes | dict(targets),
        elements=elements,
        metadata=({"name": name} if isinstance(name, str) else {}) | {PRIMITIVE: kept},
    )


def _connectivity(
    document: Any, body: bytes | bytearray, primitive: Any, n_vertices: int, place: str
) -> tuple[Array, dict[str, Element]]:
    mode = primitive.get("mode", TRIANGLES)
    if "indices" in primitive:
        corners = read_accessor(document, body, primitive["indices"]).astype(np.int64)
    elif mode == POINTS:
        return np.zeros((0, 3), np.int32), {}
    else:
        corners = np.arange(n_vertices)
    if corners.ndim != 1:
        raise MeshError(f"{place}: indices are no scalars")
    if mode in (TRIANGLES, STRIP, FAN):
        return _triangles(corners, mode, place), {}
    if mode not in (POINTS, LINES, LINE_LOOP, LINE_STRIP):
        raise MeshError(f"{place}: unknown mode {mode!r}")
    name, rows = _rows(corners, mode, place)
    return np.zeros((0, 3), np.int32), {name: rows}


def _triangles(corners: Array, mode: int, place: str) -> Array:
    if mode == TRIANGLES:
        if len(corners) % 3:
            raise MeshError(f"{place}: {len(corners)} corners of triangles")
        return corners.reshape(-1, 3)
    i = np.arange(max(len(corners) - 2, 0))
    if mode == STRIP:
        return corners[np.stack([i, i + 1 + i % 2, i + 2 - i % 2], axis=1)]
    return corners[np.stack([i + 1, i + 2, 0 * i], axis=1)]


def _rows(corners: Array, mode: int, place: str) -> tuple[str, Element]:
    """Points one by one; lines in pairs; a strip or loop as one row, which ends where it began."""
    if mode == POINTS:
        return "point", Element(np.arange(len(corners) + 1), corners)
    if mode == LINES:
        if len(corners) % 2:
            raise MeshError(f"{place}: {len(corners)} ends of lines")
        return "line", Element(np.arange(0, len(corners) + 1, 2), corners)
    if mode == LINE_LOOP:
        corners = np.concatenate([corners, corners[:1]])
    return "line", Element(np.array([0, len(corners)]), corners)


def _used(part: Mesh) -> Array:
    """The vertices that a part uses: all, where it is a cloud of points."""
    rows = [part.corners, *(element.corners for element in part.elements.values())]
    return np.unique(np.concatenate(rows)) if any(map(len, rows)) else np.arange(part.n_vertices)


def _taken(part: Mesh, used: Array) -> Mesh:
    """The part with these of its vertices alone."""
    number = np.zeros(part.n_vertices, np.int64)
    number[used] = np.arange(len(used))
    return Mesh(
        part.vertices[used],
        number[part.faces],
        vertex_attributes={name: v[used] for name, v in part.vertex_attributes.items()},
        elements={
            name: Element(element.offsets, number[element.corners])
            for name, element in part.elements.items()
        },
        metadata=part.metadata,
    )
