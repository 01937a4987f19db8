"""read and write: paths and files, mesh formats and .ebz, and errors that name the file."""

import array
import io
import mmap
from pathlib import Path

import numpy as np
import pytest

import ebz
from tests.connectivity_check import same_mesh

MESH = ebz.Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.1]]), [[0, 1, 2], [0, 2, 3]])
DATA = ebz.compress(MESH)
FORMATS = ["ply", "obj", "off", "ebz"]


class Fspath:
    """A path that is neither str nor Path."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __fspath__(self) -> str:
        return str(self.path)


@pytest.mark.parametrize("kind", [str, Path, Fspath])
@pytest.mark.parametrize("suffix", FORMATS)
def test_paths_of_any_kind_are_read_and_written(tmp_path, suffix, kind):
    path = kind(tmp_path / f"mesh.{suffix}")
    ebz.write(path, MESH)
    assert same_mesh(MESH, ebz.read(path))


@pytest.mark.parametrize("format", FORMATS)
def test_file_objects_are_read_and_written(format):
    file = io.BytesIO()
    ebz.write(file, MESH, format=format)
    assert not file.closed
    file.seek(0)
    assert same_mesh(MESH, ebz.read(file))


def test_open_files_know_their_format_by_name(tmp_path):
    path = tmp_path / "mesh.off"
    with path.open("wb") as file:
        ebz.write(file, MESH)
    assert path.read_bytes().startswith(b"OFF")
    with path.open("rb") as file:
        assert same_mesh(MESH, ebz.read(file))


def test_content_decides_before_the_suffix(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_bytes(DATA)
    assert same_mesh(MESH, ebz.read(path))


def test_what_is_written_to_ebz_is_what_compress_gives(tmp_path):
    ebz.write(tmp_path / "mesh.ebz", MESH)
    assert (tmp_path / "mesh.ebz").read_bytes() == DATA


def test_a_format_that_is_given_wins_over_the_suffix(tmp_path):
    ebz.write(tmp_path / "mesh.ply", MESH, format="off")
    assert (tmp_path / "mesh.ply").read_bytes().startswith(b"OFF")


BYTES_LIKE = {
    "bytes": bytes,
    "bytearray": bytearray,
    "memoryview": memoryview,
    "wide memoryview": lambda data: memoryview(array.array("H", data + data[len(data) :])),
    "strided memoryview": lambda data: memoryview(np.repeat(np.frombuffer(data, np.uint8), 2))[::2],
    "array": lambda data: array.array("B", data),
    "numpy uint8": lambda data: np.frombuffer(data, np.uint8),
    "numpy int8": lambda data: np.frombuffer(data, np.int8),
    "numpy column": lambda data: np.frombuffer(data, np.uint8).reshape(-1, 1),
}


def even(data: bytes) -> bytes:
    """The same mesh in an even number of bytes."""
    for length in range(2):
        mesh = ebz.Mesh(MESH.vertices, MESH.faces, metadata={"pad": "x" * length})
        if len(data := ebz.compress(mesh)) % 2 == 0:
            return data
    raise AssertionError("one of two lengths is even")


@pytest.mark.parametrize("kind", BYTES_LIKE)
def test_anything_bytes_like_is_accepted(kind):
    data = BYTES_LIKE[kind](even(DATA))
    assert same_mesh(MESH, ebz.decompress(data))
    assert ebz.verify(data).equal


def test_a_mapped_file_is_accepted(tmp_path):
    path = tmp_path / "mesh.ebz"
    path.write_bytes(DATA)
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as mapped:
        assert same_mesh(MESH, ebz.decompress(mapped))


@pytest.mark.parametrize("empty", [b"", memoryview(b""), np.zeros(0, np.uint8)], ids=type)
def test_no_bytes_are_no_file(empty):
    with pytest.raises(ebz.NotEbzError, match="it is empty"):
        ebz.decompress(empty)


def test_decoded_arrays_can_be_changed():
    mesh = ebz.decompress(ebz.compress(ebz.Mesh(MESH.vertices, MESH.faces, {"a": np.arange(4)})))
    for values in (mesh.vertices, mesh.faces, mesh.vertex_attributes["a"]):
        values[0] = 1


@pytest.mark.parametrize(
    ("name", "content", "error", "message"),
    [
        ("a.ebz", DATA[:-1], ebz.TruncatedError, "the file ends 1 bytes too early"),
        ("a.ebz", DATA + b"\0", ebz.CorruptError, "1 bytes after the end chunk"),
        ("a.ebz", DATA[:8] + b"\x07" + DATA[9:], ebz.VersionError, "format version 7"),
        ("a.ply", b"ply\nformat ascii 1.0\n", ebz.MeshError, ""),
        ("a.xyz", b"what is this", ebz.EbzError, ""),
    ],
    ids=["truncated", "extra byte", "version", "header", "unknown"],
)
def test_errors_carry_the_name_of_the_file(tmp_path, name, content, error, message):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(error) as raised:
        ebz.read(path)
    assert raised.value.source == str(path)
    assert str(raised.value).startswith(f"{path}: ")
    assert message in str(raised.value)


def test_errors_without_a_file_have_no_source():
    with pytest.raises(ebz.TruncatedError) as raised:
        ebz.read(io.BytesIO(DATA[:-1]))
    assert raised.value.source is None


def test_a_missing_file_is_an_os_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        ebz.read(tmp_path / "none.ply")


@pytest.mark.parametrize("call", [ebz.decompress, ebz.stats, ebz.verify])
def test_the_memory_limit_holds_in_every_call(call):
    with pytest.raises(ebz.MemoryLimitError, match="past the limit of 100"):
        call(DATA, memory_limit=100)


def test_the_memory_limit_holds_for_files(tmp_path):
    (tmp_path / "mesh.ebz").write_bytes(DATA)
    with pytest.raises(ebz.MemoryLimitError, match=r"mesh\.ebz: decoding takes up to"):
        ebz.read(tmp_path / "mesh.ebz", memory_limit=100)
