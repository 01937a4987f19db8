"""The body of an ascii PLY file: lines of numbers <-> columns.

One row is one line; blank lines are passed over. Floats of every declared type are read as
float64, and ply.py decides what they become.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.numbers import first_bad, format_numbers, parse_floats, parse_integers, shown
from ebz.formats.ply.columns import Column, Lists, early_end, place
from ebz.formats.ply.header import Element, Property
from ebz.formats.text_lines import BLOCK_LINES, line_starts, words_per_line


class Body:
    """The lines behind the header, taken element by element."""

    def __init__(self, text: bytes) -> None:
        self._text = text
        self._starts = line_starts(text)
        self._line = 0

    def read_rows(self, element: Element) -> list[Column]:
        """One column per property of `element`."""
        if not element.properties or not element.count:
            return [_column(prop, [], []) for prop in element.properties]
        blocks = [_read_block(element, row, *block) for row, block in self._blocks(element)]
        return [_joined([block[i] for block in blocks]) for i in range(len(element.properties))]

    def _blocks(
        self, element: Element
    ) -> Iterator[tuple[int, tuple[list[bytes], npt.NDArray[np.intp]]]]:
        """The words of the next rows and how many each row has, behind the number of the first."""
        row = 0
        while row < element.count:
            first = self._line
            last = min(first + BLOCK_LINES, len(self._starts) - 1, first + element.count - row)
            if first >= last:
                raise early_end(element, row, element.properties[0])
            self._line = last
            text = self._text[self._starts[first] : self._starts[last]]
            counts = words_per_line(text)
            counts = counts[counts > 0]
            if len(counts):
                yield row, (text.split(), counts)
            row += len(counts)

    def rest(self) -> int:
        """The number of lines that are left and not blank."""
        text = self._text[self._starts[self._line] :]
        return int(np.count_nonzero(words_per_line(text)))


def _joined(parts: list[Column]) -> Column:
    lists = [part for part in parts if isinstance(part, Lists)]
    if lists:
        return Lists(
            np.concatenate([part.lengths for part in lists]),
            np.concatenate([part.values for part in lists]),
        )
    return np.concatenate([part for part in parts if not isinstance(part, Lists)])


def _read_block(
    element: Element, row: int, words: list[bytes], counts: npt.NDArray[np.intp]
) -> list[Column]:
    block = _Block(element, row, words, counts)
    return block.even() or block.uneven()


class _Block:
    def __init__(
        self, element: Element, row: int, words: list[bytes], counts: npt.NDArray[np.intp]
    ) -> None:
        self.element = element
        self.row = row
        self.words = words
        self.counts = counts

    def even(self) -> list[Column] | None:
        """Columns where every row is as long, and has the lists, of the first one; else None."""
        width = int(self.counts[0])
        if (self.counts != width).any():
            return None
        n = len(self.counts)
        columns: list[Column] = []
        at = 0
        for prop in self.element.properties:
            if at >= width:
                return None
            if not prop.count_type:
                columns.append(self._parse(prop, self.words[at::width], np.arange(n)))
                at += 1
                continue
            lengths = self._lengths(prop, self.words[at::width], np.arange(n))
            length = int(lengths[0])
            if (lengths != length).any() or at + 1 + length > width:
                return None
            parts = [self.words[at + 1 + j :: width] for j in range(length)]
            flat = [word for row in zip(*parts, strict=True) for word in row]
            rows = np.repeat(np.arange(n), length)
            columns.append(Lists(lengths, self._parse(prop, flat, rows)))
            at += 1 + length
        return columns if at == width else None

    def uneven(self) -> list[Column]:
        """Columns where each row has lists of its own lengths, one property after another."""
        rows, ends = np.arange(len(self.counts)), np.cumsum(self.counts)
        at = ends - self.counts
        columns: list[Column] = []
        for prop in self.element.properties:
            self._check_room(prop, at + 1 > ends)
            if not prop.count_type:
                columns.append(self._parse(prop, self._words(at), rows))
                at = at + 1
                continue
            lengths = self._lengths(prop, self._words(at), rows)
            n = lengths.astype(np.int64)
            self._check_room(prop, at + 1 + n > ends)
            first = np.cumsum(n) - n
            places = np.arange(n.sum()) + np.repeat(at + 1 - first, n)
            values = self._parse(prop, self._words(places), np.repeat(rows, n))
            columns.append(Lists(lengths, values))
            at = at + 1 + n
        if (at < ends).any():
            row = int(np.argmax(at < ends))
            raise MeshError(
                f"element {self.element.name!r}: row {self.row + row}: "
                f"expected end of line, found {shown(self.words[at[row]])}"
            )
        return columns

    def _words(self, places: npt.NDArray[np.intp]) -> list[bytes]:
        return [self.words[i] for i in places.tolist()]

    def _check_room(self, prop: Property, beyond: npt.NDArray[np.bool_]) -> None:
        if beyond.any():
            raise self._error(int(np.argmax(beyond)), prop, "early end of line")

    def _lengths(
        self, prop: Property, words: list[bytes], rows: npt.NDArray[np.intp]
    ) -> npt.NDArray[Any]:
        lengths = self._integers(prop, prop.count_type or "", prop.count_dtype, words, rows)
        if lengths.min(initial=0) < 0:
            bad = int(np.argmax(lengths < 0))
            raise self._error(int(rows[bad]), prop, f"a list of {lengths[bad]} entries")
        return lengths

    def _parse(
        self, prop: Property, words: list[bytes], rows: npt.NDArray[np.intp]
    ) -> npt.NDArray[Any]:
        if prop.dtype.kind != "f":
            return self._integers(prop, prop.type, prop.dtype, words, rows)
        try:
            return parse_floats(words)
        except ValueError:
            bad = first_bad(words, integer=False)
            raise self._error(int(rows[bad]), prop, f"{shown(words[bad])} is no number") from None

    def _integers(
        self,
        prop: Property,
        type_name: str,
        dtype: np.dtype[Any],
        words: list[bytes],
        rows: npt.NDArray[np.intp],
    ) -> npt.NDArray[Any]:
        try:
            values = parse_integers(words)
        except ValueError:
            bad = first_bad(words, integer=True)
            raise self._error(int(rows[bad]), prop, f"{shown(words[bad])} is no integer") from None
        limits = np.iinfo(dtype)
        outside = (values < limits.min) | (values > limits.max)
        if outside.any():
            bad = int(np.argmax(outside))
            raise self._error(int(rows[bad]), prop, f"{values[bad]} does not fit {type_name!r}")
        return values.astype(dtype)

    def _error(self, row: int, prop: Property, message: str) -> MeshError:
        return MeshError(f"{place(self.element, self.row + row, prop)}: {message}")


def _column(prop: Property, lengths: list[int], values: list[float]) -> Column:
    array = np.array(values, np.float64 if prop.dtype.kind == "f" else prop.dtype)
    return Lists(np.array(lengths, prop.count_dtype), array) if prop.count_type else array


def write_rows(element: Element, columns: list[Column], newline: str) -> bytes:
    """The rows of `element`, one per line, numbers as the shortest decimals of their dtype."""
    if not columns:
        return b""
    words = [_words(column) for column in columns]
    lines = map(" ".join, zip(*words, strict=True))
    return newline.join([*lines, ""]).encode() if element.count else b""


def _words(column: Column) -> list[str]:
    """One string per row."""
    if not isinstance(column, Lists):
        return format_numbers(column)
    values = format_numbers(column.values)
    length = column.constant_length()
    counts = format_numbers(column.lengths)
    if length:
        parts = [values[j::length] for j in range(length)]
        return list(map(" ".join, zip(counts, *parts, strict=True)))
    ends = np.cumsum(column.lengths, dtype=np.int64).tolist()
    starts = [0, *ends][: len(ends)]
    return [
        " ".join([count, *values[start:end]])
        for count, start, end in zip(counts, starts, ends, strict=True)
    ]
