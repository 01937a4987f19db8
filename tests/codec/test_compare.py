"""verify says what differs, and never gives a verdict that it has no ground for."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import matching
from ebz.codec.matching import Labelled
from ebz.codec.mesh import Mesh
from ebz.codec.sample import glued_grid, random_triangulation
from tests import surgery
from tests.connectivity_check import same_mesh
from tests.meshes import meshes, rngs
from tests.topology import topology

MESH = random_triangulation(200, seed=5)
MESH = ebz.Mesh(
    MESH.vertices,
    MESH.faces,
    {"red": np.arange(200, dtype=np.uint8)},
    {"label": np.arange(len(MESH.faces)) % 7},
)
DATA = ebz.compress(MESH)


def shuffled(mesh: ebz.Mesh, seed: int = 0) -> ebz.Mesh:
    return surgery.shuffled(mesh, np.random.default_rng(seed))[0]


@settings(max_examples=80, deadline=None)
@given(meshes(with_attributes=True))
def test_a_file_equals_the_mesh_it_was_made_of(mesh):
    found = ebz.verify(ebz.compress(mesh), mesh)
    assert found.equal
    assert found.first_difference is None
    assert found.largest_error == found.rms_error == found.allowed_error == 0


@settings(max_examples=80, deadline=None)
@given(meshes(with_attributes=True), rngs)
def test_a_mesh_in_another_order_is_equal_or_undecided(mesh, rng):
    other, _ = surgery.shuffled(mesh, rng)
    try:
        found = ebz.verify(ebz.compress(mesh), other)
    except ebz.EbzError as error:
        assert "cannot tell which vertex is which" in str(error)
    else:
        assert found.equal, found


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 100), st.booleans())
def test_distinct_vertices_in_another_order_are_matched_by_data(seed, lossy):
    data = ebz.compress(MESH, bits=20 if lossy else None)
    found = ebz.verify(data, shuffled(MESH, seed))
    assert found.equal
    assert found.matched_by in {"data", "traversal"}


@settings(max_examples=60, deadline=None)
@given(meshes(distinct=False), st.data())
def test_no_other_mesh_is_called_equal(mesh, data):
    """One vertex moved, one face turned, or one corner put elsewhere."""
    assume(len(mesh.faces) and len(mesh.vertices) > 3)
    other = ebz.Mesh(mesh.vertices.copy(), mesh.faces.copy())
    rng = data.draw(rngs)
    row, column = rng.integers(len(mesh.faces)), rng.integers(3)
    kind = data.draw(st.sampled_from(["vertex", "turn", "corner"]))
    if kind == "vertex":
        other.vertices[rng.integers(len(mesh.vertices)), column] = 12345.678
    elif kind == "turn":
        other.faces[row] = other.faces[row, ::-1]
    else:
        other.faces[row, column] = rng.integers(len(mesh.vertices))
    try:
        found = ebz.verify(ebz.compress(mesh), other)
    except ebz.EbzError:
        return
    try:
        assert found.equal == same_mesh(mesh, other)
    except ValueError:
        # Vertices that cannot be told apart: equal only if it is one mesh up to their names.
        same_shape = topology(proper(mesh.faces)) == topology(proper(other.faces))
        assert same_shape or not found.equal


def proper(faces: np.ndarray) -> np.ndarray:
    return faces[[len(set(face)) == 3 for face in faces.tolist()]]


def moved(mesh: ebz.Mesh, row: int, by: float) -> ebz.Mesh:
    vertices = mesh.vertices.copy()
    vertices[row, 1] += np.float32(by)
    return replace(mesh, vertices=vertices)


def test_a_moved_vertex_is_named():
    found = ebz.verify(DATA, moved(MESH, 17, 0.5))
    assert not found.equal
    assert found.matched_by == "traversal"
    assert found.first_difference.startswith("vertex ")
    assert ": y is " in found.first_difference
    assert found.largest_error == pytest.approx(0.5, rel=1e-5)
    assert found.rms_error == pytest.approx(0.5 / np.sqrt(200), rel=1e-5)


def test_a_moved_vertex_in_another_order_is_a_difference():
    found = ebz.verify(DATA, shuffled(moved(MESH, 17, 0.5)))
    assert not found.equal
    assert found.first_difference == "vertex data"


def test_a_turned_face_is_a_difference():
    faces = MESH.faces.copy()
    faces[3] = faces[3, ::-1]
    found = ebz.verify(DATA, replace(MESH, faces=faces))
    assert not found.equal
    assert found.first_difference == "faces"


@pytest.mark.parametrize("shuffle", [False, True])
def test_changed_attributes_are_named(shuffle):
    values = MESH.face_attributes["label"].copy()
    values[5] += 1
    other = replace(MESH, face_attributes={"label": values})
    found = ebz.verify(DATA, shuffled(other) if shuffle else other)
    assert not found.equal
    assert found.first_difference == "face attribute 'label': values differ"


@pytest.mark.parametrize(
    ("changes", "difference"),
    [
        ({"vertex_attributes": {}}, "vertex attribute 'red': not in MESH"),
        ({"face_attributes": {}}, "face attribute 'label': not in MESH"),
        ({"vertices": MESH.vertices.astype(float)}, "type of coordinates: float32, not float64"),
    ],
    ids=["no red", "no label", "dtype"],
)
def test_other_kinds_of_mesh_are_named(changes, difference):
    found = ebz.verify(DATA, replace(MESH, **changes))
    assert not found.equal
    assert found.first_difference == difference


def test_other_numbers_of_vertices_and_faces_are_named():
    more = np.concatenate([MESH.vertices, MESH.vertices[:1]])
    found = ebz.verify(DATA, ebz.Mesh(more, MESH.faces))
    assert found.first_difference == "number of vertices: 200, not 201"
    found = ebz.verify(DATA, replace(MESH, faces=MESH.faces[1:], face_attributes={}))
    assert found.first_difference == "number of faces: 396, not 395"


def test_another_dtype_of_an_attribute_is_a_difference():
    other = replace(MESH, vertex_attributes={"red": MESH.vertex_attributes["red"].astype(int)})
    assert ebz.verify(DATA, other).first_difference == "vertex attribute 'red': uint8, not int64"


def test_zeros_of_other_sign_differ():
    mesh = ebz.Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]])
    other = ebz.Mesh(np.array([[0.0, -0.0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]])
    assert not ebz.verify(ebz.compress(mesh), other).equal


@pytest.mark.parametrize("options", [{"bits": 8}, {"bits": 16}, {"max_error": 0.01}], ids=str)
def test_lossy_files_equal_their_mesh_within_what_was_allowed(options):
    data = ebz.compress(MESH, **options)
    found = ebz.verify(data, MESH)
    assert found.equal
    assert 0 < found.largest_error <= found.allowed_error
    assert 0 < found.rms_error <= np.sqrt(3) * found.largest_error
    assert not ebz.verify(data, moved(MESH, 3, 3 * found.allowed_error)).equal


@settings(max_examples=80, deadline=None)
@given(meshes(finite=True), st.integers(1, 30))
def test_what_bits_move_is_always_allowed(mesh, bits):
    assert ebz.verify(ebz.compress(mesh, bits=bits), mesh).equal


def test_vertices_that_nothing_tells_apart_are_equal_or_undecided():
    """A torus with all its vertices at one place: traversals may start along three directions."""
    mesh = ebz.Mesh(np.zeros((20, 3)), glued_grid(4, 5, "join", "join")[2])
    data = ebz.compress(mesh)
    n_undecided = 0
    for seed in range(12):
        try:
            assert ebz.verify(data, shuffled(mesh, seed)).equal
        except ebz.EbzError as error:
            assert "cannot tell which vertex is which" in str(error)
            n_undecided += 1
    assert 0 < n_undecided < 12


def test_repeated_faces_are_told_apart_by_their_data():
    vertices, faces = np.eye(3), np.array([[0, 1, 2]] * 4)
    mesh = ebz.Mesh(vertices, faces, {}, {"label": np.arange(4)})
    other = ebz.Mesh(vertices[::-1], faces[:, ::-1], {}, {"label": np.array([3, 1, 0, 2])})
    assert ebz.verify(ebz.compress(mesh), other).equal
    other.face_attributes["label"][0] = 7
    found = ebz.verify(ebz.compress(mesh), other)
    assert found.first_difference == "face attribute 'label': values differ"


def test_a_mesh_that_was_reordered_and_moved_within_the_error_is_no_difference():
    """The lattice of the file tells which vertex is which, though a box of its own would move."""
    data = ebz.compress(MESH, bits=12)
    allowed = ebz.verify(data, MESH).allowed_error
    lowest = int(MESH.vertices[:, 1].argmin())
    assert ebz.verify(data, shuffled(moved(MESH, lowest, 0.9 * allowed))).equal


def labelled(faces: np.ndarray, data: np.ndarray) -> Labelled:
    mesh = Mesh(np.zeros((len(data), 3)), faces)
    return Labelled(mesh.corners, mesh.offsets, data, np.zeros((len(faces), 0), np.uint8))


def test_matching_refines_by_the_faces_around():
    """A path of triangles whose vertices carry one label but for one end."""
    n = 12
    faces = np.array([(i, i + 1, i + 2) for i in range(n - 2)])
    data = np.zeros((n, 1), np.uint8)
    data[0] = 1
    order = np.random.default_rng(0).permutation(n)
    name = np.argsort(order)
    found = matching.match(labelled(faces, data), labelled(name[faces], data[order]))
    vertices, face_order = found
    assert np.array_equal(vertices, name)
    assert np.array_equal(face_order, np.arange(n - 2))


def test_matching_does_not_take_two_triangles_for_a_hexagon():
    """Six vertices that refinement cannot tell apart, in two ways that differ: no verdict."""
    zeros = np.zeros((6, 1), np.uint8)
    ring = np.array([(i, (i + 1) % 6, (i + 2) % 6) for i in range(6)])
    twice = np.array(
        [(a + 3 * b, (a + 1) % 3 + 3 * b, (a + 2) % 3 + 3 * b) for a in range(3) for b in range(2)]
    )
    assert matching.match(labelled(ring, zeros), labelled(twice, zeros)) is None


def test_verify_without_a_mesh_checks_the_file():
    found = ebz.verify(DATA)
    assert found.equal
    assert (found.vertices, found.faces) == (200, 396)
    assert found.checked == ["checksums", "every stream", "digest"]
    assert found.as_dict()["largest_error"] is None
