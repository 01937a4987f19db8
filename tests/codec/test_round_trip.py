"""Every mesh comes back: vertices and attributes bit for bit, faces with their orientation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec.models.table import table_names
from ebz.codec.sample import random_triangulation, torus
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


def carrying(n_columns: int = 2) -> ebz.Mesh:
    """A torus with a seam in its corner attribute, and elements of every kind."""
    mesh = torus(400)
    corners = mesh.faces.reshape(-1)
    uv = (mesh.vertices[corners, :n_columns] * 1000).round().astype(np.float32) / 1000
    uv[corners % 40 == 0] += (np.arange(len(uv)) % 2)[corners % 40 == 0, None]
    rng = np.random.default_rng(1)
    pairs, path = rng.integers(0, len(mesh.vertices), 20), rng.integers(0, 9, 7)
    elements = {
        "edge": ebz.Element(np.arange(0, 21, 2), pairs, {"w": np.arange(10.0)}, {"q": pairs}),
        "line": ebz.Element(np.array([0, 3, 3, 7]), path),
        "camera": ebz.Element(np.zeros(3, int), attributes={"x": np.eye(2)}),
        "none": ebz.Element(np.zeros(1, int), attributes={"x": np.zeros((0, 2))}),
    }
    return ebz.Mesh(
        mesh.vertices, mesh.faces, corner_attributes={"uv": uv, "": uv > 0}, elements=elements
    )


def test_corner_attributes_and_elements_come_back_in_order():
    mesh = carrying()
    decoded = ebz.decompress(ebz.compress(mesh, keep_order=True))
    assert decoded.corner_attributes.keys() == mesh.corner_attributes.keys()
    for name, values in mesh.corner_attributes.items():
        assert decoded.corner_attributes[name].tobytes() == values.tobytes()
        assert decoded.corner_attributes[name].dtype == values.dtype
    assert list(decoded.elements) == list(mesh.elements)
    for name, element in mesh.elements.items():
        other = decoded.elements[name]
        assert np.array_equal(other.offsets, element.offsets)
        assert np.array_equal(other.corners, element.corners)
        for kind in ("attributes", "corner_attributes"):
            ours, theirs = getattr(other, kind), getattr(element, kind)
            assert {k: v.tolist() for k, v in ours.items()} == {
                k: v.tolist() for k, v in theirs.items()
            }


@pytest.mark.parametrize("level", [1, 6])
def test_corner_attributes_and_elements_follow_vertices_and_faces(level):
    mesh = carrying()
    data, permutation = ebz.compress(mesh, level=level, return_permutation=True)
    decoded = ebz.decompress(data)
    assert ebz.compress(decoded, level=level) == data
    for name, element in mesh.elements.items():
        corners = permutation.vertices[decoded.elements[name].corners]
        assert np.array_equal(corners, element.corners)
    source = {
        (int(vertex), int(face)): uv.tobytes()
        for face, row in enumerate(mesh.faces)
        for vertex, uv in zip(row, mesh.corner_attributes["uv"][3 * face :][:3], strict=True)
    }
    faces = permutation.faces[np.arange(len(decoded.faces))]
    corners = zip(permutation.vertices[decoded.faces].reshape(-1), faces.repeat(3), strict=True)
    got = decoded.corner_attributes["uv"]
    assert {key: uv.tobytes() for key, uv in zip(corners, got, strict=True)} == source


def test_equal_values_at_a_vertex_are_stored_once():
    mesh = torus(2000)
    values = np.random.default_rng(1).random((len(mesh.vertices), 2))
    by_corner = ebz.Mesh(
        mesh.vertices, mesh.faces, corner_attributes={"uv": values[mesh.faces.reshape(-1)]}
    )
    by_vertex = ebz.Mesh(mesh.vertices, mesh.faces, {"uv": values})
    assert len(ebz.compress(by_corner)) == len(ebz.compress(by_vertex))


@settings(max_examples=40, deadline=None)
@given(meshes(), st.booleans())
def test_corner_attributes_stay_with_their_corners(mesh, keep_order):
    corner = {"corner": mesh.faces.reshape(-1).astype(np.int64)}
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, corner_attributes=corner)
    data, permutation = ebz.compress(mesh, keep_order=keep_order, return_permutation=True)
    decoded = ebz.decompress(data)
    vertices = permutation.vertices[decoded.faces.reshape(-1)]
    assert np.array_equal(decoded.corner_attributes["corner"], vertices)
