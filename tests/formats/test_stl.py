"""STL: welding, both encodings, and what of their flavour is kept."""

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, EbzError, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh
from ebz.formats.stl.reader import FACET
from ebz.formats.weld import weld

FACET_TEXT = """\
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 1 0 0
  vertex 0 1 0
 endloop
endfacet
"""
ASCII = f"solid a name\n{FACET_TEXT}endsolid a name\n"


def binary(n: int = 2, header: bytes = b"") -> bytes:
    table = np.zeros(n, FACET)
    rng = np.random.default_rng(1)
    table["corners"] = rng.integers(0, 3, (n, 3, 3))
    return header.ljust(80, b"\0") + n.to_bytes(4, "little") + table.tobytes()


def test_weld_numbers_positions_in_order_of_first_use() -> None:
    corners = np.array([[5, 0, 0], [1, 0, 0], [5, 0, 0], [0, 0, 0], [1, 0, 0]], np.float32)
    vertices, index = weld(corners)
    assert vertices.tolist() == [[5, 0, 0], [1, 0, 0], [0, 0, 0]]
    assert index.tolist() == [0, 1, 0, 2, 1]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weld_goes_by_bits(dtype: type) -> None:
    corners = np.array([[0, 0, 0], [-0.0, 0, 0], [np.nan, 0, 0], [np.nan, 0, 0]], dtype)
    vertices, index = weld(corners)
    assert index.tolist() == [0, 1, 2, 2]
    assert vertices.tobytes() == corners[:3].tobytes()


def test_weld_is_exact_where_hashes_collide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ebz.formats.weld._MULTIPLIERS", np.zeros(3, np.uint64))
    corners = np.array([[2, 0, 0], [1, 0, 0], [2, 0, 0]], np.float32)
    vertices, index = weld(corners)
    assert vertices.tolist() == [[2, 0, 0], [1, 0, 0]]
    assert index.tolist() == [0, 1, 0]


def test_binary_that_begins_with_solid_is_told_by_its_size() -> None:
    data = binary(header=b"solid but binary")
    mesh = read_mesh(data)
    assert len(mesh.faces) == 2
    assert mesh.metadata["stl"] == {"format": "binary", "header": data[:80]}
    assert write_mesh(mesh, "stl")[:84] == data[:84]


def test_attribute_bytes_are_kept() -> None:
    table = np.frombuffer(binary()[84:], FACET).copy()
    table["attribute"] = [0, 0x7C1F]
    data = binary()[:84] + table.tobytes()
    mesh = read_mesh(data)
    assert mesh.face_attributes["attribute_byte_count"].tolist() == [0, 0x7C1F]
    assert read_mesh(write_mesh(mesh, "stl")).face_attributes["attribute_byte_count"].any()


def test_ascii_comes_back_with_its_name() -> None:
    mesh = read_mesh(ASCII.encode())
    assert mesh.metadata["stl"] == {"format": "ascii", "names": ["a name"]}
    assert write_mesh(mesh, "stl") == ASCII.encode()


def test_several_solids_come_back_with_their_names() -> None:
    text = f"solid a\n{FACET_TEXT}{FACET_TEXT}endsolid a\nsolid\nendsolid\n"
    text += f"solid c\n{FACET_TEXT}endsolid c\n"
    mesh = read_mesh(text.encode())
    assert mesh.metadata["stl"]["names"] == ["a", "", "c"]
    assert mesh.face_attributes["solid"].tolist() == [0, 0, 2]
    assert write_mesh(mesh, "stl") == text.encode()


def test_ascii_in_capitals_and_other_line_ends_is_read() -> None:
    for text in (ASCII.upper(), ASCII.replace("\n", "\r\n"), ASCII.replace("\n", "\r")):
        assert read_mesh(text.encode()).faces.tolist() == [[0, 1, 2]]


