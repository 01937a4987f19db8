"""Small glTF documents, and an independent reader of what ebz writes."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from ebz.formats.gltf.glb import make_glb

POSITIONS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 1], [2, 0, 1]], np.float32)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4"}


class Document:
    """A document with accessors added one by one, all tightly packed."""

    def __init__(self, **members: Any) -> None:
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "accessors": [],
            "bufferViews": [],
        }
        self.json |= members
        self.body = b""

    def view(self, data: bytes, **more: Any) -> int:
        self.body += bytes(-len(self.body) % 4)
        place = {"buffer": 0, "byteOffset": len(self.body), "byteLength": len(data)}
        self.json["bufferViews"].append(place | more)
        self.body += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values: np.ndarray, **more: Any) -> int:
        entry = {
            "bufferView": self.view(values.tobytes()),
            "componentType": COMPONENTS[values.dtype.str[1:]],
            "count": len(values),
            "type": TYPES[values.shape[1:]],
        }
        self.json["accessors"].append(entry | more)
        return len(self.json["accessors"]) - 1

    def glb(self) -> bytes:
        self.json["buffers"] = [{"byteLength": len(self.body)}]
        return make_glb(self.json, self.body)


def triangle(**members: Any) -> Document:
    """A node that shows one triangle."""
    document = Document(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], scene=0)
    position = document.accessor(POSITIONS[:3], min=[0, 0, 0], max=[1, 1, 0])
    indices = document.accessor(np.array([0, 1, 2], np.uint16))
    primitive = {"attributes": {"POSITION": position}, "indices": indices}
    document.json["meshes"] = [{"name": "m", "primitives": [primitive]}]
    document.json |= members
    return document


def triangles_by_open3d(path: Path) -> np.ndarray:
    """(m, 3, 3) the corners of all triangles, sorted; nodes are applied."""
    with _stdout_on_stderr():
        # open3d's wheel wants libusb, which headless machines lack.
        if sys.platform.startswith("linux"):
            with suppress(ImportError, OSError):
                import libusb_package

                ctypes.CDLL(str(libusb_package.get_library_path()), mode=ctypes.RTLD_GLOBAL)
        import open3d

        mesh = open3d.io.read_triangle_mesh(str(path))
        corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    return sorted_triangles(corners)


def sorted_triangles(corners: np.ndarray) -> np.ndarray:
    rows = corners.reshape(-1, 9).astype(np.float32)
    return rows[np.lexsort(rows.T)]


@contextmanager
def _stdout_on_stderr() -> Iterator[None]:
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        os.dup2(2, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


def scene_of_two() -> Document:
    """A mesh of two primitives with different materials, shown by two nodes, and one mesh more."""
    document = triangle(
        nodes=[
            {"mesh": 0, "children": [1, 2], "name": "root", "extras": {"a": [1]}},
            {"mesh": 0, "translation": [5, 0, 0]},
            {"mesh": 1, "matrix": [float(i % 5 == 0) for i in range(16)]},
        ],
        materials=[{"name": "red"}, {"name": "blue", "pbrMetallicRoughness": {}}],
    )
    first = document.json["meshes"][0]["primitives"][0]
    first |= {"material": 0, "extras": {"part": 1}}
    other = document.accessor(POSITIONS[2:] + 1)
    meshes = document.json["meshes"]
    meshes[0]["primitives"].append({"attributes": {"POSITION": other}, "material": 1})
    meshes.append({"extras": {"k": 2}, "primitives": [{"attributes": {"POSITION": other}}]})
    meshes[1]["primitives"][0]["attributes"] = {"POSITION": document.accessor(POSITIONS[:3] + 9)}
    return document
