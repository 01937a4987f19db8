"""Meshes -> PLY files, in the flavour that metadata["ply"] remembers where there is one."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.elements import Element as Rows
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import rendered
from ebz.formats.ply import ascii_body, binary_body
from ebz.formats.ply.columns import Lists
from ebz.formats.ply.fields import (
    COUNT_TYPES,
    TYPE_NAMES,
    Fields,
    Wanted,
    attribute_fields,
    converted,
    corner_fields,
    count_type,
    fits,
    is_name,
)
from ebz.formats.ply.header import TYPES, Element, Header, Property, read_header, write_header
from ebz.formats.ply.tables import AXES, END_NAMES, INDEX_NAMES, index_properties, mark

DEFAULT_FLAVOUR = {"format": "binary_little_endian", "header": ["element vertex", "element face"]}
RESERVED = ("vertex", "face", "tristrips")


def write_ply(mesh: Mesh) -> bytes:
    """The mesh as a PLY file: what read_ply reads back as the same.

    Warns of attributes that PLY has no name or no type for. Raises MeshError where metadata["ply"]
    is no header.
    """
    header = _parsed(mesh.metadata.get("ply", DEFAULT_FLAVOUR))
    in_text = header.format == "ascii"
    wanted = {
        element.name: Wanted(element.name, in_text, {p.name: p for p in element.properties})
        for element in header.elements
    }
    tables = _tables(mesh, wanted, in_text)
    order = dict.fromkeys(name for name in [*wanted, *tables] if name in tables)
    header.elements = [
        Element(name, tables[name][0], [prop for prop, _ in tables[name][1]]) for name in order
    ]
    header.lines = _lines(header.lines, header.elements) + _marks(mesh, tables)
    parts = [write_header(header)]
    for element in header.elements:
        columns = [column for _, column in tables[element.name][1]]
        if in_text:
            parts.append(ascii_body.write_rows(element, columns, header.newline))
        else:
            parts.append(binary_body.write_rows(element, columns, header.byte_order))
    return b"".join(parts)


def _parsed(flavour: Any) -> Header:
    """The flavour as a header without rows; it may come from a file and is checked like one."""
    try:
        lines = [b"ply", b"format " + flavour["format"].encode() + b" 1.0"]
        for line in flavour["header"]:
            text = line.encode() if isinstance(line, str) else bytes(line)
            lines.append(text + b" 0" if text.startswith(b"element ") else text)
        newline = flavour.get("newline", "\n").encode()
        return read_header(newline.join([*lines, b"end_header", b""]))
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise MeshError(f"metadata 'ply' is no PLY header: {error!r}") from None
    except MeshError as error:
        raise MeshError(f"metadata 'ply' is no PLY header: {error.message}") from None


def _lines(old: list[str | bytes], elements: list[Element]) -> list[str | bytes]:
    """The header lines of `elements`, with comments where they were between the old ones."""
    left = {e.name: {prop.name: str(prop) for prop in e.properties} for e in elements}
    lines: list[str | bytes] = []
    current: dict[str, str] = {}
    for line in old:
        if isinstance(line, bytes) or not line.startswith(("element ", "property ")):
            lines.append(line)
            continue
        name = line.split(" ")[-1]
        if line.startswith("property "):
            if name in current:
                lines.append(current.pop(name))
        else:
            lines += current.values()
            current = left.pop(name, {})
            if current:
                lines.append(line)
    lines += current.values()
    for name, properties in left.items():
        lines += [f"element {name}", *properties.values()]
    return lines


def _tables(mesh: Mesh, wanted: dict[str, Wanted], in_text: bool) -> dict[str, tuple[int, Fields]]:
    """How many rows each element has, and its properties with their columns."""
    vertex = wanted.get("vertex", Wanted("vertex", in_text))
    tables = {"vertex": (mesh.n_vertices, _vertex_fields(mesh, vertex))}
    if "face" in wanted or mesh.n_faces:
        face = Rows(mesh.offsets, mesh.corners, mesh.face_attributes, mesh.corner_attributes)
        face_wanted = wanted.get("face", Wanted("face", in_text))
        tables["face"] = (len(face), _row_fields(face, face_wanted))
    for name, element in mesh.elements.items():
        if name in RESERVED or not is_name(name):
            warn_dropped(f"PLY cannot carry an element named {name!r}")
            continue
        fields = _row_fields(element, wanted.get(name, Wanted(name, in_text)))
        if fields or not len(element):
            tables[name] = (len(element), fields)
        else:
            warn_dropped(f"PLY cannot carry {len(element)} rows without properties: {name!r}")
    return tables


def _vertex_fields(mesh: Mesh, wanted: Wanted) -> Fields:
    types = [
        _coordinate_type(mesh.vertices[:, i], wanted.declared.get(name), wanted.in_text)
        for i, name in enumerate(AXES)
    ]
    if mesh.vertices.dtype == np.float64 and all(TYPES[name] == "f4" for name in types):
        # All float would be read back as float32, unless in text that says more than that.
        text_says_more = wanted.in_text and rendered(mesh.vertices).dtype == np.float64
        types = types if text_says_more else ["double"] * 3
    fields: Fields = []
    for i, (name, type_name) in enumerate(zip(AXES, types, strict=True)):
        prop = Property(name, type_name)
        fields.append((prop, converted(mesh.vertices[:, i], prop, in_text=wanted.in_text)))
    fields += attribute_fields(wanted, mesh.vertex_attributes, set(AXES))
    return wanted.ordered(fields)


def _coordinate_type(values: npt.NDArray[Any], declared: Property | None, in_text: bool) -> str:
    own = TYPE_NAMES[values.dtype]
    if declared is None or declared.count_type:
        return own
    if declared.dtype == values.dtype:
        return declared.type
    if values.dtype == np.float32:
        return own
    if in_text and declared.dtype == np.float32:
        return declared.type
    return declared.type if fits(values, declared.dtype) else own


def _row_fields(element: Rows, wanted: Wanted) -> Fields:
    """The properties of faces, or of the rows of another element."""
    lengths = np.diff(element.offsets)
    fields = _index_fields(element, lengths, wanted)
    taken = {prop.name for prop, _ in fields}
    fields += attribute_fields(wanted, element.attributes, taken)
    fields += corner_fields(wanted, element.corner_attributes, lengths, taken)
    return wanted.ordered(fields)


def _index_fields(element: Rows, lengths: npt.NDArray[np.int64], wanted: Wanted) -> Fields:
    """What refers to vertices: `vertex1` and `vertex2` where edges have them, else a list."""
    old = [*wanted.declared.values()]
    index = [old[i] for i in index_properties(Element(wanted.name, 0, old))]
    if not index and wanted.name != "face" and not len(element.corners):
        return []
    as_ends = len(index) == 2 or (not index and wanted.name == "edge")
    if as_ends and (lengths == 2).all():
        index = index or [Property(name, "int") for name in END_NAMES]
        return [
            (prop, element.corners[i::2].astype(prop.dtype))
            for i, prop in enumerate(_wide_enough(prop, element.corners) for prop in index)
        ]
    given = index[0] if len(index) == 1 else Property(INDEX_NAMES[0], "int", COUNT_TYPES[0])
    prop = _wide_enough(given, element.corners)
    prop.count_type = count_type(int(lengths.max(initial=0)), given)
    counts = lengths.astype(prop.count_dtype)
    return [(prop, Lists(counts, element.corners.astype(prop.dtype)))]


def _wide_enough(prop: Property, corners: npt.NDArray[Any]) -> Property:
    """The property in a type that can refer to the highest vertex, its own if that can."""
    highest = int(corners.max(initial=0))
    for name in (prop.type, "int", "uint"):
        if highest <= np.iinfo(TYPES[name]).max:
            return Property(prop.name, name, prop.count_type)
    raise MeshError(f"PLY cannot refer to vertex {highest}")


def _marks(mesh: Mesh, tables: dict[str, tuple[int, Fields]]) -> list[str | bytes]:
    """Comments about the lists that would be taken for those of corners, or rows, and are not."""
    marks: list[str | bytes] = []
    of_corners = {name: element.corner_attributes for name, element in mesh.elements.items()}
    of_corners["face"] = mesh.corner_attributes
    offsets = {name: element.offsets for name, element in mesh.elements.items()}
    offsets["face"] = mesh.offsets
    for name, (_, fields) in tables.items():
        if name == "vertex":
            continue
        lengths = np.diff(offsets[name])
        for prop, column in fields:
            if isinstance(column, Lists) and prop.name not in INDEX_NAMES:
                is_corner = prop.name in of_corners[name]
                if is_corner != (column.per_corner(lengths) is not None) and len(column.values):
                    marks.append(mark(prop.name, name, per_corner=is_corner))
    return marks
