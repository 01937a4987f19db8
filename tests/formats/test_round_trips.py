"""What is written is read back: random meshes through every native format."""

import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.elements import rows
from ebz.codec.errors import DroppedWarning
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh
from tests.formats.carried import contents, obj_meshes, ply_meshes, row_set

COORDINATES = {
    "everyday": lambda rng, n: rng.standard_normal((n, 3)),
    "short": lambda rng, n: rng.integers(-99, 99, (n, 3)) / 10,
    "wide": lambda rng, n: rng.standard_normal((n, 3)) * 10.0 ** rng.integers(-38, 38, (n, 3)),
    "whole": lambda rng, n: rng.integers(-3, 3, (n, 3)) * 1.0,
}
TYPES = "i1 u1 i2 u2 i4 u4 f4 f8".split()  # noqa: SIM905
PLY_FORMATS = ("ascii", "binary_little_endian", "binary_big_endian")


def special(vertices: np.ndarray, rng: np.random.Generator) -> None:
    """Puts values at a few places that formats and float parsers stumble over."""
    values = [0.0, -0.0, np.inf, -np.inf, np.nan, np.finfo(vertices.dtype).max]
    values += [np.finfo(vertices.dtype).tiny, np.finfo(vertices.dtype).smallest_subnormal]
    for value in values:
        if rng.integers(3) == 0 and vertices.size:
            vertices.flat[rng.integers(vertices.size)] = value


