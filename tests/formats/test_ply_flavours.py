"""PLY: every flavour is read, and canonical files come back byte for byte."""

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh

FORMATS = ["ascii", "binary_little_endian", "binary_big_endian"]

ASCII_FILES = {
    "plain": """\
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0.1
1 0 -0
0 1e-10 1.1754944e-38
3 0 1 2
""",
    "comments between all lines": """\
ply
format ascii 1.0
comment  two spaces kept 
obj_info num_cols 512
element vertex 1
comment inside
property double z
property double y
property double x
comment caf\u00e9
element face 0
property list uchar int vertex_index
comment at the end
end_header
0.1 0.2 0.30000000000000004
""",
    "every type name": """\
ply
format ascii 1.0
element vertex 2
property char a
property uchar b
property short c
property ushort d
property int e
property uint f
property float g
property double h
property float32 x
property float32 y
property float32 z
property int8 i
property uint8 j
property int16 k
property uint16 l
property int32 m
property uint32 n
property float64 o
element face 1
property uchar red
property list uint8 uint32 vertex_indices
property double quality
end_header
-128 255 -32768 65535 -2147483648 4294967295 0.1 0.1 1 2 3 -1 1 -1 1 -1 1 nan
127 0 32767 0 2147483647 0 inf -inf 4 5 6 1 1 1 1 1 1 -nan
9 3 0 1 0 0.5
""",
    "lists": """\
ply
format ascii 1.0
element vertex 2
property list uchar float even
property float x
property float y
property float z
property list ushort short ragged
element face 2
property list uchar int vertex_indices
property list uchar float texcoord
property list int double weights
end_header
2 0.5 1.5 1 2 3 0
2 2.5 3.5 4 5 6 3 1 -2 0
3 0 1 1 6 1 2 3 4 5 6 1 0.1
3 1 0 0 6 6 5 4 3 2 1 2 0.2 0.3
""",
    "faces before vertices": """\
ply
format ascii 1.0
element face 1
property list uchar int vertex_indices
element vertex 3
property float x
property float y
property float z
end_header
3 2 1 0
0 0 0
1 0 0
0 1 0
""",
    "no faces": """\
ply
format ascii 1.0
element vertex 1
property float x
property float y
property float z
end_header
1 2 3
""",
    "coordinates of other types": """\
ply
format ascii 1.0
element vertex 2
property int x
property float y
property double z
end_header
-7 0.1 0.1
8 0.2 1e+300
""",
    "float with more digits than a float32": """\
ply
format ascii 1.0
element vertex 2
property float x
property float y
property float z
property float quality
end_header
24.1234567 0.1 0.2
1 2 3 0.12345678901
""".replace("0.1 0.2\n", "0.1 0.2 0.25\n"),
    "nothing": """\
ply
format ascii 1.0
element vertex 0
property float x
property float y
property float z
element face 0
property list uchar int vertex_indices
end_header
""",
}


# Text says more than float there; in binary the type has to say it.
WIDER_IN_BINARY = ("float with more digits than a float32", "coordinates of other types")


@pytest.mark.parametrize("name", ASCII_FILES)
def test_canonical_ascii_comes_back_byte_for_byte(name: str) -> None:
    data = ASCII_FILES[name].encode()
    mesh = read_mesh(data)
    assert write_mesh(mesh, "ply") == data


@pytest.mark.parametrize("name", ASCII_FILES)
@pytest.mark.parametrize("flavour", FORMATS[1:])
def test_canonical_binary_comes_back_byte_for_byte(name: str, flavour: str) -> None:
    mesh = read_mesh(ASCII_FILES[name].encode())
    mesh.metadata["ply"]["format"] = flavour
    data = write_mesh(mesh, "ply")
    again = read_mesh(data)
    assert write_mesh(again, "ply") == data
    assert_same(again, mesh, header=name not in WIDER_IN_BINARY)


def assert_same(a: Mesh, b: Mesh, *, header: bool = True) -> None:
    assert a.vertices.dtype == b.vertices.dtype
    assert a.vertices.tobytes() == b.vertices.tobytes()
    assert a.faces.tobytes() == b.faces.tobytes()
    assert a.offsets.tobytes() == b.offsets.tobytes()
    for ours, theirs in (
        (a.vertex_attributes, b.vertex_attributes),
        (a.face_attributes, b.face_attributes),
        (a.corner_attributes, b.corner_attributes),
    ):
        assert ours.keys() == theirs.keys()
        for name, values in ours.items():
            assert values.dtype == theirs[name].dtype
            assert values.shape == theirs[name].shape
            assert values.tobytes() == theirs[name].tobytes()
    if header:
        assert a.metadata == b.metadata


