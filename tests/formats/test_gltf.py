"""glTF and GLB: every primitive is a part, nothing merged, and the rest of the file comes back."""

import json
from typing import Any

import numpy as np
import pytest

import ebz
from ebz.codec.elements import Element
from ebz.codec.errors import DroppedWarning, MeshError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.gltf.glb import split_glb
from ebz.formats.meshes import read_mesh, write_mesh
from tests.formats.carried import contents
from tests.formats.gltf_files import (
    POSITIONS,
    Document,
    scene_of_two,
    sorted_triangles,
    triangle,
    triangles_by_open3d,
)

# Two vertices share a position, and stay two.
VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 0]], np.float32)
FACES = np.array([[0, 1, 2], [1, 3, 0]], np.int32)


def parts(content: Mesh | Scene) -> list[Mesh]:
    return content.parts if isinstance(content, Scene) else [content]


def same(a: Mesh | Scene, b: Mesh | Scene) -> bool:
    """Whether all arrays and metadata are the same."""
    return (
        type(a) is type(b)
        and a.metadata == b.metadata
        and [part.metadata for part in parts(a)] == [part.metadata for part in parts(b)]
        and [contents(part) for part in parts(a)] == [contents(part) for part in parts(b)]
    )


def come_back(data: bytes) -> Mesh | Scene:
    """What is read, which is written and read alike, and compressed and decompressed too."""
    found = read_mesh(data)
    again = read_mesh(write_mesh(found, found.metadata["format"]))
    assert same(read_mesh(write_mesh(again, again.metadata["format"])), again)
    assert [contents(part) for part in parts(found)] == [contents(part) for part in parts(again)]
    assert same(found, ebz.decompress(ebz.compress(found, keep_order=True)))
    document, kept = (content.metadata["gltf"]["document"] for content in (found, again))
    for key in document.keys() - {"accessors", "bufferViews"}:
        assert kept[key] == document[key]
    return found


@pytest.mark.parametrize("format", ["gltf", "glb"])
def test_what_is_written_is_read(format: str) -> None:
    data = write_mesh(Mesh(VERTICES, FACES), format)
    mesh = come_back(data)
    assert mesh.metadata["format"] == format
    assert np.array_equal(mesh.vertices, VERTICES)
    assert np.array_equal(mesh.faces, FACES)


def test_another_reader_finds_the_same_triangles(tmp_path) -> None:
    mesh = ebz.Mesh(POSITIONS, [[0, 1, 2], [2, 1, 3], [3, 1, 4]])
    (tmp_path / "a.glb").write_bytes(write_mesh(mesh, "glb"))
    expected = sorted_triangles(POSITIONS[mesh.faces])
    assert np.array_equal(triangles_by_open3d(tmp_path / "a.glb"), expected)
    moved = triangle(nodes=[{"mesh": 0, "translation": [5, 0, 0]}]).glb()
    (tmp_path / "b.glb").write_bytes(write_mesh(read_mesh(moved), "glb"))
    expected = sorted_triangles(POSITIONS[:3][None] + np.array([5, 0, 0], np.float32))
    assert np.array_equal(triangles_by_open3d(tmp_path / "b.glb"), expected)


def test_attributes_keep_their_names_and_types() -> None:
    document = triangle()
    rng = np.random.default_rng(0)
    given: dict[str, np.ndarray] = {
        "NORMAL": rng.random((3, 3)).astype("f4"),
        "TANGENT": rng.random((3, 4)).astype("f4"),
        "TEXCOORD_0": rng.random((3, 2)).astype("f4"),
        "TEXCOORD_1": rng.integers(0, 65535, (3, 2)).astype("u2"),
        "COLOR_0": rng.integers(0, 255, (3, 3)).astype("u1"),
        "JOINTS_0": rng.integers(0, 99, (3, 4)).astype("u1"),
        "WEIGHTS_0": rng.random((3, 4)).astype("f4"),
        "_ID": np.array([5, 6, 300], "u2"),
        "_signed": np.array([-5, 6, 100], "i1"),
    }
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    for name, values in given.items():
        scaled = {"normalized": True} if name in ("TEXCOORD_1", "COLOR_0") else {}
        attributes[name] = document.accessor(values, **scaled)
    mesh = come_back(document.glb())
    assert list(mesh.vertex_attributes) == list(given)
    for name, values in given.items():
        assert mesh.vertex_attributes[name].dtype == values.dtype
        assert np.array_equal(mesh.vertex_attributes[name], values)
    written = split_glb(write_mesh(mesh, "glb"))[0]
    accessors = written["accessors"]
    found = written["meshes"][0]["primitives"][0]["attributes"]
    assert [n for n, at in found.items() if accessors[at].get("normalized")] == [
        "TEXCOORD_1",
        "COLOR_0",
    ]
    # Entries of vertices are aligned to four bytes.
    assert written["bufferViews"][accessors[found["COLOR_0"]]["bufferView"]]["byteStride"] == 4


