"""Attributes that follow from where vertices are, on surfaces and in clouds of points."""

import numpy as np
import pytest

import ebz
from ebz.codec.sample import torus

NOTHING = np.zeros((0, 3), np.int32)


def cost(mesh: ebz.Mesh, values: np.ndarray, level: int = 6) -> float:
    """Bits a value; checks that they come back."""
    carrying = ebz.Mesh(mesh.vertices, mesh.faces, {"x": values})
    data = ebz.compress(carrying, level=level)
    assert ebz.verify(data, carrying).equal
    assert ebz.compress(ebz.decompress(data), level=level) == data
    return 8 * (len(data) - len(ebz.compress(mesh, level=level))) / values.size


def test_linear_functions_of_the_place_cost_little():
    mesh = torus(4000, noise=0.01)
    projected = (mesh.vertices[:, :2] * [0.3, -700] + [0.5, 40]).astype(np.float32)
    bent = np.sin(3 * projected).astype(np.float32)
    assert cost(mesh, projected) < cost(mesh, bent) / 3


def test_places_that_are_not_finite_tell_nothing():
    mesh = torus(400)
    vertices = mesh.vertices.copy()
    vertices[::7] = np.nan
    vertices[3::11, 1] = np.inf
    for faces in (mesh.faces, NOTHING):
        values = np.random.default_rng(0).normal(size=(len(vertices), 2))
        cost(ebz.Mesh(vertices, faces), values)


@pytest.mark.parametrize("level", [1, 6, 9])
def test_points_are_told_from_the_nearest_before(level):
    rng = np.random.default_rng(1)
    cloud = ebz.Mesh(rng.random((6000, 3)).astype(np.float32), NOTHING)
    smooth = (900 * np.sin(2 * cloud.vertices).sum(axis=1)).astype(np.int32)
    shuffled = rng.permutation(smooth)
    assert cost(cloud, smooth, level) < cost(cloud, shuffled, level) - (3.5 if level > 1 else 1)
    labels = np.where(cloud.vertices[:, 0] > 0.5, 7, 9)
    assert cost(cloud, labels, level) < 0.4


def test_points_at_one_place_are_told_apart():
    rng = np.random.default_rng(2)
    vertices = rng.integers(0, 4, (500, 3)).astype(np.float32)
    cost(ebz.Mesh(vertices, NOTHING), rng.integers(0, 9, (500, 3)))