@st.composite
def meshes(draw: st.DrawFn, *, used: bool = False, attributes: bool = True) -> Mesh:
    """Any list of triangles; with `used`, every vertex is on a face and no position is twice."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    n = draw(st.integers(3 if used else 0, 12))
    dtype = draw(st.sampled_from([np.float32, np.float64]))
    kind = draw(st.sampled_from(sorted(COORDINATES)))
    with np.errstate(over="ignore", under="ignore"):
        vertices = COORDINATES[kind](rng, n).astype(dtype)
    special(vertices, rng)
    m = draw(st.integers(0, 12)) if n else 0
    faces = rng.integers(0, max(n, 1), (m, 3)).astype(np.int32)
    if used:
        vertices[:, 0] = np.arange(n) + 0.25
        order = np.arange(n)
        covering = np.stack([order, np.roll(order, -1), np.roll(order, -2)], axis=1)
        faces = np.concatenate([covering.astype(np.int32), faces])
    if not attributes:
        return Mesh(vertices, faces)
    return Mesh(vertices, faces, table(draw, rng, n), table(draw, rng, len(faces)))


def table(draw: st.DrawFn, rng: np.random.Generator, n: int) -> dict[str, np.ndarray]:
    result = {}
    for name in draw(st.lists(st.sampled_from(["red", "nx", "a:b", "\u00e9"]), unique=True)):
        dtype = np.dtype(draw(st.sampled_from(TYPES)))
        width = draw(st.integers(0, 3))
        values = rng.integers(0, 2**31, (n, width) if width else n).astype(dtype)
        if dtype.kind == "f":
            values /= 7
        result[name] = values
        if width > 1 and draw(st.booleans()):
            lengths = rng.integers(0, width + 1, n).astype(np.uint8)
            # One list of each kind, lest all turn out equally long and need no count.
            if n > 1:
                lengths[:2] = (width, 0)
                values[np.arange(width) >= lengths[:, None]] = 0
                result[f"{name}:count"] = lengths
    return result


def assert_same(again: Mesh, mesh: Mesh) -> None:
    assert contents(again) == contents(mesh)


@pytest.mark.parametrize("flavour", PLY_FORMATS)
@given(mesh=meshes())
def test_ply_keeps_everything(flavour: str, mesh: Mesh) -> None:
    mesh.metadata["ply"] = {"format": flavour, "header": []}
    data = write_mesh(mesh, "ply")
    again = read_mesh(data)
    assert_same(again, mesh)
    assert write_mesh(again, "ply") == data
    assert read_mesh(write_mesh(again, "ply")).metadata == again.metadata


@pytest.mark.parametrize("flavour", PLY_FORMATS)
@given(mesh=ply_meshes())
def test_ply_keeps_polygons_corners_and_elements(flavour: str, mesh: Mesh) -> None:
    mesh.metadata["ply"] = {"format": flavour, "header": []}
    data = write_mesh(mesh, "ply")
    again = read_mesh(data)
    assert_same(again, mesh)
    assert write_mesh(again, "ply") == data


@given(mesh=obj_meshes())
def test_obj_keeps_all_that_it_has(mesh: Mesh) -> None:
    data = write_mesh(mesh, "obj")
    again = read_mesh(data, format="obj")
    assert again.metadata == mesh.metadata
    for kind in ("face", *mesh.elements):
        assert row_set(again, kind) == row_set(mesh, kind)
    assert write_mesh(again, "obj") == data
    assert_same(read_mesh(data, format="obj"), again)


@pytest.mark.parametrize("format", ["obj", "off"])
@given(mesh=meshes(attributes=False))
def test_text_keeps_vertices_and_faces(format: str, mesh: Mesh) -> None:
    data = write_mesh(mesh, format)
    again = read_mesh(data, format=format)
    assert_same(again, mesh)
    assert again.metadata["format"] == format
    assert write_mesh(again, format) == data


@given(mesh=meshes(used=True, attributes=False))
def test_ascii_stl_keeps_triangles(mesh: Mesh) -> None:
    mesh.metadata["stl"] = {"format": "ascii"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DroppedWarning)
        again = read_mesh(write_mesh(mesh, "stl"))
    # Shortest decimals: the same text, whatever the dtype.
    assert_same_triangles(again.vertices.astype(str), again, mesh.vertices.astype(str), mesh)


@given(mesh=meshes(used=True, attributes=False))
def test_binary_stl_keeps_float32_triangles(mesh: Mesh) -> None:
    with np.errstate(over="ignore"):
        mesh = Mesh(mesh.vertices.astype(np.float32), mesh.faces)
    data = write_mesh(mesh, "stl")
    again = read_mesh(data)
    ours, theirs = again.vertices.view(np.uint32), mesh.vertices.view(np.uint32)
    assert_same_triangles(ours, again, theirs, mesh)
    assert write_mesh(again, "stl") == data
    assert again.face_attributes == {}


def assert_same_triangles(ours: np.ndarray, again: Mesh, theirs: np.ndarray, mesh: Mesh) -> None:
    assert len(again.vertices) == len(mesh.vertices)
    assert np.array_equal(ours[again.faces], theirs[mesh.faces])


@given(mesh=meshes(attributes=False))
def test_colours_and_normals_come_back_from_off(mesh: Mesh) -> None:
    n, m = len(mesh.vertices), len(mesh.faces)
    rng = np.random.default_rng(n)
    mesh.vertex_attributes = {
        "normal": rng.standard_normal((n, 3)).astype(np.float32),
        "rgba": rng.integers(0, 256, (n, 4)).astype(np.uint8),
        "st": rng.standard_normal((n, 2)).astype(np.float32),
    }
    mesh.face_attributes = {"rgb": np.ones((m, 3), np.float32)}
    assert_same(read_mesh(write_mesh(mesh, "off")), mesh)


@given(mesh=meshes(attributes=False))
def test_colours_come_back_from_obj(mesh: Mesh) -> None:
    n = len(mesh.vertices)
    mesh.vertex_attributes = {"rgb": np.linspace(0, 1, 3 * n, dtype=np.float32).reshape(n, 3)}
    assert_same(read_mesh(write_mesh(mesh, "obj"), format="obj"), mesh)
    if n > 1:
        mesh.vertex_attributes["rgb"][0] = np.nan
        mesh.vertex_attributes = {"rgb": mesh.vertex_attributes["rgb"], "w": np.full(n, np.nan)}
        mesh.vertex_attributes["w"][0] = 2
        mesh.vertex_attributes["w"] = mesh.vertex_attributes["w"].astype(np.float32)
        assert_same(read_mesh(write_mesh(mesh, "obj"), format="obj"), mesh)


@pytest.mark.parametrize(
    ("format", "flavour", "message"),
    [
        ("obj", {}, "OBJ cannot carry vertex attributes: 'a'"),
        ("obj", {}, "OBJ cannot carry face corner attributes: 'c'"),
        ("obj", {}, "OBJ cannot carry elements: 'edge'"),
        ("off", {}, "OFF cannot carry corner attributes: 'c'"),
        ("off", {}, "OFF cannot carry elements: 'edge' (2)"),
        ("stl", {}, "STL cannot carry corner attributes: 'c'"),
        ("stl", {}, "STL cannot carry elements: 'edge' (2)"),
        ("obj", {}, "OBJ cannot carry face attributes: 'b', 'rgb'"),
        ("off", {}, "OFF cannot carry vertex attributes: 'a'"),
        ("off", {}, "OFF cannot carry face attributes: 'b'"),
        ("stl", {}, "binary STL cannot carry vertex attributes: 'a'"),
        ("stl", {}, "binary STL cannot carry face attributes: 'b', 'rgb'"),
        ("stl", {}, "binary STL cannot carry float64: coordinates are rounded to float32"),
        ("stl", {}, "STL cannot carry vertices that no face uses: 1"),
        ("stl", {}, "STL cannot carry vertices that share a position: 1 will be welded"),
        ("stl", {"format": "ascii"}, "ascii STL cannot carry vertex attributes: 'a'"),
        (
            "stl",
            {"format": "ascii"},
            "ascii STL cannot carry float64 where the text says no more than float32",
        ),
    ],
)
def test_what_a_format_cannot_carry_is_named(
    format: str, flavour: dict[str, Any], message: str
) -> None:
    vertices = np.array([[0, 0, 0.1], [1, 0, 0], [0, 1, 0], [1, 0, 0], [9, 9, 9]])
    mesh = Mesh(
        vertices,
        [[0, 1, 2], [0, 2, 3]],
        {"a": np.zeros(5, np.uint8)},
        {"b": np.zeros(2, np.uint8), "rgb": np.zeros((2, 3), np.uint8)},
        {"stl": flavour},
        corner_attributes={"c": np.zeros(6, np.uint8)},
        elements={"edge": rows(2, {})},
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        write_mesh(mesh, format)
    assert message in [str(warning.message) for warning in caught]
    assert {warning.category for warning in caught} == {DroppedWarning}
