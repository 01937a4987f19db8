"""PLY: lists by corner, and elements beyond vertices and faces."""

from pathlib import Path

import numpy as np
import pytest

from ebz.codec.elements import Element
from ebz.codec.errors import DroppedWarning
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh
from tests.formats.carried import contents

SAMPLE = Path(__file__).parents[2] / "samples" / "texcoord.ply"
FLAVOURS = ["ascii", "binary_little_endian", "binary_big_endian"]


def in_flavour(mesh: Mesh, flavour: str) -> bytes:
    mesh.metadata.setdefault("ply", {"header": []})["format"] = flavour
    return write_mesh(mesh, "ply")


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_every_element_comes_back_in_every_flavour(flavour: str) -> None:
    mesh = read_mesh(SAMPLE.read_bytes())
    data = in_flavour(mesh, flavour)
    again = read_mesh(data)
    assert contents(again) == contents(mesh)
    assert again.metadata == mesh.metadata
    assert write_mesh(again, "ply") == data
    if flavour == "ascii":
        assert data == SAMPLE.read_bytes()


def test_what_elements_and_lists_become() -> None:
    mesh = read_mesh(SAMPLE.read_bytes())
    assert mesh.corner_attributes["texcoord"][3:].tolist() == [[0, 0], [0.5, 1], [0, 1]]
    assert list(mesh.face_attributes) == ["red", "texnumber"]
    assert mesh.elements["edge"].corners.tolist() == [0, 2, 3, 0]
    assert mesh.elements["edge"].attributes["crease"].tolist() == [1, 0]
    assert mesh.elements["camera"].corners.size == 0
    assert mesh.elements["camera"].attributes["view_pz"].tolist() == [9]


GRID = """\
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element range_grid 4
property list uchar int vertex_indices
element face 3
property list uchar {index} vertex_index
property list uchar short weight
property list uchar uchar color
end_header
0 0 0
1 0 0
0 1 0
0
1 0
1 2
0
4 0 1 2 0 4 1 2 3 4 3 255 0 9
0 0 3 1 2 3
2 0 1 2 5 6 3 4 5 6
"""


@pytest.mark.parametrize("index", ["char", "uchar", "short", "ushort", "int", "uint", "uint32"])
def test_indices_of_every_type_and_faces_of_any_number_of_corners(index: str) -> None:
    data = GRID.format(index=index).encode()
    mesh = read_mesh(data)
    assert mesh.face_offsets is not None and mesh.face_offsets.tolist() == [0, 4, 4, 6]
    assert mesh.corner_attributes["weight"].tolist() == [1, 2, 3, 4, 5, 6]
    assert mesh.face_attributes["color"].tolist() == [[255, 0, 9], [1, 2, 3], [4, 5, 6]]
    assert mesh.elements["range_grid"].offsets.tolist() == [0, 0, 1, 2, 2]
    assert write_mesh(mesh, "ply") == data


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_comment_tells_vectors_of_faces_from_values_of_corners(flavour: str) -> None:
    faces = [[0, 1, 2], [2, 1, 0]]
    mesh = Mesh(
        np.eye(3),
        faces,
        face_attributes={"normal": np.ones((2, 3)), "matrix": np.arange(12.0).reshape(2, 6)},
        corner_attributes={"weight": np.arange(6.0), "uv": np.arange(12.0).reshape(6, 2)},
    )
    data = in_flavour(mesh, flavour)
    assert b"comment ebz: weight of face is per corner\n" in data
    assert b"comment ebz: matrix of face is per row\n" in data
    assert data.count(b"comment ebz: ") == 2
    again = read_mesh(data)
    assert contents(again) == contents(mesh)
    assert not [line for line in again.metadata["ply"]["header"] if line.startswith("comment")]
    assert write_mesh(again, "ply") == data


def test_elements_of_another_format_find_a_form() -> None:
    edge = Element(np.array([0, 2, 4]), np.array([0, 1, 1, 2], np.int32))
    line = Element(np.array([0, 3]), np.array([0, 1, 2], np.int32))
    mesh = Mesh(np.eye(3), [], elements={"edge": edge, "line": line})
    mesh.metadata["ply"] = {"format": "ascii", "header": []}
    data = write_mesh(mesh, "ply")
    assert b"element edge 2\nproperty int vertex1\nproperty int vertex2\n" in data
    assert b"element line 1\nproperty list uchar int vertex_indices\n" in data
    assert contents(read_mesh(data)) == contents(mesh)


def test_lists_longer_than_their_type_counts_get_another() -> None:
    corners = np.zeros(300, np.int32)
    mesh = Mesh(np.zeros((1, 3)), corners, face_offsets=np.array([0, 300]))
    data = write_mesh(mesh, "ply")
    assert b"property list int int vertex_indices\n" in data
    assert contents(read_mesh(data)) == contents(mesh)


@pytest.mark.parametrize("name", ["face", "a b", "tristrips", ""])
def test_elements_without_a_name_in_ply_are_named(name: str) -> None:
    mesh = Mesh(np.eye(3), [], elements={name: Element(np.zeros(2, np.int64))})
    with pytest.warns(DroppedWarning, match="^PLY cannot carry an element named"):
        read_mesh(write_mesh(mesh, "ply"))


def test_rows_without_properties_are_named() -> None:
    mesh = Mesh(np.eye(3), [], elements={"user": Element(np.zeros(3, np.int64))})
    with pytest.warns(DroppedWarning, match="^PLY cannot carry 2 rows without properties: 'user'$"):
        assert read_mesh(write_mesh(mesh, "ply")).elements == {}


def test_corner_names_that_are_taken_are_named() -> None:
    mesh = Mesh(
        np.eye(3),
        [[0, 1, 2]],
        face_attributes={"a": np.zeros(1)},
        corner_attributes={"a": np.zeros(3), "vertex_indices": np.zeros(3)},
    )
    with pytest.warns(DroppedWarning) as warned:
        again = read_mesh(write_mesh(mesh, "ply"))
    assert [str(warning.message) for warning in warned] == [
        "PLY cannot carry face corner attribute 'a' under this name",
        "PLY cannot carry face corner attribute 'vertex_indices' under this name",
    ]
    assert list(again.face_attributes) == ["a"]


@pytest.mark.parametrize("format", ["ascii", "binary_little_endian"])
def test_triangle_strips_become_triangles(format) -> None:
    header = f"ply\nformat {format} 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
    header += "property float z\nelement tristrips 2\nproperty list int int vertex_indices\n"
    points, strips = np.arange(18, dtype="<f4"), [[0, 1, 2, 3, -1, 4, 5], [3, 4, 5]]
    if format == "ascii":
        body = " ".join(f"{x:g}{'' if i % 3 < 2 else chr(10)}" for i, x in enumerate(points))
        body += "".join(" ".join(map(str, [len(row), *row])) + "\n" for row in strips)
        data = (header + "end_header\n" + body).encode()
    else:
        rows = [np.array([len(row), *row], "<i4").tobytes() for row in strips]
        data = (header + "end_header\n").encode() + points.tobytes() + b"".join(rows)
    mesh = read_mesh(data)
    assert mesh.faces.tolist() == [[0, 1, 2], [1, 3, 2], [3, 4, 5]]
    again = read_mesh(write_mesh(mesh, "ply"))
    assert np.array_equal(again.faces, mesh.faces)
    assert again.metadata == mesh.metadata
