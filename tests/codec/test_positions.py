"""Positions along any surface, whatever their values: every method for integers, and any bytes."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, pipeline, positions
from ebz.codec.connectivity import traverse
from ebz.codec.positions import Coding, Method
from ebz.codec.sample import glued_grid
from ebz.codec.surface import Surface
from tests.connectivity_check import same_mesh
from tests.meshes import face_lists, rngs
from tests.oracles import light, medium
from tests.surgery import Faces

INTEGER_METHODS = (Method.FAST, Method.MEDIUM, Method.LIGHT, Method.STRONG)
# Those of 32 bits, and the widest values that each of them codes.
WIDEST = {
    Method.FAST: 2**31 - 1,
    Method.MEDIUM: 2**31 - 1,
    Method.LIGHT: 2**40,
    Method.STRONG: 2**40,
}

TWINS = {Method.MEDIUM: medium, Method.LIGHT: light}

Values = npt.NDArray[np.int64]
Points = npt.NDArray[np.int64]


@st.composite
def surfaces(draw: st.DrawFn) -> tuple[Surface, int]:
    """Along any faces, and the number of vertices, some of them in no face."""
    faces = draw(face_lists())
    n_vertices = int(faces.max(initial=-1)) + 1 + draw(st.integers(0, 3))
    return traverse(faces, n_vertices)[0], n_vertices


@st.composite
def values(draw: st.DrawFn, n: int, widest: int) -> Values:
    """(3 n,) near each other, repeated, or as far apart as can be."""
    rng = draw(rngs)
    spread = draw(st.sampled_from([1, 2, 40, 3000, 10**6, widest]))
    found = rng.integers(-spread, spread + 1, 3 * n)
    if draw(st.booleans()):
        found[rng.random(3 * n) < 0.3] = draw(st.sampled_from([-widest, 0, widest]))
    return found


def encode(surface: Surface, n: int, coordinates: Values, method: Method) -> bytes:
    return _kernels.encode_positions(surface.opposite, surface.vertex, n, coordinates, method)


def decode(data: bytes, surface: Surface, n: int, method: Method) -> Values:
    coded = positions.Coded(data, Coding(method))
    return positions.decode(coded, surface, n).reshape(-1)


@settings(deadline=None)
@given(surfaces(), st.sampled_from(INTEGER_METHODS), st.data())
def test_any_integers_come_back_along_any_surface(along, method, data):
    surface, n = along
    coordinates = data.draw(values(n, WIDEST[method]))
    stream = encode(surface, n, coordinates, method)
    assert np.array_equal(decode(stream, surface, n, method), coordinates)


@settings(deadline=None)
@given(surfaces(), st.sampled_from(INTEGER_METHODS), st.data())
def test_both_instruction_sets_write_the_same(along, method, data):
    surface, n = along
    coordinates = data.draw(values(n, WIDEST[method]))
    stream = encode(surface, n, coordinates, method)
    _kernels.forbid_extensions(True)
    try:
        assert encode(surface, n, coordinates, method) == stream
        assert np.array_equal(decode(stream, surface, n, method), coordinates)
    finally:
        _kernels.forbid_extensions(False)


@settings(deadline=None)
@given(surfaces(), st.sampled_from(INTEGER_METHODS), st.binary(max_size=200))
def test_any_bytes_decode_to_the_same_on_both_instruction_sets(along, method, data):
    surface, n = along
    coordinates = decode(data, surface, n, method)
    assert len(coordinates) == 3 * n
    _kernels.forbid_extensions(True)
    try:
        assert np.array_equal(decode(data, surface, n, method), coordinates)
    finally:
        _kernels.forbid_extensions(False)


def read_by_twin(stream: bytes, surface: Surface, n: int, method: Method) -> Values:
    corners = surface.opposite.tolist(), surface.vertex.tolist()
    return np.array(TWINS[method].Decoder(stream, *corners, n).decode(), np.int64).reshape(-1)


@settings(deadline=None)
@given(surfaces(), st.sampled_from(list(TWINS)), st.data())
def test_a_twin_reads_the_same(along, method, data):
    surface, n = along
    written = values(n, WIDEST[method]).map(
        lambda coordinates: encode(surface, n, coordinates, method)
    )
    stream = data.draw(written | st.binary(max_size=200))
    read = decode(stream, surface, n, method)
    assert np.array_equal(read_by_twin(stream, surface, n, method), read)


def waves(height: int) -> tuple[Faces, Points]:
    row, column, faces = glued_grid(20, 25, "open", "join")
    heights = (height * np.sin(row / 5) * np.cos(column / 4)).round().astype(np.int64)
    return faces, np.stack([40 * row, 40 * column, heights], axis=1)


def noise(widest: int) -> tuple[Faces, Points]:
    faces, points = waves(0)
    return faces, np.random.default_rng(3).integers(-widest, widest, points.shape)


def halves(step: int) -> tuple[Faces, Points]:
    """Mirrored, with some of the heights multiples of 50."""
    row, column, faces = glued_grid(20, 30, "open", "join")
    rng = np.random.default_rng(5)
    heights = rng.integers(-step, step, (21, 16))
    heights = np.where(rng.random(heights.shape) < 0.5, heights, heights // 50 * 50)
    inward = np.minimum(column, 30 - column)
    z = heights[row, inward]
    x = np.where(column > 15, -1, 1) * (50 * inward + z // 3)
    return faces, np.stack([x, 37 * row, z], axis=1)


def parts(offset: int) -> tuple[Faces, Points]:
    """The same one at many places, each third one mirrored."""
    row, column, faces = glued_grid(4, 5, "open", "open")
    rng = np.random.default_rng(7)
    part = np.stack([40 * row, 40 * column, 0 * row], axis=1) + rng.integers(-30, 30, (30, 3))
    turned = np.where(np.arange(20)[:, None] % 3 == 1, [[1, -1, 1]], [[1, 1, 1]])
    places = rng.integers(-2000, 2000, (20, 1, 3)) * [1, 1, 0] + offset
    all_faces = faces + 30 * np.arange(20)[:, None, None]
    return all_faces.reshape(-1, 3), (part * turned[:, None] + places).reshape(-1, 3)


LONG = [waves(30), waves(3000), noise(5000), halves(5), halves(600), halves(20000), parts(0)]
WIDE = [noise(2**39), parts(2**39)]


@pytest.mark.parametrize(
    ("method", "faces", "points"),
    [(method, *mesh) for method in TWINS for mesh in LONG]
    + [(Method.LIGHT, *mesh) for mesh in WIDE],
)
def test_a_twin_reads_a_long_stream(method, faces, points):
    surface, order = traverse(faces, len(points))
    coordinates = points[order.vertices].reshape(-1)
    stream = encode(surface, len(points), coordinates, method)
    assert np.array_equal(read_by_twin(stream, surface, len(points), method), coordinates)


@pytest.mark.parametrize("method", [Method.FAST, Method.MEDIUM])
@pytest.mark.parametrize("value", [2**31, -(2**31) - 1])
def test_methods_of_32_bits_give_nothing_for_wider_values(method, value):
    surface, _ = traverse(np.array([[0, 1, 2]]), 3)
    coordinates = np.zeros(9, np.int64)
    coordinates[4] = value
    assert encode(surface, 3, coordinates, method) == b""


@pytest.mark.parametrize("level", [1, 3, 6, 9])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_floats_that_come_again_are_listed(dtype, level):
    sizes = np.random.default_rng(0).normal(size=20)
    faces = glued_grid(16, 16, "open", "open")[2]
    chosen = np.random.default_rng(1).choice(20**3, int(faces.max()) + 1, replace=False)
    places = np.stack(np.unravel_index(chosen, (20, 20, 20)), axis=1)
    mesh = ebz.Mesh(np.unique(sizes)[places].astype(dtype), faces)
    encoded, _ = pipeline.encode(mesh, level=level)
    assert encoded.coding.is_listed
    assert encoded.streams.listing.n == 20
    # A list costs less than its floats, a place in it little more than it says, if learnt.
    assert encoded.streams.listing.size < 20 * mesh.vertices.itemsize
    overhead = 1.5 if level == 1 else 1.15
    assert len(encoded.streams.positions) <= overhead * places.size * np.log2(20) / 8 + 40
    assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh, level=level)))


def test_coordinates_that_fill_their_range_are_not_listed():
    mesh = ebz.Mesh(np.random.default_rng(0).integers(0, 50, (400, 3)).astype(float), [])
    assert not pipeline.encode(mesh, keep_order=True)[0].coding.is_listed
