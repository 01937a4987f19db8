"""A shared grid: what tiles have in common, they still have when they are decoded."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import fitting, lattice
from ebz.codec.fitting import Precision
from ebz.codec.lattice import MAX_MULTIPLE, GridLattice
from ebz.codec.sample import grid as height_field
from tests.codec.test_precision import compress, largest_error, scaled_meshes
from tests.meshes import rngs


def allowed(mesh: ebz.Mesh, grid: tuple[float, float]) -> Fraction:
    """Half a step, half the spacing of the floats, and three roundings of doubles."""
    origin, step = map(Fraction, grid)
    largest = max((abs(Fraction(x)) for x in mesh.vertices.ravel().tolist()), default=Fraction(0))
    limits = np.finfo(mesh.vertices.dtype)
    doubles = 3 * Fraction(2) ** -53 * (2 * largest + abs(origin) + step)
    spacing = Fraction(float(limits.eps)) / 2 * (largest + step)
    return step / 2 + spacing + doubles + Fraction(float(limits.smallest_subnormal))


@settings(max_examples=150, deadline=None)
@given(scaled_meshes(), st.floats(-9, 6), st.sampled_from([0.0, 1.0, -0.1, 1234.5]))
@example(ebz.Mesh(np.array([[1.7e308, -1.7e308, 0]]), []), 0.2, 0.0)
@example(ebz.Mesh(np.array([[3.4e38, -3.4e38, 1]], np.float32), []), -0.1, 0.0)
@example(ebz.Mesh(np.array([[1e-310, 5e-324, -0.0]]), []), -1.0, 0.0)
def test_no_coordinate_moves_by_more_than_half_a_step(mesh, digits, share):
    largest = float(np.abs(mesh.vertices).max(initial=0)) or 1.0
    step, origin = min(largest * 10.0**digits, 1e308) or 1e-300, largest * min(share, 1.0)
    data, got, source = compress(mesh, grid=(origin, step))
    assert largest_error(got, source) <= allowed(mesh, (origin, step))
    assert ebz.compress(ebz.decompress(data), grid=(origin, step)) == data
    assert ebz.verify(data, mesh).equal


@settings(max_examples=80, deadline=None)
@given(st.data(), st.integers(1, 12), rngs)
def test_a_grid_near_the_resolution_of_the_floats_is_canonical(data, n, rng):
    dtype = data.draw(st.sampled_from([np.float32, np.float64]))
    start = np.array(data.draw(st.sampled_from([0, 1, -3, 1e6, 1e-30, 1e-44])), dtype)
    steps = np.spacing(abs(start)) * rng.integers(-40, 40, (n, 3)).astype(dtype)
    mesh = ebz.Mesh((start + steps).astype(dtype), [])
    share = data.draw(st.sampled_from([0.1, 0.49, 0.5, 0.51, 1, 1.5, 2, 2.5, 10]))
    grid = (float(start), max(float(np.spacing(abs(start))) * share, 5e-324))
    encoded, got, source = compress(mesh, grid=grid)
    assert largest_error(got, source) <= allowed(mesh, grid)
    assert ebz.compress(ebz.decompress(encoded), grid=grid) == encoded


@settings(max_examples=60, deadline=None)
@given(rngs, st.sampled_from([np.float32, np.float64]), st.floats(-8, 1))
def test_a_coordinate_decodes_alike_in_any_company(rng, dtype, digits):
    grid = GridLattice((0.0, 0.0, 0.0), 10.0**digits)
    vertices = (rng.normal(size=(40, 3)) * 10.0 ** rng.integers(-3, 4, (40, 1))).astype(dtype)

    def decoded(part: np.ndarray) -> np.ndarray:
        points = fitting.fit(part, Precision(grid=grid))
        return lattice.restore(points, part.dtype, part.reshape(-1)[points.exceptions])

    alone = np.concatenate([decoded(vertices[i : i + 1]) for i in range(len(vertices))])
    assert np.array_equal(decoded(vertices), alone)


def tiles() -> tuple[ebz.Mesh, ebz.Mesh]:
    """Two halves of a rough height field, which share the vertices along the cut."""
    whole = height_field(2000, noise=0.3, seed=4)
    middle = np.median(whole.vertices[:, 0])
    left = (whole.vertices[whole.faces][:, :, 0].mean(axis=1)) < middle
    halves = []
    for faces in (whole.faces[left], whole.faces[~left]):
        used, compact = np.unique(faces, return_inverse=True)
        halves.append(ebz.Mesh(whole.vertices[used], compact.reshape(-1, 3)))
    return halves[0], halves[1]


def shared(a: np.ndarray, b: np.ndarray) -> int:
    """How many points are in both, bit for bit."""
    return len({row.tobytes() for row in a} & {row.tobytes() for row in b})


@pytest.mark.parametrize("origin", [0, (1, 2, -3)])
def test_tiles_meet_without_cracks(origin):
    left, right = tiles()
    seam = shared(left.vertices, right.vertices)
    assert seam > 30
    a, b = (ebz.decompress(ebz.compress(tile, grid=(origin, 1e-5))) for tile in (left, right))
    assert shared(a.vertices, b.vertices) == seam
    # Grids of their own do not meet.
    a, b = (ebz.decompress(ebz.compress(tile, bits=14)) for tile in (left, right))
    assert shared(a.vertices, b.vertices) < seam


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_has_no_place_on_a_grid(value):
    with pytest.raises(ebz.MeshError, match=f"^vertex 1: z is {value}, which cannot be quantised"):
        ebz.compress(ebz.Mesh(np.array([[0, 0, 0], [0, 0, value]]), []), grid=(0, 1))


@pytest.mark.parametrize("far", [MAX_MULTIPLE + 1, -1e300, 1.7e308])
def test_what_is_too_far_from_the_origin_is_named(far):
    near = ebz.Mesh(np.array([[0, MAX_MULTIPLE, 0.0]]), [])
    assert ebz.decompress(ebz.compress(near, grid=(0, 1))).vertices.tolist() == [
        [0, MAX_MULTIPLE, 0]
    ]
    with pytest.raises(ebz.OptionError, match=r"^vertex 1: y is .*, more than 2\^40 steps"):
        ebz.compress(ebz.Mesh(np.array([[0, 0, 0], [0, far, 0]]), []), grid=(0, 1))


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        ((0, 0), "the step of the grid is 0.0"),
        ((0, -1), "the step of the grid is -1.0"),
        ((0, float("inf")), "the step of the grid is inf"),
        ((float("nan"), 1), "the origin of the grid is nan"),
        (((0, 1), 1), "not \\(origin, step\\)"),
        ((0,), "not \\(origin, step\\)"),
        ("ab", "not \\(origin, step\\)"),
    ],
    ids=str,
)
def test_other_grids_are_refused(grid, message):
    with pytest.raises(ebz.OptionError, match=message):
        ebz.compress(ebz.Mesh(np.eye(3), []), grid=grid)


def test_precisions_exclude_each_other():
    for other in ({"bits": 3}, {"max_error": 1.0}):
        with pytest.raises(ebz.OptionError, match="bits, max_error and grid exclude each other"):
            ebz.compress(ebz.Mesh(np.eye(3), []), grid=(0, 1), **other)
