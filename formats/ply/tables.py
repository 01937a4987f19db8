"""The columns of a PLY element -> what refers to vertices, attributes of rows, and of corners.

A list of integers named `vertex_indices` or `vertex_index` holds the corners of each row, as the
scalars `vertex1` and `vertex2` hold the two of an edge. A list property that has k values for each
corner of its row holds them by corner; where that can be told from a vector of the row by the
numbers alone, and it is the other, a comment says so.
"""

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.errors import MeshError
from ebz.formats.numbers import rendered
from ebz.formats.ply.columns import Column, Lists, padded
from ebz.formats.ply.header import Element, Header, Property

AXES = ("x", "y", "z")
INDEX_NAMES = ("vertex_indices", "vertex_index")
END_NAMES = ("vertex1", "vertex2")
COUNT_SUFFIX = ":count"
MARK = re.compile(r"comment ebz: (\S+) of (\S+) is per (corner|row)")


@dataclass
class Table:
    """lengths: how many corners each row has; corners: the vertices of all, row after row."""

    lengths: npt.NDArray[Any]
    corners: npt.NDArray[Any]
    attributes: Attributes = field(default_factory=dict)
    corner_attributes: Attributes = field(default_factory=dict)


def mark(prop: str, element: str, *, per_corner: bool) -> str:
    """The comment that says whose values a list property holds."""
    return f"comment ebz: {prop} of {element} is per {'corner' if per_corner else 'row'}"


def marks_of(header: Header) -> dict[tuple[str, str], bool]:
    """Whether lists are per corner, by element and property, where a comment says so."""
    found = [MARK.fullmatch(line) for line in header.lines if isinstance(line, str)]
    return {(match[2], match[1]): match[3] == "corner" for match in found if match}


def index_properties(element: Element) -> list[int]:
    """Where the properties stand that refer to vertices: one list, two scalars, or none."""
    if element.name == "vertex":
        return []
    by_name = {prop.name: i for i, prop in enumerate(element.properties) if prop.dtype.kind != "f"}
    for i, prop in enumerate(element.properties):
        if prop.name in INDEX_NAMES and prop.count_type and i in by_name.values():
            return [i]
    ends = [by_name[name] for name in END_NAMES if name in by_name]
    if len(ends) == 2 and not any(element.properties[i].count_type for i in ends):
        return ends
    return []


def read_table(element: Element, columns: list[Column], header: Header) -> Table:
    """What the columns of an element hold; coordinates are left to the caller."""
    index = index_properties(element)
    table = _corners(element.count if columns else 0, [columns[i] for i in index])
    marks = marks_of(header)
    for i, (prop, column) in enumerate(zip(element.properties, columns, strict=True)):
        if i in index or (element.name == "vertex" and prop.name in AXES):
            continue
        values = column.values if isinstance(column, Lists) else column
        if header.format == "ascii" and prop.dtype == np.float32:
            values = rendered(values)
        if not isinstance(column, Lists):
            table.attributes[prop.name] = values
            continue
        lists = Lists(column.lengths, values)
        _add_lists(table, element, prop, lists, marks.get((element.name, prop.name)))
    return table


def _corners(count: int, columns: list[Column]) -> Table:
    if not columns:
        return Table(np.zeros(count, np.int64), np.zeros(0, np.int32))
    if isinstance(columns[0], Lists):
        return Table(columns[0].lengths, columns[0].values)
    ends = [column for column in columns if not isinstance(column, Lists)]
    return Table(np.full(count, 2), np.stack(ends, axis=1).ravel())


def _add_lists(
    table: Table, element: Element, prop: Property, lists: Lists, marked: bool | None
) -> None:
    width = lists.per_corner(table.lengths)
    if marked and np.array_equal(lists.lengths, table.lengths):
        width = 1
    if width and marked is not False:
        values = lists.values if width == 1 else lists.values.reshape(-1, width)
        table.corner_attributes[prop.name] = values
        return
    length = lists.constant_length()
    if length is None:
        table.attributes[prop.name + COUNT_SUFFIX] = lists.lengths
        where = f"element {element.name!r}: property {prop.name!r}"
        table.attributes[prop.name] = padded(lists, where)
    else:
        table.attributes[prop.name] = lists.values.reshape(len(lists.lengths), length)


def check_named(element: Element) -> None:
    """Raises MeshError where a face has no list of integers for its vertices."""
    for prop in element.properties:
        if prop.name in INDEX_NAMES:
            if not prop.count_type or prop.dtype.kind == "f":
                raise MeshError(f"element 'face': property {prop.name!r} is no list of integers")
            return
    raise MeshError("element 'face': there is no property 'vertex_indices'")
