"""Classes of the loops below the top one: what the rows of the stack table tell apart of them.

A class gives ranges for the lengths of the second, third and sometimes fourth loop; finer where
the costliest words spend their time: short loops.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ebz.codec.models.stack import SHORTEST, StackTable

UNBOUNDED = 1 << 40
Range = tuple[int, int]
LowerClass = tuple[Range, ...]


def _ranges(*starts: int) -> list[Range]:
    """Lengths from each start up to the next; the last range has no end."""
    return [(a, b - 1) for a, b in zip(starts, (*starts[1:], UNBOUNDED + 1), strict=True)]


FEW, MORE, MOST = _ranges(3, 5), _ranges(3, 4, 7), _ranges(3, 4, 5, 7, 9)
SECOND = _ranges(3, 4, 5, 6, 7, 9, 12)
# A fourth loop is looked at only where the second and the third have such lengths.
DEEP = (3, 4)


def lower_classes() -> list[LowerClass]:
    """The 36 classes of the table that ships."""
    found: list[LowerClass] = []
    for second in SECOND:
        for third in _third(second):
            if second[0] in DEEP and third[0] in DEEP:
                fourths = MOST if second[0] == third[0] == SHORTEST else MORE
                found += [(second, third, fourth) for fourth in fourths]
            else:
                found.append((second, third))
    return found


def _third(second: Range) -> list[Range]:
    """Ranges of the third loop under a given second loop."""
    if second[0] in (*DEEP, SECOND[-1][0]):
        return MOST
    return FEW if second[0] >= 9 else MORE


def shape(length_max: int, conflict_max: int, classes: list[LowerClass]) -> StackTable:
    """A stack table whose frequencies are all zero: only what tells the rows apart."""
    step = _step_table(classes, max(span[0] for lengths in classes for span in lengths))
    empty = np.zeros((0, 5), np.uint32)
    top = np.zeros((length_max + 1, conflict_max + 1), np.uint8)
    table = StackTable("stack", empty, top, step, _deepest(step))
    tops = list(table.tops())
    for column, pair in enumerate(tops):
        top[pair] = column
    table.frequencies = np.zeros((len(classes) * len(tops), 5), np.uint32)
    return table


def _step_table(classes: list[LowerClass], length_cap: int) -> npt.NDArray[np.uint8]:
    """The class of a loop of each length on top of each class."""
    step = np.zeros((len(classes), length_cap + 1), np.uint8)
    for index, below in enumerate(classes):
        for length in range(SHORTEST, length_cap + 1):
            longest = length if length < length_cap else UNBOUNDED
            pushed = ((length, longest), *below)
            (step[index, length],) = [i for i, c in enumerate(classes) if _contains(c, pushed)]
    return step


def _contains(general: LowerClass, special: LowerClass) -> bool:
    """Whether every stack of the special class lies in the general one."""
    return len(special) >= len(general) and all(
        a <= c and d <= b for (a, b), (c, d) in zip(general, special, strict=False)
    )


def _deepest(step: npt.NDArray[np.uint8]) -> int:
    """The class of endlessly many loops of the largest length: below the last real loop."""
    below = 0
    for _ in range(len(step)):
        below = int(step[below, -1])
    return below