def test_morph_targets_are_attributes() -> None:
    document = triangle()
    moved, turned = np.eye(3, dtype="f4"), -np.eye(3, dtype="f4")
    targets = [{"POSITION": document.accessor(moved)}, {"NORMAL": document.accessor(turned)}]
    document.json["meshes"][0] |= {"weights": [0.5, 0.25], "extras": {"targetNames": ["a", "b"]}}
    document.json["meshes"][0]["primitives"][0]["targets"] = targets
    mesh = come_back(document.glb())
    assert np.array_equal(mesh.vertex_attributes["target 0/POSITION"], moved)
    assert np.array_equal(mesh.vertex_attributes["target 1/NORMAL"], turned)
    written = split_glb(write_mesh(mesh, "glb"))[0]["meshes"][0]
    assert [list(target) for target in written["primitives"][0]["targets"]] == [
        ["POSITION"],
        ["NORMAL"],
    ]
    assert (written["weights"], written["extras"]["targetNames"]) == ([0.5, 0.25], ["a", "b"])


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (0, [[0], [1], [2], [3], [4]]),
        (1, [[0, 1], [2, 3]]),
        (2, [[0, 1, 2, 3, 4, 0]]),
        (3, [[0, 1, 2, 3, 4]]),
        (5, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (6, [[1, 2, 0], [2, 3, 0], [3, 4, 0]]),
    ],
)
def test_modes(mode: int, expected: list[list[int]], indexed: bool) -> None:
    document, n = Document(), 4 if mode == 1 else 5
    primitive: dict[str, Any] = {"mode": mode}
    primitive["attributes"] = {"POSITION": document.accessor(POSITIONS[:n])}
    if indexed:
        primitive["indices"] = document.accessor(np.arange(n, dtype=np.uint8))
    document.json["meshes"] = [{"primitives": [primitive]}]
    mesh = read_mesh(document.glb())
    again = read_mesh(write_mesh(mesh, "glb"))
    assert np.array_equal(again.vertices, POSITIONS[:n])
    if mode > 3:
        assert mesh.faces.tolist() == again.faces.tolist() == expected
    elif mode == 0 and not indexed:
        assert not mesh.elements and not mesh.n_faces
    else:
        element = mesh.elements["point" if mode == 0 else "line"]
        rows = np.split(element.corners, element.offsets[1:-1])
        assert [row.tolist() for row in rows] == expected
        assert mode > 1 or contents(mesh) == contents(again)


def test_lines_are_written_as_segments() -> None:
    line = Element(np.array([0, 3, 3, 5]), np.array([0, 1, 2, 3, 4]))
    written = read_mesh(write_mesh(Mesh(POSITIONS, [], elements={"line": line}), "glb"))
    assert written.elements["line"].corners.tolist() == [0, 1, 1, 2, 3, 4]


def test_primitives_are_parts_of_a_scene() -> None:
    scene = come_back(scene_of_two().glb())
    assert isinstance(scene, Scene)
    assert scene.names == ["m", "m", None]
    assert [part.metadata["gltf_primitive"] for part in scene.parts] == [
        {"mesh": 0, "material": 0, "extras": {"part": 1}},
        {"mesh": 0, "material": 1},
        {"mesh": 1},
    ]
    written = split_glb(write_mesh(scene, "glb"))[0]
    assert written["nodes"] == scene_of_two().json["nodes"]
    assert [len(mesh["primitives"]) for mesh in written["meshes"]] == [2, 1]


