"""PLY files <-> meshes: ascii, binary little and big endian, any properties in any order.

What the format leaves open, and what is chosen here:

- `vertex_index` and `vertex_indices` are the same; the first of the two makes the faces, which may
  have any number of corners. tables.py says what lists and other elements become.
- Coordinates of mixed types, or of integers, become float64; the declared types are kept and come
  back where the values still fit them.
- In ascii, `float` is honoured where each text is a float32 rounded to some number of digits, as
  printf does it; where one holds more than that, the property (x, y and z together) is kept as
  float64 and written as such text, still declared `float`. So nothing is lost either way, but for
  superfluous digits of the text itself.
- One row is one line in ascii; blank lines are passed over. A row of other length is an error.
- Lists of one length in all rows become an (n, length) array; others are padded with zeros, and
  the attribute `NAME:count` says how long they are. `NAME:count` is written back as the list's.
- What follows the last element is left out with a warning. Triangle strips become triangles.
- Spaces within header lines are not kept, but for those of comments and obj_info; line ends are.
"""

from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import face_dtype
from ebz.codec.elements import Element as Rows
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import rendered
from ebz.formats.ply import ascii_body, binary_body, strips
from ebz.formats.ply.columns import Column
from ebz.formats.ply.header import MAGIC, Header, read_header
from ebz.formats.ply.tables import AXES, MARK, Table, check_named, read_table
from ebz.formats.polygons import check_indices, offsets_of


def is_ply(head: bytes) -> bool:
    """Whether a file that begins with `head` is a PLY file."""
    return head[:4] in (MAGIC + b"\n", MAGIC + b"\r")


def read_ply(data: bytes) -> Mesh:
    """The mesh of a PLY file; metadata["ply"] holds the flavour: format, newline, header lines.

    Raises MeshError that names line, or element, row and property.
    """
    header = read_header(data)
    _check_elements(header)
    columns = _read_columns(data, header)
    strips.strips_as_faces(header, columns)
    vertices = _vertices(header, columns["vertex"])
    tables = {e.name: read_table(e, columns[e.name], header) for e in header.elements}
    for name, table in tables.items():
        place = "face" if name == "face" else f"element {name!r}: row"
        check_indices(table.corners, table.lengths, len(vertices), partial("{} {}".format, place))
    vertex = tables.pop("vertex")
    face = tables.pop("face", Table(np.zeros(0, np.int64), np.zeros(0, np.int32)))
    return Mesh(
        vertices,
        face.corners,
        vertex.attributes,
        face.attributes,
        {"format": "ply", "ply": _flavour(header)},
        offsets_of(face.lengths),
        face.corner_attributes,
        {name: _rows(table, len(vertices)) for name, table in tables.items()},
    )


def _rows(table: Table, n_vertices: int) -> Rows:
    corners = table.corners.astype(face_dtype(n_vertices))
    return Rows(offsets_of(table.lengths), corners, table.attributes, table.corner_attributes)


def _check_elements(header: Header) -> None:
    by_name = {element.name: element for element in header.elements}
    if "vertex" not in by_name:
        raise MeshError("there is no element 'vertex'")
    for name in AXES:
        found = [p for p in by_name["vertex"].properties if p.name == name]
        if not found:
            raise MeshError(f"element 'vertex': there is no property {name!r}")
        if found[0].count_type:
            raise MeshError(f"element 'vertex': property {name!r} is a list")
    for element in header.elements:
        if element.name == strips.NAME:
            strips.check_strips(header, element)
        if element.name == "face" and element.count:
            check_named(element)
        elif not element.properties and element.count:
            raise MeshError(f"element {element.name!r}: {element.count} rows without properties")


def _read_columns(data: bytes, header: Header) -> dict[str, list[Column]]:
    columns = {}
    if header.format == "ascii":
        text = data[header.size :]
        body = ascii_body.Body(text.replace(b"\r", b"\n") if header.newline == "\r" else text)
        for element in header.elements:
            columns[element.name] = body.read_rows(element)
        left, unit = body.rest(), "lines"
    else:
        offset = header.size
        for element in header.elements:
            columns[element.name], offset = binary_body.read_rows(
                data, offset, element, header.byte_order
            )
        left, unit = len(data) - offset, "bytes"
    if left:
        warn_dropped(f"{left} {unit} behind the last element")
    return columns


def _vertices(header: Header, columns: list[Column]) -> npt.NDArray[Any]:
    """(n, 3) float32 where x, y and z are float, else float64."""
    vertex = next(element for element in header.elements if element.name == "vertex")
    by_name = {p.name: (p, c) for p, c in zip(vertex.properties, columns, strict=True)}
    single = all(by_name[name][0].dtype == np.float32 for name in AXES)
    ascii_file = header.format == "ascii"
    dtype = np.float32 if single and not ascii_file else np.float64
    vertices = np.empty((vertex.count, 3), dtype)
    for i, name in enumerate(AXES):
        vertices[:, i] = by_name[name][1]
    return rendered(vertices) if single and ascii_file else vertices


def _flavour(header: Header) -> dict[str, Any]:
    """What write_ply needs to write the file as it was."""
    lines = [x for x in header.lines if isinstance(x, bytes) or not MARK.fullmatch(x)]
    flavour: dict[str, Any] = {"format": header.format, "header": lines}
    if header.newline != "\n":
        flavour["newline"] = header.newline
    return flavour
