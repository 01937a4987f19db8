"""OBJ: corners, statements, lines and points, and where they are written."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from ebz.codec.elements import Element
from ebz.codec.errors import DroppedWarning, EbzError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh
from tests.formats.carried import contents, row_set

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
SAMPLE = Path(__file__).parents[2] / "samples" / "materials.obj"


def obj(text: str) -> Mesh:
    return read_mesh(text.encode(), format="obj")


def body(mesh: Mesh) -> str:
    """The lines that are written behind the vertices."""
    return write_mesh(mesh, "obj").decode().removeprefix(SQUARE)


@pytest.mark.parametrize(
    ("face", "written"),
    [
        ("f 1/2 2/1 3/2", "f 1/1 2/2 3/1"),
        ("f 1//1 2//1 3//-1", "f 1//1 2//1 3//1"),
        ("f 1/-1/1 2/2/1 3/1/1", "f 1/1/1 2/1/1 3/2/1"),
        ("f 1/1/1 2//1 3 4/1", "f 1/1/1 2//1 3 4/1"),
        ("f +1 2.0 3", "f 1 2 3"),
        ("f\t1/1/  2/1 3/1\t#c", "f 1/1 2/1 3/1"),
    ],
)
def test_corners_refer_to_distinct_values_in_order(face: str, written: str) -> None:
    mesh = obj(f"{SQUARE}vt 1 0\nvt 0 0.5\nvn 0 0 1\n{face}\n")
    assert written in write_mesh(mesh, "obj").decode().splitlines()
    assert contents(obj(write_mesh(mesh, "obj").decode())) == contents(mesh)


def test_texture_coordinates_and_normals_belong_to_corners() -> None:
    mesh = obj(f"{SQUARE}vt 1 0\nvt 0 0.5\nvn 0 0 1\nf 1/2/1 2/1 3 4//1\n")
    uv, normal = mesh.corner_attributes["uv"], mesh.corner_attributes["normal"]
    nan = np.nan
    assert np.array_equal(uv, [[0, 0.5], [1, 0], [nan, nan], [nan, nan]], equal_nan=True)
    assert np.array_equal(normal[:, 2], [1, nan, nan, 1], equal_nan=True)
    assert uv.dtype == normal.dtype == np.float32


def test_equal_values_are_written_once() -> None:
    mesh = obj(f"{SQUARE}vt 0 0\nvt 0 0\nvt -0 0\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n")
    assert body(mesh) == "vt 0 0\nvt -0 0\nf 1/1 2/1 3/2\nf 1/1 3/2 4/1\n"


def test_values_that_no_corner_has_are_kept() -> None:
    text = f"{SQUARE}vt 0 0\nvt 5 5\nvt 6 6\nvn 0 0 1\nf 1/1 2/1 3/1\n"
    mesh = obj(text)
    assert mesh.elements["vt"].attributes["uv"].tolist() == [[5, 5], [6, 6]]
    assert mesh.elements["vn"].attributes["normal"].tolist() == [[0, 0, 1]]
    assert write_mesh(mesh, "obj").decode() == text


@pytest.mark.parametrize("faces", ["", "f 1 2 3\n"])
def test_values_beside_vertices_are_theirs(faces: str) -> None:
    rows = "".join(f"vt {i} 0 {i}\n" for i in range(4)) + "vn 0 0 1\n" * 4
    mesh = obj(f"{SQUARE}{rows}{faces}")
    assert mesh.vertex_attributes["normal"].shape == (4, 3)
    assert mesh.vertex_attributes["uv"][3].tolist() == [3, 0, 3]
    assert body(mesh) == f"{rows}{faces}"


def test_texture_coordinates_of_different_length() -> None:
    text = f"{SQUARE}vt 1\nvt 1 2 3\nvt 1 2\nf 1/1 2/2 3/3\n"
    mesh = obj(text)
    assert mesh.corner_attributes["uv"].shape == (3, 3)
    assert write_mesh(mesh, "obj").decode() == text


def test_float64_attributes_that_read_like_float32_are_marked() -> None:
    mesh = obj(f"{SQUARE}vt 0 0.5\nf 1/1 2/1 3/1\n")
    mesh.corner_attributes["uv"] = mesh.corner_attributes["uv"].astype(np.float64)
    data = write_mesh(mesh, "obj")
    assert data.startswith(b"# ebz: float64 uv\n")
    assert read_mesh(data).corner_attributes["uv"].dtype == np.float64
    assert "comments" not in read_mesh(data).metadata.get("obj", {})


def test_statements_are_attributes_with_names() -> None:
    mesh = read_mesh(SAMPLE.read_bytes())
    flavour = mesh.metadata["obj"]
    assert flavour["mtllibs"] == ["paint.mtl"]
    assert flavour["objects"] == ["house"]
    assert flavour["groups"] == ["", "walls", "roof", "cellar"]
    assert flavour["materials"] == ["red paint", "blue#2"]
    assert flavour["smoothing"] == ["off", "1"]
    found = {name: values.tolist() for name, values in mesh.face_attributes.items()}
    assert found == {
        "object": [0, 0, 0],
        "group": [1, 1, 2],
        "material": [0, 1, 0],
        "smoothing": [0, 0, 1],
    }
    line, point = mesh.elements["line"], mesh.elements["point"]
    assert (line.corners.tolist(), line.offsets.tolist()) == ([0, 1, 5, 4, 6], [0, 3, 5])
    assert line.attributes["group"].tolist() == [2, 2]
    assert np.isnan(line.corner_attributes["uv"]).all(axis=1).tolist() == [False] * 3 + [True] * 2
    assert point.attributes["group"].tolist() == [0]
    assert point.attributes["material"].tolist() == [-1]
    again = read_mesh(write_mesh(mesh, "obj"))
    assert again.metadata == mesh.metadata
    assert contents(again) == contents(mesh)


IN_TURN = f"{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nf 2 3 4\nusemtl a\nf 3 4 1\n"
SORTED = f"{SQUARE}usemtl a\nf 1 2 3\nf 3 4 1\nusemtl b\nf 2 3 4\n"


def test_a_file_in_turns_stays_so_as_long_as_its_order_is_kept() -> None:
    mesh = obj(IN_TURN)
    assert mesh.metadata["runs"] == 3
    assert write_mesh(mesh, "obj").decode() == IN_TURN
    assert "runs" not in obj(SORTED).metadata


def test_in_turns_what_stands_before_a_statement_stays_there() -> None:
    text = f"{SQUARE}p 1\n" + IN_TURN.removeprefix(SQUARE) + "l 1 2\n"
    assert write_mesh(obj(text), "obj").decode() == text


def test_faces_in_another_order_are_sorted_by_what_is_in_force() -> None:
    text = SQUARE + "f 4 3 2\ng x\n" + "f 1 2 3\n" * 3 + "g y\n" + "f 2 3 4\n" * 3
    mesh = obj(text)
    order = [4, 1, 0, 5, 2, 6, 3]
    shuffled = Mesh(
        mesh.vertices,
        mesh.faces[order],
        face_attributes={"group": mesh.face_attributes["group"][order]},
        metadata=mesh.metadata,
    )
    assert write_mesh(shuffled, "obj").decode() == text


def test_statements_that_cannot_be_undone_come_after_what_they_do_not_hold_for() -> None:
    text = f"{SQUARE}g b\nf 1 2 3\nl 1 2\no z\ng a\nf 2 3 4\np 1\n"
    mesh = obj(text)
    assert mesh.face_attributes["object"].tolist() == [-1, 0]
    assert write_mesh(mesh, "obj").decode() == text


def test_names_keep_their_order_and_those_without_faces_stay() -> None:
    mesh = obj(f"{SQUARE}g unused\nusemtl late\nusemtl early\nf 1 2 3\n")
    assert mesh.metadata["obj"]["materials"] == ["late", "early"]
    again = obj(write_mesh(mesh, "obj").decode())
    assert again.metadata == mesh.metadata
    assert contents(again) == contents(mesh)
    only = obj(f"{SQUARE}g nothing\n")
    assert body(only) == "g nothing\n"


def test_numbers_without_names_are_names() -> None:
    mesh = Mesh(np.eye(3), [[0, 1, 2]], face_attributes={"group": np.array([7])})
    assert b"g 7\nf 1 2 3\n" in write_mesh(mesh, "obj")


def test_metadata_of_another_kind_does_no_harm() -> None:
    flavour = {"groups": "x", "mtllibs": [3, "a\nb"], "comments": {}}
    mesh = Mesh(np.eye(3), [[0, 1, 2]], face_attributes={"group": np.array([0])})
    mesh.metadata |= {"obj": flavour, "runs": "many"}
    again = read_mesh(write_mesh(mesh, "obj"))
    assert again.metadata["obj"] == {"groups": ["0"], "mtllibs": ["3", "a b"]}


def test_texcoord_of_ply_is_written_as_texture_coordinates() -> None:
    uv = np.array([[0, 0], [1, 0], [0, 1]], np.float32)
    mesh = Mesh(np.eye(3), [[0, 1, 2]], corner_attributes={"texcoord": uv})
    assert read_mesh(write_mesh(mesh, "obj")).corner_attributes["uv"].tolist() == uv.tolist()


def test_triangulate_takes_corners_along() -> None:
    mesh = read_mesh(SAMPLE.read_bytes(), triangulate=True)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 5, 6], [1, 6, 2], [3, 2, 4]]
    assert mesh.face_attributes["material"].tolist() == [0, 0, 1, 1, 0]
    assert mesh.corner_attributes["uv"][3:6].tolist() == [[0, 0], [1, 1], [0, 1]]
    assert len(mesh.elements["line"]) == 2
    with pytest.warns(DroppedWarning, match="^2 faces with fewer than three corners$"):
        mesh = read_mesh(f"{SQUARE}f 1 2\nf 1 2 3\nf\n".encode(), triangulate=True)
    assert mesh.faces.tolist() == [[0, 1, 2]]


def test_what_is_left_out_is_counted() -> None:
    text = f"{SQUARE}vp 0 0\nvp 1 1\ncstype bezier\nhologram 7\nf 1 2 3\n"
    message = "^OBJ: 2 lines of 'vp', 1 lines of 'cstype', 1 lines of 'hologram'$"
    with pytest.warns(DroppedWarning, match=message):
        obj(text)


def test_comments_behind_statements_and_faces_are_kept() -> None:
    mesh = obj(f"{SQUARE}g a#1 # one\nf 1 2 3 # two\n#three\n")
    assert mesh.metadata["obj"]["comments"] == ["one", "two", "three"]
    assert mesh.metadata["obj"]["groups"] == ["a#1"]


def test_faces_of_any_number_of_corners_come_back() -> None:
    mesh = obj(f"{SQUARE}f\nf 1\nf 1 2\nf 1 2 3 4\n")
    assert mesh.face_offsets is not None and mesh.face_offsets.tolist() == [0, 0, 1, 3, 7]
    assert contents(obj(write_mesh(mesh, "obj").decode())) == contents(mesh)


def test_elements_without_a_place_are_named() -> None:
    mesh = obj(f"{SQUARE}l 1 2\n")
    mesh.elements["edge"] = Element(np.array([0, 2]), np.array([0, 1], np.int32))
    mesh.elements["line"].attributes["width"] = np.ones(1)
    with pytest.warns(DroppedWarning) as warned:
        again = read_mesh(write_mesh(mesh, "obj"))
    assert {str(warning.message) for warning in warned} == {
        "OBJ cannot carry line attributes: 'width'",
        "OBJ cannot carry elements: 'edge'",
    }
    assert row_set(again, "line") == [([0, 1],)]


def test_colours_may_have_an_alpha() -> None:
    text = "v 0 0 0 0.5 0 1 0.25\nv 1 0 0 1 1 1\n"
    mesh = obj(text)
    assert mesh.vertex_attributes["rgba"][0].tolist() == [0.5, 0, 1, 0.25]
    assert write_mesh(mesh, "obj").decode() == text


def test_every_prefix_and_a_flipped_bit_of_every_byte_is_an_error_or_comes_back() -> None:
    data = SAMPLE.read_bytes()
    damaged = [data[:end] for end in range(len(data))]
    for at in range(len(data)):
        flipped = bytearray(data)
        flipped[at] ^= 1 << at % 8
        damaged.append(bytes(flipped))
    n_read = 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DroppedWarning)
        for case in damaged:
            try:
                mesh = read_mesh(case, format="obj")
            except EbzError as error:
                assert str(error)
                continue
            again = read_mesh(write_mesh(mesh, "obj"), format="obj")
            assert contents(again) == contents(mesh)
            assert again.metadata == mesh.metadata
            n_read += 1
    assert 0 < n_read < len(damaged)


@pytest.mark.parametrize("end", [b"", b"\n", b"\\", b"\\\n", b" \\\r\n", b"# \\"])
def test_the_last_line_is_read_however_it_ends(end: bytes) -> None:
    assert len(read_mesh(b"v 0 0 0\nv 1 2 3" + end, format="obj").vertices) == 2