def test_what_is_no_geometry_comes_back() -> None:
    document = triangle()
    image = bytes(range(256)) * 2
    times = document.accessor(np.array([0, 1], "f4"), min=[0], max=[1])
    moves = document.accessor(np.ones((2, 3), "f4"))
    document.json |= {
        "images": [{"bufferView": document.view(image), "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "animations": [
            {
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": times, "output": moves}],
            }
        ],
        "extras": {"anything": [1, None, {"x": "y"}]},
    }
    mesh = come_back(document.glb())
    written, body = split_glb(write_mesh(mesh, "glb"))
    view = written["bufferViews"][written["images"][0]["bufferView"]]
    assert body[view["byteOffset"] :][: view["byteLength"]] == image
    sampler = written["animations"][0]["samplers"][0]
    accessor = written["accessors"][sampler["output"]]
    view = written["bufferViews"][accessor["bufferView"]]
    assert body[view["byteOffset"] :][:24] == np.ones((2, 3), "<f4").tobytes()
    assert accessor["count"] == 2


def test_shared_vertices_are_shared_out() -> None:
    document = triangle()
    primitives = document.json["meshes"][0]["primitives"]
    position = document.accessor(np.concatenate([POSITIONS, POSITIONS[:1]]))
    rows = ([0, 1, 2], [4, 3, 2])
    indices = [document.accessor(np.array(row, np.uint16)) for row in rows]
    primitives[:] = [{"attributes": {"POSITION": position}, "indices": i} for i in indices]
    message = r"^glTF: vertices of shared buffers that no primitive uses \(1\)$"
    with pytest.warns(DroppedWarning, match=message):
        scene = read_mesh(document.glb())
    for part, row in zip(scene.parts, rows, strict=True):
        assert part.n_vertices == 3
        assert np.array_equal(part.vertices[part.faces[0]], POSITIONS[row])


def test_accessors_may_stand_apart_be_sparse_or_missing() -> None:
    document = triangle()
    accessors = document.json["accessors"]
    strided = np.zeros((3, 5), "f4")
    strided[:, 1:4] = POSITIONS[:3]
    accessors[0] |= {"bufferView": document.view(strided.tobytes(), byteStride=20), "byteOffset": 4}
    rows, values = document.view(b"\2"), document.view(np.array([7, 8, 9], "f4").tobytes())
    sparse = {
        "count": 1,
        "indices": {"bufferView": rows, "componentType": 5121},
        "values": {"bufferView": values},
    }
    accessors.append(accessors[0] | {"sparse": sparse})
    accessors.append({"componentType": 5126, "count": 3, "type": "VEC3"})
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    attributes |= {"_SPARSE": 2, "_ZEROS": 3}
    mesh = come_back(document.glb())
    assert np.array_equal(mesh.vertices, POSITIONS[:3])
    assert mesh.vertex_attributes["_SPARSE"].tolist() == [[0, 0, 0], [1, 0, 0], [7, 8, 9]]
    assert not mesh.vertex_attributes["_ZEROS"].any()


def test_what_gltf_cannot_hold_is_named() -> None:
    with pytest.raises(MeshError, match=r"^vertex 0: glTF holds finite coordinates only$"):
        write_mesh(Mesh(VERTICES * np.float32(np.nan), FACES), "glb")
    mesh = Mesh(
        VERTICES.astype(np.float64) + 0.1,
        FACES,
        {"a": np.full(4, 0.1), "id": np.arange(4), "rgb": np.zeros((4, 3), np.uint8)},
        {"b": np.zeros(2)},
    )
    with pytest.warns(DroppedWarning) as warned:
        data = write_mesh(mesh, "gltf")
    assert [str(warning.message) for warning in warned] == [
        "glTF cannot carry face attributes: 'b'",
        "glTF cannot carry float64: coordinates are rounded to float32",
        "glTF cannot carry vertex attributes: 'a'",
    ]
    assert json.loads(data)["asset"]["version"] == "2.0"
    found = read_mesh(data).vertex_attributes
    assert {name: values.dtype.name for name, values in found.items()} == {
        "_id": "uint8",
        "COLOR_0": "uint8",
    }


def test_scenes_of_other_origin_are_written_too() -> None:
    ball = Mesh(VERTICES, FACES, metadata={"name": "ball"})
    scene = Scene([ball, Mesh([], []), Mesh(POSITIONS, [])])
    with pytest.warns(DroppedWarning, match="glTF cannot hold the empty mesh ''"):
        again = read_mesh(write_mesh(scene, "glb"))
    assert again.names == ["ball", None]
    assert np.array_equal(again.parts[1].vertices, POSITIONS)
    document = again.metadata["gltf"]["document"]
    assert document["nodes"] == [{"mesh": 0}, {"mesh": 1}]
    empty = read_mesh(write_mesh(Scene([]), "glb"))
    assert empty.parts == []


def test_formats_of_one_mesh_get_what_the_nodes_show() -> None:
    with pytest.warns(DroppedWarning) as warned:
        data = write_mesh(read_mesh(scene_of_two().glb()), "ply")
    assert [str(warning.message) for warning in warned] == [
        "PLY cannot carry materials (2) of glTF",
        "PLY holds one mesh: the 5 parts are joined",
    ]
    mesh = read_mesh(data)
    assert mesh.face_attributes["object"].tolist() == [0, 1, 2, 3, 4]
    first, moved = POSITIONS[:3], np.array([5, 0, 0], np.float32)
    found = mesh.vertices[mesh.faces].tolist()
    second, third = POSITIONS[2:] + 1, POSITIONS[:3] + 9
    expected = [first, second, first + moved, second + moved, third]
    assert found == [corners.tolist() for corners in expected]


def test_nodes_turn_scale_and_mirror() -> None:
    half = float(np.sqrt(0.5))
    nodes = [
        {"children": [1], "scale": [-2, 2, 2]},
        {"mesh": 0, "rotation": [0, 0, half, half], "translation": [0, 0, 3]},
    ]
    document = triangle(nodes=nodes)
    normals = document.accessor(np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]], "f4"))
    document.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals
    mesh = read_mesh(write_mesh(read_mesh(document.glb()), "ply"))
    # A quarter turn about z, then mirrored in x: (x, y, z) becomes (2 y, 2 x, 2 z + 6).
    expected = POSITIONS[:3][:, [1, 0, 2]] * 2 + np.array([0, 0, 6], np.float32)
    assert np.allclose(mesh.vertices, expected, atol=1e-6)
    assert mesh.faces.tolist() == [[0, 2, 1]]
    turned = np.abs(mesh.vertex_attributes["NORMAL"])
    assert np.allclose(turned, [[0, 1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-6)


def test_nodes_that_are_no_tree_are_refused() -> None:
    mesh = read_mesh(triangle(nodes=[{"children": [0], "mesh": 0}]).glb())
    with pytest.raises(MeshError, match="the nodes of the scene are no tree"):
        write_mesh(mesh, "ply")


def test_polygons_are_cut_up() -> None:
    with pytest.warns(DroppedWarning, match="glTF holds triangles only: 1 polygons are cut up"):
        data = write_mesh(Mesh(POSITIONS, [[0, 1, 2, 3]]), "glb")
    assert read_mesh(data).faces.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_corners_get_vertices_of_their_own() -> None:
    uv = np.array([[0, 0], [1, 0], [0, 1], [0, 0], [0, 1], [0.5, 0.5]], np.float32)
    line = Element(np.array([0, 2]), np.array([2, 4]))
    mesh = Mesh(
        POSITIONS,
        [[0, 1, 2], [0, 2, 3]],
        {"id": np.arange(5, dtype=np.uint8)},
        corner_attributes={"uv": uv},
        elements={"line": line},
    )
    scene = read_mesh(write_mesh(mesh, "glb"))  # nothing is split: corners agree
    assert [part.n_vertices for part in scene.parts] == [3 + 1, 2]
    mesh.corner_attributes["uv"][4] = 7
    with pytest.warns(
        DroppedWarning, match="attributes of vertices only: 1 vertices are split off"
    ):
        scene = read_mesh(write_mesh(mesh, "glb"))
    part = scene.parts[0]
    assert part.vertex_attributes["_id"][part.faces].tolist() == [[0, 1, 2], [0, 2, 3]]
    assert np.array_equal(part.vertices[part.faces], POSITIONS[mesh.faces])
    found = part.vertex_attributes["TEXCOORD_0"][part.faces]
    assert np.array_equal(found.reshape(-1, 2), mesh.corner_attributes["uv"])
    assert np.array_equal(scene.parts[1].vertices, POSITIONS[[2, 4]])


def test_names_of_other_formats_become_those_of_gltf() -> None:
    columns = {
        name: np.arange(4, dtype=np.uint8) + i for i, name in enumerate(("red", "green", "blue"))
    }
    normals = {name: np.full(4, float(name == "nz")) for name in ("nx", "ny", "nz")}
    uv = np.linspace(0, 1, 8).reshape(4, 2)
    attributes = columns | {"confidence": np.ones(4, np.float32)} | normals | {"uv": uv}
    with pytest.warns(DroppedWarning, match="float64: rounded to float32 are uv"):
        mesh = read_mesh(write_mesh(Mesh(VERTICES, FACES, attributes), "glb"))
    found = mesh.vertex_attributes
    assert list(found) == ["COLOR_0", "_confidence", "NORMAL", "TEXCOORD_0"]
    assert found["COLOR_0"].tolist() == [[i, i + 1, i + 2] for i in range(4)]
    assert mesh.metadata["gltf_primitive"]["normalized"] == ["COLOR_0"]
    assert found["NORMAL"].tolist() == 4 * [[0, 0, 1]]
    assert np.array_equal(found["TEXCOORD_0"], uv.astype(np.float32))


def test_lines_of_one_row_come_back_as_one() -> None:
    document = triangle()
    document.json["meshes"][0]["primitives"][0]["mode"] = 2  # a loop
    mesh = come_back(document.glb())
    assert mesh.elements["line"].offsets.tolist() == [0, 4]
