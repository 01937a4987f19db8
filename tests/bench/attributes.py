"""Sizes of attributes beside Draco (level 10, the same precision) and zstd -19 on the raw arrays.

    python -m tests.bench.attributes FOLDER...

reads the meshes of the folders.  What they carry is measured as it is; normals and colours that are
computed from the shape stand in where meshes carry none.  Prints a table in Markdown.
"""

import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import DracoPy
import numpy as np
import numpy.typing as npt
import zstandard

import ebz

Array = npt.NDArray[Any]
POSITION_BITS = 14
SUFFIXES = (".ply", ".obj", ".off", ".glb")


@dataclass(frozen=True)
class Case:
    """An attribute of a mesh; draco: how DracoPy is told of it, None where it cannot carry it."""

    file: str
    kind: str
    mesh: ebz.Mesh  # without attributes
    values: Array
    options: dict[str, Any]
    draco: dict[str, Any] | None
    by_corner: bool = False


def main(folders: list[str]) -> None:
    print("| file | attribute | entries | zstd -19 | Draco | ebz | ebz / Draco | ebz / zstd |")
    print("|---|---|--:|--:|--:|--:|--:|--:|")
    for folder in folders:
        for path in sorted(Path(folder).iterdir()):
            if path.suffix in SUFFIXES:
                for part in _parts(path):
                    for case in _cases(path.name, part):
                        print(_row(case), flush=True)


def _parts(path: Path) -> list[ebz.Mesh]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        content = ebz.read(path, triangulate=True)
    parts = content.parts if hasattr(content, "parts") else [content]
    return [part for part in parts if part.n_faces]


def _row(case: Case) -> str:
    raw = zstandard.ZstdCompressor(19).compress(case.values.tobytes())
    ours, draco = _ebz_size(case), _draco_size(case)
    share = f"{ours / draco:.2f}" if draco else ""
    sizes = f"{len(raw)} | {draco or ''} | {ours} | {share} | {ours / len(raw):.2f}"
    return f"| {case.file} | {case.kind} | {len(case.values)} | {sizes} |"


def _ebz_size(case: Case) -> int:
    mesh = case.mesh
    owner = "corner_attributes" if case.by_corner else "vertex_attributes"
    carrying = ebz.Mesh(mesh.vertices, mesh.faces, **{owner: {"normal": case.values}})
    plain = ebz.compress(mesh, bits=POSITION_BITS)
    return len(ebz.compress(carrying, bits=POSITION_BITS, **case.options)) - len(plain)


def _draco_size(case: Case) -> int:
    if case.draco is None:
        return 0
    mesh, values = case.mesh, case.values
    vertices, faces = mesh.vertices, mesh.faces
    if case.by_corner:
        rows, first, inverse = np.unique(
            np.concatenate(
                [
                    faces.reshape(-1, 1),
                    values.view(np.uint8).view(np.int32).reshape(len(values), -1),
                ],
                axis=1,
            ),
            axis=0,
            return_index=True,
            return_inverse=True,
        )
        vertices, values = vertices[rows[:, 0]], values[first]
        faces = inverse.reshape(-1, 3).astype(np.int32)
    name = case.draco["name"]
    rest = {key: value for key, value in case.draco.items() if key != "name"}
    if name in ("normals", "tex_coord"):
        values = values.astype(np.float64)  # what DracoPy wants; it makes floats of them
    value = {"values": values} if name == "generic_attributes" else values
    return len(_draco(vertices, faces, **{name: value}, **rest)) - len(
        _draco(mesh.vertices, mesh.faces)
    )


def _draco(vertices: Array, faces: Array, **options: Any) -> bytes:
    return DracoPy.encode(
        vertices.astype(np.float32),
        faces.astype(np.uint32),
        quantization_bits=POSITION_BITS,
        compression_level=10,
        **options,
    )


def _cases(file: str, mesh: ebz.Mesh) -> Iterator[Case]:
    plain = ebz.Mesh(mesh.vertices, mesh.faces)
    owners = [(mesh.vertex_attributes, False), (mesh.corner_attributes, True)]
    for attributes, by_corner in owners:
        for name, values in attributes.items():
            yield from _carried(file, plain, name, values, by_corner)
    if not any(
        "normal" in name or name == "nx" for name in mesh.corner_attributes | mesh.vertex_attributes
    ):
        yield from _normals(file, plain, computed_normals(mesh), False, "computed normals")
    if "red" in mesh.vertex_attributes:
        names = [
            name for name in ("red", "green", "blue", "alpha") if name in mesh.vertex_attributes
        ]
        colours = np.stack([mesh.vertex_attributes[name] for name in names], axis=1)
        yield Case(file, "colours", plain, colours, {}, {"name": "colors"})
    else:
        yield Case(file, "computed colours", plain, computed_colours(mesh), {}, {"name": "colors"})


def _carried(
    file: str, mesh: ebz.Mesh, name: str, values: Array, by_corner: bool
) -> Iterator[Case]:
    width = values.shape[1] if values.ndim == 2 else 1
    is_float = values.dtype.kind == "f"
    if "normal" in name.lower() and is_float and width == 3:
        yield from _normals(file, mesh, values, by_corner, name)
    elif is_float and width == 2:
        values = values.astype(np.float32)
        for bits in (10, 12):
            draco = {"name": "tex_coord", "tex_coord_quantization_bits": bits}
            yield Case(
                file,
                f"{name}, {bits} bits",
                mesh,
                values,
                {"attribute_bits": {"normal": bits}},
                draco,
                by_corner,
            )
        yield Case(file, f"{name}, lossless", mesh, values, {}, {"name": "tex_coord"}, by_corner)
    elif name not in ("red", "green", "blue", "alpha"):
        known = values.dtype in (np.float32, np.uint8, np.uint16, np.uint32)
        draco = {"name": "generic_attributes"} if known else None
        values = values if values.ndim > 1 else values[:, None]
        yield Case(file, name, mesh, values, {}, draco, by_corner)


def _normals(
    file: str, mesh: ebz.Mesh, values: Array, by_corner: bool, name: str
) -> Iterator[Case]:
    values = values.astype(np.float32)
    for bits in (8, 10, 12):
        draco = {"name": "normals", "normal_quantization_bits": bits}
        yield Case(
            file, f"{name}, {bits} bits", mesh, values, {"normal_bits": bits}, draco, by_corner
        )
    yield Case(file, f"{name}, lossless", mesh, values, {}, {"name": "normals"}, by_corner)


def computed_normals(mesh: ebz.Mesh) -> Array:
    """Float32, means by area."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    normals = np.zeros(mesh.vertices.shape)
    for i in range(3):
        np.add.at(normals, mesh.faces[:, i], np.cross(b - a, c - a))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return (normals / np.where(length > 0, length, 1)).astype(np.float32)


def computed_colours(mesh: ebz.Mesh) -> Array:
    """Bytes: patches with soft borders, shaded, and a little noise."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    x, y, z = ((mesh.vertices.astype(float) - low) / max((high - low).max(), 1e-30)).T
    patch = np.tanh(4 * np.sin(9 * x + 4 * np.sin(5 * y)) * np.sin(7 * z + 2 * x))
    shade = 0.75 + 0.25 * np.sin(15 * y)
    noise = np.random.default_rng(0).normal(0, 2, (len(x), 1))
    base = np.stack([150 + 80 * patch, 120 - 60 * patch, 90 + 30 * np.sin(11 * z)], axis=1)
    return np.clip(base * shade[:, None] + noise, 0, 255).astype(np.uint8)


if __name__ == "__main__":
    main(sys.argv[1:])
