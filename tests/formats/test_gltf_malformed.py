"""glTF that is damaged is refused with a reason; buffers in files beside it are found."""

import json
import warnings
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebz
from ebz.codec.errors import DroppedWarning, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.gltf.glb import make_glb, split_glb
from ebz.formats.meshes import read_mesh, write_mesh
from tests.formats.gltf_files import (
    Document,
    scene_of_two,
    triangle,
)

# Two vertices share a position, and stay two.


def changed(**members: Any) -> bytes:
    return triangle(**members).glb()


def with_accessor(**members: Any) -> bytes:
    document = triangle()
    document.json["accessors"][0] |= members
    return document.glb()


def with_primitive(**members: Any) -> bytes:
    document = triangle()
    document.json["meshes"][0]["primitives"][0] |= members
    return document.glb()


def with_buffer(uri: Any) -> bytes:
    return json.dumps({"buffers": [{"byteLength": 1, "uri": uri}]}).encode()


GOOD = changed()
MALFORMED = [
    (b"glTF", "offset 0: not a GLB header"),
    (b"glTF\x01" + GOOD[5:], "offset 4: glTF version 1 is not read, only 2"),
    (GOOD[:-1], "early end of file in a chunk"),
    (GOOD[:12] + bytes(8), "offset 12: there is no JSON chunk"),
    (b"{", "glTF: malformed JSON: "),
    (b"[" * 100000, "glTF: malformed JSON: "),
    (b"[]", "glTF: the document is no object"),
    (make_glb({"buffers": [{"byteLength": 99}]}, b"1234"), "glTF: buffer 0: early end at 4 bytes"),
    (with_buffer("a.bin"), "glTF: buffer 0 is in another file, 'a.bin': name the file"),
    (with_buffer("a/../../a.bin"), "glTF: buffer 0 is at 'a/../../a.bin', which is not below"),
    (with_buffer("/a.bin"), "glTF: buffer 0 is at '/a.bin', which is not below"),
    (with_buffer("%2e%2E/a.bin"), "which is not below"),
    (with_buffer("file:a.bin"), "which is not below"),
    (with_buffer("data:;base64,?"), "glTF: buffer 0: malformed base64 in its address"),
    (with_buffer("data:;a"), "glTF: buffer 0: malformed base64 in its address"),
    (with_buffer(3), "glTF: buffer 0: 3 is no address"),
    (changed(bufferViews=[{"buffer": 0, "byteLength": 99}]), "buffer view 0 is out of range"),
    (changed(extensionsRequired=["KHR_draco_mesh_compression"]),
     "glTF: KHR_draco_mesh_compression is not read: decompress the file first"),
    (with_accessor(count=2**40), "glTF: accessor 0: 1099511627776 values past the end"),
    (with_accessor(count=-1), "glTF: accessor 0: a count of -1"),
    (with_accessor(count="3"), "glTF: accessor 0: a count of '3'"),
    (with_accessor(byteOffset=-4), "glTF: accessor 0: 3 values past the end"),
    (with_accessor(byteOffset=4), "glTF: accessor 0: 3 values past the end"),
    (with_accessor(bufferView=9), "glTF: accessor 0: there is no buffer view 9"),
    (with_accessor(bufferView=None), "glTF: accessor 0: there is no buffer view None"),
    (with_accessor(componentType=9999), "glTF: accessor 0: 'VEC3' of components 9999"),
    (with_accessor(type="VEC5"), "glTF: accessor 0: 'VEC5' of components 5126"),
    (changed(nodes=[{"mesh": 1}]), "glTF: node 0: there is no mesh 1"),
    (changed(nodes=[{}, {"mesh": None}]), "glTF: node 1: there is no mesh None"),
    (with_primitive(indices=7), "glTF: there is no accessor 7"),
    (with_accessor(type="VEC2"), "vertices: shape (3, 2) is not (n, 3)"),
    (with_primitive(attributes={}), "glTF: mesh 0: a primitive without positions"),
    (with_primitive(mode=7), "glTF: mesh 0: unknown mode 7"),
    (with_primitive(mode=1), "glTF: mesh 0: 3 ends of lines"),
    (with_primitive(indices=0), "glTF: mesh 0: indices are no scalars"),
]  # fmt: skip


@pytest.mark.parametrize(("data", "message"), MALFORMED)
def test_malformed_input_is_refused(data: bytes, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(data, format="gltf" if data[:1] in b"{[" else "glb")
    assert message in str(caught.value)


def test_indices_out_of_range_are_named() -> None:
    document = triangle()
    primitive = document.json["meshes"][0]["primitives"][0]
    primitive["indices"] = document.accessor(np.array([0, 1, 3], np.uint32))
    with pytest.raises(MeshError, match=r"^face 0: vertex 3 is out of range"):
        read_mesh(document.glb())


def test_primitives_that_repeat_a_buffer_without_end_are_refused() -> None:
    document = Document()
    position = document.accessor(np.zeros((2000, 3), "f4"))
    primitive = {"attributes": {"POSITION": position}, "mode": 0}
    document.json["meshes"] = [{"primitives": 500 * [primitive]}]
    with pytest.raises(MeshError, match="repeat too much"):
        read_mesh(document.glb())


def test_flipped_bits_never_crash() -> None:
    data = scene_of_two().glb()
    rng = np.random.default_rng(0)
    for at in rng.integers(20 * 8, 8 * len(data), 600).tolist():
        damaged = bytearray(data)
        damaged[at // 8] ^= 1 << at % 8
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DroppedWarning)
            try:
                read_mesh(bytes(damaged), format="glb")
            except MeshError:
                continue


def beside(tmp_path: Path, name: str, uri: str) -> Path:
    """A glTF file whose buffer is in a file."""
    document, body = split_glb(triangle().glb())
    document["buffers"][0]["uri"] = uri
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / name).write_bytes(body)
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    return tmp_path / "a.gltf"


def test_buffers_in_files_beside_are_read(tmp_path: Path) -> None:
    mesh = ebz.read(beside(tmp_path, "a b.bin", "parts/a%20b.bin"))
    assert np.array_equal(mesh.vertices, ebz.read(BytesIO(triangle().glb())).vertices)
    ebz.write(tmp_path / "b.gltf", mesh)
    assert ebz.verify(ebz.compress(mesh), ebz.read(tmp_path / "b.gltf")).equal


def test_buffers_in_files_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    path = beside(tmp_path, "a.bin", "parts/b.bin")
    with pytest.raises(MeshError, match=r"buffer 0: parts/b.bin: No such file") as caught:
        ebz.read(path)
    assert caught.value.source == str(path)


@pytest.mark.parametrize("document", [[], {"nodes": [{"mesh": 9}]}, {"nodes": 3}, {"meshes": [1]}])
def test_metadata_that_is_no_document_is_refused(document) -> None:
    mesh = Mesh(np.eye(3), [[0, 1, 2]], metadata={"gltf": {"document": document}})
    with pytest.raises(MeshError, match=r"no glTF document|no mesh 9"):
        write_mesh(mesh, "glb")