@pytest.mark.parametrize("newline", ["\r\n", "\r"])
def test_other_line_ends_come_back(newline: str) -> None:
    data = ASCII_FILES["plain"].replace("\n", newline).encode()
    mesh = read_mesh(data)
    assert mesh.metadata["ply"]["newline"] == newline
    assert write_mesh(mesh, "ply") == data


def test_comments_that_are_not_utf8_come_back() -> None:
    data = ASCII_FILES["no faces"].encode().replace(b"element", b"comment \xff\xe9\nelement", 1)
    mesh = read_mesh(data)
    assert b"comment \xff\xe9" in mesh.metadata["ply"]["header"]
    assert write_mesh(mesh, "ply") == data


def test_properties_become_attributes_of_their_type() -> None:
    mesh = read_mesh(ASCII_FILES["every type name"].encode())
    codes = ["i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8"]
    assert list(mesh.vertex_attributes) == list("abcdefghijklmno")
    assert [values.dtype for values in mesh.vertex_attributes.values()] == [
        *codes,
        *codes[:6],
        codes[7],
    ]
    assert mesh.vertices.dtype == np.float32
    assert mesh.face_attributes["red"].tolist() == [9]
    assert mesh.face_attributes["quality"].tolist() == [0.5]


def test_lists_become_tables_padded_where_ragged() -> None:
    mesh = read_mesh(ASCII_FILES["lists"].encode())
    assert mesh.vertex_attributes["even"].tolist() == [[0.5, 1.5], [2.5, 3.5]]
    assert mesh.vertex_attributes["ragged"].tolist() == [[0, 0, 0], [1, -2, 0]]
    assert mesh.vertex_attributes["ragged:count"].tolist() == [0, 3]
    assert mesh.vertex_attributes["ragged:count"].dtype == np.uint16
    assert mesh.corner_attributes["texcoord"][[0, 5]].tolist() == [[1, 2], [2, 1]]
    assert mesh.face_attributes["weights"].tolist() == [[0.1, 0.0], [0.2, 0.3]]
    assert mesh.faces.tolist() == [[0, 1, 1], [1, 0, 0]]


def test_coordinates_of_mixed_types_become_float64() -> None:
    mesh = read_mesh(ASCII_FILES["coordinates of other types"].encode())
    assert mesh.vertices.dtype == np.float64
    assert mesh.vertices.tolist() == [[-7, 0.1, 0.1], [8, 0.2, 1e300]]


def test_coordinates_that_no_longer_fit_their_type_get_a_wider_one() -> None:
    mesh = read_mesh(ASCII_FILES["coordinates of other types"].encode())
    mesh.vertices[0, 0] = 0.5
    again = read_mesh(write_mesh(mesh, "ply"))
    assert again.vertices.tolist() == mesh.vertices.tolist()
    assert "property double x" in again.metadata["ply"]["header"]


def test_float_of_too_many_digits_loses_none() -> None:
    mesh = read_mesh(ASCII_FILES["float with more digits than a float32"].encode())
    assert mesh.vertices.dtype == np.float64
    assert mesh.vertices[0].tolist() == [24.1234567, 0.1, 0.2]
    assert mesh.vertex_attributes["quality"].dtype == np.float64


@pytest.mark.parametrize("flavour", FORMATS)
def test_a_float64_mesh_stays_one_in_a_float_flavour(flavour: str) -> None:
    mesh = read_mesh(ASCII_FILES["plain"].encode())
    mesh.metadata["ply"]["format"] = flavour
    wide = Mesh(mesh.vertices.astype(np.float64), mesh.faces, {}, {}, mesh.metadata)
    again = read_mesh(write_mesh(wide, "ply"))
    assert again.vertices.dtype == np.float64
    assert again.vertices.tobytes() == wide.vertices.tobytes()


def test_blank_lines_in_the_body_are_passed_over() -> None:
    data = ASCII_FILES["plain"].encode().replace(b"1 0 -0\n", b"\n1 0 -0\n \n")
    assert_same(read_mesh(data), read_mesh(ASCII_FILES["plain"].encode()))


@pytest.mark.parametrize(("extra", "what"), [(b"1 2\n\n3\n", "2 lines"), (b"\n\n", None)])
def test_lines_behind_the_last_element_are_a_warning(extra: bytes, what: str | None) -> None:
    data = ASCII_FILES["plain"].encode() + extra
    if what is None:
        read_mesh(data)
    else:
        with pytest.warns(DroppedWarning, match=f"^{what} behind the last element$"):
            read_mesh(data)


