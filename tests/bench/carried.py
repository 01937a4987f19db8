"""Sizes of meshes that carry more than triangles, beside zstd and Draco: a table in Markdown.

    python -m tests.bench.carried FOLDER [--level 6]

Lossless: zstd -19 keeps the file, ebz all that the file says, Draco (level 10, floats as they are)
the attributes of vertices, with vertices split where their corners differ.  What Draco has no place
for is named.  Rounded: positions to 14 bits, texture coordinates to 12, normals to 10, by both.
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
    "| file | carries | file | zstd -19 | ebz | Draco | ebz, rounded | Draco, rounded "
    "| Draco leaves out |\n|---|---|--:|--:|--:|--:|--:|--:|---|"
)
POSITION_BITS, UV_BITS, NORMAL_BITS = 14, 12, 10
NORMALS = ("normal", "NORMAL", ("nx", "ny", "nz"))
UVS = ("uv", "texcoord", "TEXCOORD_0", "st")
COLOURS = (("red", "green", "blue", "alpha"), ("red", "green", "blue"), "rgba", "rgb")


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
    rounded = len(_rounded(mesh, parts, level))
    draco, draco_rounded = (
        _sum([_draco(part, exact) for part in parts]) for exact in (True, False)
    )
    missing = dict.fromkeys(name for part in parts for name in _left_out(part))
    kinds = dict.fromkeys(name for part in parts for name in _carried(part))
    sizes = f"{len(data):,} | {zstd:,} | {len(packed):,} | {draco} | {rounded:,} | {draco_rounded}"
    return f"| {path.name} | {', '.join(kinds)} | {sizes} | {', '.join(missing)} |"


def _sum(sizes: list[int | None]) -> str:
    return "" if None in sizes else f"{sum(filter(None, sizes)):,}"


def _rounded(mesh: ebz.Mesh | ebz.Scene, parts: list[ebz.Mesh], level: int) -> bytes:
    names = {name for part in parts for name in (*part.vertex_attributes, *part.corner_attributes)}
    finite = all(np.isfinite(part.vertices).all() for part in parts)
    return ebz.compress(
        mesh,
        bits=POSITION_BITS if finite else None,
        attribute_bits=dict.fromkeys(names.intersection(UVS), UV_BITS),
        normal_bits=NORMAL_BITS,
        level=level,
    )


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


def _draco(mesh: ebz.Mesh, exact: bool) -> int | None:
    """Bytes of Draco; None where it has nothing to code."""
    if not mesh.n_vertices or (mesh.elements and not mesh.n_faces):
        return None
    mesh = _split(fanned(mesh))
    left = {name: _generic(values) for name, values in mesh.vertex_attributes.items()}
    normals, uv, colours = (_taken(left, names) for names in (NORMALS, UVS, COLOURS))
    data = DracoPy.encode(
        mesh.vertices.astype(np.float32),
        mesh.faces.astype(np.uint32) if mesh.n_faces else None,
        quantization_bits=0 if exact else POSITION_BITS,
        compression_level=10,
        colors=colours,
        tex_coord=None if uv is None else uv.astype(np.float64),  # stored as float32
        normals=None if normals is None else normals.astype(np.float64),
        tex_coord_quantization_bits=None if exact else UV_BITS,
        normal_quantization_bits=None if exact else NORMAL_BITS,
        generic_attributes=left or None,
    )
    return len(data)


def _taken(
    left: dict[str, np.ndarray], names: tuple[str | tuple[str, ...], ...]
) -> np.ndarray | None:
    """The first of the attributes, or of their groups, that there is; taken out of `left`."""
    for found in names:
        group = (found,) if isinstance(found, str) else found
        if all(name in left for name in group):
            return np.concatenate([left.pop(name) for name in group], axis=1)
    return None


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
