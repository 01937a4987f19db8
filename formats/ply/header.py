"""The header of a PLY file: text <-> elements and their properties.

Source: Greg Turk, The PLY polygon file format, 1994.
"""

from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np

from ebz.codec.errors import MeshError
from ebz.formats.numbers import shown

ByteOrder: TypeAlias = Literal["<", ">"]

MAGIC = b"ply"
BYTE_ORDERS: dict[str, ByteOrder] = {
    "ascii": "<",
    "binary_little_endian": "<",
    "binary_big_endian": ">",
}
TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
MAX_COUNT_DIGITS = 20


@dataclass
class Property:
    """A scalar of `type`, or where `count_type` is given a list of them."""

    name: str
    type: str
    count_type: str | None = None

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype(TYPES[self.type])

    @property
    def count_dtype(self) -> np.dtype[Any]:
        return np.dtype(TYPES[self.count_type or ""])

    def __str__(self) -> str:
        kind = f"list {self.count_type} {self.type}" if self.count_type else self.type
        return f"property {kind} {self.name}"


@dataclass
class Element:
    """A table of `count` rows."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


@dataclass
class Header:
    """The elements in order, and every line between the format and end_header.

    lines: comments and obj_info as they stand (bytes where they are not UTF-8), `element NAME`
    and `property ...` lines with single spaces; so the order of everything is kept.
    """

    format: str
    newline: str
    elements: list[Element]
    lines: list[str | bytes]
    size: int

    @property
    def byte_order(self) -> ByteOrder:
        return BYTE_ORDERS[self.format]


def read_header(data: bytes) -> Header:
    """The header at the start of `data`; `size` is where the body begins."""
    newline = _newline(data)
    offset = len(MAGIC) + len(newline)
    header = Header("", newline.decode(), [], [], 0)
    number = 2
    while True:
        end = data.find(newline, offset)
        if end < 0:
            raise MeshError(f"line {number}: early end of file in the header")
        line = data[offset:end]
        offset = end + len(newline)
        if line.rstrip() == b"end_header":
            break
        try:
            _take_line(header, line)
        except MeshError as error:
            raise MeshError(f"line {number}: {error.message}") from None
        number += 1
    if not header.format:
        raise MeshError(f"line {number}: the header ends without a 'format' line")
    header.size = offset
    return header


def _newline(data: bytes) -> bytes:
    for newline in (b"\r\n", b"\n", b"\r"):
        if data.startswith(MAGIC + newline):
            return newline
    raise MeshError("line 1: expected 'ply'")


def _take_line(header: Header, line: bytes) -> None:
    words = line.split()
    keyword = words[0] if words else b""
    if keyword in (b"comment", b"obj_info"):
        header.lines.append(_text(line))
        return
    try:
        fields = [word.decode() for word in words[1:]]
    except UnicodeDecodeError:
        raise MeshError(f"{shown(line)} is not UTF-8") from None
    if keyword == b"format":
        _take_format(header, fields)
    elif not header.format:
        raise MeshError(f"expected 'format', found {shown(keyword)}")
    elif keyword == b"element":
        _take_element(header, fields)
    elif keyword == b"property":
        _take_property(header, fields)
    else:
        raise MeshError(f"{shown(keyword)} is no keyword of a PLY header")


def _take_format(header: Header, fields: list[str]) -> None:
    if header.format:
        raise MeshError("a second 'format' line")
    if len(fields) != 2 or fields[0] not in BYTE_ORDERS or fields[1] != "1.0":
        raise MeshError(
            "expected 'format ascii|binary_little_endian|binary_big_endian 1.0', "
            f"found {shown(' '.join(['format', *fields]).encode())}"
        )
    header.format = fields[0]


def _take_element(header: Header, fields: list[str]) -> None:
    if len(fields) != 2 or not _is_count(fields[1]):
        raise MeshError("expected 'element NAME COUNT'")
    if any(element.name == fields[0] for element in header.elements):
        raise MeshError(f"a second element {fields[0]!r}")
    header.elements.append(Element(fields[0], int(fields[1])))
    header.lines.append(f"element {fields[0]}")


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) <= MAX_COUNT_DIGITS


def _take_property(header: Header, fields: list[str]) -> None:
    if not header.elements:
        raise MeshError("a property before any element")
    element = header.elements[-1]
    prop = _property(fields)
    if any(other.name == prop.name for other in element.properties):
        raise MeshError(f"element {element.name!r}: a second property {prop.name!r}")
    element.properties.append(prop)
    header.lines.append(str(prop))


def _property(fields: list[str]) -> Property:
    if len(fields) == 4 and fields[0] == "list":
        _check_types(fields[1:3])
        if TYPES[fields[1]].startswith("f"):
            raise MeshError(f"a list cannot be counted in type {fields[1]!r}")
        return Property(fields[3], fields[2], fields[1])
    if len(fields) == 2:
        _check_types(fields[:1])
        return Property(fields[1], fields[0])
    raise MeshError("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'")


def _check_types(names: list[str]) -> None:
    for name in names:
        if name not in TYPES:
            raise MeshError(f"{shown(name.encode())} is no type of PLY")


def _text(line: bytes) -> str | bytes:
    try:
        return line.decode()
    except UnicodeDecodeError:
        return line


def write_header(header: Header) -> bytes:
    """The header as bytes: what read_header reads back as the same."""
    counts = {element.name: element.count for element in header.elements}
    lines: list[bytes] = [MAGIC, f"format {header.format} 1.0".encode()]
    for line in header.lines:
        if isinstance(line, bytes):
            lines.append(line)
        elif line.startswith("element "):
            lines.append(f"{line} {counts[line[8:]]}".encode())
        else:
            lines.append(line.encode())
    newline = header.newline.encode()
    return newline.join([*lines, b"end_header", b""])
