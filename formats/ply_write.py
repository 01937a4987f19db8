"""Meshes -> PLY files, in the flavour that metadata["ply"] remembers where there is one."""

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats import ply_ascii, ply_binary
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import rendered
from ebz.formats.ply import AXES, COUNT_SUFFIX, INDEX_NAMES
from ebz.formats.ply_columns import Column, Lists, unpadded
from ebz.formats.ply_header import TYPES, Element, Header, Property, read_header, write_header

Fields: TypeAlias = list[tuple[Property, Column]]

TYPE_NAMES = {np.dtype(code): name for name, code in reversed(TYPES.items())}
DEFAULT_FLAVOUR = {"format": "binary_little_endian", "header": ["element vertex", "element face"]}


def write_ply(mesh: Mesh) -> bytes:
    """The mesh as a PLY file: what read_ply reads back as the same.

    Warns of attributes that PLY has no name or no type for. Raises MeshError where metadata["ply"]
    is no header.
    """
    header = _parsed(mesh.metadata.get("ply", DEFAULT_FLAVOUR))
    wanted = {element.name: element.properties for element in header.elements}
    in_text = header.format == "ascii"
    tables = {"vertex": _vertex_fields(mesh, wanted.get("vertex", []), in_text)}
    if "face" in wanted or len(mesh.faces):
        tables["face"] = _face_fields(mesh, wanted.get("face", []), in_text)
    counts = {"vertex": len(mesh.vertices), "face": len(mesh.faces)}
    order = [name for name in [*wanted, *tables] if name in tables]
    header.elements = [
        Element(name, counts[name], [prop for prop, _ in tables[name]])
        for name in dict.fromkeys(order)
    ]
    header.lines = _lines(header.lines, header.elements)
    parts = [write_header(header)]
    for element in header.elements:
        columns = [column for _, column in tables[element.name]]
        if in_text:
            parts.append(ply_ascii.write_rows(element, columns, header.newline))
        else:
            parts.append(ply_binary.write_rows(element, columns, header.byte_order))
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


def _vertex_fields(mesh: Mesh, wanted: list[Property], in_text: bool) -> Fields:
    declared = {prop.name: prop for prop in wanted}
    types = [
        _coordinate_type(mesh.vertices[:, i], declared.get(name), in_text)
        for i, name in enumerate(AXES)
    ]
    if mesh.vertices.dtype == np.float64 and all(TYPES[name] == "f4" for name in types):
        # All float would be read back as float32, unless in text that says more than that.
        text_says_more = in_text and rendered(mesh.vertices).dtype == np.float64
        types = types if text_says_more else ["double"] * 3
    fields: Fields = []
    for i, (name, type_name) in enumerate(zip(AXES, types, strict=True)):
        prop = Property(name, type_name)
        fields.append((prop, _converted(mesh.vertices[:, i], prop, in_text)))
    fields += _attribute_fields("vertex", mesh.vertex_attributes, declared, in_text, AXES)
    return _ordered(fields, declared)


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
    return declared.type if _fits(values, declared.dtype) else own


def _fits(values: npt.NDArray[Any], dtype: np.dtype[Any]) -> bool:
    """Whether `values` come back bit for bit from `dtype`."""
    with np.errstate(over="ignore", invalid="ignore"):
        back = values.astype(dtype).astype(values.dtype)
    return np.ascontiguousarray(values).tobytes() == back.tobytes()


def _face_fields(mesh: Mesh, wanted: list[Property], in_text: bool) -> Fields:
    declared = {prop.name: prop for prop in wanted}
    index = next(
        (p for p in wanted if p.name in INDEX_NAMES and p.count_type and p.dtype.kind != "f"),
        Property(INDEX_NAMES[0], "int", "uchar"),
    )
    highest = int(mesh.faces.max(initial=0))
    type_name = next(
        (name for name in (index.type, "int", "uint") if highest <= np.iinfo(TYPES[name]).max), None
    )
    if type_name is None:
        raise MeshError(f"PLY cannot refer to vertex {highest}")
    prop = Property(index.name, type_name, index.count_type)
    lengths = np.full(len(mesh.faces), 3, prop.count_dtype)
    fields: Fields = [(prop, Lists(lengths, mesh.faces.astype(prop.dtype).ravel()))]
    fields += _attribute_fields("face", mesh.face_attributes, declared, in_text, (index.name,))
    return _ordered(fields, declared)


