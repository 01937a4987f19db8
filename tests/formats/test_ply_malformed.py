"""PLY input that is malformed: an error that names the place, never a crash, hang or huge array.

For every damaged file the reader either raises an EbzError or returns a valid mesh, in time and
memory that are bounded by the size of the file, whatever its header declares.
"""

import tracemalloc
import warnings

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, EbzError, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import read_mesh, write_mesh

HEADER = """\
ply
format {format} 1.0
element vertex 2
property float x
property float y
property float z
element face 1
property list {count} int vertex_indices
end_header
"""
ASCII = HEADER.format(format="ascii", count="uchar")
LITTLE = HEADER.format(format="binary_little_endian", count="uchar").encode()
VERTICES = np.arange(6, dtype="<f4").tobytes()
FACE = b"\x03" + np.array([0, 1, 1], "<i4").tobytes()
GOOD_ASCII = f"{ASCII}0 1 2\n3 4 5\n3 0 1 1\n"


def edited(old: str, new: str) -> bytes:
    assert old in GOOD_ASCII
    return GOOD_ASCII.replace(old, new, 1).encode()


MALFORMED = [
    (b"plx\n", "line 1: expected 'ply'"),
    (b"ply\n", "line 2: early end of file in the header"),
    (b"ply\nend_header\n", "line 2: the header ends without a 'format' line"),
    (
        edited("ascii 1.0", "ascii 2.0"),
        "line 2: expected 'format ascii|binary_little_endian|binary_big_endian 1.0', "
        "found 'format ascii 2.0'",
    ),
    (edited("format ascii 1.0\n", ""), "line 2: expected 'format', found 'element'"),
    (edited("element vertex 2", "format ascii 1.0"), "line 3: a second 'format' line"),
    (edited("vertex 2", "vertex"), "line 3: expected 'element NAME COUNT'"),
    (edited("vertex 2", "vertex -2"), "line 3: expected 'element NAME COUNT'"),
    (edited("vertex 2", "vertex 1_0"), "line 3: expected 'element NAME COUNT'"),
    (edited("vertex 2", "vertex " + "9" * 5000), "line 3: expected 'element NAME COUNT'"),
    (edited("face 1", "vertex 1"), "line 7: a second element 'vertex'"),
    (edited("float x", "real x"), "line 4: 'real' is no type of PLY"),
    (edited("float x", "float"), "line 4: expected 'property TYPE NAME' or "
     "'property list TYPE TYPE NAME'"),
    (edited("float y", "float x"), "line 5: element 'vertex': a second property 'x'"),
    (edited("uchar int", "float int"), "line 8: a list cannot be counted in type 'float'"),
    (edited("element vertex 2", "property int a"), "line 3: a property before any element"),
    (edited("element vertex 2", "elephant 2"), "line 3: 'elephant' is no keyword of a PLY header"),
    (edited("vertex 2", "vertez 2"), "there is no element 'vertex'"),
    (edited("float y", "float t"), "element 'vertex': there is no property 'y'"),
    (edited("float y", "list uchar float y"), "element 'vertex': property 'y' is a list"),
    (edited("vertex_indices", "corners"), "element 'face': there is no property 'vertex_indices'"),
    (
        edited("list uchar int", "int"),
        "element 'face': property 'vertex_indices' is no list of integers",
    ),
    (
        edited("uchar int", "uchar float"),
        "element 'face': property 'vertex_indices' is no list of integers",
    ),
    (
        edited("element face 1", "element tristrips 0\nproperty list int int a\nelement face 1"),
        "element 'tristrips': strips beside faces are not read",
    ),
    (
        edited("face 1", "{}face{1} 1").replace(b"0 1 1", b"0 1 7"),
        "element '{}face{1}': row 0 refers to vertex 7, but there are 2",
    ),
    (edited("0 1 2\n", "0 1\n"), "element 'vertex': row 0: property 'z': early end of line"),
    (edited("3 4 5\n", "3 4 5 6\n"), "element 'vertex': row 1: expected end of line, found '6'"),
    (edited("3 4 5\n", "3 4 x\n"), "element 'vertex': row 1: property 'z': 'x' is no number"),
    (edited("3 4 5\n", "3 4 1_0\n"), "element 'vertex': row 1: property 'z': '1_0' is no number"),
    (edited("3 4 5\n3 0 1 1\n", ""), "element 'vertex': row 1: property 'x': early end of file"),
    (
        edited("3 0 1 1\n", ""),
        "element 'face': row 0: property 'vertex_indices': early end of file",
    ),
    (
        edited("3 0 1 1", "3 0 1"),
        "element 'face': row 0: property 'vertex_indices': early end of line",
    ),
    (
        edited("3 0 1 1", "-1 0 1"),
        "element 'face': row 0: property 'vertex_indices': -1 does not fit 'uchar'",
    ),
    (
        edited("3 0 1 1", "3 0 1 1.5"),
        "element 'face': row 0: property 'vertex_indices': '1.5' is no integer",
    ),
    (
        edited("3 0 1 1", "3 0 1 4294967296"),
        "element 'face': row 0: property 'vertex_indices': 4294967296 does not fit 'int'",
    ),
    (edited("3 0 1 1", "3 0 1 2"), "face 0 refers to vertex 2, but there are 2"),
    (edited("3 0 1 1", "3 0 1 -1"), "face 0 refers to vertex -1, but there are 2"),
    (
        edited("end_header", "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
               "end_header") + b"1 2\n",
        "element 'edge': row 0 refers to vertex 2, but there are 2",
    ),
    (
        edited("end_header", "element grid 2\nproperty list uchar int vertex_indices\n"
               "end_header") + b"0\n1 7\n",
        "element 'grid': row 1 refers to vertex 7, but there are 2",
    ),
    (
        edited("end_header", "element user 9\nend_header"),
        "element 'user': 9 rows without properties",
    ),
    (LITTLE, "element 'vertex': row 0: property 'x': early end of file"),
    (LITTLE + VERTICES[:11], "element 'vertex': row 0: property 'z': early end of file"),
    (LITTLE + VERTICES[:12], "element 'vertex': row 1: property 'x': early end of file"),
    (LITTLE + VERTICES, "element 'face': row 0: property 'vertex_indices': early end of file"),
    (
        LITTLE + VERTICES + FACE[:-1],
        "element 'face': row 0: property 'vertex_indices': early end of file",
    ),
    (
        HEADER.format(format="binary_little_endian", count="char").encode()
        + VERTICES
        + b"\xff"
        + FACE[1:],
        "element 'face': row 0: property 'vertex_indices': a list of -1 entries",
    ),
    (
        LITTLE + VERTICES + b"\x03" + np.array([0, 1, 9], ">i4").tobytes(),
        "face 0 refers to vertex 16777216, but there are 2",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("data", "message"), MALFORMED)
def test_the_error_names_the_place(data: bytes, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(data, format="ply")
    assert str(caught.value) == message


@pytest.mark.parametrize("flavour", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("count", [2**32 - 1, 2**32, 2**63 - 1, 2**63, 2**64])
@pytest.mark.parametrize("element", ["vertex 2", "face 1", "edge 1"])
def test_a_count_beyond_the_file_is_refused_before_it_is_allocated(
    flavour: str, count: int, element: str
) -> None:
    data = tiny_file(flavour)
    if element == "edge 1":
        line = f"element edge {count}\nproperty list int int v\nend_header"
        damaged = data.replace(b"end_header", line.encode())
    else:
        damaged = data.replace(element.encode(), f"{element.split(maxsplit=1)[0]} {count}".encode())
    assert damaged != data
    assert_early_end(damaged)


def tiny_file(flavour: str) -> bytes:
    if flavour == "ascii":
        return GOOD_ASCII.encode()
    order = ">" if "big" in flavour else "<"
    face = b"\x03" + np.array([0, 1, 1], order + "i4").tobytes()
    head = HEADER.format(format=flavour, count="uchar").encode()
    return head + np.arange(6, dtype=order + "f4").tobytes() + face


@pytest.mark.parametrize("count", [2**31 - 1, 2**32 - 1])
@pytest.mark.parametrize("flavour", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_list_longer_than_the_file_is_refused(flavour: str, count: int) -> None:
    data = HEADER.format(format=flavour, count="uint").encode()
    order = "big" if "big" in flavour else "little"
    if flavour == "ascii":
        assert_early_end(data + f"0 1 2\n3 4 5\n{count} 0 1 1\n".encode())
    else:
        assert_early_end(data + VERTICES + count.to_bytes(4, order) + FACE[1:])


def assert_early_end(data: bytes) -> None:
    tracemalloc.start()
    try:
        with pytest.raises(MeshError, match=r"early end of|expected end of"):
            read_mesh(data)
        assert tracemalloc.get_traced_memory()[1] < 1 << 22
    finally:
        tracemalloc.stop()


def test_lists_too_uneven_to_be_padded_are_refused() -> None:
    n, longest = 20000, 20000
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\n"
        "property float y\nproperty float z\nproperty list uint uchar a\nend_header\n"
    )
    row = bytes(12) + (0).to_bytes(4, "little")
    last = bytes(12) + longest.to_bytes(4, "little") + bytes(longest)
    with pytest.raises(MeshError, match="'a': lists of up to 20000 entries are too uneven"):
        read_mesh(head.encode() + row * (n - 1) + last)


def small_file(flavour: str) -> bytes:
    """A tetrahedron with attributes and lists, in a few hundred bytes."""
    mesh = Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]], np.float32),
        np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
        {"red": np.arange(4, dtype=np.uint8)},
        {
            "uv": np.arange(12, dtype=np.float32).reshape(4, 3) * np.array([[1, 1, 0]], np.float32),
            "uv:count": np.array([2, 3, 2, 2], np.uint8),
        },
        {"ply": {"format": flavour, "header": ["comment c"]}},
    )
    mesh.vertices[3] = 0.1
    return write_mesh(mesh, "ply")


