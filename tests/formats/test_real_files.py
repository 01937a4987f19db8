"""Files as others wrote them: all are read, or refused with the message that helps.

They are looked for in the folder that EBZ_TEST_DATA names, else in ../shared/data beside the
project.
"""

import os
import warnings
from pathlib import Path

import numpy as np
import pytest

from ebz.codec.errors import DroppedWarning
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.meshes import format_of_suffix, read_mesh, write_mesh
from tests.formats.carried import contents

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = [Path(os.environ.get("EBZ_TEST_DATA", ROOT.parent / "shared" / "data"))]
FILES = sorted(
    path
    for folder in FOLDERS
    for path in folder.glob("**/*")
    if format_of_suffix(path.suffix) is not None
)


def read(path: Path, **options: bool) -> tuple[Mesh | Scene, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", DroppedWarning)
        mesh = read_mesh(path.read_bytes(), name=path.name, **options)
    return mesh, [str(warning.message) for warning in caught]


def parts(content: Mesh | Scene) -> list[Mesh]:
    return content.parts if isinstance(content, Scene) else [content]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_real_file_is_read_and_comes_back(path: Path) -> None:
    mesh, _ = read(path)
    format = mesh.metadata["format"]
    assert format == format_of_suffix(path.suffix)
    data = write_mesh(mesh, format)
    again = read_mesh(data)
    assert write_mesh(again, format) == data
    if format == "glb":
        assert again.metadata.keys() == mesh.metadata.keys()
        pairs = zip(parts(again), parts(mesh), strict=True)
        assert all(contents(ours) == contents(theirs) for ours, theirs in pairs)
        return
    assert again.metadata == mesh.metadata
    assert contents(again) == contents(mesh)
    if format == "ply" and b"format binary" in data[:40]:
        assert data == path.read_bytes()


WIDE = ("lines.obj", "groups.obj")
CARRIED = {
    "bunny_confidence.ply": (35947, 69451, ["confidence", "intensity"], []),
    "points_emptyface.ply": (1024, 0, [], []),
    "lines.obj": (484, 0, [], []),
    "mat_test.obj": (3576, 1300, [], []),
    "horse_quad.obj": (2400, 2398, [], []),
    "groups.obj": (1156, 2308, [], []),
    "normals.obj": (114, 170, [], []),
    "cesium_man_skinned.glb": (
        3273,
        4672,
        ["JOINTS_0", "NORMAL", "TEXCOORD_0", "WEIGHTS_0"],
        [],
    ),
}


@pytest.mark.parametrize(
    "path", [path for path in FILES if path.name in CARRIED], ids=lambda path: path.name
)
def test_what_a_real_file_carries_is_kept_or_named(path: Path) -> None:
    mesh, messages = read(path)
    n_vertices, n_faces, names, expected = CARRIED[path.name]
    assert (mesh.n_vertices, mesh.n_faces) == (n_vertices, n_faces)
    assert list(mesh.vertex_attributes) == names
    assert messages == expected
    assert mesh.vertices.dtype == (np.float64 if path.name in WIDE else np.float32)
