"""The numbers of OBJ vertices, texture coordinates and normals -> arrays."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.errors import MeshError
from ebz.formats.obj.lines import Rows
from ebz.formats.text_floats import floats_at, wide_if

# What stands behind x, y and z where there are so many numbers in all.
EXTRA = {4: ("w", 1), 6: ("rgb", 3), 7: ("rgba", 4)}


def read_vertices(rows: Rows, doubles: set[str]) -> tuple[npt.NDArray[Any], Attributes]:
    """(n, 3), and what stands behind the coordinates; doubles: what is float64 in any case."""
    values, counts = _numbers(rows)
    bad = ~np.isin(counts, (3, *EXTRA))
    if bad.any():
        row = int(np.argmax(bad))
        raise MeshError(
            f"line {rows.numbers[row]}: a vertex has 3, 4, 6 or 7 numbers, not {counts[row]}"
        )
    first = np.cumsum(counts) - counts
    attributes = {}
    for count, (name, width) in EXTRA.items():
        chosen = np.flatnonzero(counts == count)
        if chosen.size:
            table = np.full((len(rows), width), np.nan)
            table[chosen] = values[first[chosen][:, None] + np.arange(3, count)]
            table = table[:, 0] if width == 1 else table
            attributes[name] = wide_if(table, double=name in doubles)
    vertices = values[first[:, None] + np.arange(3)]
    return wide_if(vertices, double="" in doubles), attributes


def read_table(rows: Rows, what: str, least: int, most: int, *, double: bool) -> npt.NDArray[Any]:
    """(n, most that a row has), NaN where a row has fewer; each has `least` to `most` numbers."""
    values, counts = _numbers(rows)
    bad = (counts < least) | (counts > most)
    if bad.any():
        row = int(np.argmax(bad))
        numbers = f"{least} to {most}" if least < most else least
        raise MeshError(
            f"line {rows.numbers[row]}: a {what} has {numbers} numbers, not {counts[row]}"
        )
    width = int(counts.max(initial=least))
    table = np.full((len(rows), width), np.nan)
    table[np.arange(width) < counts[:, None]] = values
    return wide_if(table, double=double)


def _numbers(rows: Rows) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.intp]]:
    """All numbers, and how many each row has."""
    parts, lengths = [np.zeros(0)], [np.zeros(0, np.intp)]
    for numbers, text, counts in rows.blocks():
        parts.append(floats_at(text.split(), np.repeat(numbers, counts)))
        lengths.append(counts)
    return np.concatenate(parts), np.concatenate(lengths)