def test_ascii_longer_than_a_block_is_read() -> None:
    n = 12000
    mesh = read_mesh(f"solid\n{FACET_TEXT * n}endsolid\n".encode())
    assert len(mesh.faces) == n
    damaged = f"solid\n{FACET_TEXT * n}{FACET_TEXT.replace('0 1 0', '0 x 0')}endsolid\n"
    with pytest.raises(MeshError, match=rf"^line {2 + 7 * n + 4}: facet {n}: 'x' is no number$"):
        read_mesh(damaged.encode())


@pytest.mark.parametrize("normal", ["0 0 1", "0 0 0", "0 0.001 7", "0 0.005 1"])
def test_normals_that_follow_from_the_corners_are_dropped(normal: str) -> None:
    mesh = read_mesh(ASCII.replace("normal 0 0 1", f"normal {normal}").encode())
    assert mesh.face_attributes == {}


@pytest.mark.parametrize("normal", ["0 0 -1", "1 0 0", "0 0.1 1"])
def test_normals_that_say_anything_else_are_kept(normal: str) -> None:
    text = ASCII.replace("normal 0 0 1", f"normal {normal}")
    mesh = read_mesh(text.encode())
    assert "normal" in mesh.face_attributes
    assert write_mesh(mesh, "stl") == text.encode()


def test_written_normals_are_the_facets() -> None:
    vertices = np.array([[0, 0, 0], [2, 0, 0], [0, 0, 2], [4, 0, 0]], np.float32)
    data = write_mesh(Mesh(vertices, [[0, 1, 2], [0, 1, 3]]), "stl")
    normals = np.frombuffer(data[84:], FACET)["normal"]
    assert normals.tolist() == [[0, -1, 0], [0, 0, 0]]


MALFORMED = [
    (b"", "early end of file: a binary STL has a header of 84 bytes"),
    (binary()[:83], "early end of file: a binary STL has a header of 84 bytes"),
    (binary()[:-1], "facet 1: early end of file, 2 facets were declared"),
    (
        binary()[:80] + b"\xff" * 4,
        "facet 0: early end of file, 4294967295 facets were declared",
    ),
    (b"solid\n", "line 2: early end of file, expected 'endsolid'"),
    (b"solid\nsolid\n", "line 2: 'solid' inside a solid"),
    (b"solid\nendsolid\nendsolid\n", "line 3: 'endsolid' outside a solid"),
    (ASCII.replace("vertex 1", "vertx 1").encode(),
     "line 5: facet 0: expected 'vertex', found 'vertx'"),
    (ASCII.replace(" endloop", "  vertex 1 1 0\n endloop").encode(),
     "line 7: facet 0: expected 'endloop', found 'vertex'"),
    (ASCII.replace("1 0 0", "1 0 x").encode(), "line 5: facet 0: 'x' is no number"),
    (ASCII.replace("endfacet\n", "").encode(), "line 8: facet 0: early end of solid"),
]  # fmt: skip


@pytest.mark.parametrize(("data", "message"), MALFORMED)
def test_errors_name_facet_and_line(data: bytes, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(data, format="stl")
    assert str(caught.value) == message


def test_bytes_behind_the_last_facet_are_a_warning() -> None:
    with pytest.warns(DroppedWarning, match=r"^3 bytes behind the last facet$"):
        read_mesh(binary() + b"abc", format="stl")


@pytest.mark.filterwarnings("ignore::ebz.codec.errors.DroppedWarning")
@pytest.mark.parametrize("data", [binary(), ASCII.encode()])
def test_every_prefix_and_flipped_bit_is_an_error_or_a_valid_mesh(data: bytes) -> None:
    damaged = [data[:end] for end in range(len(data))]
    for at in range(len(data)):
        for bit in range(8):
            flipped = bytearray(data)
            flipped[at] ^= 1 << bit
            damaged.append(bytes(flipped))
    for case in damaged:
        try:
            found = read_mesh(case, format="stl")
        except EbzError as error:
            assert str(error)
        else:
            Mesh(**vars(found))
