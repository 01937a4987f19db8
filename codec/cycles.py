"""Faces as cycles: equal where they differ in their first corner only."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]


def by_size(offsets: Ints) -> Iterator[tuple[Ints, Ints]]:
    """For each number of corners d, ascending: the faces that have it, and (n, d) their corners."""
    sizes = np.diff(offsets)
    for size in np.unique(sizes).tolist():
        faces = np.flatnonzero(sizes == size)
        yield faces, offsets[faces][:, None] + np.arange(size)


def turned(rows: npt.NDArray[Any], turns: Ints) -> npt.NDArray[Any]:
    """Each row from its entry `turn` on, and around."""
    n = rows.shape[1]
    if not n:
        return rows
    return np.take_along_axis(rows, (turns[:, None] + np.arange(n)) % n, axis=1)


def least_turns(rows: npt.NDArray[Any]) -> Ints:
    """(n,) from where on each of (n, d) rows is least: the first of several such entries."""
    alive = np.ones(rows.shape, bool)
    largest = np.iinfo(rows.dtype).max
    for step in range(rows.shape[1]):
        values = np.where(alive, np.roll(rows, -step, axis=1), largest)
        alive &= values == values.min(axis=1, keepdims=True)
        if (np.count_nonzero(alive, axis=1) == 1).all():
            break
    return np.argmax(alive, axis=1) if rows.shape[1] else np.zeros(len(rows), np.int64)


def least(rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The rows from where on they are least: the same for rows that are the same cycle."""
    return turned(rows, least_turns(rows))


def turns_between(
    rows: npt.NDArray[Any], others: npt.NDArray[Any]
) -> tuple[Ints, npt.NDArray[np.bool_]]:
    """From which entry on each of the others is the row, and whether it is from any."""
    turns = (least_turns(others) - least_turns(rows)) % max(rows.shape[1], 1)
    return turns, (turned(others, turns) == rows).all(axis=1)
