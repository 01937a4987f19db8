"""Every mesh comes back: vertices and attributes bit for bit, faces with their orientation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec.models.table import table_names
from ebz.codec.sample import random_triangulation
from tests import surgery
from tests.connectivity_check import same_mesh, same_under
from tests.meshes import attributes, meshes, rngs

levels = st.integers(1, 9)
options = st.fixed_dictionaries(
    {"level": levels},
    optional={
        "model": st.none() | st.sampled_from(table_names()),
        "embed_model": st.booleans(),
        "keep_order": st.booleans(),
    },
).flatmap(
    lambda chosen: st.sampled_from([{}, {"bits": 3}, {"bits": 12}, {"max_error": 0.01}]).map(
        lambda lossy: chosen | lossy
    )
)


@settings(max_examples=150, deadline=None)
@given(meshes(with_attributes=True), levels)
def test_meshes_come_back_at_every_level(mesh, level):
    assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh, level=level)))


@settings(max_examples=100, deadline=None)
@given(meshes(distinct=False))
def test_meshes_come_back_in_the_order_that_is_said(mesh):
    data, permutation = ebz.compress(mesh, return_permutation=True)
    assert same_under(mesh, ebz.decompress(data), permutation.vertices)


@settings(max_examples=60, deadline=None)
@given(meshes(), st.integers(1, 4), rngs)
def test_vertices_at_equal_positions_come_back_apart(mesh, n_places, rng):
    vertices = rng.integers(0, n_places, mesh.vertices.shape).astype(np.float32)
    numbers = {"number": np.arange(len(vertices), dtype=np.int32)}
    mesh = ebz.Mesh(vertices, mesh.faces, numbers)
    data = ebz.compress(mesh)
    decoded = ebz.decompress(data)
    assert same_mesh(mesh, decoded)
    assert ebz.compress(decoded) == data


@settings(max_examples=60, deadline=None)
@given(meshes(), rngs)
def test_the_order_of_vertices_and_faces_does_not_matter(mesh, rng):
    other, _ = surgery.shuffled(mesh, rng)
    assert same_mesh(mesh, ebz.decompress(ebz.compress(other)))


@settings(max_examples=100, deadline=None)
@given(meshes(with_attributes=True, finite=True), options)
def test_compressing_what_was_decompressed_gives_the_same_bytes(mesh, options):
    data = ebz.compress(mesh, **options)
    assert ebz.compress(ebz.decompress(data), **options) == data


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("n_vertices", [0, 1, 7])
def test_meshes_without_faces_come_back(n_vertices, dtype):
    mesh = ebz.Mesh(np.arange(3.0 * n_vertices).reshape(-1, 3).astype(dtype), np.zeros((0, 3), int))
    decoded = ebz.decompress(ebz.compress(mesh))
    assert decoded.vertices.dtype == dtype
    assert decoded.faces.dtype == np.int32
    assert np.array_equal(decoded.vertices, mesh.vertices)
    assert decoded.faces.shape == (0, 3)


def test_few_faces_among_very_many_vertices_come_back():
    vertices = np.arange(3e5).reshape(-1, 3)
    mesh = ebz.Mesh(vertices, [[99_999, 5, 70_000], [5, 99_999, 1234]])
    assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh)))


@pytest.mark.parametrize("level", [1, 3, 6, 9])
def test_a_large_random_triangulation_comes_back(level):
    mesh = random_triangulation(10_000, seed=level)
    assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh, level=level)))


NUMBERS = ["?", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8", ">f4", ">i2"]
SHAPES = [(), (1,), (3,), (2, 2), (0,), (2, 0, 3)]


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("dtype", NUMBERS)
def test_attributes_of_all_dtypes_and_shapes_come_back(dtype, shape):
    def values(n: int) -> np.ndarray:
        words = np.random.default_rng(n).integers(0, 256, (n, *shape)).astype(np.uint8)
        return words.astype(dtype)

    mesh = ebz.Mesh(
        np.arange(15.0).reshape(-1, 3),
        [[0, 1, 2], [2, 1, 3]],
        {"a": values(5), "": values(5)[::-1]},
        {"a": values(2)},
    )
    decoded = ebz.decompress(ebz.compress(mesh))
    assert same_mesh(mesh, decoded)
    assert list(decoded.vertex_attributes) == ["a", ""]
    assert decoded.vertex_attributes["a"].dtype == np.dtype(dtype).newbyteorder("=")
    assert decoded.face_attributes["a"].shape == (2, *shape)


@settings(max_examples=40, deadline=None)
@given(st.data(), meshes())
def test_values_per_corner_stay_with_their_corners(data, mesh):
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, {}, {"corner": mesh.faces.astype(np.int64)})
    extra = data.draw(attributes(len(mesh.faces)))
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, {}, mesh.face_attributes | extra)
    data, permutation = ebz.compress(mesh, return_permutation=True)
    decoded = ebz.decompress(data)
    assert np.array_equal(decoded.face_attributes["corner"], permutation.vertices[decoded.faces])


def test_attribute_names_may_hold_anything():
    names = ["", "é", "a\0b", "\ud800", "$bytes", "x" * 300]
    attributes = {name: np.arange(3) + i for i, name in enumerate(names)}
    mesh = ebz.Mesh(np.eye(3), [[0, 1, 2]], attributes)
    decoded = ebz.decompress(ebz.compress(mesh))
    assert list(decoded.vertex_attributes) == names
    assert same_mesh(mesh, decoded)


def test_big_endian_coordinates_keep_their_precision():
    mesh = ebz.Mesh(np.eye(3, dtype=">f4"), [[0, 1, 2]])
    assert ebz.decompress(ebz.compress(mesh)).vertices.dtype == np.float32


def test_faces_that_no_longer_fit_are_refused():
    mesh = ebz.Mesh(np.eye(3), [[0, 1, 2]])
    mesh.faces[0, 1] = 1_000_000
    with pytest.raises(ebz.MeshError, match="face 0: vertex 1000000 is out of range"):
        ebz.compress(mesh)
