"""Sizes of meshes that carry more than triangles, beside zstd and Draco: a table in Markdown.

    python -m tests.bench.carried FOLDER [--level 6]

Everything is lossless, as far as it goes: zstd -19 keeps the file, ebz all that the file says,
Draco (level 10, floats as they are) the attributes of vertices, with vertices split where their
corners differ.  What Draco has no place for is named.
"""

import argparse
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import DracoPy
import numpy as np
import zstandard

import ebz
from ebz.formats.meshes import format_of_suffix
from ebz.formats.polygons import fanned
from ebz.formats.weld import weld

HEAD = (
    "| file | carries | file | zstd -19 | ebz | ebz / zstd | Draco | Draco leaves out |\n"
    "|---|---|--:|--:|--:|--:|--:|---|"
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--level", type=int, default=6)
    options = parser.parse_args()
    warnings.simplefilter("ignore", ebz.DroppedWarning)
    print(HEAD)
    for path in sorted(options.folder.iterdir()):
        if format_of_suffix(path.suffix):
            print(_row(path, options.level), flush=True)
    return 0


def _row(path: Path, level: int) -> str:
    data = path.read_bytes()
    mesh = ebz.read(path)
    packed = ebz.compress(mesh, level=level)
    if not ebz.verify(packed, against=mesh).equal:
        raise AssertionError(path.name)
    zstd = len(zstandard.ZstdCompressor(level=19).compress(data))
    parts = mesh.parts if isinstance(mesh, ebz.Scene) else [mesh]
    draco = [_draco(part) for part in parts]
    size = "" if None in draco else f"{sum(filter(None, draco)):,}"
    missing = dict.fromkeys(name for part in parts for name in _left_out(part))
    kinds = dict.fromkeys(name for part in parts for name in _carried(part))
    sizes = f"{len(data):,} | {zstd:,} | {len(packed):,} | {len(packed) / zstd:.2f}"
    return f"| {path.name} | {', '.join(kinds)} | {sizes} | {size} | {', '.join(missing)} |"


def _carried(mesh: ebz.Mesh) -> Iterator[str]:
    """What there is besides vertices and triangles."""
    if not mesh.is_triangles:
        yield "polygons"
    if not mesh.n_faces:
        yield "no faces"
    if mesh.n_faces and len(np.unique(mesh.faces)) < mesh.n_vertices:
        yield "isolated vertices"
    if mesh.vertices.dtype == np.float64:
        yield "float64"
    for owner, attributes in (
        ("", mesh.vertex_attributes),
        (" of faces", mesh.face_attributes),
        (" of corners", mesh.corner_attributes),
    ):
        if attributes:
            yield f"{' '.join(attributes)}{owner}"
    for name, element in mesh.elements.items():
        yield f"{name} ({len(element)})"


def _left_out(mesh: ebz.Mesh) -> Iterator[str]:
    """What Draco has no place for."""
    if not mesh.is_triangles:
        yield "polygons"
    if mesh.n_faces and len(np.unique(mesh.faces)) < mesh.n_vertices:
        yield "isolated vertices"
    if mesh.vertices.dtype == np.float64:
        yield "float64"
    if mesh.face_attributes:
        yield "attributes of faces"
    yield from (f"{name} elements" for name in mesh.elements)


def _draco(mesh: ebz.Mesh) -> int | None:
    """Bytes of Draco; None where it has nothing to code."""
    if not mesh.n_vertices or (mesh.elements and not mesh.n_faces):
        return None
    mesh = _split(fanned(mesh))
    generic = {name: _generic(values) for name, values in mesh.vertex_attributes.items()}
    faces = mesh.faces.astype(np.uint32) if mesh.n_faces else None
    data = DracoPy.encode(
        mesh.vertices.astype(np.float32),
        faces,
        quantization_bits=0,
        compression_level=10,
        generic_attributes=generic or None,
    )
    return len(data)


def _generic(values: np.ndarray) -> np.ndarray:
    """(n, k) in a type that Draco has."""
    table = values.reshape(len(values), -1)
    if table.dtype in (np.float32, np.uint8, np.uint16, np.uint32):
        return table
    return table.astype(np.float32 if table.dtype.kind == "f" else np.uint32)


def _split(mesh: ebz.Mesh) -> ebz.Mesh:
    """Vertices split where the attributes of their corners differ, which become theirs."""
    if not mesh.corner_attributes:
        return mesh
    columns = [mesh.corners[:, None].astype(np.float64)]
    for values in mesh.corner_attributes.values():
        _, number = weld(values.reshape(len(values), -1))
        columns.append(number[:, None].astype(np.float64))
    _, first, inverse = np.unique(
        np.concatenate(columns, axis=1), axis=0, return_index=True, return_inverse=True
    )
    source = mesh.corners[first]
    attributes = {name: values[source] for name, values in mesh.vertex_attributes.items()}
    attributes |= {name: values[first] for name, values in mesh.corner_attributes.items()}
    return ebz.Mesh(mesh.vertices[source], inverse.reshape(-1, 3), attributes)


if __name__ == "__main__":
    sys.exit(main())
