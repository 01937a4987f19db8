"""Any list of triangles is cut into pieces that Edgebreaker can code, and glued again."""

from collections import Counter, defaultdict

import numpy as np
import pytest
from hypothesis import given, settings

from ebz.codec import connectivity
from tests import surgery
from tests.meshes import face_lists, meshes, rngs, simple_surfaces
from tests.topology import topology


def next_corner(corner: int) -> int:
    return corner - corner % 3 + (corner + 1) % 3


def traverse(faces):
    return connectivity.traverse(faces, surgery.n_used(faces))


@settings(max_examples=150, deadline=None)
@given(face_lists())
def test_opposite_half_edges_are_one_edge_seen_from_both_sides(faces):
    surface, _ = traverse(faces)
    opposite, vertex = surface.opposite.tolist(), surface.piece_vertex.tolist()
    for h, across in enumerate(opposite):
        if across >= 0:
            assert opposite[across] == h != across
            assert vertex[h] == vertex[next_corner(across)]
            assert vertex[next_corner(h)] == vertex[across]


@settings(max_examples=150, deadline=None)
@given(face_lists())
def test_pieces_are_simple_oriented_manifolds(faces):
    surface, _ = traverse(faces)
    triangles = surface.piece_vertex.reshape(-1, 3)
    assert all(len(set(triangle)) == 3 for triangle in triangles.tolist())
    ends = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
    n_edges = sum(1 if across < 0 else 0.5 for across in surface.opposite.tolist())
    assert len(np.unique(ends, axis=0)) == n_edges, "no two edges have the same ends"
    assert topology(triangles)[3:] == (0, 0, 0)


@settings(max_examples=100, deadline=None)
@given(face_lists())
def test_every_boundary_of_a_piece_has_at_least_three_edges(faces):
    surface, _ = traverse(faces)
    vertex = surface.piece_vertex.tolist()
    following = {
        vertex[h]: vertex[next_corner(h)] for h in np.flatnonzero(surface.opposite < 0).tolist()
    }
    while following:
        start, end = following.popitem()
        length = 1
        while end != start:
            end = following.pop(end)
            length += 1
        assert length >= 3


@settings(max_examples=100, deadline=None)
@given(face_lists())
def test_glued_pieces_are_the_faces_in_the_order_that_is_said(faces):
    surface, order = traverse(faces)
    n = surgery.n_used(faces)
    assert sorted(order.vertices.tolist()) == list(range(n))
    assert sorted(order.faces.tolist()) == list(range(len(faces)))
    corners = order.corners[:, None] // 3 * 3 + (order.corners[:, None] + np.arange(3)) % 3
    expected = faces.reshape(-1)[corners]
    assert np.array_equal(order.vertices[surface.vertex].reshape(-1, 3), expected)


@settings(max_examples=60, deadline=None)
@given(simple_surfaces())
def test_what_is_simple_already_is_not_cut(faces):
    surface, _ = traverse(faces)
    assert len(surface.vertex_of_piece) == len(np.unique(faces))


@settings(max_examples=80, deadline=None)
@given(meshes(), rngs)
def test_cuts_do_not_depend_on_the_order_of_vertices_and_faces(mesh, rng):
    """Apart from which of several equal faces stands for all, nothing changes but names."""
    other, order = surgery.shuffled(mesh, rng)
    assert shapes(mesh.faces) == shapes(order[other.faces].reshape(-1, 3))


def shapes(faces) -> Counter:
    """How many pieces there are, and with which faces."""
    surface, order = traverse(faces)
    pieces: defaultdict[int, list] = defaultdict(list)
    names = order.vertices[surface.vertex].reshape(-1, 3).tolist()
    for label, (a, b, c) in zip(component_of(surface.opposite), names, strict=True):
        pieces[label].append(min((a, b, c), (b, c, a), (c, a, b)))
    return Counter(tuple(sorted(piece)) for piece in pieces.values())


def component_of(opposite) -> list[int]:
    label = list(range(len(opposite) // 3))

    def root(triangle: int) -> int:
        while label[triangle] != triangle:
            triangle = label[triangle]
        return triangle

    for h, across in enumerate(opposite.tolist()):
        if across >= 0:
            label[root(h // 3)] = root(across // 3)
    return [root(triangle) for triangle in range(len(label))]


BOW_TIE = [(0, 1, 2), (0, 3, 4)]
THREE_PAGES = [(0, 1, 2), (0, 1, 3), (1, 0, 4)]
TWO_PAGES_ONE_WAY = [(0, 1, 2), (0, 1, 3)]
PILLOW = [(0, 1, 2), (0, 2, 1)]
TETRAHEDRON = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]


@pytest.mark.parametrize(
    ("faces", "n_components", "n_copies"),
    [
        (BOW_TIE, 2, 1),
        (THREE_PAGES, 3, 4),
        (TWO_PAGES_ONE_WAY, 2, 2),
        (PILLOW, 1, 0),
        ([(0, 1, 2), (1, 2, 0)], 2, 3),
        ([(0, 0, 1)], 1, 1),
        ([(0, 0, 0)], 1, 2),
        (TETRAHEDRON, 1, 0),
        ([*TETRAHEDRON, (0, 1, 2)], 2, 3),
        # Two tetrahedra sharing an edge, and sharing a vertex, stay two closed surfaces.
        ([*TETRAHEDRON, (0, 1, 4), (0, 4, 5), (0, 5, 1), (1, 5, 4)], 2, 2),
        ([*TETRAHEDRON, (0, 4, 5), (0, 5, 6), (0, 6, 4), (4, 6, 5)], 2, 1),
    ],
)
def test_known_cuts(faces, n_components, n_copies):
    faces = np.array(faces)
    surface, _ = traverse(faces)
    assert len(set(component_of(surface.opposite))) == n_components
    assert len(surface.vertex_of_piece) - len(np.unique(faces)) == n_copies
