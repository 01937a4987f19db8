"""Triangle strips in PLY files -> the triangles that they make.

A row of the element `tristrips` is one list of vertices, in which -1 begins another strip; every
other triangle of a strip is turned round.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.ply.columns import Column, Lists
from ebz.formats.ply.header import Element, Header

NAME = "tristrips"
BREAK = -1


def strips_as_faces(header: Header, columns: dict[str, list[Column]]) -> None:
    """Put the element `face` in the place of `tristrips` where there is one. Raises MeshError."""
    found = next((element for element in header.elements if element.name == NAME), None)
    if found is None:
        return
    (strips,) = columns.pop(NAME)
    assert isinstance(strips, Lists)
    triangles = _triangles(strips)
    found.name, found.count = "face", len(triangles)
    header.lines = [f"element {found.name}" if x == f"element {NAME}" else x for x in header.lines]
    columns[found.name] = [Lists(np.full(len(triangles), 3), triangles.reshape(-1))]


def check_strips(header: Header, element: Element) -> None:
    """Raise MeshError where there is more than a list of vertices, or faces beside it."""
    if any(other.name == "face" for other in header.elements):
        raise MeshError(f"element {NAME!r}: strips beside faces are not read")
    lists = [p for p in element.properties if p.count_type and p.dtype.kind == "i"]
    if len(lists) != 1 or len(element.properties) != 1:
        raise MeshError(f"element {NAME!r}: expected one list of signed integers")


def _triangles(strips: Lists) -> npt.NDArray[Any]:
    """(n, 3) vertices."""
    ends = np.cumsum(strips.lengths, dtype=np.int64)[:-1]
    vertex = np.insert(strips.values.astype(np.int64), ends, BREAK)
    place = np.arange(len(vertex))
    begin = np.maximum.accumulate(np.where(vertex == BREAK, place + 1, 0)) if len(vertex) else place
    first = place[:-2]
    broken = vertex == BREAK
    first = first[~(broken[:-2] | broken[1:-1] | broken[2:])]
    odd = (first - begin[first]) % 2
    triangles: npt.NDArray[Any] = vertex[
        np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)
    ]
    return triangles
