"""A glTF scene as meshes in the coordinates of the world, for formats that have no nodes.

Source: The Khronos Group, glTF 2.0 Specification, section 3.5.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.dropped import warn_dropped
from ebz.formats.gltf.accessors import Array
from ebz.formats.gltf.primitives import PRIMITIVE

# What no format of one mesh can carry.
OTHERS = ("materials", "textures", "images", "animations", "skins", "cameras")


def placed(content: Mesh | Scene, format: str) -> Mesh | Scene:
    """The parts once for each node that shows them, transformed; warns of what is left out."""
    document = content.metadata["gltf"]["document"]
    others = [f"{key} ({len(document[key])})" for key in OTHERS if document.get(key)]
    if others:
        warn_dropped(f"{format.upper()} cannot carry {', '.join(others)} of glTF")
    parts = content.parts if isinstance(content, Scene) else [content]
    try:
        shown = list(_shown(document))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise MeshError(f"glTF: malformed document: {error!r}") from None
    found = [
        _transformed(part, matrix)
        for number, matrix in shown
        for part in parts
        if part.metadata.get(PRIMITIVE, {}).get("mesh") == number
    ]
    hidden = sum(
        part.metadata.get(PRIMITIVE, {}).get("mesh") not in {number for number, _ in shown}
        for part in parts
    )
    if hidden:
        warn_dropped(f"{hidden} meshes that no node of the scene shows")
    return found[0] if len(found) == 1 else Scene(found)


def _shown(document: Any) -> Iterator[tuple[int, Array]]:
    """The mesh and the matrix of every node of the scene that has one, in the order of the tree."""
    nodes, scenes = document.get("nodes", []), document.get("scenes", [])
    roots = scenes[document.get("scene", 0)].get("nodes", []) if scenes else _roots(nodes)
    left = [(number, np.eye(4)) for number in reversed(roots)]
    n_seen = 0
    while left:
        number, above = left.pop()
        n_seen += 1
        if n_seen > len(nodes):
            raise MeshError("glTF: the nodes of the scene are no tree")
        node = nodes[number]
        matrix = above @ _local(node)
        left += [(child, matrix) for child in reversed(node.get("children", []))]
        if "mesh" in node:
            yield node["mesh"], matrix


def _roots(nodes: list[Any]) -> list[int]:
    children = {child for node in nodes for child in node.get("children", [])}
    return [number for number in range(len(nodes)) if number not in children]


def _local(node: Any) -> Array:
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), np.float64)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def _transformed(part: Mesh, matrix: Array) -> Mesh:
    if np.array_equal(matrix, np.eye(4)):
        return part
    linear = matrix[:3, :3]
    vertices = part.vertices.astype(np.float64) @ linear.T + matrix[:3, 3]
    faces = part.faces
    if np.linalg.det(linear) < 0 and part.is_triangles:
        faces = faces[:, [0, 2, 1]]  # mirrored, so turned round
    attributes = dict(part.vertex_attributes)
    if "NORMAL" in attributes:
        attributes["NORMAL"] = _normals(attributes["NORMAL"], linear)
    return Mesh(
        vertices.astype(part.vertices.dtype),
        faces,
        attributes,
        part.face_attributes,
        part.metadata,
        elements=part.elements,
    )


def _normals(normals: Array, linear: Array) -> Array:
    """By the cofactors, which are those of the inverse transposed but for their length."""
    cofactors = np.stack([np.cross(linear[i - 2], linear[i - 1]) for i in range(3)])
    turned = normals.astype(np.float64) @ cofactors.T
    length = np.linalg.norm(turned, axis=1, keepdims=True)
    unit: Array = (turned / np.where(length > 0, length, 1)).astype(normals.dtype)
    return unit