def _ordered(fields: Fields, declared: dict[str, Property]) -> Fields:
    """Declared properties in their order, then the others in theirs."""
    rank = {name: i for i, name in enumerate(declared)}
    return sorted(fields, key=lambda field: rank.get(field[0].name, len(rank)))


def _attribute_fields(
    owner: str,
    attributes: dict[str, npt.NDArray[Any]],
    declared: dict[str, Property],
    in_text: bool,
    taken: tuple[str, ...],
) -> Fields:
    fields: Fields = []
    counts = {name for name in attributes if _is_count(name, attributes)}
    for name, values in attributes.items():
        if name in counts:
            continue
        if name in taken or not _is_name(name):
            warn_dropped(f"PLY cannot carry {owner} attribute {name!r} under this name")
            continue
        plain = _plain(values)
        if plain is None:
            warn_dropped(f"PLY has no type for {owner} attribute {name!r} of {values.dtype}")
            continue
        lengths = attributes[name + COUNT_SUFFIX] if name + COUNT_SUFFIX in counts else None
        fields.append(_attribute_field(name, plain, lengths, declared.get(name), in_text))
    return fields


def _is_name(name: str) -> bool:
    """Whether `name` is one word of a header."""
    word = name.encode(errors="replace")
    return word.split() == [word] and word.decode() == name


def _is_count(name: str, attributes: dict[str, npt.NDArray[Any]]) -> bool:
    """Whether attribute `name` says how long the lists of another one are."""
    table = attributes.get(name.removesuffix(COUNT_SUFFIX))
    lengths = attributes[name]
    if not name.endswith(COUNT_SUFFIX) or table is None or table.ndim != 2 or lengths.ndim != 1:
        return False
    if lengths.dtype not in TYPE_NAMES or lengths.dtype.kind == "f":
        return False
    if lengths.min(initial=0) < 0 or lengths.max(initial=0) > table.shape[1]:
        return False
    return not table[np.arange(table.shape[1]) >= lengths[:, None]].any()


def _plain(values: npt.NDArray[Any]) -> npt.NDArray[Any] | None:
    """The values in a type that PLY has, None where there is none that holds them."""
    if values.dtype in TYPE_NAMES:
        return values
    for code in ("u1", "i4", "u4", "f4", "f8"):
        suits = code[0] == "f" or values.dtype.kind != "f"
        if suits and _fits(values, np.dtype(code)):
            return values.astype(code)
    return None


def _attribute_field(
    name: str,
    values: npt.NDArray[Any],
    lengths: npt.NDArray[Any] | None,
    declared: Property | None,
    in_text: bool,
) -> tuple[Property, Column]:
    type_name = TYPE_NAMES[values.dtype]
    if declared and _keeps_dtype(values, declared, in_text):
        type_name = declared.type
    prop = Property(name, type_name)
    if values.ndim == 1:
        return prop, _converted(values, prop, in_text)
    table = values.reshape(len(values), -1) if values.size else values.reshape(len(values), 0)
    prop.count_type = _count_type(table, lengths, declared)
    if lengths is None:
        lengths = np.full(len(table), table.shape[1], prop.count_dtype)
    lists = unpadded(table, lengths)
    return prop, Lists(lengths.astype(prop.count_dtype), _converted(lists.values, prop, in_text))


def _keeps_dtype(values: npt.NDArray[Any], declared: Property, in_text: bool) -> bool:
    if declared.dtype == values.dtype:
        return True
    text_says_more = in_text and declared.dtype == np.float32 and values.dtype == np.float64
    return text_says_more and rendered(values).dtype == np.float64


def _count_type(
    table: npt.NDArray[Any], lengths: npt.NDArray[Any] | None, declared: Property | None
) -> str:
    names = [declared.count_type] if declared and declared.count_type else []
    if lengths is not None:
        same = [name for name in names if np.dtype(TYPES[name]) == lengths.dtype]
        return (same or [TYPE_NAMES[lengths.dtype]])[0]
    return next(n for n in [*names, "uchar", "int"] if table.shape[1] <= np.iinfo(TYPES[n]).max)


def _converted(values: npt.NDArray[Any], prop: Property, in_text: bool) -> npt.NDArray[Any]:
    """Values in the declared type; in text float64 stays what it is and says more than float."""
    if in_text and values.dtype == np.float64 and prop.dtype == np.float32:
        return values
    return values.astype(prop.dtype)
