"""The smooth shapes have the size, the surface and the smoothness that they promise."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.sample import circle, grid, icosahedron, sphere, subdivide, torus, uniform
from tests.topology import topology

SHAPES = {sphere: (1, 2, 0, 0, 0, 0), torus: (1, 0, 0, 0, 0, 0), grid: (1, 1, 1, 0, 0, 0)}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("n_triangles", [1, 50, 1000, 3000])
def test_shapes_are_the_surfaces_they_are_called(shape, n_triangles):
    mesh = shape(n_triangles)
    assert topology(mesh.faces) == SHAPES[shape]
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
    assert len(np.unique(mesh.faces)) == len(mesh.vertices)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_million_triangles_are_about_a_million(shape):
    mesh = shape(10**6)
    assert len(mesh.faces) == pytest.approx(10**6, rel=0.01)
    corners = mesh.vertices[mesh.faces]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert 0 < edges.min() < edges.max() < 0.02


@pytest.mark.parametrize(("shape", "volume"), [(sphere, 4 / 3 * pi), (torus, 2 * pi**2 * 0.4**2)])
def test_faces_are_counter_clockwise_from_outside(shape, volume):
    mesh = shape(100_000)
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(np.float64) for i in range(3))
    assert np.sum(np.cross(a, b) * c) / 6 == pytest.approx(volume, rel=0.001)


def test_terrain_faces_look_up():
    mesh = grid(1000)
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


@pytest.mark.parametrize("shape", SHAPES)
def test_noise_moves_coordinates_by_at_most_its_size(shape):
    moved = shape(2000, noise=0.125, seed=3).vertices - shape(2000).vertices.astype(np.float64)
    assert 0.12 < np.abs(moved).max() <= 0.125 + 1e-6
    assert not np.array_equal(shape(2000, 0.125, 3).vertices, shape(2000, 0.125, 4).vertices)


def test_subdivision_keeps_corners_and_shares_edges():
    corners, faces = icosahedron()
    vertices, small = subdivide(corners, faces, 5)
    assert len(small) == 25 * len(faces)
    assert np.array_equal(vertices[: len(corners)], corners)
    assert topology(small) == (1, 2, 0, 0, 0, 0)


@given(st.floats(-8, 8))
def test_circle_is_cosine_and_sine(turns):
    x, y = circle(np.array([turns]))
    part = turns % 1.0
    assert x[0] == pytest.approx(cos(2 * pi * part), abs=4e-15)
    assert y[0] == pytest.approx(sin(2 * pi * part), abs=4e-15)


def test_circle_is_exact_at_quarter_turns():
    x, y = circle(np.arange(-4, 5) / 4)
    assert x.tolist() == [1, 0, -1, 0, 1, 0, -1, 0, 1]
    assert y.tolist() == [0, 1, 0, -1, 0, 1, 0, -1, 0]
    assert not np.signbit(x[x == 0]).any()


def test_uniform_numbers_are_the_same_for_ever():
    assert [float.hex(x) for x in uniform(1, (2,))] == [
        "0x1.060d7be6f245cp-1",
        "0x1.e6a32d7782a55p-1",
    ]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"n_triangles": 0}, "0 triangles"),
        ({"n_triangles": 9, "noise": -1.0}, "noise -1.0"),
        ({"n_triangles": 9, "noise": float("nan")}, "noise nan"),
        ({"n_triangles": 9, "noise": 1.0, "seed": -1}, "seed -1"),
    ],
)
def test_impossible_arguments_are_refused(shape, arguments, message):
    with pytest.raises(OptionError, match=message):
        shape(**arguments)
