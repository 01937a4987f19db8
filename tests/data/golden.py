"""The frozen files: which meshes and options they are made of, and what they must decode to.

    python -m tests.data.golden

writes golden-v1 again.  From version 1.0 on the files of a version never change; before, they are
made again, on purpose and in a commit of its own, when the format changes.
"""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import ebz
from ebz.codec.models.load import load
from ebz.codec.sample import random_triangulation, sphere, torus
from tests import surgery

FOLDER = Path(__file__).parent / "golden-v1"
SUMMARIES = FOLDER / "meshes.json"


def _curved(n_triangles: int) -> ebz.Mesh:
    """A torus whose coordinates are on no lattice."""
    mesh = torus(n_triangles)
    return ebz.Mesh(np.sqrt(mesh.vertices.astype(float) + 9), mesh.faces)


def _everything() -> ebz.Mesh:
    tetrahedron = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])
    pages = np.array([(0, 1, 2), (0, 1, 3), (1, 0, 4), (4, 4, 0), (0, 1, 2)])
    faces = surgery.union([torus(60).faces.astype(int), tetrahedron, pages])
    n = surgery.n_used(faces) + 2
    vertices = (np.arange(3 * n).reshape(n, 3) ** 2 % 97 / 8).astype(np.float32)
    vertices[3, 1] = np.nan
    return ebz.Mesh(
        vertices,
        faces,
        {"red": np.arange(n, dtype=np.uint8), "uv": np.arange(2 * n).reshape(n, 2) / 4},
        {"corner": faces.astype(np.int16), "label": np.arange(len(faces), dtype=np.int64) % 5},
        {"format": "ply", "bytes": b"\0\xff", "name": "é\ud800", "nested": [1, None, {"a": 0.5}]},
    )


def seam() -> ebz.Mesh:
    """A strip whose middle is there twice, as where texture coordinates are cut."""
    x, y = np.divmod(np.arange(12), 2)
    x -= x > 2  # columns 2 and 3 are at one place
    faces = [(2 * i, 2 * i + 1, 2 * i + 2) for i in (0, 1, 3, 4)]
    faces += [(2 * i + 1, 2 * i + 3, 2 * i + 2) for i in (0, 1, 3, 4)]
    return ebz.Mesh(np.column_stack([x, y, x * y]).astype(np.float32), faces)


def cases() -> dict[str, tuple[ebz.Mesh, dict[str, Any]]]:
    """The mesh and the options of each file."""
    ball, random = sphere(320), random_triangulation(300, seed=1)
    files: dict[str, tuple[ebz.Mesh, dict[str, Any]]] = {
        "empty": (ebz.Mesh([], []), {}),
        "one_triangle": (ebz.Mesh(np.eye(3, dtype=np.float32), [[0, 1, 2]]), {}),
        "isolated_vertices": (ebz.Mesh(np.arange(12.0).reshape(4, 3), []), {}),
        "everything": (_everything(), {}),
        "seam": (seam(), {}),
        "float64": (_curved(200), {}),
        "kept_order": (_everything(), {"keep_order": True}),
        "bits_14": (ball, {"bits": 14}),
        "max_error": (_curved(200), {"max_error": 1e-3}),
        "automaton": (random, {"model": "loop-60"}),
        "stack": (random, {"model": "stack"}),
        "embedded_automaton": (ball, {"model": "loop-60", "embed_model": True}),
        "custom_automaton": (ball, {"model": _custom_table()}),
    }
    for level in (1, 3, 6, 9):
        files[f"level_{level}"] = (random, {"level": level})
    return files


def _custom_table() -> Any:
    table = load("loop-60")
    return type(table)("custom", table.frequencies, table.successors)


def summary(mesh: ebz.Mesh) -> dict[str, Any]:
    """What a mesh holds, as JSON: arrays by their bytes in little-endian order."""
    return {
        "vertices": _array(mesh.vertices),
        "faces": _array(mesh.faces),
        "vertex_attributes": {k: _array(v) for k, v in mesh.vertex_attributes.items()},
        "face_attributes": {k: _array(v) for k, v in mesh.face_attributes.items()},
        "metadata": repr(mesh.metadata),
    }


def _array(values: np.ndarray) -> str:
    little = values.astype(values.dtype.newbyteorder("<"))
    digest = hashlib.sha256(little.tobytes()).hexdigest()
    return f"{values.dtype.name} {list(values.shape)} {digest[:32]}"


def main(report: Callable[[str], None] = print) -> None:
    FOLDER.mkdir(exist_ok=True)
    summaries = {}
    for name, (mesh, options) in cases().items():
        data = ebz.compress(mesh, **options)
        (FOLDER / f"{name}.ebz").write_bytes(data)
        summaries[name] = summary(ebz.decompress(data))
        report(f"{name}: {len(data)} bytes")
    SUMMARIES.write_text(json.dumps(summaries, indent=1) + "\n")


if __name__ == "__main__":
    main()
