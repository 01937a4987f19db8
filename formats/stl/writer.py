"""Meshes -> STL files, in the flavour that metadata["stl"] remembers; binary where it does not."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped, warn_elements
from ebz.formats.numbers import format_numbers
from ebz.formats.stl.normals import facet_normals
from ebz.formats.stl.reader import FACET, HEADER_SIZE
from ebz.formats.text_floats import one_line, reads_as_float32
from ebz.formats.weld import weld

FACET_TEXT = (
    "facet normal {}\n outer loop\n  vertex {}\n  vertex {}\n  vertex {}\n endloop\nendfacet\n"
).format


def write_stl(mesh: Mesh) -> bytes:
    """The mesh as an STL file; warns of what STL cannot carry.

    That is attributes, vertices that no face uses, vertices that share a position, and in binary
    what float64 says more than float32.
    """
    flavour = mesh.metadata.get("stl")
    flavour = flavour if isinstance(flavour, dict) else {}
    corners = mesh.vertices[mesh.faces]
    _warn_of_vertices(mesh)
    warn_attributes("STL", corner=mesh.corner_attributes)
    warn_elements("STL", mesh)
    left = dict(mesh.face_attributes)
    normals = left.pop("normal", None)
    if normals is None or normals.shape != (len(corners), 3) or normals.dtype.kind != "f":
        if normals is not None:
            left["normal"] = normals
        normals = facet_normals(corners)
    if flavour.get("format") == "ascii":
        return _write_ascii(mesh, corners, normals, left, flavour)
    return _write_binary(mesh, corners, normals, left, flavour)


def _warn_of_vertices(mesh: Mesh) -> None:
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    n_unused = len(used) - int(np.count_nonzero(used))
    if n_unused:
        warn_dropped(f"STL cannot carry vertices that no face uses: {n_unused}")
    n_shared = len(used) - n_unused - len(weld(mesh.vertices[used])[0])
    if n_shared:
        warn_dropped(f"STL cannot carry vertices that share a position: {n_shared} will be welded")


def _write_binary(
    mesh: Mesh,
    corners: npt.NDArray[Any],
    normals: npt.NDArray[Any],
    left: dict[str, npt.NDArray[Any]],
    flavour: dict[str, Any],
) -> bytes:
    if len(corners) >= 2**32:
        raise MeshError(f"binary STL cannot hold {len(corners)} facets")
    table = np.zeros(len(corners), FACET)
    with np.errstate(over="ignore", invalid="ignore"):
        table["normal"], table["corners"] = normals, corners
    if not np.array_equal(table["corners"], corners, equal_nan=True):
        warn_dropped("binary STL cannot carry float64: coordinates are rounded to float32")
    counts = left.get("attribute_byte_count")
    if counts is not None and counts.dtype == np.uint16 and counts.ndim == 1:
        table["attribute"] = left.pop("attribute_byte_count")
    warn_attributes("binary STL", vertex=mesh.vertex_attributes, face=left)
    header = flavour.get("header", b"")
    header = header if isinstance(header, bytes) else b""
    start = header[:HEADER_SIZE].ljust(HEADER_SIZE, b"\0")
    return b"".join([start, len(table).to_bytes(4, "little"), table.tobytes()])


def _write_ascii(
    mesh: Mesh,
    corners: npt.NDArray[Any],
    normals: npt.NDArray[Any],
    left: dict[str, npt.NDArray[Any]],
    flavour: dict[str, Any],
) -> bytes:
    if corners.dtype == np.float64 and reads_as_float32(corners):
        warn_dropped("ascii STL cannot carry float64 where the text says no more than float32")
    names = flavour.get("names")
    names = [one_line(name) for name in names] if isinstance(names, list) else []
    solids = left.get("solid")
    of_face = np.zeros(len(corners), np.int64)
    if solids is not None and solids.ndim == 1 and solids.dtype.kind in "iu":
        ordered = solids.size == 0 or bool((np.diff(solids.astype(np.int64)) >= 0).all())
        if ordered and solids.min(initial=0) >= 0 and solids.max(initial=0) < len(names):
            of_face = left.pop("solid").astype(np.int64)
    warn_attributes("ascii STL", vertex=mesh.vertex_attributes, face=left)
    points = _triples(mesh.vertices)
    of_corners = [[points[vertex] for vertex in column] for column in mesh.faces.T.tolist()]
    facets = list(map(FACET_TEXT, _triples(normals), *of_corners))
    ends = np.searchsorted(of_face, np.arange(max(len(names), 1)), "right").tolist()
    parts, start = [], 0
    for name, end in zip(names or [""], ends, strict=True):
        parts += [f"solid {name}".rstrip(" "), "\n", *facets[start:end]]
        parts += [f"endsolid {name}".rstrip(" "), "\n"]
        start = end
    return "".join(parts).encode()


def _triples(table: npt.NDArray[Any]) -> list[str]:
    columns = [format_numbers(np.ascontiguousarray(table[:, i])) for i in range(3)]
    return list(map(" ".join, zip(*columns, strict=True)))
