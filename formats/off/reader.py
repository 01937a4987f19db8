"""OFF files <-> meshes: OFF with the prefixes ST, C and N.

What the format leaves open, and what is chosen here:

- Vertex normals become the attribute `normal`, colours `rgb` or `rgba`, texture coordinates `st`.
  Numbers behind x, y and z that the header does not announce are a colour where they are 3 or 4.
- Face colours become `rgb`, `rgba`, or `colormap` (one index); where faces differ in how many
  numbers they have, `color` (m, 4), padded with zeros, with `color:count`.
- Colours of whole numbers in 0 .. 255 are uint8, other numbers float32 or float64.
- Coordinates are float32 where every shortest decimal survives that, else float64. A float64 mesh
  whose text would be taken for float32 is marked by a comment, `# ebz: float64`.
- A face ends with the line in which its last corner stands: what follows there is its colour.
- Comments are kept and written behind the header; the count of
  edges, which nothing depends on, is kept too.
- 4OFF, nOFF and BINARY are refused.

Source: Geomview manual, OFF files.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import narrowed, shown
from ebz.formats.polygons import check_indices, offsets_of
from ebz.formats.text_floats import (
    DOUBLE_MARK,
    Line,
    floats_at,
    integers_at,
    text_of,
    wide_if,
)
from ebz.formats.text_lines import words_per_line


@dataclass
class Rows:
    """The words of all rows, how many each has, and the number of its first line."""

    numbers: npt.NDArray[np.intp]
    words: list[bytes]
    counts: npt.NDArray[np.intp]

    def first_words(self) -> list[bytes]:
        starts = np.cumsum(self.counts) - self.counts
        return [self.words[start] for start in starts.tolist()]


Least: TypeAlias = Callable[[Rows], npt.NDArray[np.int64]]

# More than any line has words, and no overflow when one is added.
MAX_CORNERS = 1 << 62

HEADER = re.compile(rb"(ST)?(C)?(N)?(4)?(n)?OFF")
COLOR_NAMES = {3: "rgb", 4: "rgba"}
FACE_COLOR_NAMES = {1: "colormap", **COLOR_NAMES}


def read_off(data: bytes) -> Mesh:
    """The mesh of an OFF file; metadata["off"] holds comments and the count of edges.

    Raises MeshError that names the line.
    """
    lines, comments = _lines(data)
    prefix, lines = _header(lines)
    counts, lines = _counts(lines)
    n_vertices, n_faces = counts[0], counts[1]
    least = 3 + 3 * (b"N" in prefix) + 3 * (b"C" in prefix) + 2 * (b"ST" in prefix)
    rows, lines = _rows("vertex", n_vertices, lines, lambda rows: np.full(len(rows.counts), least))
    face_rows, lines = _rows("face", n_faces, lines, _words_of_faces)
    if lines:
        warn_dropped(f"OFF: {len(lines)} lines behind the last face")
    double = DOUBLE_MARK in comments
    vertices, vertex_attributes = _vertices(rows, prefix, double=double)
    corners, offsets, face_attributes = _faces(face_rows, n_vertices)
    flavour: dict[str, Any] = {"comments": [c for c in comments if c != DOUBLE_MARK]}
    if len(counts) > 2:
        flavour["edges"] = counts[2]
    metadata = {"format": "off", "off": {k: v for k, v in flavour.items() if v}}
    return Mesh(vertices, corners, vertex_attributes, face_attributes, metadata, offsets)


def _lines(data: bytes) -> tuple[list[Line], list[str]]:
    """The lines that are not blank, with their numbers and without comments; the comments."""
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    comments = []
    if b"#" in text:
        found = re.findall(rb"#([^\n]*)", text)
        comments = [text_of(comment.strip()) for comment in found]
        text = re.sub(rb"#[^\n]*", b"", text)
    return [item for item in enumerate(text.split(b"\n"), 1) if item[1].strip()], comments


def _header(lines: list[Line]) -> tuple[set[bytes], list[Line]]:
    """The prefixes of the keyword, and the lines behind it; what follows it counts as a line."""
    if not lines:
        raise MeshError("there is no OFF header")
    number, line = lines[0]
    words = line.split(None, 1)
    match = HEADER.fullmatch(words[0])
    if match is None:
        if words[0].isdigit():  # the keyword is optional
            return set(), lines
        raise MeshError(f"line {number}: expected 'OFF', found {shown(words[0])}")
    prefix = {part for part in match.groups() if part}
    if prefix & {b"4", b"n"}:
        raise MeshError(f"line {number}: only three dimensions are read, not {shown(words[0])}")
    rest = words[1:]
    if rest and rest[0].strip() == b"BINARY":
        raise MeshError(f"line {number}: binary OFF is not read")
    return prefix, [*((number, word) for word in rest), *lines[1:]]


def _counts(lines: list[Line]) -> tuple[list[int], list[Line]]:
    if not lines:
        raise MeshError("early end of file: the counts are missing")
    number, line = lines[0]
    words = line.split()
    if not 2 <= len(words) <= 3 or not all(w.isdigit() and len(w) <= 20 for w in words):
        raise MeshError(f"line {number}: expected the counts of vertices, faces and edges")
    return [int(word) for word in words], lines[1:]


def _rows(what: str, count: int, lines: list[Line], least: Least) -> tuple[Rows, list[Line]]:
    """The first `count` rows, and the lines behind them.

    A row goes on in the next line while it has fewer words than `least` says.
    """
    taken = lines[:count]
    text = b"\n".join([line for _, line in taken])
    numbers = np.fromiter((number for number, _ in taken), np.intp, len(taken))
    rows = Rows(numbers, text.split(), words_per_line(text))
    if len(taken) == count and (rows.counts >= least(rows)).all():
        return rows, lines[count:]
    return _continued_rows(what, count, lines, least)


def _continued_rows(
    what: str, count: int, lines: list[Line], least: Least
) -> tuple[Rows, list[Line]]:
    numbers, counts, flat = [], [], []
    at = 0
    for row in range(count):
        if at == len(lines):
            raise MeshError(f"{what} {row}: early end of file")
        number, words = lines[at][0], lines[at][1].split()
        at += 1
        n = int(least(Rows(np.array([number]), words, np.array([len(words)])))[0])
        while len(words) < n:
            if at == len(lines):
                raise MeshError(f"line {number}: {what} {row}: early end of file")
            words += lines[at][1].split()
            at += 1
        numbers.append(number)
        counts.append(len(words))
        flat += words
    return Rows(np.array(numbers, np.intp), flat, np.array(counts, np.intp)), lines[at:]


def _words_of_faces(rows: Rows) -> npt.NDArray[np.int64]:
    """How many words each face has at least."""
    lengths = integers_at(rows.first_words(), rows.numbers)
    if lengths.min(initial=0) < 0:
        bad = int(np.argmax(lengths < 0))
        raise MeshError(f"line {rows.numbers[bad]}: a face of {lengths[bad]} corners")
    return np.minimum(lengths, MAX_CORNERS) + 1


def _vertices(
    rows: Rows, prefix: set[bytes], *, double: bool
) -> tuple[npt.NDArray[Any], dict[str, npt.NDArray[Any]]]:
    if not rows.words:
        return np.zeros((0, 3), np.float64 if double else np.float32), {}
    width = int(rows.counts[0])
    if (rows.counts != width).any():
        bad = int(np.argmax(rows.counts != width))
        n = rows.counts[bad]
        raise MeshError(f"line {rows.numbers[bad]}: a vertex of {n} numbers, others have {width}")
    values = floats_at(rows.words, np.repeat(rows.numbers, width)).reshape(-1, width)
    attributes = {}
    for name, start, end in _parts(width, prefix, int(rows.numbers[0])):
        table = np.ascontiguousarray(values[:, start:end])
        if name in COLOR_NAMES.values():
            words = [word for i in range(start, end) for word in rows.words[i::width]]
            attributes[name] = _color(table, words)
        else:
            attributes[name] = wide_if(table, double=double and name == "")
    return attributes.pop(""), attributes


def _parts(width: int, prefix: set[bytes], line: int) -> list[tuple[str, int, int]]:
    """What each run of columns is; coordinates have no name."""
    parts, at = [("", 0, 3)], 3
    if b"N" in prefix:
        parts.append(("normal", at, at + 3))
        at += 3
    n_colors = width - at - 2 * (b"ST" in prefix)
    if n_colors in COLOR_NAMES:
        parts.append((COLOR_NAMES[n_colors], at, at + n_colors))
        at += n_colors
    elif n_colors or b"C" in prefix:
        raise MeshError(f"line {line}: a vertex of {width} numbers does not suit the header")
    if b"ST" in prefix:
        parts.append(("st", at, at + 2))
    return parts


def _color(values: npt.NDArray[np.float64], words: list[bytes]) -> npt.NDArray[Any]:
    whole = all(word.isdigit() for word in words)
    if whole and values.max(initial=0) <= 255:
        return values.astype(np.uint8)
    return narrowed(values)


def _faces(
    rows: Rows, n_vertices: int
) -> tuple[npt.NDArray[Any], npt.NDArray[np.int64], dict[str, npt.NDArray[Any]]]:
    """The corners of all faces, where those of each begin, and the colours behind them."""
    if not rows.words:
        return np.zeros(0, np.int32), np.zeros(1, np.int64), {}
    numbers, counts = rows.numbers, rows.counts
    lengths = _words_of_faces(rows) - 1
    place = np.arange(len(rows.words)) - np.repeat(np.cumsum(counts) - counts, counts)
    is_corner = place <= np.repeat(lengths, counts)
    words, colors = rows.words, list[bytes]()
    if not is_corner.all():
        colors = [word for word, keep in zip(words, (~is_corner).tolist(), strict=True) if keep]
    is_corner &= place > 0
    words = [word for word, keep in zip(words, is_corner.tolist(), strict=True) if keep]
    corners = integers_at(words, np.repeat(numbers, lengths))
    check_indices(corners, lengths, n_vertices, lambda row: f"line {numbers[row]}: face")
    return corners, offsets_of(lengths), _face_colors(colors, counts - lengths - 1, numbers)


def _face_colors(
    words: list[bytes], counts: npt.NDArray[np.int64], numbers: npt.NDArray[np.intp]
) -> dict[str, npt.NDArray[Any]]:
    """The attributes that the `counts` words behind the corners of each face make."""
    if not words:
        return {}
    if counts.max() > 4:
        bad = int(np.argmax(counts > 4))
        raise MeshError(f"line {numbers[bad]}: {counts[bad]} numbers behind the corners")
    values = _color(floats_at(words, np.repeat(numbers, counts)), words)
    width = int(counts[0])
    if (counts == width).all() and width in FACE_COLOR_NAMES:
        table = values.reshape(len(counts), width)
        return {FACE_COLOR_NAMES[width]: table[:, 0] if width == 1 else table}
    table = np.zeros((len(counts), 4), values.dtype)
    table[np.arange(4) < counts[:, None]] = values
    return {"color": table, "color:count": counts.astype(np.uint8)}
