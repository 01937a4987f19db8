"""Formats are told by content, else by name."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ebz.codec.errors import MeshError, OptionError
from ebz.codec.mesh import Mesh
from ebz.formats.detect import format_of, format_of_content
from ebz.formats.meshes import FORMATS, format_of_suffix, read_mesh, suffix_of, write_mesh

MESH = Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), [[0, 1, 2]])
NATIVE = ["ply", "obj", "off", "stl"]


@pytest.mark.parametrize("format", NATIVE)
def test_what_is_written_is_recognised(format: str) -> None:
    assert format_of_content(write_mesh(MESH, format)) == format


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"ply\nformat", "ply"),
        (b"ply\r\nformat", "ply"),
        (b"glTF\x02\0\0\0", "glb"),
        (b'{"asset": {"version": "2.0"}}', "gltf"),
        (b'\n{\n  "asset" : {}\n}', "gltf"),
        (b"# comment\n\nOFF\n", "off"),
        (b"STCNOFF 3 1 0\n", "off"),
        (b"\xef\xbb\xbfOFF\n", "off"),
        (b"solid name\nfacet", "stl"),
        (b"\n# Blender\nmtllib a.mtl\nv 0 0 0\n", "obj"),
        (b"v 0 0 0\n", "obj"),
        (b"# only a comment\n", None),
        (b"plywood\n", None),
        (b"\x00\x01\x02", None),
        (b"hello world\n", None),
    ],
)
def test_content_is_recognised(data: bytes, expected: str | None) -> None:
    assert format_of_content(data) == expected


def test_content_goes_before_the_name() -> None:
    assert format_of(b"ply\n", "mesh.obj") == "ply"
    assert format_of(b"# only a comment\n", "mesh.OBJ") == "obj"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"what?", "the format cannot be recognised: name it with --from "),
        (b"", "the data is empty: name it with --from "),
    ],
)
def test_an_unknown_format_asks_for_from(data: bytes, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(data, name="mesh.xyz")
    assert str(caught.value) == f"{message}(ply, obj, off, stl, gltf, glb)"


def test_unknown_names_of_formats_are_refused() -> None:
    with pytest.raises(OptionError, match=r"^unknown mesh format 'step': one of ply, obj, "):
        read_mesh(b"", format="step")
    with pytest.raises(OptionError):
        write_mesh(MESH, "step")


def test_suffixes_name_formats() -> None:
    assert [format_of_suffix(suffix_of(format)) for format in FORMATS] == list(FORMATS)
    assert format_of_suffix(".STL") == "stl"
    assert format_of_suffix(".ebz") is None


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_any_bytes_like_input_is_read(kind: type) -> None:
    assert len(read_mesh(kind(write_mesh(MESH, "ply"))).faces) == 1


# What small files need not wait for.
SLOW = ("open3d", "scipy", "construct", "hashlib", "pdb", "importlib.metadata")


def test_a_small_ply_needs_no_slow_import(tmp_path: Path) -> None:
    (tmp_path / "mesh.ply").write_bytes(write_mesh(MESH, "ply"))
    code = f"""
import sys, ebz
ebz.write("again.ply", ebz.decompress(ebz.compress(ebz.read("mesh.ply"))))
import ebz.cli.compress, ebz.cli.decompress
print(*(name for name in {SLOW} if name in sys.modules))
"""
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, check=True, cwd=tmp_path)
    assert result.stdout.strip() == b""
