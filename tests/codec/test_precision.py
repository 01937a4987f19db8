"""What --bits and --max-error promise holds for every coordinate, and compression is canonical."""

import math
import warnings
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, note, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import fitting
from ebz.codec.fitting import Precision
from ebz.codec.lattice import BoxLattice, StepLattice
from tests.connectivity_check import same_mesh
from tests.meshes import meshes, rngs

MAGNITUDES = [1e-310, 1e-45, 1e-30, 1e-6, 1.0, 1234.5, 1e7, 1e30]


@st.composite
def scaled_meshes(draw: st.DrawFn) -> ebz.Mesh:
    """Finite meshes of any size, far from the origin or not, some flat or with equal vertices."""
    mesh = draw(meshes(finite=True, distinct=draw(st.booleans())))
    scale = draw(st.sampled_from(MAGNITUDES))
    offset = np.array([draw(st.sampled_from([0, 0, 1, -1000, 1e6, 1e9])) for _ in range(3)])
    squeeze = np.array([draw(st.sampled_from([1, 1, 0, 1e-9])) for _ in range(3)])
    with np.errstate(all="ignore"):
        moved = (mesh.vertices * squeeze + offset) * scale
        vertices = np.nan_to_num(moved.astype(mesh.vertices.dtype))
    note(f"vertices = {vertices!r}")
    return ebz.Mesh(vertices, mesh.faces)


def compress(mesh: ebz.Mesh, **options: Any) -> tuple[bytes, np.ndarray, np.ndarray]:
    """The file, and coordinates as decoded and as they were, in the same order."""
    data, permutation = ebz.compress(mesh, return_permutation=True, **options)
    return data, ebz.decompress(data).vertices, mesh.vertices[permutation.vertices]


def largest_error(got: np.ndarray, source: np.ndarray) -> Fraction:
    """Exactly, in rational numbers."""
    pairs = zip(got.ravel().tolist(), source.ravel().tolist(), strict=True)
    return max((abs(Fraction(a) - Fraction(b)) for a, b in pairs), default=Fraction(0))


@settings(max_examples=120, deadline=None)
@given(scaled_meshes(), st.floats(-20, 6).map(lambda x: 10.0**x))
@example(ebz.Mesh(np.array([[3e38, -3e38, 1]], np.float32), []), 1.9e38)
@example(ebz.Mesh(np.array([[1e308, -1.7e308, 1.0]]), []), 1e308)
@example(ebz.Mesh(np.array([[1.0, 2.0, 3.0]]), []), 1e308)
@example(ebz.Mesh(np.array([[1.0, 2.0, 3.0]]), []), 1.7e308)
@example(ebz.Mesh(np.array([[1.0, 2.0, 3.0]]), []), 5e-324)
def test_no_coordinate_moves_by_more_than_max_error(mesh, share):
    max_error = share * float(np.abs(mesh.vertices).max(initial=0)) or share
    max_error = share if not math.isfinite(max_error) else max_error
    data, got, source = compress(mesh, max_error=max_error)
    assert largest_error(got, source) <= Fraction(max_error)
    assert ebz.compress(ebz.decompress(data), max_error=max_error) == data


def rounding(mesh: ebz.Mesh, side: Fraction) -> Fraction:
    """Half the spacing of the floats at the largest coordinate, and a few roundings of doubles."""
    limits = np.finfo(mesh.vertices.dtype)
    largest = Fraction(float(np.abs(mesh.vertices).max(initial=0))) + side
    shares = Fraction(float(limits.eps)) / 2 + 4 * Fraction(2) ** -52
    return shares * largest + Fraction(float(limits.smallest_subnormal))


@settings(max_examples=150, deadline=None)
@given(scaled_meshes(), st.integers(1, 30))
@example(ebz.Mesh(np.array([[1.7e308, -1.7e308, 0]]), []), 7)
@example(ebz.Mesh(np.array([[3e38, -3.4e38, 0], [1, 2, 3]], np.float32), []), 7)
def test_bits_move_no_coordinate_by_more_than_half_a_step(mesh, bits):
    data, got, source = compress(mesh, bits=bits)
    columns = [[Fraction(x) for x in axis] for axis in mesh.vertices.T.tolist()]
    side = max(max(axis, default=Fraction(0)) - min(axis, default=Fraction(0)) for axis in columns)
    assert largest_error(got, source) <= side / (2**bits - 1) / 2 + rounding(mesh, side)
    assert ebz.compress(ebz.decompress(data), bits=bits) == data


@settings(max_examples=100, deadline=None)
@given(meshes(finite=True), st.sampled_from([None, *range(1, 31)]))
def test_compression_is_canonical_at_any_number_of_bits(mesh, bits):
    data = ebz.compress(mesh, bits=bits)
    assert ebz.compress(ebz.decompress(data), bits=bits) == data


@settings(max_examples=60, deadline=None)
@given(st.data(), st.integers(1, 12), rngs)
def test_compression_is_canonical_at_the_resolution_of_the_floats(data, n, rng):
    dtype = data.draw(st.sampled_from([np.float32, np.float64]))
    start = np.array(data.draw(st.sampled_from([0, 1, -3, 1e6, 1e-30, 1e-44])), dtype)
    vertices = start + np.spacing(abs(start)) * rng.integers(-40, 40, (n, 3)).astype(dtype)
    mesh = ebz.Mesh(vertices.astype(dtype), [])
    options = data.draw(
        st.builds(lambda bits: {"bits": bits}, st.integers(1, 30))
        | st.builds(
            lambda ulps: {"max_error": float(np.spacing(abs(start))) * ulps},
            st.sampled_from([0.1, 0.49, 0.5, 0.51, 1, 1.5, 2, 2.5, 3, 10]),
        )
    )
    encoded, got, source = compress(mesh, **options)
    assert ebz.compress(ebz.decompress(encoded), **options) == encoded
    if limit := options.get("max_error"):
        assert largest_error(got, source) <= Fraction(limit)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("bits", [1, 2, 8, 11, 14, 18, 20])
