"""The corners of OBJ faces, lines and points: words like 7, 7/1, 7//2 and 7/1/2 -> indices.

Digits are read for all words at once; a block in which there is anything but plain indices is read
word by word, which finds what is wrong with it.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.numbers import parse_integers, shown
from ebz.formats.obj.lines import Rows
from ebz.formats.text_lines import WHITE

Integers = npt.NDArray[np.int64]

SLASH, MINUS, ZERO = b"/-0"
MAX_SLOTS = 3
MAX_DIGITS = 18  # of which every number is an int64
WHAT = ("vertex", "texture coordinate", "normal")


@dataclass
class Corners:
    """lengths: how many corners each row has; indices: (k, 3) from 0, -1 where there is none.

    Columns: vertex, texture coordinate, normal.
    """

    lengths: npt.NDArray[np.intp]
    indices: Integers


def read_corners(rows: Rows, tables: tuple[Rows, Rows, Rows], what: str) -> Corners:
    """The corners of all rows; negative indices count back from what stands before their line.

    tables: the lines of vertices, texture coordinates and normals. Raises MeshError that names the
    line, where an index refers to nothing.
    """
    lengths, parts = [np.zeros(0, np.intp)], [np.zeros((0, MAX_SLOTS), np.int64)]
    for numbers, text, counts in rows.blocks():
        lengths.append(counts)
        found = _plain_indices(text)
        if found is None:
            found = _odd_indices(text, np.repeat(numbers, counts), what)
        parts.append(found)
    corners = Corners(np.concatenate(lengths), np.concatenate(parts))
    numbers = np.repeat(rows.numbers, corners.lengths)
    for slot, table in enumerate(tables):
        _resolve(corners.indices[:, slot], table.numbers, numbers, what, slot)
    return corners


def _plain_indices(text: bytes) -> Integers | None:
    """(k, 3) as written, 0 where there is none; None where the text is not plain."""
    characters = np.frombuffer(text, np.uint8)
    white, slash = WHITE[characters], characters == SLASH
    apart = white | slash
    digits = characters - np.uint8(ZERO)
    begins = np.flatnonzero(_begins(~apart))
    ends = np.flatnonzero(_begins(apart[::-1] == 0)[::-1]) + 1
    negative = characters[begins] == MINUS
    firsts = begins + negative
    n_digits = ends - firsts
    n_plain = np.count_nonzero(digits <= 9)
    if n_plain != n_digits.sum() or (n_digits < 1).any() or n_digits.max(initial=1) > MAX_DIGITS:
        return None
    values = np.zeros(len(begins), np.int64)
    for i in range(int(n_digits.max(initial=0))):
        more = np.flatnonzero(n_digits > i)
        values[more] = values[more] * 10 + digits[firsts[more] + i]
    if not values.all():
        return None
    np.negative(values, out=values, where=negative)
    corner_begins = _begins(~white)
    corner = np.cumsum(corner_begins, dtype=np.int32)[begins] - 1
    n_slashes = np.cumsum(slash, dtype=np.int32)
    before = n_slashes[corner_begins] - slash[corner_begins]
    slot = n_slashes[begins] - before[corner]
    if slot.max(initial=0) >= MAX_SLOTS:
        return None
    indices = np.zeros((len(before), MAX_SLOTS), np.int64)
    indices[corner, slot] = values
    return None if not indices[:, 0].all() else indices


def _begins(inside: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Where each run begins."""
    begins = inside.copy()
    begins[1:] &= ~inside[:-1]
    return begins


def _odd_indices(text: bytes, lines: npt.NDArray[np.int64], what: str) -> Integers:
    indices = np.zeros((len(lines), MAX_SLOTS), np.int64)
    for row, (word, line) in enumerate(zip(text.split(), lines.tolist(), strict=True)):
        parts = word.split(b"/")
        try:
            given = [int(parse_integers([part])[0]) if part else None for part in parts]
        except ValueError:
            raise MeshError(f"line {line}: {shown(word)} is no integer") from None
        if len(given) > MAX_SLOTS or given[0] is None:
            raise MeshError(f"line {line}: {shown(word)} is no corner")
        for slot, index in enumerate(given):
            if index == 0:
                raise MeshError(
                    f"line {line}: {what} refers to {WHAT[slot]} 0, but OBJ counts from 1"
                )
            indices[row, slot] = index or 0
    return indices


def _resolve(index: Integers, table_lines: Integers, lines: Integers, what: str, slot: int) -> None:
    """Turns indices as written into indices from 0, in place."""
    back = index < 0
    written = index.copy()
    index[back] += np.searchsorted(table_lines, lines[back]) + 1
    index[back & (index <= 0)] = len(table_lines) + 1  # before the first
    bad = index > len(table_lines)
    if bad.any():
        at, n = int(np.argmax(bad)), len(table_lines)
        there = "there is 1" if n == 1 else f"there are {n}"
        raise MeshError(
            f"line {lines[at]}: {what} refers to {WHAT[slot]} {written[at]}, but {there}"
        )
    index -= 1
