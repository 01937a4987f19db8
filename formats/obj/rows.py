"""Faces, lines and points of a mesh as the rows of an OBJ file, with what their corners have.

Texture coordinates and normals are written once for each distinct value, in the order of their
first use.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.elements import Element
from ebz.formats.polygons import offsets_of
from ebz.formats.text_lines import joined_rows
from ebz.formats.weld import weld

Integers = npt.NDArray[np.int64]

# By keyword of the table: names of the corner attribute, and how many numbers a row may have.
TABLES = {"vt": (("uv", "texcoord"), (1, 2, 3)), "vn": (("normal",), (3,))}
NO_INDEX = 0


@dataclass
class Rows:
    """kinds: the keyword of each row as an index; values: (k, width) by table, NaN for none."""

    kinds: npt.NDArray[np.int8]
    lengths: Integers
    corners: npt.NDArray[Any]
    values: dict[str, npt.NDArray[Any]]

    def take(self, order: npt.NDArray[np.intp]) -> "Rows":
        """The rows in another order."""
        if np.array_equal(order, np.arange(len(order))):
            return self
        lengths = self.lengths[order]
        first = offsets_of(self.lengths)[:-1][order]
        steps = np.arange(int(lengths.sum())) - np.repeat(offsets_of(lengths)[:-1], lengths)
        corner = np.repeat(first, lengths) + steps
        values = {name: table[corner] for name, table in self.values.items()}
        return Rows(self.kinds[order], lengths, self.corners[corner], values)


def stacked(parts: list[Element], left: list[Attributes]) -> Rows:
    """The rows of all parts, one kind each; takes what it uses out of `left`, by part."""
    values = {}
    for keyword, (names, widths) in TABLES.items():
        tables = [
            _taken(attributes, names, widths, len(part.corners))
            for part, attributes in zip(parts, left, strict=True)
        ]
        width = max((table.shape[1] for table in tables if table is not None), default=0)
        if width:
            columns = [
                _widened(table, len(part.corners), width)
                for part, table in zip(parts, tables, strict=True)
            ]
            values[keyword] = np.concatenate([c for c in columns if len(c)] or columns)
    return Rows(
        np.repeat(np.arange(len(parts), dtype=np.int8), [len(part) for part in parts]),
        np.concatenate([np.diff(part.offsets) for part in parts]),
        np.concatenate([part.corners for part in parts]),
        values,
    )


def _taken(
    attributes: Attributes, names: tuple[str, ...], widths: tuple[int, ...], n: int
) -> npt.NDArray[Any] | None:
    for name in names:
        values = attributes.get(name)
        if values is None or values.dtype.kind != "f" or values.ndim > 2:
            continue
        if (values.shape[1] if values.ndim == 2 else 1) in widths:
            del attributes[name]
            return values.reshape(n, -1) if n else values.reshape(0, widths[-1])
    return None


def _widened(table: npt.NDArray[Any] | None, n: int, width: int) -> npt.NDArray[Any]:
    if table is None:
        return np.full((n, width), np.nan, np.float32)
    if table.shape[1] == width:
        return table
    wide = np.full((n, width), np.nan, table.dtype)
    wide[:, : table.shape[1]] = table
    return wide


def distinct(values: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], Integers]:
    """The distinct rows that are not all NaN, and for each row the number of its own from 1."""
    given = ~np.isnan(values).all(axis=1)
    table, inverse = weld(values[given])
    index = np.full(len(values), NO_INDEX, np.int64)
    index[given] = inverse + 1
    return table, index


def row_texts(rows: Rows, indices: dict[str, Integers], keywords: list[str]) -> list[str]:
    """The line of each row."""
    words = _corner_words(rows.corners.astype(np.int64) + 1, indices)
    texts = joined_rows(words, offsets_of(rows.lengths))
    heads = [keywords[kind] for kind in rows.kinds.tolist()]
    return [f"{head} {text}" for head, text in zip(heads, texts, strict=True)]


def _corner_words(vertices: Integers, indices: dict[str, Integers]) -> list[str]:
    """v, v/vt, v//vn or v/vt/vn for each corner."""
    v = vertices.tolist()
    none = [NO_INDEX] * len(v)
    given = {keyword: index.any() for keyword, index in indices.items()}
    if not any(given.values()):
        return list(map(str, v))
    vt, vn = (indices[keyword].tolist() if given.get(keyword) else none for keyword in TABLES)
    if all((index != NO_INDEX).all() for index in indices.values()):
        if len(given) == 2:
            return [f"{a}/{b}/{c}" for a, b, c in zip(v, vt, vn, strict=True)]
        if "vt" in given:
            return [f"{a}/{b}" for a, b in zip(v, vt, strict=True)]
        return [f"{a}//{c}" for a, c in zip(v, vn, strict=True)]
    return [f"{a}/{b or ''}/{c or ''}".rstrip("/") for a, b, c in zip(v, vt, vn, strict=True)]
