"""Polygons come back as they were: corners, orientation, order where it is kept, all attributes."""

from collections import Counter
from itertools import combinations_with_replacement, pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, connectivity, cycles, pipeline
from ebz.codec.errors import OptionError
from ebz.codec.fitting import Precision
from ebz.codec.levels import word_effort
from ebz.codec.mesh import Mesh
from ebz.codec.models.adaptive import Effort
from ebz.codec.polygons import Cut
from ebz.codec.sample import random_triangulation
from ebz.formats.polygons import fanned
from tests import polygons
from tests.meshes import rngs
from tests.oracles.cut import Cutter, opposites
from tests.polygons import faces_of, least_turn, mesh_of, polygon_meshes, quad_grid


def check_faces(rows: list[polygons.Polygon], n_vertices: int) -> None:
    """Faces, without positions, are the same again, and so are the streams of what was decoded."""
    mesh = mesh_of(rows, np.zeros((n_vertices, 3)))
    encode = (n_vertices, [Effort.FAST], mesh.offsets)
    word, _, order = connectivity.encode(mesh.corners, *encode)
    parts = (word.word, word.special_integers, word.gluing, word.counts)
    _, surface = connectivity.decode(*parts, Effort.FAST)
    assert surface.polygons is not None
    corners = surface.vertex[surface.polygons.corner]
    got = mesh_of_corners(order.vertices[corners], surface.polygons.offsets, n_vertices)
    assert Counter(map(least_turn, faces_of(got))) == Counter(map(least_turn, rows)), rows
    assert [least_turn(rows[f]) for f in order.faces] == [least_turn(f) for f in faces_of(got)]
    again, _, _ = connectivity.encode(corners, n_vertices, [Effort.FAST], surface.polygons.offsets)
    assert (again.word, again.special_integers, again.gluing, again.counts) == parts, rows


def mesh_of_corners(corners, offsets, n_vertices: int) -> Mesh:
    return Mesh(np.zeros((n_vertices, 3)), corners, face_offsets=offsets)


def all_faces(n_vertices: int, max_corners: int) -> list[polygons.Polygon]:
    """Every face up to rotation, degenerate ones included."""
    faces = [f for d in range(max_corners + 1) for f in product(range(n_vertices), repeat=d)]
    return [face for face in faces if face == least_turn(face)]


def test_every_pair_of_faces_of_up_to_four_corners_on_four_vertices():
    for rows in combinations_with_replacement(all_faces(4, 4), 2):
        check_faces(list(rows), 4)


def test_some_lists_of_faces_of_up_to_five_corners_on_five_vertices():
    rng, kinds = np.random.default_rng(0), all_faces(5, 5)
    proper = [face for face in kinds if len(set(face)) == len(face) >= 3]
    for chosen in rng.integers(len(proper), size=(1500, 5)):
        check_faces([proper[i] for i in chosen], 5)


@settings(max_examples=150, deadline=None)
@given(polygon_meshes(), st.sampled_from([1, 6, 9]))
def test_polygons_come_back_and_again_with_the_same_bytes(mesh, level):
    data = ebz.compress(mesh, level=level)
    decoded = ebz.decompress(data)
    assert polygons.cycles(decoded) == polygons.cycles(mesh)
    assert ebz.compress(decoded, level=level) == data


@settings(max_examples=100, deadline=None)
@given(polygon_meshes(distinct=False, with_attributes=True))
def test_order_and_everything_is_kept(mesh):
    data = ebz.compress(mesh, keep_order=True)
    decoded = ebz.decompress(data)
    assert np.array_equal(decoded.corners, mesh.corners)
    assert np.array_equal(decoded.offsets, mesh.offsets)
    assert decoded.vertices.tobytes() == mesh.vertices.tobytes()
    for kind in ("vertex_attributes", "face_attributes", "corner_attributes"):
        got, wanted = getattr(decoded, kind), getattr(mesh, kind)
        assert list(got) == list(wanted)
        assert all(got[name].tobytes() == wanted[name].tobytes() for name in wanted)
    assert ebz.compress(decoded, keep_order=True) == data


@settings(max_examples=100, deadline=None)
@given(polygon_meshes(with_attributes=True))
def test_attributes_go_with_their_faces_and_corners(mesh):
    data, order = ebz.compress(mesh, return_permutation=True)
    decoded = ebz.decompress(data)
    for name, values in mesh.vertex_attributes.items():
        assert decoded.vertex_attributes[name].tobytes() == values[order.vertices].tobytes()
    for name, values in mesh.face_attributes.items():
        assert decoded.face_attributes[name].tobytes() == values[order.faces].tobytes()
    assert carried_by_corners(decoded) == carried_by_corners(mesh)
    assert ebz.compress(decoded) == data


