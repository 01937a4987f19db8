"""The lines of an OBJ file, sorted by keyword without a look at each one in Python."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.numbers import shown
from ebz.formats.text_floats import Line, text_of
from ebz.formats.text_lines import BLOCK_LINES, WHITE, line_starts, words_per_line

# Lines of these are told by their first bytes; there may be millions.
TABLES = (b"v", b"vt", b"vn", b"f", b"l", b"p")
KEYWORD = re.compile(rb"[A-Za-z_]\w{0,31}")
COMMENT_OR_CONTINUED = re.compile(rb"^[ \t]*#[^\n]*|\\\n", re.MULTILINE)
TRAILING_COMMENT = re.compile(rb"#[^\n]*")
# A name may have a # in it, but does not begin with one.
COMMENT_BEHIND_NAME = re.compile(rb"\s#.*")


@dataclass
class Rows:
    """The lines of one keyword, which is blanked out, and the number of each in the file."""

    numbers: npt.NDArray[np.int64]
    text: bytes

    def __len__(self) -> int:
        return len(self.numbers)

    def blocks(self) -> Iterator[tuple[npt.NDArray[np.int64], bytes, npt.NDArray[np.intp]]]:
        """Numbers, text and words of each line, a limited number of lines at a time."""
        starts = line_starts(self.text)
        for first in range(0, len(self.numbers), BLOCK_LINES):
            last = min(first + BLOCK_LINES, len(self.numbers))
            text = self.text[starts[first] : starts[last]]
            yield self.numbers[first:last], text, words_per_line(text)


@dataclass
class Lines:
    """tables: the rows of each keyword in TABLES; others: the lines of all other keywords."""

    tables: dict[bytes, Rows]
    others: list[Line]
    comments: list[str]


def read_lines(data: bytes) -> Lines:
    """The lines of a file; raises MeshError where one begins with what is no keyword."""
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    text += b"\n\n"  # the last line may be continued
    physical = _ends(text)
    if b"\\\n" in text:
        # Of the same length, so that places, and with them line numbers, stay what they are.
        text = COMMENT_OR_CONTINUED.sub(lambda m: m[0] if m[0][0] != 92 else b"  ", text)
    ends = _ends(text)
    starts = np.concatenate([[0], ends[:-1] + 1])
    numbers = np.searchsorted(physical, starts) + 1
    starts = _unindented(text, starts, ends)
    kinds = _kinds(text, starts)
    lines = Lines({}, [], [])
    found: list[tuple[int, bytes]] = []
    for kind, keyword in enumerate(TABLES):
        lines.tables[keyword] = _rows(text, starts, ends, numbers, kinds == kind, keyword, found)
    for i in np.flatnonzero((kinds == len(TABLES)) & (starts < ends)).tolist():
        _take(lines, found, int(numbers[i]), text[starts[i] : ends[i]])
    found.sort(key=lambda item: item[0])
    lines.comments = [text_of(comment[1:].strip()) for _, comment in found]
    return lines


def _ends(text: bytes) -> npt.NDArray[np.int64]:
    return np.flatnonzero(np.frombuffer(text, np.uint8) == 10)


def _unindented(
    text: bytes, starts: npt.NDArray[np.int64], ends: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64]:
    """Where the first word of each line begins; its end where there is none."""
    first = np.frombuffer(text, np.uint8)[starts]
    indented = np.flatnonzero(WHITE[first] & (starts < ends))
    for i in indented.tolist():
        line = text[starts[i] : ends[i]]
        starts[i] = ends[i] - len(line.lstrip())
    return starts


def _kinds(text: bytes, starts: npt.NDArray[np.int64]) -> npt.NDArray[np.int8]:
    """Which of TABLES each line belongs to, their number where to none."""
    characters = np.frombuffer(text + b"\n\n", np.uint8)
    kinds = np.full(len(starts), len(TABLES), np.int8)
    for kind, keyword in enumerate(TABLES):
        matches = WHITE[characters[starts + len(keyword)]]
        for i, character in enumerate(keyword):
            matches &= characters[starts + i] == character
        kinds[matches] = kind
    return kinds


def _rows(
    text: bytes,
    starts: npt.NDArray[np.int64],
    ends: npt.NDArray[np.int64],
    numbers: npt.NDArray[np.int64],
    chosen: npt.NDArray[np.bool_],
    keyword: bytes,
    comments: list[tuple[int, bytes]],
) -> Rows:
    """The chosen lines; comments at their ends go to `comments`, with their line numbers."""
    if not chosen.any():
        return Rows(np.zeros(0, np.int64), b"")
    starts, lengths = starts[chosen], (ends - starts)[chosen] + 1
    characters = np.frombuffer(text, np.uint8)
    first = np.cumsum(lengths) - lengths
    # Lines do not overlap, but one may begin where another ends.
    edges = np.zeros(len(text) + 1, np.int8)
    edges[starts] += 1
    edges[starts + lengths] -= 1
    body = characters[np.cumsum(edges[:-1], dtype=np.int8).view(np.bool_)]
    for i in range(len(keyword)):
        body[first + i] = 32
    rows = Rows(numbers[chosen], body.tobytes())
    if b"#" in rows.text:
        row_ends = first + lengths
        for match in TRAILING_COMMENT.finditer(rows.text):
            row = int(np.searchsorted(row_ends, match.start(), side="right"))
            comments.append((int(rows.numbers[row]), match[0]))
        rows.text = TRAILING_COMMENT.sub(b"", rows.text)
    return rows


def _take(lines: Lines, comments: list[tuple[int, bytes]], number: int, line: bytes) -> None:
    if line.startswith(b"#"):
        comments.append((number, line))
        return
    word = line.split(None, 1)[0]
    if not KEYWORD.fullmatch(word):
        raise MeshError(f"line {number}: {shown(word)} is no keyword")
    behind = COMMENT_BEHIND_NAME.search(line)
    if behind:
        comments.append((number, behind[0].strip()))
        line = line[: behind.start()]
    lines.others.append((number, line))
