"""OBJ and OFF: what their readers take, keep, name and refuse."""

import warnings

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, EbzError, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
OFF = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"


def obj(text: str) -> Mesh:
    return read_mesh(text.encode(), format="obj")


def off(text: str) -> Mesh:
    return read_mesh(text.encode(), format="off")


@pytest.mark.parametrize(
    "face", ["f 1 2 3", "f -3 -2 -1", "f 1 -2 3", "  f\t1  2 3 \r", "f 1 2 \\\n3", "f 1 2 3 # last"]
)
def test_obj_indices_of_every_form(face: str) -> None:
    assert obj(f"{TRIANGLE}{face}\n").faces.tolist() == [[0, 1, 2]]


def test_obj_negative_indices_count_from_the_face() -> None:
    mesh = obj(f"{TRIANGLE}f -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [1, 2, 3]]


def test_obj_line_numbers_count_continued_lines() -> None:
    with pytest.raises(MeshError, match=r"^line 5: face refers to vertex 9, but there are 3$"):
        obj("v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n9\n")


def test_obj_keeps_comments_w_and_colours() -> None:
    mesh = obj("# one\nv 0 0 0 0.5\n#\nv 1 0 0 1 0 0.25\nv 0 1 0\nf 1 2 3\n# two\n")
    assert mesh.metadata["obj"]["comments"] == ["one", "", "two"]
    w, rgb = mesh.vertex_attributes["w"], mesh.vertex_attributes["rgb"]
    assert np.array_equal(w, [0.5, np.nan, np.nan], equal_nan=True)
    assert np.array_equal(rgb[1], [1, 0, 0.25])
    assert np.isnan(rgb[[0, 2]]).all()
    head = b"# one\n#\n# two\nv 0 0 0 0.5\nv 1 0 0 1 0 0.25\nv 0 1 0\nf 1 2 3\n"
    assert write_mesh(mesh, "obj") == head


COMMENTS = [
    b"caf\xc3\xa9",
    b"caf\xe9",
    b"\xc2\x85 \x0b \x1c\xe2\x80\xa8",
    b"ends \\",
    b"a # b",
    b"",
]


@pytest.mark.parametrize("comment", COMMENTS)
def test_comments_come_back(comment: bytes) -> None:
    for data in (
        b"# %s\n%sf 1 2 3\n" % (comment, TRIANGLE.encode()),
        OFF.encode().replace(b"OFF\n", b"OFF\n# %s\n" % comment),
    ):
        mesh = read_mesh(data)
        format = mesh.metadata["format"]
        assert len(mesh.metadata[format]["comments"]) == 1
        written = write_mesh(mesh, format)
        assert read_mesh(written).metadata == mesh.metadata
        if comment != b"caf\xe9":
            assert written == data.replace(b"# \n", b"#\n")


def test_comments_of_any_kind_are_written_as_one_line() -> None:
    for format in ("obj", "off"):
        mesh = Mesh(np.ones((1, 3), np.float32), [], {}, {}, {format: {"comments": ["a\nv 1", 7]}})
        mesh.metadata[format]["comments"].append("\ud800")
        again = read_mesh(write_mesh(mesh, format))
        assert len(again.vertices) == 1
        assert again.metadata[format]["comments"] == ["a v 1", "7", "?"]


def test_float64_that_reads_like_float32_is_marked() -> None:
    mesh = Mesh(np.array([[0.5, 0.1, 0]]), [])
    assert write_mesh(mesh, "obj") == b"# ebz: float64\nv 0.5 0.1 0\n"
    assert write_mesh(mesh, "off") == b"OFF\n# ebz: float64\n1 0 0\n0.5 0.1 0\n"
    mesh = Mesh(np.array([[0.5, 0.1234567891, 0]]), [])
    assert write_mesh(mesh, "obj") == b"v 0.5 0.1234567891 0\n"


MALFORMED_OBJ = [
    ("", "there is no vertex"),
    ("g a\n", "there is no vertex"),
    ("\x00\x01\n", "line 1: '\\x00\\x01' is no keyword"),
    ("v 0 0\n", "line 1: a vertex has 3, 4, 6 or 7 numbers, not 2"),
    ("\nv 0 0 0 0 0\n", "line 2: a vertex has 3, 4, 6 or 7 numbers, not 5"),
    ("v 0 0 0\nv 0 x 0\n", "line 2: 'x' is no number"),
    ("v 0 0 1_0\n", "line 1: '1_0' is no number"),
    ("vt\nv 0 0 0\n", "line 1: a texture coordinate has 1 to 3 numbers, not 0"),
    ("v 0 0 0\nvt 0 0 0 0\n", "line 2: a texture coordinate has 1 to 3 numbers, not 4"),
    ("v 0 0 0\nvn 0 1\n", "line 2: a normal has 3 numbers, not 2"),
    ("v 0 0 0\nvn 0 1 x\n", "line 2: 'x' is no number"),
    (f"{TRIANGLE}f 1 2 9\n", "line 4: face refers to vertex 9, but there are 3"),
    ("v 0 0 0\nf 1 1 2\n", "line 2: face refers to vertex 2, but there is 1"),
    (f"{TRIANGLE}f 0 1 2\n", "line 4: face refers to vertex 0, but OBJ counts from 1"),
    (f"{TRIANGLE}f 1 2 -4\n", "line 4: face refers to vertex -4, but there are 3"),
    (f"{TRIANGLE}f 1 2 x\n", "line 4: 'x' is no integer"),
    (f"{TRIANGLE}f 1/x 2 3\n", "line 4: '1/x' is no integer"),
    (f"{TRIANGLE}f 1/1 2 3\n", "line 4: face refers to texture coordinate 1, but there are 0"),
    (f"vn 0 0 1\n{TRIANGLE}f 1//-2 2 3\n", "line 5: face refers to normal -2, but there is 1"),
    (f"{TRIANGLE}l 1/0 2\n", "line 4: line refers to texture coordinate 0, but OBJ counts from 1"),
    (f"{TRIANGLE}p 1 4\n", "line 4: point refers to vertex 4, but there are 3"),
    (f"{TRIANGLE}f 1/1/1/1 2 3\n", "line 4: '1/1/1/1' is no corner"),
    (f"{TRIANGLE}f /1 2 3\n", "line 4: '/1' is no corner"),
    (f"{TRIANGLE}f / 2 3\n", "line 4: '/' is no corner"),
    (f"{TRIANGLE}f 1 2 {2**70}\n", "line 4: '1180591620717411303424' is no integer"),
    ("f 1 2 3\n", "line 1: face refers to vertex 1, but there are 0"),
]
MALFORMED_OFF = [
    ("", "there is no OFF header"),
    ("FOO\n", "line 1: expected 'OFF', found 'FOO'"),
    ("4OFF\n", "line 1: only three dimensions are read, not '4OFF'"),
    ("OFF BINARY\n", "line 1: binary OFF is not read"),
    ("OFF\n", "early end of file: the counts are missing"),
    ("OFF\n3\n", "line 2: expected the counts of vertices, faces and edges"),
    ("OFF\n3 -1 0\n", "line 2: expected the counts of vertices, faces and edges"),
    ("OFF\n3 1 0\n0 0 0\n", "vertex 1: early end of file"),
    ("OFF\n1 0 0\n0 0\n", "line 3: vertex 0: early end of file"),
    (OFF[: OFF.index("3 0 1 2")], "face 0: early end of file"),
    (OFF.replace("3 0 1 2", "3 0 1"), "line 6: face 0: early end of file"),
    (OFF.replace("3 0 1 2", "3 0 1 9"), "line 6: face refers to vertex 9, but there are 3"),
    (OFF.replace("3 0 1 2", "-3 0 1 2"), "line 6: a face of -3 corners"),
    (OFF.replace("3 0 1 2", "x 0 1"), "line 6: 'x' is no integer"),
    (OFF.replace("1 0 0\n0 1", "1 0 x\n0 1"), "line 4: 'x' is no number"),
    (OFF.replace("1 0 0\n0 1", "1 0 0 7\n0 1"), "line 4: a vertex of 4 numbers, others have 3"),
    (OFF.replace("OFF", "NOFF"), "vertex 2: early end of file"),
    ("COFF\n1 0 0\n0 0 0 1 2 3 4 5\n", "line 3: a vertex of 8 numbers does not suit the header"),
    (OFF.replace("3 0 1 2", "3 0 1 2 1 2 3 4 5"), "line 6: 5 numbers behind the corners"),
    (OFF.replace("3 1 0", f"{2**63} 1 0"), "vertex 4: early end of file"),
    (OFF.replace("3 1 0", f"3 {2**63} 0"), "face 1: early end of file"),
    (OFF.replace("3 0 1 2", f"{2**63 - 1} 0 1"), "line 6: face 0: early end of file"),
]


@pytest.mark.parametrize(("text", "message"), MALFORMED_OBJ)
def test_obj_errors_name_the_line(text: str, message: str) -> None:
    with warnings.catch_warnings(), pytest.raises(MeshError) as caught:
        warnings.simplefilter("ignore", DroppedWarning)
        obj(text)
    assert str(caught.value) == message


@pytest.mark.parametrize(("text", "message"), MALFORMED_OFF)
def test_off_errors_name_the_line(text: str, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        off(text)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    "text",
    [
        OFF,
        OFF.replace("OFF\n3", "OFF 3"),
        OFF.replace("OFF\n", "# head\nOFF # tail\n\n"),
        OFF.replace("3 1 0\n", "3 1\n"),
        OFF.replace("OFF\n", ""),
        OFF.replace("\n", "\r\n"),
        OFF.replace("3 0 1 2", "3 0 \n\n1\n 2"),
        OFF.removesuffix("\n"),
    ],
)
def test_off_layouts(text: str) -> None:
    mesh = off(text)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2]]


