"""Meshes -> OFF files; formats/off/reader.py says how attributes are named."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_elements
from ebz.formats.numbers import format_numbers
from ebz.formats.off.reader import COLOR_NAMES, FACE_COLOR_NAMES
from ebz.formats.text_floats import DOUBLE_MARK, one_line, reads_as_float32
from ebz.formats.text_lines import joined_rows


def write_off(mesh: Mesh) -> bytes:
    """The mesh as an OFF file, shortest decimals; warns of attributes without a place."""
    left = dict(mesh.vertex_attributes)
    columns = _columns(mesh.vertices)
    keyword = "OFF"
    for name, letter, width in (
        ("normal", "N", 3),
        ("rgba", "C", 4),
        ("rgb", "C", 3),
        ("st", "ST", 2),
    ):
        values = left.get(name)
        suits = values is not None and values.shape == (len(mesh.vertices), width)
        if values is None or not suits or keyword.startswith(letter) or not _is_color(name, values):
            continue
        columns += _colors(values) if name in COLOR_NAMES.values() else _columns(values)
        keyword = letter + keyword
        del left[name]
    face_words, left_faces = _face_color_words(mesh)
    warn_attributes("OFF", vertex=left, face=left_faces, corner=mesh.corner_attributes)
    warn_elements("OFF", mesh)
    flavour = mesh.metadata.get("off")
    flavour = flavour if isinstance(flavour, dict) else {}
    found = flavour.get("comments")
    comments = found if isinstance(found, list) else []
    if mesh.vertices.dtype == np.float64 and reads_as_float32(mesh.vertices):
        comments = [DOUBLE_MARK, *comments]
    edges = flavour.get("edges")
    lines = [keyword, *(f"# {one_line(c)}".rstrip(" ") for c in comments)]
    n_edges = edges if isinstance(edges, int) and edges >= 0 else 0
    lines.append(f"{mesh.n_vertices} {mesh.n_faces} {n_edges}")
    lines += map(" ".join, zip(*columns, strict=True))
    corners = joined_rows(list(map(str, mesh.corners.tolist())), mesh.offsets)
    lengths = np.diff(mesh.offsets).tolist()
    faces = zip(lengths, corners, face_words, strict=True)
    lines += [f"{n} {text}{more}" if n else f"0{more}" for n, text, more in faces]
    return "\n".join([*lines, ""]).encode()


def _is_color(name: str, values: npt.NDArray[Any]) -> bool:
    """Whether the text gives these values back: floats, and in colours bytes."""
    return values.dtype.kind == "f" or (name in COLOR_NAMES.values() and values.dtype == np.uint8)


def _columns(table: npt.NDArray[Any]) -> list[list[str]]:
    return [format_numbers(np.ascontiguousarray(table[:, i])) for i in range(table.shape[1])]


def _colors(table: npt.NDArray[Any]) -> list[list[str]]:
    """Like _columns, but floats are told from bytes by a point."""
    columns = _columns(table)
    if table.dtype.kind != "f":
        return columns
    return [[f"{w}.0" if w.lstrip("-").isdigit() else w for w in column] for column in columns]


def _face_color_words(mesh: Mesh) -> tuple[list[str], dict[str, npt.NDArray[Any]]]:
    """What stands behind the corners of each face, and the attributes that have no place there."""
    left, n = dict(mesh.face_attributes), mesh.n_faces
    for width, name in (*FACE_COLOR_NAMES.items(), (4, "color")):
        values, counts = left.get(name), left.get("color:count")
        if values is None or values.shape not in ((n, width), (n,) if width == 1 else (n, 4)):
            continue
        if not _is_color("rgb", values) or (name == "color" and counts is None):
            continue
        columns = _colors(values.reshape(n, width))
        words = [" " + " ".join(row) for row in zip(*columns, strict=True)]
        del left[name]
        if name == "color" and counts is not None:
            limits = counts.tolist()
            rows = zip(words, limits, strict=True)
            words = ["".join(f" {w}" for w in text.split()[:k]) for text, k in rows]
            del left["color:count"]
        return words, left
    return [""] * n, left