@pytest.mark.parametrize("flavour", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("triangulate", [False, True])
def test_every_prefix_is_an_error_or_a_valid_mesh(flavour: str, triangulate: bool) -> None:
    data = small_file(flavour)
    n_read = sum(read_or_refused(data[:end], triangulate=triangulate) for end in range(len(data)))
    # In ascii the last line end, and digits of the last number, may be missing.
    assert n_read <= (3 if flavour == "ascii" else 0)


@pytest.mark.parametrize("flavour", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_every_flipped_bit_is_an_error_or_a_valid_mesh(flavour: str) -> None:
    data = small_file(flavour)
    outcomes = []
    for at in range(len(data)):
        for bit in range(8):
            damaged = bytearray(data)
            damaged[at] ^= 1 << bit
            outcomes.append(read_or_refused(bytes(damaged), triangulate=bool(bit & 1)))
    assert 0 < sum(outcomes) < len(outcomes)


def read_or_refused(data: bytes, *, triangulate: bool) -> bool:
    """Whether the file was read; any error but EbzError, and any invalid mesh, fails."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DroppedWarning)
        try:
            mesh = read_mesh(data, format="ply", triangulate=triangulate)
        except EbzError as error:
            assert str(error)
            return False
    Mesh(**vars(mesh))
    return True
