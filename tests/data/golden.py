"""The frozen files: which meshes and options they are made of, and what they must decode to.

    python -m tests.data.golden

writes golden-v2 again.  From version 1.0 on the files of a version never change; before, they are
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

FOLDER = Path(__file__).parent / "golden-v2"
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


def _polygons() -> ebz.Mesh:
    """Quads, a pentagon, a triangle, faces of two corners and of none, one twice at a vertex."""
    faces = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7, 8), (8, 7, 3), (0, 4), ()]
    faces.append((9, 10, 9, 11))
    offsets = np.cumsum([0, *map(len, faces)])
    corners = np.concatenate([np.array(face, np.int64) for face in faces])
    vertices = np.column_stack([np.arange(12) % 4, np.arange(12) // 4, np.arange(12) ** 2 % 7])
    return ebz.Mesh(
        vertices.astype(np.float32),
        corners,
        face_attributes={"material": np.arange(len(faces), dtype=np.int32) // 3},
        face_offsets=offsets,
        corner_attributes={"uv": np.column_stack([corners % 4, corners // 4]).astype(float) / 8},
    )


def _carrying() -> ebz.Mesh:
    """Attributes of the kinds that have models of their own, and rows beside the faces."""
    mesh = sphere(320)
    n = len(mesh.vertices)
    length = np.linalg.norm(mesh.vertices, axis=1, keepdims=True)
    weights = np.arange(1, 2 * n + 1, dtype=np.float32).reshape(n, 2)
    uv = (mesh.vertices[mesh.faces.reshape(-1), :2] / 4).astype(np.float32)
    uv[: 3 * 40] += np.float32(0.5)  # a seam
    return ebz.Mesh(
        mesh.vertices,
        mesh.faces,
        {
            "normal": (mesh.vertices / length).astype(np.float32),
            "red": (np.arange(n) * 7 % 256).astype(np.uint8),
            "weights": weights / weights.sum(axis=1, keepdims=True),
        },
        {"label": (np.arange(len(mesh.faces)) // 50).astype(np.int16)},
        corner_attributes={"uv": uv},
        elements={"line": ebz.Element([0, 2, 5], [0, 1, 2, 3, 4], {"id": np.array([7, 9])})},
    )


def _scene() -> ebz.Scene:
    parts = [_polygons(), ebz.Mesh([], []), seam()]
    for name, part in zip(("body", "nothing", "strip"), parts, strict=True):
        part.metadata["name"] = name
    return ebz.Scene(parts, {"title": "three"})


def cases() -> dict[str, tuple[ebz.Mesh | ebz.Scene, dict[str, Any]]]:
    """The mesh and the options of each file."""
    ball, random = sphere(320), random_triangulation(300, seed=1)
    files: dict[str, tuple[ebz.Mesh | ebz.Scene, dict[str, Any]]] = {
        "empty": (ebz.Mesh([], []), {}),
        "one_triangle": (ebz.Mesh(np.eye(3, dtype=np.float32), [[0, 1, 2]]), {}),
        "isolated_vertices": (ebz.Mesh(np.arange(12.0).reshape(4, 3), []), {}),
        "everything": (_everything(), {}),
        "seam": (seam(), {}),
        "float64": (_curved(200), {}),
        "kept_order": (_everything(), {"keep_order": True}),
        "bits_14": (ball, {"bits": 14}),
        "grid": (ball, {"grid": (0.5, 0.01)}),
        "points": (ebz.Mesh(ball.vertices, []), {"bits": 12}),
        "polygons": (_polygons(), {}),
        "polygons_kept_order": (_polygons(), {"keep_order": True, "level": 9}),
        "carrying": (_carrying(), {}),
        "rounded_attributes": (_carrying(), {"attribute_bits": {"uv": 8}, "normal_bits": 8}),
        "scene": (_scene(), {"level": 9}),
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


def summary(content: ebz.Mesh | ebz.Scene) -> dict[str, Any]:
    """What a mesh or scene holds, as JSON: arrays by their bytes in little-endian order."""
    if isinstance(content, ebz.Scene):
        return {
            "parts": [summary(part) for part in content.parts],
            "metadata": repr(content.metadata),
        }
    offsets = content.face_offsets
    return {
        "vertices": _array(content.vertices),
        "faces": _array(content.faces),
        "face_offsets": None if offsets is None else _array(offsets),
        "vertex_attributes": _arrays(content.vertex_attributes),
        "face_attributes": _arrays(content.face_attributes),
        "corner_attributes": _arrays(content.corner_attributes),
        "elements": {
            name: [
                _array(element.offsets),
                _array(element.corners),
                _arrays(element.attributes),
                _arrays(element.corner_attributes),
            ]
            for name, element in content.elements.items()
        },
        "metadata": repr(content.metadata),
    }


def _arrays(attributes: dict[str, np.ndarray]) -> dict[str, str]:
    return {name: _array(values) for name, values in attributes.items()}


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
