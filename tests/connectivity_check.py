"""What it means that a mesh came back: an oracle that shares no code with the codec."""

from collections import Counter
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.mesh import Mesh

Attributes = dict[str, npt.NDArray[Any]]


def same_mesh(a: Mesh, b: Mesh) -> bool:
    """Whether the meshes are equal up to order of vertices, order of faces and rotation of faces.

    Coordinates and attributes are compared bit by bit.  Raises ValueError where faces of `a` use
    two vertices with equal coordinates and attributes, so that only `same_under` can tell.
    """
    keys_a, keys_b = _vertex_keys(a), _vertex_keys(b)
    if _layout(a) != _layout(b) or Counter(keys_a) != Counter(keys_b):
        return False
    if not _distinct_where_used(a, keys_a):
        raise ValueError("vertices cannot be told apart by their coordinates and attributes")
    return _distinct_where_used(b, keys_b) and _faces(a, keys_a) == _faces(b, keys_b)


def same_under(a: Mesh, b: Mesh, order: Sequence[int] | npt.NDArray[np.integer[Any]]) -> bool:
    """Whether the meshes are equal if vertex i of `b` is vertex order[i] of `a`.

    Faces may still come in any order and rotation.
    """
    vertices = [int(vertex) for vertex in order]
    if _layout(a) != _layout(b) or sorted(vertices) != list(range(len(a.vertices))):
        return False
    keys_a, keys_b = _vertex_keys(a), _vertex_keys(b)
    if keys_b != [keys_a[vertex] for vertex in vertices]:
        return False
    return _faces(a, range(len(vertices))) == _faces(b, vertices)


def _layout(mesh: Mesh) -> tuple[Any, ...]:
    attributes = [
        {name: (values.dtype, values.shape[1:]) for name, values in owner.items()}
        for owner in (mesh.vertex_attributes, mesh.face_attributes)
    ]
    return mesh.vertices.dtype, mesh.vertices.shape, mesh.faces.shape, attributes


def _vertex_keys(mesh: Mesh) -> list[Hashable]:
    attributes = _rows(mesh.vertex_attributes) or [()] * len(mesh.vertices)
    return list(zip(_rows({"": mesh.vertices}), attributes, strict=True))


def _rows(attributes: Attributes) -> list[Hashable]:
    columns = [[row.tobytes() for row in attributes[name]] for name in sorted(attributes)]
    return list(zip(*columns, strict=True))


def _distinct_where_used(mesh: Mesh, keys: Sequence[Hashable]) -> bool:
    used = {int(vertex) for vertex in mesh.faces.ravel()}
    return len({keys[vertex] for vertex in used}) == len(used)


def _faces(mesh: Mesh, names: Sequence[Any]) -> Counter[Hashable]:
    attributes = _rows(mesh.face_attributes) or [()] * len(mesh.faces)
    corners = [tuple(names[vertex] for vertex in face) for face in mesh.faces.tolist()]
    rotated = [min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in corners]
    return Counter(zip(rotated, attributes, strict=True))
