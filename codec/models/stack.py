"""The stack model: probabilities that look at the decoder's real stack of loops.

Each loop of the stack has a length, a conflict and the class of the loops below it, which is fixed
when the next loop is pushed:

    start      one virtual loop (UNKNOWN, 0, bottom); no S ever pops it
    C          (length - 1, max(conflict - 1, 0), below); forbidden at length 3 or conflict 1
    L          (length + 1, 1, below)
    R          (length + 1, 0, below)
    E          pushes (3, 0, step[below][min(length, length_cap)]), both of the loop on top
    S          pops the top; the loop under it becomes (length of the top + its length - 1,
               its length - 1, or 0 above conflict_max, below)
    special S  (UNKNOWN, 0, below); nothing is popped

UNKNOWN absorbs: UNKNOWN plus or minus anything is UNKNOWN, and a conflict that comes of it is 0.
The row of the next symbol is

    below * n_tops + top[min(length, length_max)][conflict]          of the loop on top.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.models.archive import integers, pack, text, unpack
from ebz.codec.models.table import SYMBOLS, C, E, L, R, check_row_sums, read

SHORTEST = 3
UNKNOWN = 1 << 30
MAX_EXTENT = 64
MAX_ROWS = 65535

# A loop: length, conflict, class of the loops below.
Loop = tuple[int, int, int]


@dataclass(eq=False)
class StackTable:
    """Integer probabilities of reverse CLRSE symbols for each class of stacks.

    frequencies: (n_classes * n_tops, 5) uint32, columns C, L, R, S, E; each row sums to 2^16.
    top: (length_max + 1, conflict_max + 1) uint8, the column of a top loop.
    step: (n_classes, length_cap + 1) uint8, the class of a loop of that length on that class.
    bottom: the class of the loops below the last one.
    A table that was loaded is read-only.
    """

    name: str
    frequencies: npt.NDArray[np.uint32]
    top: npt.NDArray[np.uint8]
    step: npt.NDArray[np.uint8]
    bottom: int
    kind: ClassVar[str] = "stack"

    def __repr__(self) -> str:
        return f"StackTable({self.name!r}, {len(self.frequencies)} rows)"

    @property
    def length_max(self) -> int:
        """The longest length of the top loop that is told apart; longer ones count as it."""
        return len(self.top) - 1

    @property
    def conflict_max(self) -> int:
        """The largest conflict that is remembered."""
        return int(self.top.shape[1]) - 1

    @property
    def length_cap(self) -> int:
        """The longest length of a lower loop that is told apart; longer ones count as it."""
        return int(self.step.shape[1]) - 1

    @property
    def n_classes(self) -> int:
        """How many classes of lower loops there are."""
        return len(self.step)

    @property
    def n_tops(self) -> int:
        """How many rows each class has."""
        return len(self.frequencies) // self.n_classes

    def same_as(self, other: object) -> bool:
        """Whether a coder would use both alike."""
        return isinstance(other, StackTable) and all(
            np.array_equal(mine, theirs)
            for mine, theirs in (
                (self.frequencies, other.frequencies),
                (self.top, other.top),
                (self.step, other.step),
                (self.bottom, other.bottom),
            )
        )

    def row(self, loop: Loop) -> int:
        """The row of the next symbol when `loop` is on top."""
        length, conflict, below = loop
        return below * self.n_tops + int(self.top[min(length, self.length_max), conflict])

    def start(self) -> list[Loop]:
        """The stack before the first symbol, top last."""
        return [(UNKNOWN, 0, self.bottom)]

    def step_over(self, loop: Loop) -> int:
        """The class of the stack with `loop` on top."""
        return int(self.step[loop[2], min(loop[0], self.length_cap)])

    def apply(self, stack: list[Loop], symbol: int, *, special: bool = False) -> None:
        """Change the stack, top last, as a symbol does."""
        length, conflict, below = stack[-1]
        if special:
            stack[-1] = (UNKNOWN, 0, below)
        elif symbol == C:
            stack[-1] = (_plus(length, -1), max(conflict - 1, 0), below)
        elif symbol in (L, R):
            stack[-1] = (_plus(length, 1), int(symbol == L), below)
        elif symbol == E:
            stack.append((SHORTEST, 0, self.step_over(stack[-1])))
        else:
            stack.pop()
            left, _, below = stack[-1]
            joined = UNKNOWN if UNKNOWN in (length, left) else length + left - 1
            stack[-1] = (joined, left - 1 if left - 1 <= self.conflict_max else 0, below)

    def tops(self) -> Iterator[tuple[int, int]]:
        """The lengths, clipped, and conflicts that a top loop can have.

        A conflict is at most the length less three: L leaves 1, S leaves at least two edges more.
        """
        for length in range(SHORTEST, self.length_max + 1):
            for conflict in range(self.conflict_max + 1):
                if length == self.length_max or conflict <= length - SHORTEST:
                    yield length, conflict

    def check(self) -> None:
        """Raise OptionError, naming the entry, unless a coder can use the table."""
        self._check_shapes()
        if (wrong := np.argwhere(self.step[:, SHORTEST:] >= self.n_classes)).size:
            below, length = wrong[0]
            raise OptionError(f"model table: step[{below}][{length + SHORTEST}] is not a class")
        if not 0 <= self.bottom < self.n_classes:
            raise OptionError(f"model table: bottom {self.bottom} is not a class")
        if self.step[self.bottom, self.length_cap] != self.bottom:
            raise OptionError("model table: the virtual loop does not stay on its class")
        check_row_sums(self.frequencies)
        for length, conflict in self.tops():
            self._check_allowed(length, conflict)

    def _check_shapes(self) -> None:
        extents = (*self.top.shape, *self.step.shape)
        if len(extents) != 4 or not 0 < min(extents) <= max(extents) <= MAX_EXTENT:
            raise OptionError(f"model table: top and step of shape {extents}")
        n, columns = len(self.frequencies), self.frequencies.shape[1:]
        if self.conflict_max < 1:
            raise OptionError("model table: top has no column for the conflict that L leaves")
        if columns != (len(SYMBOLS),) or not 0 < n <= MAX_ROWS or n % self.n_classes:
            raise OptionError(f"model table: frequencies of shape {self.frequencies.shape}")
        if min(self.length_max, self.length_cap) < self.conflict_max + 2:
            # A loop of a clipped length must be too long for its conflict to be remembered.
            raise OptionError("model table: a remembered conflict may come of a clipped length")

    def _check_allowed(self, length: int, conflict: int) -> None:
        column = int(self.top[length, conflict])
        if column >= self.n_tops:
            raise OptionError(f"model table: top[{length}][{conflict}] is not a column")
        rows = np.arange(self.n_classes) * self.n_tops + column
        first = L if length == SHORTEST or conflict == 1 else C
        if (zeros := np.argwhere(self.frequencies[rows, first:] == 0)).size:
            row, symbol = rows[zeros[0, 0]], SYMBOLS[first + zeros[0, 1]]
            raise OptionError(
                f"model table: unsound: row {row} forbids {symbol}, which loops of length "
                f"{length} and conflict {conflict} allow"
            )

    @classmethod
    def from_bytes(cls, data: bytes) -> StackTable:
        """The checked table of a file's content; raises OptionError where it is malformed."""
        arrays = unpack(data)
        table = cls(
            name=text(arrays, "name"),
            frequencies=integers(arrays, "frequencies", np.uint32),
            top=integers(arrays, "top", np.uint8),
            step=integers(arrays, "step", np.uint8),
            bottom=int(integers(arrays, "bottom", np.uint8).ravel()[:1].sum()),
        )
        table.check()
        return table

    @classmethod
    def load(cls, name_or_path: str | PathLike[str]) -> StackTable:
        """The built-in table of that name, or the table in that file; raises OptionError."""
        return read(name_or_path, cls.from_bytes)

    def to_bytes(self) -> bytes:
        """The content of the table's file; the same table gives the same bytes."""
        return pack(
            name=np.array(self.name),
            kind=np.array(self.kind),
            frequencies=self.frequencies.astype(np.uint16),
            top=self.top.astype(np.uint8),
            step=self.step.astype(np.uint8),
            bottom=np.array(self.bottom, np.uint8),
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the checked table to `path`."""
        self.check()
        Path(path).write_bytes(self.to_bytes())


def _plus(length: int, step: int) -> int:
    return length if length == UNKNOWN else length + step
