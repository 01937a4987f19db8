"""glTF and GLB through open3d: nothing merged, nothing lost in silence, stdout untouched."""

import json
import warnings

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, EbzError, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats import gltf
from ebz.formats.gltf_json import make_glb
from ebz.formats.meshes import read_mesh, write_mesh

# Two vertices share a position, and stay two.
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [1, 3, 0]], np.int32)


@pytest.mark.parametrize("format", ["gltf", "glb"])
def test_what_is_written_is_read(format: str, capfd: pytest.CaptureFixture[str]) -> None:
    data = write_mesh(Mesh(VERTICES, FACES), format)
    mesh = read_mesh(data)
    assert mesh.metadata["format"] == format
    assert mesh.vertices[mesh.faces].tolist() == VERTICES[FACES].tolist()
    assert len(mesh.vertices) == 4
    assert capfd.readouterr().out == ""


def document(**changes: object) -> tuple[dict[str, object], bytes]:
    """Two nodes that show one mesh of one triangle, and its buffer."""
    positions = VERTICES[:3].tobytes()
    indices = np.array([0, 1, 2, 0], np.uint16).tobytes()
    result: dict[str, object] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [5, 0, 0]}],
        "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 42}],
    }  # fmt: skip
    return result | changes, positions + indices


def glb(**changes: object) -> bytes:
    return make_glb(*document(**changes))


def test_nodes_are_transformed_and_joined() -> None:
    with pytest.warns(DroppedWarning, match=r"^glTF: names of meshes \(1\)$"):
        mesh = read_mesh(glb())
    moved = VERTICES[:3] + np.array([5, 0, 0], np.float32)
    found = sorted(mesh.vertices[mesh.faces].tolist())
    assert found == [VERTICES[:3].tolist(), moved.tolist()]


def test_what_is_not_carried_is_named() -> None:
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 0, "_WEIGHT": 1}, "indices": 1}
    lines = {"attributes": {"POSITION": 0}, "mode": 1}
    data = glb(meshes=[{"primitives": [primitive, lines]}], materials=[{}], cameras=[{}, {}])
    with pytest.warns(DroppedWarning) as warned:
        read_mesh(data)
    assert [str(warning.message) for warning in warned] == [
        "glTF: materials (1), cameras (2), NORMAL (2), _WEIGHT (2), "
        "primitives that are no triangles (2)"
    ]


def test_vertices_that_no_triangle_uses_are_counted() -> None:
    mesh = Mesh(np.concatenate([VERTICES, VERTICES + 7]), FACES)
    data = write_mesh(mesh, "glb")
    with pytest.warns(DroppedWarning, match=r"^glTF: vertices that no triangle uses \(4\)$"):
        assert len(read_mesh(data).vertices) == 4


GOOD = glb()
MALFORMED = [
    (b"glTF", "offset 0: not a GLB header"),
    (b"glTF\x01" + GOOD[5:], "offset 4: glTF version 1 is not read, only 2"),
    (GOOD[:-1], "early end of file in a chunk"),
    (GOOD[:12] + bytes(8), "offset 12: there is no JSON chunk"),
    (b"{", "glTF: malformed JSON: "),
    (b"[" * 100000, "glTF: malformed JSON: "),
    (b"[]", "glTF: malformed document: "),
    (glb(meshes=[]), "glTF: malformed document: "),
    (glb(nodes=[{"children": [0], "mesh": 0}]), "glTF: the nodes of the scene are no tree"),
    (glb(buffers=[{"byteLength": 99}]), "glTF: buffer 0: early end at 44 bytes"),
    (glb(buffers=[{"byteLength": 1, "uri": "../a.bin"}]), "glTF: buffer 0 is in another file"),
    (glb(bufferViews=[{"buffer": 0, "byteLength": 99}]), "glTF: buffer view 0 is out of range"),
    (glb(scenes=[{"nodes": []}]), "glTF: there is no triangle that can be read"),
    (glb(extensionsRequired=["KHR_draco_mesh_compression"]),
     "glTF: KHR_draco_mesh_compression is not read: decompress the file first"),
    (glb(accessors=[{"count": 2**40}, {"count": 3}]), "glTF: 1099511627776 positions declared"),
]  # fmt: skip


@pytest.mark.parametrize(("data", "message"), MALFORMED)
def test_malformed_input_is_refused(data: bytes, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_mesh(data, format="gltf" if data[:1] in b"{[" else "glb")
    assert message in str(caught.value)


def test_what_open3d_cannot_read_is_an_error_not_an_empty_mesh() -> None:
    content, binary = document()
    content["accessors"][1] |= {"count": 3, "componentType": 9999}  # type: ignore[index]
    with warnings.catch_warnings(), pytest.raises(MeshError, match=r"^glTF: "):
        warnings.simplefilter("ignore", DroppedWarning)
        read_mesh(make_glb(content, binary))


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        (Mesh(VERTICES, []), "glTF cannot hold a mesh without faces"),
        (
            Mesh(VERTICES * np.float32(np.nan), FACES),
            "vertex 0: glTF holds finite coordinates only",
        ),
    ],
)
def test_what_gltf_cannot_hold_is_refused(mesh: Mesh, message: str) -> None:
    with pytest.raises(MeshError) as caught:
        write_mesh(mesh, "glb")
    assert str(caught.value) == message


def test_float64_and_attributes_are_named_when_written() -> None:
    mesh = Mesh(VERTICES.astype(np.float64) + 0.1, FACES, {"a": np.zeros(4)}, {"b": np.zeros(2)})
    with pytest.warns(DroppedWarning) as warned:
        data = write_mesh(mesh, "gltf")
    assert [str(warning.message) for warning in warned] == [
        "glTF cannot carry vertex attributes: 'a'",
        "glTF cannot carry face attributes: 'b'",
        "glTF cannot carry float64: coordinates are rounded to float32",
    ]
    assert json.loads(data)["asset"]["version"] == "2.0"


@pytest.mark.parametrize(
    ("error", "advice"),
    [
        ("libGL.so.1: cannot open shared object file", "apt-get install libgl1"),
        ("libX11.so.6: cannot open shared object file", "apt-get install libx11-6"),
        ("No module named 'open3d'", "python -m pip install open3d"),
    ],
)
def test_an_open3d_that_cannot_be_imported_says_what_to_install(
    error: str, advice: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Broken:
        def find_spec(self, name: str, *_: object) -> None:
            if name == "open3d":
                raise ImportError(error)

    monkeypatch.delitem(gltf.sys.modules, "open3d", raising=False)
    monkeypatch.setattr(gltf.sys, "meta_path", [Broken(), *gltf.sys.meta_path])
    with pytest.raises(EbzError) as caught:
        write_mesh(Mesh(VERTICES, FACES), "glb")
    assert str(caught.value) == f"glTF needs open3d, which cannot be imported ({error}): {advice}"
