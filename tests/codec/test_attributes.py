"""Attributes of vertices, faces, corners and elements: what comes back, and what may be lost."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, pipeline
from ebz.codec.attributes.bundles import bundles
from ebz.codec.attributes.plan import Guess, Method, Relation
from ebz.codec.sample import random_triangulation, torus
from tests.meshes import SPECIAL_32, SPECIAL_64, attributes, meshes, rngs

DTYPES = ["?", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8"]


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def same_attributes(a: dict[str, np.ndarray], b: dict[str, np.ndarray]) -> bool:
    return list(a) == list(b) and all(same(a[name], b[name]) for name in a)


@st.composite
def carrying(draw: st.DrawFn) -> ebz.Mesh:
    """Meshes with attributes of everything, some smooth, some with special floats."""
    mesh = draw(meshes(finite=True))
    n, m, k, r = mesh.n_vertices, mesh.n_faces, mesh.n_corners, draw(st.integers(0, 9))
    offsets = np.sort(draw(rngs).integers(0, 12, r + 1)) if r else np.zeros(1, int)
    offsets = offsets - offsets[0]
    corners = draw(rngs).integers(0, max(n, 1), offsets[-1] if n else 0)
    offsets = offsets if n else np.zeros(r + 1, int)
    element = ebz.Element(offsets, corners, draw(attributes(r)), draw(attributes(len(corners))))
    by_vertex, rng = draw(attributes(n)), draw(rngs)
    for name, dtype, words in (("a", "f4", SPECIAL_32), ("b", "f8", SPECIAL_64)):
        odd = np.array(words, f"u{dtype[1:]}").view(dtype)
        smooth = (mesh.vertices[:, :1] * [1, 2]).astype(dtype)
        by_vertex[name] = np.where(rng.random((n, 2)) < 0.1, rng.choice(odd, (n, 2)), smooth)
    by_corner = {name: values[mesh.faces.reshape(-1)] for name, values in by_vertex.items()}
    for values in by_corner.values():
        values[rng.random(k) < 0.1] = values[:1]
    return ebz.Mesh(
        mesh.vertices,
        mesh.faces,
        by_vertex,
        draw(attributes(m)),
        corner_attributes=by_corner,
        elements={"element": element},
    )


@settings(max_examples=60, deadline=None)
@given(carrying(), st.sampled_from([1, 6, 9]))
def test_everything_comes_back_in_its_order(mesh, level):
    data = ebz.compress(mesh, level=level, keep_order=True)
    decoded = ebz.decompress(data)
    assert same_attributes(decoded.vertex_attributes, mesh.vertex_attributes)
    assert same_attributes(decoded.face_attributes, mesh.face_attributes)
    assert same_attributes(decoded.corner_attributes, mesh.corner_attributes)
    ours, theirs = decoded.elements["element"], mesh.elements["element"]
    assert same(ours.offsets, theirs.offsets)
    assert same(ours.corners, theirs.corners)
    assert same_attributes(ours.attributes, theirs.attributes)
    assert same_attributes(ours.corner_attributes, theirs.corner_attributes)
    assert ebz.compress(decoded, level=level, keep_order=True) == data


@settings(max_examples=60, deadline=None)
@given(carrying())
def test_everything_follows_the_order_of_the_output(mesh):
    data, permutation = ebz.compress(mesh, return_permutation=True)
    decoded = ebz.decompress(data)
    assert ebz.compress(decoded) == data
    assert ebz.verify(data, mesh).equal
    for name, values in mesh.vertex_attributes.items():
        assert same(decoded.vertex_attributes[name], values[permutation.vertices])
    for name, values in mesh.face_attributes.items():
        assert same(decoded.face_attributes[name], values[permutation.faces])


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("shape", [(), (2,), (3,), (2, 2), (0,)], ids=str)
def test_smooth_and_random_values_of_every_dtype_come_back(dtype, shape):
    mesh = torus(600)
    rng = np.random.default_rng(1)
    base = mesh.vertices[:, :1].reshape(-1, *[1] * len(shape)) * np.ones(shape) * 40 + 60
    words = rng.integers(0, 256, (mesh.n_vertices, *shape, np.dtype(dtype).itemsize), np.uint8)
    random = words.view(dtype)[..., 0] if dtype != "?" else words[..., 0] > 127
    carried = {"smooth": base.astype(dtype), "random": random}
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, carried)
    decoded = ebz.decompress(ebz.compress(mesh, keep_order=True))
    assert same_attributes(decoded.vertex_attributes, carried)


def plan_of(values: np.ndarray, mesh: ebz.Mesh | None = None, **options: Any):
    mesh = mesh or torus(2000)
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, {"normal": values})
    return pipeline.encode(mesh, **options)[0].vertex_attributes[0]


def normals(mesh: ebz.Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    sums = np.zeros(mesh.vertices.shape)
    for i in range(3):
        np.add.at(sums, mesh.faces[:, i], np.cross(b - a, c - a))
    return (sums / np.linalg.norm(sums, axis=1, keepdims=True)).astype(np.float32)


def test_normals_are_predicted_from_the_surface():
    mesh = torus(2000)
    array = plan_of(normals(mesh), mesh)
    assert array.plan.relation == Relation.UNIT
    assert array.plan.guess == Guess.NORMALS | Guess.AREA
    assert len(array.data) < 12 * mesh.n_vertices / 3
    inverted = plan_of(-normals(mesh), mesh)
    assert inverted.plan.guess == Guess.NORMALS | Guess.AREA | Guess.INVERTED
    assert abs(len(inverted.data) - len(array.data)) < 0.03 * mesh.n_vertices


def test_normals_tell_how_rounding_has_moved_the_vertices():
    mesh = torus(8000, noise=0.003)
    plain = ebz.Mesh(mesh.vertices.astype(float), mesh.faces)
    carrying = ebz.Mesh(plain.vertices, plain.faces, {"normal": normals(plain)})
    size = len(ebz.compress(carrying, bits=10, normal_bits=12)) - len(ebz.compress(plain, bits=10))
    assert size < 9.5 / 8 * mesh.n_vertices  # 11 bits each where they tell nothing of one another


def test_labels_are_coded_as_such():
    mesh = torus(2000)
    labels = np.where(mesh.vertices[:, 0] > 0, 10**15, -7)
    array = plan_of(labels, mesh)
    assert array.plan.n_labels == 2
    assert len(array.data) < mesh.n_vertices / 16
    ids = np.random.default_rng(0).choice([5, 900, -(10**12)], mesh.n_vertices)
    assert plan_of(ids, mesh).plan.method == Method.SYMBOLS


def test_low_levels_take_the_fast_method_where_values_have_room():
    mesh = torus(2000)
    colours = (mesh.vertices * 90 + 128).astype(np.uint8)
    wide = np.arange(mesh.n_vertices) ** 5
    for values, method in ((colours, Method.FAST), (wide, Method.NUMBERS)):
        assert plan_of(values, mesh, level=1).plan.method == method
        assert plan_of(values, mesh, level=6).plan.method == Method.NUMBERS
    floats = (mesh.vertices[:, 0] * mesh.vertices[:, 1]).astype(np.float32)
    for level, method in ((2, Method.FAST), (3, Method.NUMBERS), (6, Method.NUMBERS)):
        assert plan_of(floats, mesh, level=level).plan.method == method
    assert len(plan_of(floats, mesh, level=1).data) < 0.8 * floats.nbytes


def test_the_fast_method_follows_what_components_share():
    mesh = torus(8000)
    shape = (mesh.n_vertices, 3)
    alone = np.random.default_rng(3).integers(-20, 20, shape)
    alike = alone[:, :1] + np.array([100, 120, 90])
    sizes = [len(plan_of(values, mesh, level=1).data) for values in (alike, alone)]
    assert 2 * sizes[0] < sizes[1]


def test_what_is_constant_costs_next_to_nothing():
    n = torus(2000).n_vertices
    for values in (np.zeros(n), np.full(n, np.nan), np.full((n, 4), 3, np.uint8)):
        assert len(plan_of(values).data) < 8


def test_components_by_name_are_coded_together():
    columns = [
        "x",
        "red",
        "green",
        "blue",
        "alpha",
        "u",
        "v",
        "f_0",
        "f_1",
        "f_3",
        "nx",
        "ny",
        "nz",
    ]
    values = {name: np.zeros(3, np.uint8) for name in columns}
    names = [bundle.names for bundle in bundles(values, lambda _: 0)]
    assert names == [
        *[("x",), ("red", "green", "blue", "alpha"), ("u", "v"), ("f_0", "f_1"), ("f_3",)],
        ("nx", "ny", "nz"),
    ]
    values["green"] = np.zeros(3, np.uint16)
    assert ("red",) in [bundle.names for bundle in bundles(values, lambda _: 0)]


def lossy(values: np.ndarray, name: str, **options: Any) -> np.ndarray:
    """As decoded, in the order of the source; the same again when compressed again."""
    mesh = random_triangulation(len(values), seed=1)
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, {name: values})
    data = ebz.compress(mesh, keep_order=True, **options)
    decoded = ebz.decompress(data)
    assert ebz.compress(decoded, keep_order=True, **options) == data
    assert ebz.verify(data, mesh).equal
    reordered = ebz.compress(mesh, **options)
    assert ebz.verify(reordered, mesh).equal
    assert ebz.compress(ebz.decompress(reordered), **options) == reordered
    return decoded.vertex_attributes[name]


VALUES = ["smooth", "random", "far", "tiny", "special"]


def floats(kind: str, dtype: str) -> np.ndarray:
    rng = np.random.default_rng(2)
    values = torus(400).vertices[:, :2].astype(float)
    if kind == "random":
        values = rng.normal(size=values.shape)
    values = {"far": values + 1e6, "tiny": values * 1e-30}.get(kind, values)
    values = values.astype(dtype)
    if kind == "special":
        values[rng.random(values.shape) < 0.1] = np.nan
        values[3, 1] = -np.inf
    return values


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("kind", VALUES)
@pytest.mark.parametrize("bits", [1, 8, 16, 30])
def test_values_move_by_half_a_step_of_attribute_bits(kind, bits, dtype):
    values = floats(kind, dtype)
    got = lossy(values, "uv", attribute_bits={"uv": bits})
    finite = np.isfinite(values)
    wide = np.where(finite, values.astype(float), np.nan)
    side = (np.nanmax(wide, axis=0) - np.nanmin(wide, axis=0)).max()
    allowed = side / (2**bits - 1) / 2 + np.spacing(np.abs(values[finite]).max())
    assert np.abs(got.astype(float) - wide)[finite].max() <= allowed
    assert same(got[~finite], values[~finite])


@pytest.mark.parametrize("dtype", ["f4", "f8"])
@pytest.mark.parametrize("kind", VALUES)
@pytest.mark.parametrize("error", [1e-40, 1e-4, 0.1, 1e4])
def test_no_value_moves_by_more_than_attribute_error(kind, error, dtype):
    values = floats(kind, dtype)
    got = lossy(values, "uv", attribute_error={"uv": error})
    finite = np.isfinite(values)
    moved = np.abs(got[finite].astype(float) - values[finite].astype(float))
    assert moved.max() <= error + np.spacing(np.abs(values[finite]).max())
    assert same(got[~finite], values[~finite])


@pytest.mark.parametrize("dtype", ["u1", "i2", "u4", "i8"])
def test_integers_stay_within_their_precision(dtype):
    limits = np.iinfo(dtype)
    low, high = max(limits.min, -(2**40)), min(limits.max, 2**40)
    values = np.random.default_rng(3).integers(low, high, (200, 3), dtype=dtype, endpoint=True)
    got = lossy(values, "c", attribute_error={"c": 3})
    assert np.abs(got.astype(object) - values.astype(object)).max() <= 3
    got = lossy(values, "c", attribute_bits={"c": 5})
    assert np.abs(got.astype(float) - values.astype(float)).max() <= (high - low) / 31 / 2 + 0.5


@pytest.mark.parametrize("bits", [2, 5, 8, 10, 16])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_normals_stay_unit_vectors_near_what_they_were(bits, dtype):
    values = np.random.default_rng(4).normal(size=(500, 3))
    values[:30] = np.sign(values[:30]) * (np.arange(90).reshape(30, 3) % 4 == 0)
    length = np.linalg.norm(values, axis=1, keepdims=True)
    values = (values / np.where(length > 0, length, 1)).astype(dtype)
    values[40], values[41] = 0, np.nan
    got = lossy(values, "normal", normal_bits=bits)
    directed = np.isfinite(values).all(axis=1) & (np.abs(values).max(axis=1) > 0)
    ours, theirs = got[directed].astype(float), values[directed].astype(float)
    assert np.abs(np.linalg.norm(ours, axis=1) - 1).max() < 4 * np.finfo(dtype).eps
    step = 2 / (2**bits - 2)
    cosine = np.clip((ours * theirs).sum(axis=1), -1, 1)
    assert np.arccos(cosine).max() <= 1.23 * np.sqrt(3) * step + 1e-3
    assert same(got[~directed], values[~directed])
    assert same(lossy(values, "normal", attribute_bits={"normal": bits}), got)


def test_axes_are_directions_of_every_precision():
    axes = np.tile(np.concatenate([np.eye(3), -np.eye(3)]), (20, 1)).astype(np.float32)
    for bits in (2, 7, 16):
        assert np.array_equal(lossy(axes, "normal", normal_bits=bits), axes)


@pytest.mark.parametrize("bits", [4, 8, 12])
def test_weights_still_add_up_to_one(bits):
    weights = np.random.default_rng(5).exponential(size=(300, 4)) ** 3
    weights = (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)
    weights[5] = [1, 0, 0, 0]
    step = 1 / (2**bits - 1)
    got = lossy(weights, "w", attribute_bits={"w": bits})
    assert np.abs(got.sum(axis=1, dtype=float) - 1).max() < 1e-6
    assert np.abs(got.astype(float) - weights).max() <= step + 1e-6
    assert (got >= 0).all()
    assert same(lossy(weights, "w", attribute_error={"w": step * 1.02}), got)


def test_precision_of_bundles_and_of_corners():
    mesh = torus(400)
    normal = normals(mesh)
    split = {f"n{axis}": normal[:, i].copy() for i, axis in enumerate("xyz")}
    uv = mesh.vertices[mesh.faces.reshape(-1), :2].copy()
    carrying = ebz.Mesh(mesh.vertices, mesh.faces, split, corner_attributes={"uv": uv})
    data = ebz.compress(carrying, normal_bits=8, attribute_bits={"uv": 10}, keep_order=True)
    decoded = ebz.decompress(data)
    got = np.stack([decoded.vertex_attributes[name] for name in split], axis=1)
    assert np.abs(np.linalg.norm(got, axis=1) - 1).max() < 1e-6
    assert 0 < np.abs(got - normal).max() < 0.02
    assert 0 < np.abs(decoded.corner_attributes["uv"] - uv).max() < 0.01
    assert ebz.verify(data, carrying).equal
    moved = ebz.Mesh(mesh.vertices, mesh.faces, split, corner_attributes={"uv": uv + 0.01})
    difference = ebz.verify(data, moved).first_difference
    assert difference == "corner attribute 'uv': values differ by more than its precision"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"attribute_bits": {"a": 0}}, "bits of attribute 'a' are 0, not 1 to 30"),
        ({"attribute_bits": {"b": 3}}, "there is no attribute 'b'"),
        ({"attribute_error": {"a": -1.0}}, "error of attribute 'a' is -1.0"),
        ({"attribute_error": {"a": np.nan}}, "error of attribute 'a' is nan"),
        ({"attribute_bits": {"a": 3}, "attribute_error": {"a": 3}}, "exclude each other"),
        ({"normal_bits": 17}, "normal_bits is 17, not 2 to 16"),
    ],
    ids=str,
)
def test_precisions_that_make_no_sense_are_refused(options, message):
    mesh = ebz.Mesh(np.eye(3), [[0, 1, 2]], {"a": np.zeros(3)})
    with pytest.raises(ebz.OptionError, match=message):
        ebz.compress(mesh, **options)


@settings(max_examples=80, deadline=None)
@given(carrying(), rngs)
def test_corners_of_rows_come_back_along_any_mesh(mesh, rng):
    n = mesh.n_vertices
    offsets = np.concatenate([[0], np.cumsum(rng.integers(0, 5, 30))]) if n else np.zeros(4, int)
    vertices = rng.integers(0, max(n, 1), offsets[-1])
    along = np.concatenate([mesh.corners, mesh.corners[::-1], vertices])[: offsets[-1]]
    ends = np.arange(0, mesh.n_corners + 1, 3, dtype=np.int32)
    of_mesh = (mesh.corners.astype(np.int32), ends, mesh.vertices.astype(float).reshape(-1))
    for told in (vertices, along):
        rows = offsets[: np.searchsorted(offsets, len(told), side="right")]
        corners = told[: rows[-1]].astype(np.int32)
        data = _kernels.encode_links(*of_mesh, rows, corners)
        assert np.array_equal(_kernels.decode_links(data, *of_mesh, rows), corners)


def element_bytes(mesh: ebz.Mesh, rows: np.ndarray) -> int:
    offsets = np.arange(0, rows.size + 1, rows.shape[1])
    element = ebz.Element(offsets, rows.reshape(-1).astype(np.int32))
    with_rows = ebz.Mesh(mesh.vertices, mesh.faces, elements={"edge": element})
    data = ebz.compress(with_rows)
    decoded, order = ebz.decompress(data), ebz.compress(with_rows, return_permutation=True)[1]
    assert np.array_equal(order.vertices[decoded.elements["edge"].corners], element.corners)
    return next(s.bytes for s in ebz.stats(data).streams if s.name == "elements")


def test_rows_that_are_edges_cost_little():
    mesh = torus(4900)  # of rings of 70 vertices
    ends = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    edges = np.unique(np.sort(ends, axis=1), axis=0)
    assert 8 * element_bytes(mesh, edges) < 4.5 * len(edges)
    ring = np.arange(70)
    lines = np.concatenate([np.stack([ring, np.roll(ring, -1)], axis=1) + 70 * i for i in (3, 9)])
    assert set(map(tuple, np.sort(lines, axis=1).tolist())) <= set(map(tuple, edges.tolist()))
    assert 8 * element_bytes(mesh, lines) < 3 * len(lines)
