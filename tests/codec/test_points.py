"""Vertices that no face uses come back as a set, cheaply, with all that belongs to them."""

from math import lgamma, log

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, points
from ebz.codec.errors import CorruptError
from ebz.codec.sample import sphere, torus
from ebz.codec.welding import Arrangement, Split
from tests.connectivity_check import same_under
from tests.meshes import rngs

INT64 = st.integers(-(2**63), 2**63 - 1)
POSITIONS = st.lists(st.tuples(INT64, INT64, INT64), min_size=1, max_size=30)


def morton(offset: np.ndarray) -> int:
    """The bits of three coordinates, interleaved, highest first."""
    digits = zip(*(f"{value:064b}" for value in offset.tolist()), strict=True)
    return int("".join("".join(digit) for digit in digits), 2)


def decode(data: bytes, n: int) -> np.ndarray:
    return _kernels.decode_points(data, n).reshape(-1, 3)


@settings(max_examples=200, deadline=None)
@given(POSITIONS, st.integers(1, 3))
@example([(-(2**63), 0, 2**63 - 1), (2**63 - 1, 0, -(2**63))], 1)
@example([(5, 5, 5)], 3)
def test_any_integers_come_back_in_the_order_of_their_bits(rows, n_times):
    values = np.array(rows * n_times, np.int64)
    data, order = _kernels.encode_points(values.reshape(-1))
    assert np.array_equal(decode(data, len(values)), values[order])
    offsets = (values.astype(np.uint64) - values.min(axis=0).astype(np.uint64))[order]
    keys = [(morton(offset), row) for offset, row in zip(offsets, order.tolist(), strict=True)]
    assert keys == sorted(keys)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=60), st.integers(1, 500))
def test_any_bytes_decode_to_as_many_points_or_are_corrupt(data, n):
    try:
        assert len(decode(data, n)) == n
    except CorruptError as error:
        assert "points than there are" in error.message or "levels" in error.message


@settings(max_examples=100, deadline=None)
@given(rngs, st.sampled_from([{}, {"bits": 9}, {"max_error": 0.01}, {"grid": (0, 0.25)}]))
def test_clouds_come_back_with_their_attributes(rng, options):
    n = int(rng.integers(1, 60))
    vertices = np.round(rng.normal(size=(n, 3)), 2)[rng.integers(0, n, n)]
    if not options:
        vertices[rng.integers(0, n, 3), 0] = [np.nan, -0.0, np.inf]
    cloud = ebz.Mesh(vertices, [], {"id": np.arange(n), "uv": rng.random((n, 2))})
    data, permutation = ebz.compress(cloud, return_permutation=True, **options)
    decoded = ebz.decompress(data)
    assert ebz.compress(decoded, **options) == data
    assert ebz.verify(data, cloud).equal
    assert np.array_equal(decoded.vertex_attributes["id"], permutation.vertices)
    source = cloud.vertices[permutation.vertices]
    assert np.allclose(decoded.vertices, source, atol=0.13 if options else 0, equal_nan=True)
    assert options or same_under(cloud, decoded, permutation.vertices)


def test_order_is_kept_on_request():
    rng = np.random.default_rng(1)
    cloud = ebz.Mesh(rng.normal(size=(300, 3)), [], {"id": np.arange(300)})
    decoded = ebz.decompress(ebz.compress(cloud, keep_order=True))
    assert np.array_equal(decoded.vertices, cloud.vertices)
    assert np.array_equal(decoded.vertex_attributes["id"], np.arange(300))


def beside_a_surface() -> ebz.Mesh:
    surface, cloud = sphere(2000), torus(2000)
    vertices = np.concatenate([cloud.vertices[:500], surface.vertices, cloud.vertices[500:]])
    return ebz.Mesh(vertices, surface.faces + 500, {"id": np.arange(len(vertices))})


@pytest.mark.parametrize("level", [1, 3, 6, 9])
@pytest.mark.parametrize("options", [{}, {"bits": 12}, {"keep_order": True}], ids=str)
def test_vertices_beside_a_surface_come_back(level, options):
    mesh = beside_a_surface()
    data = ebz.compress(mesh, level=level, **options)
    decoded = ebz.decompress(data)
    assert ebz.compress(decoded, level=level, **options) == data
    assert ebz.verify(data, mesh).equal
    assert sorted(decoded.vertex_attributes["id"].tolist()) == list(range(len(mesh.vertices)))


def log2_of_sets(n_places: int, n: int) -> float:
    return (lgamma(n_places + 1) - lgamma(n + 1) - lgamma(n_places - n + 1)) / log(2)


@pytest.mark.parametrize("bits", [6, 10, 14])
def test_points_at_random_cost_little_more_than_their_set(bits):
    n = 6000
    places = np.random.default_rng(bits).choice(8**bits, n, replace=False)
    values = np.stack([places >> shift & 2**bits - 1 for shift in (0, bits, 2 * bits)], axis=1)
    data, _ = _kernels.encode_points(values.astype(np.int64).reshape(-1))
    assert 8 * len(data) < 1.03 * log2_of_sets(8**bits, n) + 2000


def test_points_on_a_surface_cost_less_than_at_random():
    cloud = ebz.Mesh(sphere(40_000).vertices, [])
    stats = ebz.stats(ebz.compress(cloud, bits=11))
    n = stats.vertices
    assert stats.geometry_bits_per_vertex < 0.75 * log2_of_sets(8**11, n) / n


def test_repeated_coordinates_cost_next_to_nothing():
    axis = np.arange(40) * 37 % 1009
    values = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1).astype(np.int64)
    data, _ = _kernels.encode_points(values)
    assert 8 * len(data) < 40**3


def test_other_numbers_of_points_are_corrupt():
    data, _ = _kernels.encode_points(np.arange(300))
    with pytest.raises(CorruptError, match="more points than there are"):
        decode(data, 99)
    with pytest.raises(CorruptError, match="fewer points than there are"):
        decode(data, 101)
    with pytest.raises(CorruptError, match="every vertex is in a face"):
        points.decode(data, 0)


def test_where_every_vertex_is_used_there_is_no_stream():
    vertices = np.arange(3)
    whole = Split(vertices.astype(np.int32), 3, np.zeros(0, np.int32), 0)
    arrangement = Arrangement(whole, vertices, vertices, None)
    assert points.encode(arrangement, np.zeros((3, 3), np.int64)) == (arrangement, None)
