"""Files as others wrote them: all are read, or refused with the message that helps.

They are looked for in the folder that EBZ_TEST_DATA names, else in ../shared/data beside the
project.
"""

import os
import warnings
from pathlib import Path

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.meshes import format_of_suffix, read_mesh, write_mesh

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = [Path(os.environ.get("EBZ_TEST_DATA", ROOT.parent / "shared" / "data"))]
POLYGONS = {"fandisk_quads.off": 769, "inspired_quads.off": 1966, "horse_quad.obj": 2401}
FILES = sorted(
    path
    for folder in FOLDERS
    for path in folder.glob("**/*")
    if format_of_suffix(path.suffix) is not None
)


def read(path: Path, **options: bool) -> tuple[Mesh, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", DroppedWarning)
        mesh = read_mesh(path.read_bytes(), name=path.name, **options)
    return mesh, [str(warning.message) for warning in caught]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_real_file_is_read_and_comes_back(path: Path) -> None:
    if path.name in POLYGONS:
        with pytest.raises(MeshError, match=rf"line {POLYGONS[path.name]}: face 0 has 4 corners"):
            read(path)
    mesh, _ = read(path, triangulate=path.name in POLYGONS)
    format = mesh.metadata["format"]
    assert format == format_of_suffix(path.suffix)
    data = write_mesh(mesh, format)
    again = read_mesh(data)
    assert again.vertices.dtype == mesh.vertices.dtype
    assert again.vertices[again.faces].tobytes() == mesh.vertices[mesh.faces].tobytes()
    assert again.metadata == mesh.metadata
    assert again.vertex_attributes.keys() == mesh.vertex_attributes.keys()
    if format != "glb":
        assert write_mesh(again, format) == data
    if format == "ply" and b"format binary" in data[:40]:
        assert data == path.read_bytes()


CARRIED = {
    "bunny_confidence.ply": (35947, 69451, ["confidence", "intensity"], []),
    "points_emptyface.ply": (1024, 0, [], []),
    "lines.obj": (484, 0, [], ["OBJ: 1 objects (o), 242 lines (l)"]),
    "mat_test.obj": (
        3576,
        1300,
        [],
        ["OBJ: 1 material libraries (mtllib), 7 materials in use (usemtl)"],
    ),
    "cesium_man_skinned.glb": (
        3273,
        4672,
        [],
        [
            "glTF: materials (1), textures (1), images (1), animations (1), skins (1), "
            "names of meshes (1), JOINTS_0 (1), NORMAL (1), TEXCOORD_0 (1), WEIGHTS_0 (1)"
        ],
    ),
}


@pytest.mark.parametrize(
    "path", [path for path in FILES if path.name in CARRIED], ids=lambda path: path.name
)
def test_what_a_real_file_carries_is_kept_or_named(path: Path) -> None:
    mesh, messages = read(path)
    n_vertices, n_faces, names, expected = CARRIED[path.name]
    assert (len(mesh.vertices), len(mesh.faces)) == (n_vertices, n_faces)
    assert list(mesh.vertex_attributes) == names
    assert messages == expected
    assert mesh.vertices.dtype == (np.float64 if path.name == "lines.obj" else np.float32)
