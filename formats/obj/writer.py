"""Meshes -> OBJ files; formats/obj/reader.py says how attributes are named."""

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.elements import Element
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.numbers import format_numbers
from ebz.formats.obj.order import RUNS, order_of_rows, statements_between, take_in_force
from ebz.formats.obj.rows import TABLES, distinct, row_texts, stacked
from ebz.formats.obj.statements import LIBRARIES, LIBRARY
from ebz.formats.obj.tables import EXTRA
from ebz.formats.text_floats import DOUBLE_MARK, EMPTY_MARK, one_line, reads_as_float32

# Elements that have corners, by name; behind the faces, which are the first kind.
KEYWORDS = {"line": "l", "point": "p"}
PADDED = re.compile(r"^(vt \S+(?: \S+)*?)(?: nan)+$")


def write_obj(mesh: Mesh) -> bytes:
    """The mesh as an OBJ file, numbers as shortest decimals.

    Warns of attributes and elements that OBJ has no place for.
    """
    flavour = mesh.metadata.get("obj")
    flavour = flavour if isinstance(flavour, dict) else {}
    marks = [EMPTY_MARK] if not mesh.n_vertices else []
    left = dict(mesh.vertex_attributes)
    extra = _extra_words(mesh, left, marks)
    _mark(marks, "", mesh.vertices)
    points = _rows_of_numbers("v", mesh.vertices, extra)
    body, tables = _body(mesh, flavour)
    head: list[str] = []
    for keyword, parts in tables.items():
        values = _table(mesh, keyword, parts, left)
        if len(values):
            _mark(marks, TABLES[keyword][0][0], values)
            head += _rows_of_numbers(keyword, values)
    warn_attributes("OBJ", vertex=left)
    _warn_of_elements(mesh)
    comments = [*marks, *_strings(flavour.get("comments"))]
    lines = [f"# {comment}".rstrip(" ") for comment in comments]
    lines += [f"{LIBRARY} {name}".rstrip(" ") for name in _strings(flavour.get(LIBRARIES))]
    return "\n".join([*lines, *points, *head, *body, ""]).encode()


def _strings(value: Any) -> list[str]:
    return [one_line(text) for text in value] if isinstance(value, list) else []


def _mark(marks: list[str], name: str, values: npt.NDArray[Any]) -> None:
    """Adds the comment that says that text is float64 which does not show it."""
    if values.dtype == np.float64 and reads_as_float32(values):
        marks.append(f"{DOUBLE_MARK} {name}".rstrip(" "))


def _rows_of_numbers(
    keyword: str, table: npt.NDArray[Any], extra: list[str] | None = None
) -> list[str]:
    """A line for each row; texture coordinates lack the NaN at their end."""
    columns = [format_numbers(np.ascontiguousarray(table[:, i])) for i in range(table.shape[1])]
    heads = [keyword] * len(table)
    texts = map(" ".join, zip(heads, *columns, strict=True))
    if extra is not None:
        return [text + more for text, more in zip(texts, extra, strict=True)]
    if keyword != "vt" or not np.isnan(table).any():
        return list(texts)
    return [PADDED.sub(r"\1", text) for text in texts]


def _body(mesh: Mesh, flavour: dict[str, Any]) -> tuple[list[str], dict[str, npt.NDArray[Any]]]:
    """The lines of faces, lines and points and the statements between, and the tables they use."""
    elements = {name: mesh.elements[name] for name in KEYWORDS if name in mesh.elements}
    parts = {"face": _faces(mesh)} | elements
    left = {name: dict(part.attributes) for name, part in parts.items()}
    left_corners = {name: dict(part.corner_attributes) for name, part in parts.items()}
    matrix = np.concatenate(
        [
            take_in_force(left[name], len(part), smooth=name == "face")
            for name, part in parts.items()
        ]
    )
    rows = stacked([*parts.values()], [*left_corners.values()])
    for name in parts:
        warn_attributes("OBJ", **{name: left[name], f"{name} corner": left_corners[name]})
    order = order_of_rows(matrix, rows.kinds, mesh.metadata.get(RUNS))
    rows = rows.take(order)
    tables, indices = {}, {}
    for keyword in TABLES:
        tables[keyword] = np.zeros((0, 0), np.float32)
        if keyword in rows.values:
            tables[keyword], indices[keyword] = distinct(rows.values[keyword])
    texts = row_texts(rows, indices, ["f", *(KEYWORDS[name] for name in elements)])
    lines, at = [], 0
    for row, statements in statements_between(matrix[order], flavour):
        lines += [*texts[at:row], *statements]
        at = row
    return [*lines, *texts[at:]], tables


def _faces(mesh: Mesh) -> Element:
    return Element(mesh.offsets, mesh.corners, mesh.face_attributes, mesh.corner_attributes)


def _table(mesh: Mesh, keyword: str, used: npt.NDArray[Any], left: Attributes) -> npt.NDArray[Any]:
    """All values that are written under a keyword: those of corners, then those of no corner."""
    names, widths = TABLES[keyword]
    name, shapes = names[0], [(width,) for width in widths]
    values = left.get(name)
    free = not len(used) and keyword not in mesh.elements
    if values is not None and free and values.dtype.kind == "f" and values.shape[1:] in shapes:
        return left.pop(name)
    element = mesh.elements.get(keyword)
    unused = None if element is None else element.attributes.get(name)
    if unused is None or unused.dtype.kind != "f" or unused.ndim != 2 or not unused.size:
        return used
    if not len(used):
        return unused
    width = max(used.shape[1], unused.shape[1])
    table = np.full((len(used) + len(unused), width), np.nan, np.result_type(used, unused))
    table[: len(used), : used.shape[1]] = used
    table[len(used) :, : unused.shape[1]] = unused
    return table


def _extra_words(mesh: Mesh, left: Attributes, marks: list[str]) -> list[str]:
    """What stands behind x, y and z of each vertex; takes what it writes out of `left`."""
    words = [""] * mesh.n_vertices
    for name, width in EXTRA.values():
        values = left.get(name)
        if values is None or values.dtype.kind != "f" or values.size != width * len(words):
            continue
        table = values.reshape(-1, width)
        given = np.flatnonzero(~np.isnan(table).all(axis=1)).tolist()
        if any(words[row] for row in given):
            continue
        columns = [format_numbers(np.ascontiguousarray(table[given, i])) for i in range(width)]
        for row, *texts in zip(given, *columns, strict=True):
            words[row] = " " + " ".join(texts)
        del left[name]
        _mark(marks, name, values)
    return words


def _warn_of_elements(mesh: Mesh) -> None:
    unknown = [name for name in mesh.elements if name not in (*KEYWORDS, *TABLES)]
    if unknown:
        warn_dropped(f"OBJ cannot carry elements: {', '.join(map(repr, unknown))}")