def test_bits_give_a_grid_whose_step_divides_the_longest_side(bits, dtype):
    vertices = np.random.default_rng(bits).normal(size=(500, 3)).astype(dtype)
    points = fitting.fit(vertices, Precision(bits=bits))
    side = float((vertices.max(axis=0).astype(float) - vertices.min(axis=0)).max())
    assert isinstance(points.lattice, BoxLattice)
    assert points.lattice.step == pytest.approx(side / (2**bits - 1), rel=1e-12)
    assert points.integers.min() == 0
    assert points.integers.max() == 2**bits - 1
    assert not len(points.exceptions)


def test_max_error_gives_a_grid_of_nearly_twice_the_step():
    vertices = np.random.default_rng(0).normal(size=(500, 3))
    points = fitting.fit(vertices, Precision(max_error=1e-3))
    assert isinstance(points.lattice, StepLattice)
    assert points.lattice.step == pytest.approx(2e-3, rel=1e-3)
    assert len(points.exceptions) < 10


@pytest.mark.parametrize("options", [{"bits": 1}, {"bits": 30}, {"max_error": 0.5}], ids=str)
@pytest.mark.parametrize("n_vertices", [0, 1, 2])
def test_zero_extents_are_fine(n_vertices, options):
    mesh = ebz.Mesh(np.full((n_vertices, 3), 7.25), [])
    data, got, source = compress(mesh, **options)
    allowed = Fraction(options.get("max_error", 0))
    assert largest_error(got, source) <= allowed
    assert ebz.compress(ebz.decompress(data), **options) == data


@settings(max_examples=50, deadline=None)
@given(meshes())
def test_a_max_error_of_zero_loses_nothing(mesh):
    assert ebz.compress(mesh, max_error=0) == ebz.compress(mesh)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("options", [{"bits": 12}, {"max_error": 0.5}], ids=str)
def test_what_is_not_finite_cannot_be_quantised_and_is_named(value, options):
    # Vertex 3 of the input comes first in the file.
    vertices = np.arange(12.0).reshape(-1, 3)
    vertices[3, 1] = value
    with pytest.raises(ebz.MeshError, match=f"^vertex 3: y is {value}, which cannot be quantised"):
        ebz.compress(ebz.Mesh(vertices, [[3, 1, 0]]), **options)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_numbers_that_overflow_on_a_decimal_lattice_are_exceptions(dtype):
    vertices = (np.random.default_rng(0).integers(-999, 999, (400, 3)) / 100).astype(dtype)
    patterns = {4: [0x7F800001, 0x7F7FFFFF, 0xFF800000], 8: [0x7FF0000000000001, (0x7FF << 52) - 1]}
    words = np.array(patterns[vertices.itemsize], f"u{vertices.itemsize}")
    vertices[: len(words), 1] = words.view(dtype)
    points = fitting.fit(vertices)
    assert points.lattice.kind == "decimal"
    assert len(points.exceptions) == len(words)
    mesh = ebz.Mesh(vertices, [])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh)))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 6), st.integers(1, 200), rngs)
def test_decimals_are_found(digits, n, rng):
    vertices = rng.integers(-(10**6), 10**6, (n, 3)) / 10.0**digits
    points = fitting.fit(vertices)
    assert points.lattice.kind == "decimal"
    assert points.lattice.digits <= digits
    assert not len(points.exceptions)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from([0, 9, 10, 12, 15]), st.integers(20, 200), st.sampled_from([1, 6, 9]), rngs)
def test_float64_that_were_float32_cost_as_much(digits, n, level, rng):
    singles = (rng.normal(size=(n, 3)) * 10.0 ** rng.integers(-9, 4)).astype(np.float32)
    singles[0, 0] = -0.0
    if digits:
        texts = [f"{x:.{digits - 1}e}" for x in singles.reshape(-1).astype(float).tolist()]
        values = np.array(texts, float).reshape(-1, 3)
    else:
        values = singles.astype(float)
    points = fitting.fit(values)
    assert points.lattice.kind == "single"
    assert points.lattice.digits == digits
    faces = rng.integers(0, n, (n, 3))
    mesh = ebz.Mesh(values, faces, {"a": values})
    data = ebz.compress(mesh, level=level)
    assert same_mesh(mesh, ebz.decompress(data))
    narrow = ebz.compress(ebz.Mesh(singles, faces, {"a": singles}), level=level)
    assert len(data) <= len(narrow) + 4


def test_what_is_beside_the_float32_is_an_exception():
    values = np.random.default_rng(0).normal(size=(400, 3)).astype(np.float32).astype(float)
    values[:5, 1] = [np.nan, np.pi, 1e300, -5e-324, -np.inf]
    points = fitting.fit(values)
    assert points.lattice.kind == "single"
    assert len(points.exceptions) == 4
    mesh = ebz.Mesh(values, [], {"a": values})
    assert same_mesh(mesh, ebz.decompress(ebz.compress(mesh)))


def test_no_float64_of_full_precision_is_taken_for_float32():
    values = np.random.default_rng(0).normal(size=(400, 3))
    assert fitting.fit(values).lattice.kind == "float"