def test_bytes_behind_the_last_element_are_a_warning() -> None:
    mesh = Mesh(np.zeros((1, 3), np.float32), [])
    with pytest.warns(DroppedWarning, match="^3 bytes behind the last element$"):
        read_mesh(write_mesh(mesh, "ply") + b"abc")


POLYGONS = """\
ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element face 3
property list uchar int vertex_indices
property uchar red
end_header
0 0 0
1 0 0
1 1 0
0 1 0
0 2 0
3 0 1 2 7
5 0 1 2 3 4 8
4 3 2 1 0 9
"""


@pytest.mark.parametrize("flavour", FORMATS)
def test_polygons_are_kept_or_fanned_with_their_attributes(flavour: str) -> None:
    data = polygons(flavour)
    mesh = read_mesh(data, triangulate=True)
    fans = [[0, 1, 2], [0, 1, 2], [0, 2, 3], [0, 3, 4], [3, 2, 1], [3, 1, 0]]
    assert mesh.faces.tolist() == fans
    assert mesh.face_attributes["red"].tolist() == [7, 8, 8, 8, 9, 9]
    mesh = read_mesh(data)
    assert mesh.faces.tolist() == [0, 1, 2, 0, 1, 2, 3, 4, 3, 2, 1, 0]
    assert mesh.face_offsets is not None and mesh.face_offsets.tolist() == [0, 3, 8, 12]
    assert write_mesh(mesh, "ply") == data


def polygons(flavour: str) -> bytes:
    if flavour == "ascii":
        return POLYGONS.encode()
    order = "<" if "little" in flavour else ">"
    head, body = POLYGONS.encode().split(b"end_header\n")
    rows = [line.split() for line in body.splitlines()]
    parts = [np.array(row, order + "f4").tobytes() for row in rows[:5]]
    for row in rows[5:]:
        parts += [bytes([int(row[0])]), np.array(row[1:-1], order + "i4").tobytes()]
        parts.append(bytes([int(row[-1])]))
    return head.replace(b"ascii", flavour.encode()) + b"end_header\n" + b"".join(parts)


def test_attributes_without_a_ply_type_are_converted_or_named() -> None:
    vertices = np.zeros((2, 3), np.float32)
    attributes = {
        "flag": np.array([True, False]),
        "id": np.array([1, 2**31], np.int64),
        "huge": np.array([1, 2**63 + 1], np.uint64),
        "half": np.array([0.5, 2], np.float16),
        "has space": np.zeros(2, np.uint8),
        "x": np.zeros(2, np.uint8),
    }
    with pytest.warns(DroppedWarning) as warned:
        data = write_mesh(Mesh(vertices, [], attributes), "ply")
    assert [str(warning.message) for warning in warned] == [
        "PLY has no type for vertex attribute 'huge' of uint64",
        "PLY cannot carry vertex attribute 'has space' under this name",
        "PLY cannot carry vertex attribute 'x' under this name",
    ]
    again = read_mesh(data).vertex_attributes
    assert [(name, again[name].dtype, again[name].tolist()) for name in again] == [
        ("flag", np.uint8, [1, 0]),
        ("id", np.uint32, [1, 2**31]),
        ("half", np.float32, [0.5, 2]),
    ]


def test_a_count_that_does_not_describe_its_table_is_an_attribute_of_its_own() -> None:
    table = np.arange(6, dtype=np.int32).reshape(2, 3)
    attributes = {"t": table, "t:count": np.array([1, 3], np.uint8)}
    again = read_mesh(write_mesh(Mesh(np.zeros((2, 3)), [], attributes), "ply"))
    assert again.vertex_attributes["t"].tolist() == table.tolist()
    assert again.vertex_attributes["t:count"].tolist() == [1, 3]


def test_names_that_a_header_line_cannot_hold_are_named() -> None:
    attributes = dict.fromkeys(("", "a\nb", "\ud800", "a\xa0b"), np.zeros(1, np.uint8))
    with pytest.warns(DroppedWarning) as warned:
        data = write_mesh(Mesh(np.zeros((1, 3)), [], attributes), "ply")
    assert len(warned) == 3
    mesh = read_mesh(data)
    assert list(mesh.vertex_attributes) == ["a\xa0b"]
    assert write_mesh(mesh, "ply") == data


@pytest.mark.parametrize("flavour", [None, [], {}, {"format": "ascii", "header": ["property"]}])
def test_metadata_that_is_no_header_is_refused(flavour: object) -> None:
    mesh = Mesh(np.zeros((1, 3)), [], {}, {}, {"ply": flavour})
    with pytest.raises(MeshError, match=r"^metadata 'ply' is no PLY header: "):
        write_mesh(mesh, "ply")
