"""The order of vertices, faces and corners comes back, and costs what it is worth."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, connectivity, order
from ebz.codec.errors import CorruptError
from ebz.codec.sample import grid, random_triangulation, sphere, torus
from tests import surgery
from tests.meshes import face_lists, meshes, rngs

STREAMS = {"vertex order", "face order", "rotations"}


def order_bytes(data: bytes) -> int:
    return sum(stream.bytes for stream in ebz.stats(data).streams if stream.name in STREAMS)


def uniform_bytes(mesh: ebz.Mesh) -> float:
    """log2(n!) + log2(m!) + m log2(3) bits."""
    n, m = len(mesh.vertices), len(mesh.faces)
    return (math.lgamma(n + 1) + math.lgamma(m + 1) + m * math.log(3)) / math.log(2) / 8


def assert_identical(a: ebz.Mesh, b: ebz.Mesh) -> None:
    for one, other in [(a.vertices, b.vertices), (a.faces, b.faces)]:
        assert (one.dtype, one.shape, one.tobytes()) == (other.dtype, other.shape, other.tobytes())
    for mine, yours in [
        (a.vertex_attributes, b.vertex_attributes),
        (a.face_attributes, b.face_attributes),
    ]:
        assert {k: (v.dtype, v.shape, v.tobytes()) for k, v in mine.items()} == {
            k: (v.dtype, v.shape, v.tobytes()) for k, v in yours.items()
        }


@settings(max_examples=100, deadline=None)
@given(meshes(distinct=False, with_attributes=True))
def test_arrays_come_back_bit_for_bit(mesh):
    data = ebz.compress(mesh, keep_order=True)
    decoded = ebz.decompress(data)
    assert_identical(mesh, decoded)
    assert ebz.compress(decoded, keep_order=True) == data


@settings(max_examples=40, deadline=None)
@given(meshes(distinct=False, finite=True))
def test_rounded_meshes_keep_their_order_and_are_canonical(mesh):
    data = ebz.compress(mesh, bits=6, keep_order=True)
    decoded = ebz.decompress(data)
    assert np.array_equal(decoded.faces, mesh.faces)
    assert ebz.compress(decoded, bits=6, keep_order=True) == data
    assert ebz.verify(data, mesh).equal


@settings(max_examples=80, deadline=None)
@given(meshes(distinct=False))
def test_no_order_costs_more_than_a_random_one(mesh):
    data = ebz.compress(mesh, keep_order=True)
    assert order_bytes(data) <= 1.01 * uniform_bytes(mesh) + 32


@pytest.mark.parametrize("seed", range(2))
def test_a_random_order_costs_the_uniform_bound(seed):
    rng = np.random.default_rng(seed)
    mesh, _ = surgery.shuffled(random_triangulation(5000, seed), rng)
    data = ebz.compress(mesh, bits=10, keep_order=True)
    assert np.array_equal(ebz.decompress(data).faces, mesh.faces)
    bound = uniform_bytes(mesh)
    assert 0.99 * bound <= order_bytes(data) <= 1.01 * bound + 32


def strips() -> ebz.Mesh:
    """Rows of a rectangle, each as a zigzag."""
    n = 60
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).reshape(-1, 1)
    faces = np.hstack([a, a + 1, a + n, a + n, a + 1, a + n + 1]).reshape(-1, 3)
    y, x = np.mgrid[0:n, 0:n].reshape(2, -1)
    return ebz.Mesh(np.column_stack([x, y, x * y]).astype(np.float32), faces)


@pytest.mark.parametrize("make", [strips, lambda: grid(7200), lambda: torus(7200)])
def test_regular_orders_cost_next_to_nothing(make):
    mesh = make()
    data = ebz.compress(mesh, bits=12, keep_order=True)
    assert order_bytes(data) < 0.02 * uniform_bytes(mesh)


def test_first_use_tells_the_vertices_from_the_faces():
    mesh = random_triangulation(3000)
    faces = mesh.faces[np.random.default_rng(0).permutation(len(mesh.faces))]
    number, _ = _kernels.number_by_first_use(faces.reshape(-1), int(faces.max()) + 1)
    mesh = ebz.Mesh(np.arange(9000.0).reshape(-1, 3), number.reshape(-1, 3))
    streams = {
        stream.name: stream.bytes
        for stream in ebz.stats(ebz.compress(mesh, keep_order=True)).streams
    }
    assert streams["vertex order"] < 50


@settings(max_examples=40, deadline=None)
@given(meshes(distinct=False, with_attributes=True))
def test_the_order_of_a_decoded_mesh_costs_a_few_bytes(mesh):
    decoded = ebz.decompress(ebz.compress(mesh))
    data = ebz.compress(decoded, keep_order=True)
    assert order_bytes(data) <= 3 * 8 + len(mesh.faces) / 4


@settings(max_examples=100, deadline=None)
@given(meshes(distinct=False, with_attributes=True))
def test_the_permutation_leads_from_the_decoded_mesh_to_the_original(mesh):
    data, permutation = ebz.compress(mesh, return_permutation=True)
    decoded = ebz.decompress(data)
    assert data == ebz.compress(mesh)
    assert permutation.vertices.dtype == permutation.faces.dtype == np.int64
    assert sorted(permutation.vertices) == list(range(len(mesh.vertices)))
    assert sorted(permutation.faces) == list(range(len(mesh.faces)))
    assert decoded.vertices.tobytes() == mesh.vertices[permutation.vertices].tobytes()
    for ours, theirs in zip(
        permutation.vertices[decoded.faces], mesh.faces[permutation.faces], strict=True
    ):
        assert any(np.array_equal(np.roll(ours, k), theirs) for k in range(3))
    for name, values in mesh.face_attributes.items():
        assert decoded.face_attributes[name].tobytes() == values[permutation.faces].tobytes()


@settings(max_examples=20, deadline=None)
@given(meshes())
def test_the_permutation_of_a_kept_order_is_the_identity(mesh):
    data, permutation = ebz.compress(mesh, keep_order=True, return_permutation=True)
    assert data == ebz.compress(mesh, keep_order=True)
    assert np.array_equal(permutation.vertices, np.arange(len(mesh.vertices)))
    assert np.array_equal(permutation.faces, np.arange(len(mesh.faces)))


@settings(max_examples=80, deadline=None)
@given(face_lists(), rngs, st.binary(max_size=40), st.sampled_from(list(order.Method)))
def test_any_bytes_give_permutations_or_an_error(faces, rng, noise, method):
    n = int(faces.max(initial=-1)) + 1
    surface, _ = connectivity.traverse(faces, n)
    known = order.Known(surface.opposite, surface.vertex, rng.integers(-(2**63), 2**63 - 1, (n, 3)))
    stream = bytes([method]) + noise
    streams = order.OrderStreams(
        stream, bytes([method % 3]) + noise, bytes([method % 3]) + noise[::-1]
    )
    source = order.decode(streams, known)
    assert sorted(source.vertices) == list(range(n))
    assert sorted(source.faces) == list(range(len(faces)))
    assert source.rotations.max(initial=0) <= 2


@pytest.mark.parametrize("stream", [b"", b"\4", b"\xff\0"])
def test_unknown_methods_are_refused(stream):
    known = order.Known(
        np.full(3, -1, np.int32), np.arange(3, dtype=np.int32), np.zeros((3, 3), int)
    )
    with pytest.raises(CorruptError, match="vertex order: unknown method"):
        order.decode(order.OrderStreams(stream, b"\0", b"\0"), known)


def test_verify_compares_the_order_where_it_is_kept():
    mesh = sphere(80)
    turned = ebz.Mesh(
        mesh.vertices, np.vstack([mesh.faces[:7], np.roll(mesh.faces[7:], 1, axis=1)])
    )
    kept, free = ebz.compress(mesh, keep_order=True), ebz.compress(mesh)
    assert ebz.verify(free, turned).equal
    result = ebz.verify(kept, turned)
    face, other = mesh.faces[7].tolist(), turned.faces[7].tolist()
    assert (result.equal, result.first_difference) == (
        False,
        f"order: face 7 is {face}, not {other}",
    )
    result = ebz.verify(kept, mesh)
    assert (result.equal, result.matched_by) == (True, "order")
    assert "order of vertices and faces" in result.checked


def test_vertices_that_no_face_visits_are_refused() -> None:
    square = np.array([[0, 1, 2], [2, 1, 3]], np.int32)
    surface, _ = connectivity.traverse(square, 4)
    positions = np.zeros(12, np.int64)
    visits = np.array([0], np.int32)
    with pytest.raises(CorruptError, match="no face visits"):
        _kernels.decode_vertex_order(
            bytes(8), surface.opposite, surface.vertex, positions, visits, False
        )
