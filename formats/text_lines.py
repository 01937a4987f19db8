"""Lines of text as arrays: where they are, and how many words each has."""

from itertools import pairwise

import numpy as np
import numpy.typing as npt

# What bytes.split() takes for white space.
WHITE = np.zeros(256, bool)
WHITE[[9, 10, 11, 12, 13, 32]] = True
BLOCK_LINES = 1 << 16


def words_per_line(text: bytes) -> npt.NDArray[np.intp]:
    """The number of words in each line of `text`; the last line need not end in a newline."""
    if not text:
        return np.zeros(0, np.intp)
    characters = np.frombuffer(text, np.uint8)
    white = WHITE[characters]
    begins = ~white
    begins[1:] &= white[:-1]
    ends = np.flatnonzero(characters == 10)
    starts = np.concatenate([[0], ends + 1])
    if starts[-1] == len(text):
        starts = starts[:-1]
    return np.add.reduceat(begins, starts, dtype=np.intp)


def line_starts(text: bytes) -> npt.NDArray[np.intp]:
    """Where each line of `text` begins, and its end."""
    ends = np.flatnonzero(np.frombuffer(text, np.uint8) == 10) + 1
    starts = np.concatenate([[0], ends])
    return starts if starts[-1] == len(text) else np.append(starts, len(text))


def joined_rows(words: list[str], offsets: npt.NDArray[np.int64]) -> list[str]:
    """The words of each row, offsets[i] to offsets[i + 1], with spaces between them."""
    lengths = np.diff(offsets)
    n = int(lengths[0]) if len(lengths) else 0
    if n and (lengths == n).all():
        return list(map(" ".join, zip(*[words[i::n] for i in range(n)], strict=True)))
    bounds = offsets.tolist()
    return [" ".join(words[start:end]) for start, end in pairwise(bounds)]