def test_off_colours_by_header_or_by_number() -> None:
    for keyword in ("COFF", "OFF"):
        mesh = off(f"{keyword}\n2 0 0\n0 0 0 255 0 1 9\n1 0 0 2 3 4 5\n")
        assert mesh.vertex_attributes["rgba"].dtype == np.uint8
        assert mesh.vertex_attributes["rgba"].tolist() == [[255, 0, 1, 9], [2, 3, 4, 5]]
    mesh = off("STCNOFF\n1 0 0\n0 0 0  0 0 1  0.5 1 0  0.25 0.75\n")
    assert mesh.vertex_attributes["normal"].tolist() == [[0, 0, 1]]
    assert mesh.vertex_attributes["rgb"].tolist() == [[0.5, 1, 0]]
    assert mesh.vertex_attributes["st"].tolist() == [[0.25, 0.75]]


@pytest.mark.parametrize(
    ("colors", "name", "expected"),
    [
        (["7", "8"], "colormap", [7, 8]),
        (["1 2 3", "4 5 6"], "rgb", [[1, 2, 3], [4, 5, 6]]),
        (["1 2 3 4", "4 5 6 7"], "rgba", [[1, 2, 3, 4], [4, 5, 6, 7]]),
        (["", "4 5 6"], "color", [[0, 0, 0, 0], [4, 5, 6, 0]]),
    ],
)
def test_off_face_colours_come_back(colors: list[str], name: str, expected: list[int]) -> None:
    head = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n"
    text = head + "".join(f"3 0 1 2 {color}".rstrip() + "\n" for color in colors)
    mesh = off(text)
    assert mesh.face_attributes[name].tolist() == expected
    assert write_mesh(mesh, "off") == text.encode()


def test_off_polygons_are_fanned_with_their_colours() -> None:
    text = OFF.replace("3 0 1 2", "4 0 1 2 0 9 9 9")
    mesh = read_mesh(text.encode(), triangulate=True)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 0]]
    assert mesh.face_attributes["rgb"].tolist() == [[9, 9, 9], [9, 9, 9]]


@pytest.mark.parametrize("format", ["obj", "off"])
def test_every_prefix_and_flipped_bit_is_an_error_or_a_valid_mesh(format: str) -> None:
    mesh = Mesh(np.array([[0, 0, 0.1], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]])
    data = write_mesh(mesh, format)
    damaged = [data[:end] for end in range(len(data))]
    for at in range(len(data)):
        for bit in range(8):
            flipped = bytearray(data)
            flipped[at] ^= 1 << bit
            damaged.append(bytes(flipped))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DroppedWarning)
        for case in damaged:
            try:
                found = read_mesh(case, format=format, triangulate=True)
            except EbzError as error:
                assert str(error)
            else:
                Mesh(**vars(found))
