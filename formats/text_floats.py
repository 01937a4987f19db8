"""Tables of numbers in line-based text formats, with errors that name the line."""

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.numbers import (
    first_bad,
    narrowed,
    parse_floats,
    parse_integers,
    shown,
)

# Text whose numbers alone would be taken for the other dtype says so in a comment.
DOUBLE_MARK = "ebz: float64"
EMPTY_MARK = "ebz: no vertices"

Line: TypeAlias = tuple[int, bytes]


def text_of(data: bytes) -> str:
    """UTF-8, or Latin-1, which has a character for every byte."""
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1")


def one_line(text: object) -> str:
    """Text that comes from metadata, as one line that can be encoded."""
    joined = str(text).replace("\r", " ").replace("\n", " ").strip(" \t\v\f")
    return joined.encode(errors="replace").decode()


def floats_at(words: Sequence[bytes], lines: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Each word as float64; the error names the line that the word is in."""
    try:
        return parse_floats(words)
    except ValueError:
        bad = first_bad(words, integer=False)
        raise MeshError(f"line {lines[bad]}: {shown(words[bad])} is no number") from None


def integers_at(words: Sequence[bytes], lines: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
    """Each word as int64; the error names the line that the word is in."""
    try:
        return parse_integers(words)
    except ValueError:
        bad = first_bad(words, integer=True)
        raise MeshError(f"line {lines[bad]}: {shown(words[bad])} is no integer") from None


def reads_as_float32(values: npt.NDArray[Any]) -> bool:
    """Whether the text of these float64 coordinates would be taken for float32."""
    return narrowed(values).dtype == np.float32


def wide_if(values: npt.NDArray[np.float64], *, double: bool) -> npt.NDArray[Any]:
    """Coordinates read from text: float64 where the file says so, else what the text calls for."""
    return values if double else narrowed(values)
