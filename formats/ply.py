"""PLY files <-> meshes: ascii, binary little and big endian, any properties in any order.

What the format leaves open, and what is chosen here:

- `vertex_index` and `vertex_indices` are the same; the first of the two makes the faces.
- Coordinates of mixed types, or of integers, become float64; the declared types are kept and come
  back where the values still fit them.
- In ascii, `float` is honoured where each text is a float32 rounded to some number of digits, as
  printf does it; where one holds more than that, the property (x, y and z together) is kept as
  float64 and written as such text, still declared `float`. So nothing is lost either way, but for
  superfluous digits of the text itself.
- One row is one line in ascii; blank lines are passed over. A row of other length is an error.
- Lists of one length in all rows become an (n, length) array; others are padded with zeros, and
  the attribute `NAME:count` says how long they are. `NAME:count` is written back as the list's.
- Elements other than vertex and face are left out with a warning; so is what follows the last
  element. Triangle strips are refused.
- Spaces within header lines are not kept, but for those of comments and obj_info; line ends are.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats import ply_ascii, ply_binary
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import rendered
from ebz.formats.ply_columns import Column, Lists, padded
from ebz.formats.ply_header import MAGIC, Element, Header, read_header
from ebz.formats.polygons import check_indices, triangles

AXES = ("x", "y", "z")
INDEX_NAMES = ("vertex_indices", "vertex_index")
COUNT_SUFFIX = ":count"


def is_ply(head: bytes) -> bool:
    """Whether a file that begins with `head` is a PLY file."""
    return head[:4] in (MAGIC + b"\n", MAGIC + b"\r")


def read_ply(data: bytes, *, triangulate: bool = False) -> Mesh:
    """The mesh of a PLY file; metadata["ply"] holds the flavour: format, newline, header lines.

    Raises MeshError that names line, or element, row and property.
    """
    header = read_header(data)
    _check_elements(header)
    columns = _read_columns(data, header)
    vertex = _element(header, "vertex")
    vertices = _vertices(header, vertex, columns["vertex"])
    rest = [(p, c) for p, c in zip(vertex.properties, columns["vertex"], strict=True)]
    vertex_attributes = _attributes(vertex, [(p, c) for p, c in rest if p.name not in AXES], header)
    mesh = Mesh(vertices, np.zeros((0, 3), np.int32), vertex_attributes)
    mesh.metadata = {"format": "ply", "ply": _flavour(header)}
    if "face" not in columns:
        return mesh
    face = _element(header, "face")
    faces, origin, attributes = _faces(face, columns["face"], header, triangulate=triangulate)
    check_indices(faces, len(vertices), lambda row: f"face {_source(origin, row)}")
    if origin is not None:
        attributes = {name: values[origin] for name, values in attributes.items()}
    return Mesh(vertices, faces, vertex_attributes, attributes, mesh.metadata)


def _source(origin: npt.NDArray[np.intp] | None, row: int) -> int:
    return row if origin is None else int(origin[row])


def _check_elements(header: Header) -> None:
    names = [element.name for element in header.elements]
    if "vertex" not in names:
        raise MeshError("there is no element 'vertex'")
    for name in AXES:
        found = [p for p in _element(header, "vertex").properties if p.name == name]
        if not found:
            raise MeshError(f"element 'vertex': there is no property {name!r}")
        if found[0].count_type:
            raise MeshError(f"element 'vertex': property {name!r} is a list")
    for element in header.elements:
        if element.name == "tristrips" and element.count:
            raise MeshError("element 'tristrips': triangle strips are not read: write faces")
        if element.name == "face" and element.count:
            _index_column(element)


def _element(header: Header, name: str) -> Element:
    return next(element for element in header.elements if element.name == name)


def _index_column(face: Element) -> int:
    for i, prop in enumerate(face.properties):
        if prop.name in INDEX_NAMES:
            if not prop.count_type or prop.dtype.kind == "f":
                raise MeshError(f"element 'face': property {prop.name!r} is no list of integers")
            return i
    raise MeshError("element 'face': there is no property 'vertex_indices'")


def _read_columns(data: bytes, header: Header) -> dict[str, list[Column]]:
    columns = {}
    if header.format == "ascii":
        text = data[header.size :]
        body = ply_ascii.Body(text.replace(b"\r", b"\n") if header.newline == "\r" else text)
        for element in header.elements:
            columns[element.name] = body.read_rows(element)
        left, unit = body.rest(), "lines"
    else:
        offset = header.size
        for element in header.elements:
            columns[element.name], offset = ply_binary.read_rows(
                data, offset, element, header.byte_order
            )
        left, unit = len(data) - offset, "bytes"
    for element in header.elements:
        if element.name not in ("vertex", "face"):
            warn_dropped(f"element {element.name!r} with {element.count} rows")
    if left:
        warn_dropped(f"{left} {unit} behind the last element")
    return columns


def _vertices(header: Header, vertex: Element, columns: list[Column]) -> npt.NDArray[Any]:
    """(n, 3) float32 where x, y and z are float, else float64."""
    by_name = {p.name: (p, c) for p, c in zip(vertex.properties, columns, strict=True)}
    single = all(by_name[name][0].dtype == np.float32 for name in AXES)
    ascii_file = header.format == "ascii"
    dtype = np.float32 if single and not ascii_file else np.float64
    vertices = np.empty((vertex.count, 3), dtype)
    for i, name in enumerate(AXES):
        vertices[:, i] = by_name[name][1]
    return rendered(vertices) if single and ascii_file else vertices


def _attributes(
    element: Element, columns: list[tuple[Any, Column]], header: Header
) -> dict[str, npt.NDArray[Any]]:
    attributes: dict[str, npt.NDArray[Any]] = {}
    for prop, column in columns:
        values = column.values if isinstance(column, Lists) else column
        if header.format == "ascii" and prop.dtype == np.float32:
            values = rendered(values)
        if isinstance(column, Lists):
            length = column.constant_length()
            if length is None:
                where = f"element {element.name!r}: property {prop.name!r}"
                values = padded(Lists(column.lengths, values), where)
                attributes[prop.name + COUNT_SUFFIX] = column.lengths
            else:
                values = values.reshape(len(column.lengths), length)
        attributes[prop.name] = values
    return attributes


def _faces(
    face: Element, columns: list[Column], header: Header, *, triangulate: bool
) -> tuple[npt.NDArray[Any], npt.NDArray[np.intp] | None, dict[str, npt.NDArray[Any]]]:
    index = _index_column(face) if face.count else -1
    rest = list(zip(face.properties, columns, strict=True))
    if index < 0:
        rest = [(p, c) for p, c in rest if p.name not in INDEX_NAMES]
        return np.zeros((0, 3), np.int32), None, _attributes(face, rest, header)
    lists = columns[index]
    assert isinstance(lists, Lists)  # _index_column has made sure
    faces, origin = triangles(
        lists.lengths, lists.values, triangulate=triangulate, place=lambda row: f"face {row}"
    )
    del rest[index]
    return faces, origin, _attributes(face, rest, header)


def _flavour(header: Header) -> dict[str, Any]:
    lines: list[str | bytes] = []
    kept = True
    for line in header.lines:
        if isinstance(line, str) and line.startswith("element "):
            kept = line in ("element vertex", "element face")
        is_comment = isinstance(line, bytes) or not line.startswith(("element ", "property "))
        if kept or is_comment:
            lines.append(line)
    flavour: dict[str, Any] = {"format": header.format, "header": lines}
    if header.newline != "\n":
        flavour["newline"] = header.newline
    return flavour
