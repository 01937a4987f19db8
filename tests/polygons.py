"""Meshes of polygons: strategies, and what makes two of them the same."""

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import note
from hypothesis import strategies as st

from ebz.codec.mesh import Mesh
from tests import meshes
from tests.surgery import Rng

Polygon = tuple[int, ...]


def mesh_of(faces: list[Polygon], vertices: npt.NDArray[Any], **carried: Any) -> Mesh:
    """A mesh of any faces."""
    offsets = np.cumsum([0, *(len(face) for face in faces)])
    corners = np.array([v for face in faces for v in face], np.int64)
    return Mesh(vertices, corners, face_offsets=offsets, **carried)


def faces_of(mesh: Mesh) -> list[Polygon]:
    """The corners of each face."""
    ends = mesh.offsets.tolist()
    return [tuple(mesh.corners[a:b].tolist()) for a, b in pairwise(ends)]


def least_turn(face: tuple[Any, ...]) -> tuple[Any, ...]:
    """The same for all rotations of a face."""
    return min([face[i:] + face[:i] for i in range(len(face))] or [face])


def cycles(mesh: Mesh) -> Counter[tuple[bytes, ...]]:
    """The faces by the exact positions of their corners, whatever the order."""
    at = [vertex.tobytes() for vertex in mesh.vertices]
    return Counter(least_turn(tuple(at[v] for v in face)) for face in faces_of(mesh))


def quad_grid(n_rows: int, n_columns: int) -> Mesh:
    """A hilly terrain of quads."""
    number = np.arange((n_rows + 1) * (n_columns + 1)).reshape(n_rows + 1, n_columns + 1)
    corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    y, x = np.divmod(number.reshape(-1), n_columns + 1)
    vertices = np.stack([x, y, np.round(np.sin(x / 9.0) * np.cos(y / 7.0), 3)], axis=1)
    return Mesh(vertices.astype(np.float32), np.stack(corners, axis=-1).reshape(-1, 4))


def merged(faces: npt.NDArray[Any], n_merges: int, rng: Rng) -> list[Polygon]:
    """Triangles of which some were joined, across an edge each, to polygons of distinct corners."""
    polygons: list[Polygon] = [tuple(face) for face in faces.tolist()]
    for _ in range(n_merges):
        edges = {
            (face[i - 1], face[i]): at for at, face in enumerate(polygons) for i in range(len(face))
        }
        inner = [edge for edge in edges if edge[::-1] in edges]
        if not inner:
            break
        a, b = inner[rng.integers(len(inner))]
        left, right = edges[a, b], edges[b, a]
        one, two = _turned(polygons[left], b), _turned(polygons[right], a)
        joined = one + two[1:-1]
        if left == right or len(set(joined)) < len(joined):
            continue
        polygons[left] = joined
        del polygons[right]
    return polygons


def _turned(face: Polygon, first: int) -> Polygon:
    at = face.index(first)
    return face[at:] + face[:at]


@st.composite
def soups(draw: st.DrawFn) -> list[Polygon]:
    """Any faces over few vertices: mostly non-manifold, many degenerate, some without corners."""
    vertex = st.integers(0, 7)
    any_face = st.lists(vertex, max_size=6).map(tuple)
    proper = st.lists(vertex, min_size=3, max_size=7, unique=True).map(tuple)
    return draw(st.lists(any_face | proper, max_size=12))


@st.composite
def polygon_lists(draw: st.DrawFn) -> list[Polygon]:
    """Soups, and surfaces of mixed polygons with holes, handles and seams."""
    if draw(st.booleans()):
        return draw(soups())
    triangles = draw(meshes.simple_surfaces() | meshes.grids() | meshes.damaged())
    faces = merged(triangles, draw(st.integers(0, 60)), draw(meshes.rngs))
    return faces + draw(st.just([]) | soups().map(lambda rows: rows[:2]))


@st.composite
def polygon_meshes(
    draw: st.DrawFn, *, distinct: bool = True, with_attributes: bool = False
) -> Mesh:
    """Meshes of polygons, shuffled, some with isolated vertices."""
    faces, rng = draw(polygon_lists()), draw(meshes.rngs)
    faces = [faces[i] for i in rng.permutation(len(faces))]
    n_vertices = max((v + 1 for face in faces for v in face), default=0) + draw(st.integers(0, 2))
    vertices = draw(meshes.coordinates(n_vertices, distinct=distinct))
    n_corners = sum(map(len, faces))
    names = ("vertex_attributes", "face_attributes", "corner_attributes")
    sizes = (n_vertices, len(faces), n_corners)
    carried = {
        name: draw(meshes.attributes(n)) if with_attributes else {}
        for name, n in zip(names, sizes, strict=True)
    }
    note(f"faces = {faces}\nvertices = {vertices!r}")
    return mesh_of(faces, vertices, **carried)