def carried_by_corners(mesh: Mesh) -> Counter:
    at = [vertex.tobytes() for vertex in mesh.vertices]
    values = [v for _, v in sorted(mesh.corner_attributes.items())]
    corners = [(at[v], *(a[i].tobytes() for a in values)) for i, v in enumerate(mesh.corners)]
    ends = mesh.offsets.tolist()
    return Counter(least_turn(tuple(corners[a:b])) for a, b in pairwise(ends))


@settings(max_examples=40, deadline=None)
@given(polygon_meshes(), rngs)
def test_verify_finds_the_mesh_and_any_difference(mesh, rng):
    data = ebz.compress(mesh)
    assert ebz.verify(data, mesh).equal
    faces = faces_of(mesh)
    turned = [f[::-1] if i == 0 else f for i, f in enumerate(faces)]
    other = mesh_of(turned, mesh.vertices)
    if polygons.cycles(other) != polygons.cycles(mesh):
        assert not ebz.verify(data, other).equal


@settings(max_examples=60, deadline=None)
@given(polygon_meshes(), rngs)
def test_damaged_words_are_corrupt_or_decode_to_something(mesh, rng):
    encode = (mesh.n_vertices, [Effort.FAST], mesh.offsets)
    word, _, _ = connectivity.encode(mesh.corners, *encode)
    for _ in range(10):
        damaged = bytearray(word.word)
        for at in rng.integers(len(damaged), size=2) if damaged else ():
            damaged[at] ^= 1 << rng.integers(8)
        parts = (bytes(damaged), word.special_integers, word.gluing, word.counts)
        try:
            _, surface = connectivity.decode(*parts, word.model)
        except ebz.CorruptError:
            continue
        assert surface.polygons is not None
        assert surface.polygons.offsets[-1] == len(surface.polygons.corner) == mesh.n_corners


def connectivity_bytes(mesh: Mesh, level: int) -> int:
    encoded, _ = pipeline.encode(mesh, level=level, precision=Precision(bits=12))
    return len(encoded.streams.word) + len(encoded.streams.gluing)


@pytest.mark.parametrize("level", [1, 4, 6, 9])
def test_a_regular_grid_of_quads_costs_next_to_nothing(level):
    mesh = quad_grid(99, 99)
    assert 8 * connectivity_bytes(mesh, level) / mesh.n_vertices < 0.02


def irregular_quads() -> Mesh:
    """A quad for each edge of a uniform random triangulation, between its ends and its faces."""
    base = random_triangulation(1500, 7)
    faces = base.faces.astype(np.int64)
    centre = base.n_vertices + np.arange(len(faces))
    across = {
        (a, b): f for f, face in zip(centre, faces.tolist(), strict=True) for a, b in edges_of(face)
    }
    quads = [(a, across[b, a], b, f) for (a, b), f in across.items() if a < b]
    centres = base.vertices[faces].mean(axis=1)
    starts = np.random.default_rng(5).integers(4, size=len(quads))
    quads = [quad[i:] + quad[:i] for quad, i in zip(quads, starts.tolist(), strict=True)]
    return mesh_of(quads, np.concatenate([base.vertices, centres.astype(np.float32)]))


def edges_of(face: list[int]) -> list[tuple[int, int]]:
    return [(face[i - 1], face[i]) for i in range(len(face))]


@pytest.mark.parametrize("level", [1, 6, 9])
def test_irregular_quads_cost_less_than_their_triangles(level):
    mesh = irregular_quads()
    cut = fanned(mesh)
    marks = len(cut.faces)  # a bit each: half of them are diagonals
    ours, theirs = connectivity_bytes(mesh, level), connectivity_bytes(cut, level)
    assert ours < 0.8 * theirs
    assert ours < 0.5 * (theirs + marks / 8)


@settings(max_examples=200, deadline=None)
@given(polygon_meshes(), st.sampled_from(Cut))
def test_polygons_are_cut_as_specified(mesh, cut):
    _, surface, _ = connectivity.encode(mesh.corners, mesh.n_vertices, [Effort.FAST], mesh.offsets)
    polygons, n_vertices = surface.polygons, surface.n_vertices
    assert polygons is not None
    vertex, across = surface.vertex[polygons.corner], polygons.across(surface.opposite)
    offsets = polygons.offsets.astype(np.int32)
    opposite, corner = _kernels.cut_polygons(vertex, offsets, across, n_vertices, cut)
    twin = Cutter(vertex.tolist(), offsets.tolist(), across.tolist(), cut)
    triangles = twin.triangles()
    assert corner.reshape(-1, 3).tolist() == [list(t) for t in triangles]
    assert opposite.tolist() == opposites(triangles, twin.across, 2 if cut == Cut.TWICE else 1)


def geometry_bytes(mesh: Mesh, level: int, bits: int) -> int:
    encoded, _ = pipeline.encode(mesh, level=level, precision=Precision(bits=bits))
    return len(encoded.streams.positions)


def wavy(grid: Mesh) -> Mesh:
    x, y, _ = grid.vertices.T
    z = 4 * np.sin(x / 7) + 5 * np.cos(y / 11 + x / 19)
    return mesh_of(faces_of(grid), np.stack([x, y, z], axis=1))


@pytest.mark.parametrize("level", [1, 3, 6, 9])
@pytest.mark.parametrize("bits", [10, 12, 14])
def test_regular_quads_cost_no_more_than_their_triangles(level, bits):
    flat = quad_grid(50, 50)
    for mesh in (flat, wavy(flat)):
        sizes = [len(ebz.compress(m, level=level, bits=bits)) for m in (mesh, fanned(mesh))]
        assert sizes[0] <= sizes[1]
    assert geometry_bytes(wavy(flat), level, bits) < 0.9 * geometry_bytes(
        fanned(wavy(flat)), level, bits
    )


@pytest.mark.parametrize("level", [1, 6])
def test_attributes_of_faces_follow_what_is_across_edges(level):
    grid = quad_grid(40, 50)
    row, column = np.divmod(np.arange(grid.n_faces), 50)
    shuffle = np.random.default_rng(0).permutation(grid.n_faces)
    values = {"smooth": row * row + 3 * column, "region": (row // 9 + column // 9) % 3}
    for name, value in values.items():
        sizes = []
        for attribute in (value, value[shuffle]):
            attributes = {name: attribute.astype(np.int32)}
            mesh = mesh_of(faces_of(grid), grid.vertices, face_attributes=attributes)
            sizes.append(ebz.stats(ebz.compress(mesh, level=level)).attribute_bytes)
        assert sizes[0] < 0.35 * sizes[1], name


@pytest.mark.parametrize("level", [1, 6])
def test_attributes_of_quads_cost_less_than_those_of_their_triangles(level):
    grid = quad_grid(40, 50)
    x, y, z = grid.vertices.T.astype(np.float64)
    uv = np.round(np.stack([x + z, y * y / 50 + z], axis=1) / 60, 5).astype(np.float32)
    normals = np.stack([-np.gradient(z.reshape(41, 51))[i].reshape(-1) for i in (1, 0)], axis=1)
    normals = np.concatenate([normals, np.ones((len(z), 1))], axis=1)
    normals /= np.sqrt((normals**2).sum(axis=1, keepdims=True))
    for values in (uv, normals.astype(np.float32)):
        at_corners = {"a": values[grid.corners]}
        mesh = mesh_of(faces_of(grid), grid.vertices, corner_attributes=at_corners)
        options = {"level": level, "attribute_bits": {"a": 10}}
        sizes = [
            ebz.stats(ebz.compress(m, **options)).attribute_bytes for m in (mesh, fanned(mesh))
        ]
        assert sizes[0] < sizes[1]


def test_order_of_polygons_is_within_the_uniform_bound():
    rng = np.random.default_rng(3)
    grid = quad_grid(30, 40)
    faces = [faces_of(grid)[i] for i in rng.permutation(grid.n_faces)]
    faces = [f[t:] + f[:t] for f, t in zip(faces, rng.integers(4, size=len(faces)), strict=True)]
    stats = ebz.stats(ebz.compress(mesh_of(faces, grid.vertices), keep_order=True))
    n_faces, order = len(faces), {s.name: s.bytes for s in stats.streams}
    uniform = np.log2(np.arange(1, n_faces + 1)).sum() + 2 * n_faces
    assert 8 * (order["face order"] + order["rotations"]) <= 1.01 * uniform + 8 * 32


def test_order_of_a_regular_grid_costs_next_to_nothing():
    grid = quad_grid(60, 80)
    stats = ebz.stats(ebz.compress(grid, keep_order=True))
    assert 8 * stats.order_bytes / grid.n_vertices < 0.5


def test_tables_are_for_triangles():
    with pytest.raises(OptionError, match="tables are for triangles"):
        ebz.compress(quad_grid(3, 3), model="stack")


def test_cycles_are_least_from_one_entry_on():
    rows = np.array([[2, 1, 2, 1], [3, 3, 3, 3], [5, 0, 4, 0]])
    assert cycles.least(rows).tolist() == [[1, 2, 1, 2], [3, 3, 3, 3], [0, 4, 0, 5]]
    assert word_effort(1) == Effort.DIRECT
