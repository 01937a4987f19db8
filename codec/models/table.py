"""Model tables: the frozen integers from which both coders take the probability of each symbol.

This kind of table is a finite automaton; stack.py has the one that looks at the decoder's stack.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import ClassVar, TypeVar

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.models.archive import integers, pack, text, unpack

SYMBOLS = "CLRSE"
C, L, R, S, E = range(5)
FREQUENCY_BITS = 16
TOTAL = 1 << FREQUENCY_BITS
MAX_STATES = 65535
TABLES = Path(__file__).parent / "tables"


@dataclass(eq=False)
class Table:
    """Integer probabilities of reverse CLRSE symbols in each state of an automaton.

    frequencies: (n, 5) uint32, columns C, L, R, S, E; each row sums to 2^16; 0 forbids (only C).
    successors: (n, 5) uint16, the next state, 0 where the symbol is forbidden.
    State 0 is where coding starts and where a special S leads: nothing is known, C is allowed.
    A table that was loaded is read-only.
    """

    name: str
    frequencies: npt.NDArray[np.uint32]
    successors: npt.NDArray[np.uint16]
    kind: ClassVar[str] = "automaton"

    def __repr__(self) -> str:
        return f"Table({self.name!r}, {self.kind}, {len(self.frequencies)} rows)"

    def same_as(self, other: object) -> bool:
        """Whether a coder would use both alike."""
        return (
            isinstance(other, Table)
            and np.array_equal(self.frequencies, other.frequencies)
            and np.array_equal(self.successors, other.successors)
        )

    def check(self) -> None:
        """Raise OptionError, naming the row and column, unless a coder can use the table."""
        n = len(self.frequencies)
        if self.frequencies.shape != (n, 5) or self.successors.shape != (n, 5):
            raise OptionError("model table: frequencies and successors are not both (n, 5)")
        if not 1 <= n <= MAX_STATES:
            raise OptionError(f"model table: {n} states, not 1 to {MAX_STATES}")
        check_frequencies(self.frequencies)
        if not self.frequencies[0, C]:
            raise OptionError("model table: state 0 is where coding starts and must allow C")
        _check_successors(self.successors, self.frequencies > 0)

    @classmethod
    def load(cls, name_or_path: str | PathLike[str]) -> Table:
        """The built-in table of that name, or the table in that file.

        Raises OptionError where there is neither, or where the table is malformed.
        """
        return read(name_or_path, cls.from_bytes)

    @classmethod
    def from_bytes(cls, data: bytes) -> Table:
        """The checked table of a file's content; raises OptionError where it is malformed."""
        arrays = unpack(data)
        if (kind := text(arrays, "kind")) != "automaton":
            raise OptionError(f"model table: kind {kind!r} is not 'automaton'")
        table = cls(
            name=text(arrays, "name"),
            frequencies=integers(arrays, "frequencies", np.uint32),
            successors=integers(arrays, "successors", np.uint16),
        )
        table.check()
        return table

    def to_bytes(self) -> bytes:
        """The content of the table's file; the same table gives the same bytes."""
        return pack(
            name=np.array(self.name),
            kind=np.array(self.kind),
            frequencies=self.frequencies.astype(np.uint16),
            successors=self.successors.astype(np.uint16),
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the checked table to `path`."""
        self.check()
        Path(path).write_bytes(self.to_bytes())


def table_names() -> list[str]:
    """The names of the built-in tables."""
    return sorted(path.stem for path in TABLES.glob("*.npz"))


def table_path(name_or_path: str | PathLike[str]) -> Path:
    """Where the built-in table of that name is, or else the path itself."""
    built_in = TABLES / f"{name_or_path}.npz"
    if Path(name_or_path).name == str(name_or_path) and built_in.is_file():
        return built_in
    path = Path(name_or_path)
    if not path.exists():
        names = ", ".join(table_names())
        raise OptionError(f"no model {str(name_or_path)!r}: neither a file nor one of {names}")
    return path


T = TypeVar("T")


def read(name_or_path: str | PathLike[str], parse: Callable[[bytes], T]) -> T:
    """What `parse` makes of a built-in table or a file; its errors name the file."""
    path = table_path(name_or_path)
    try:
        return parse(path.read_bytes())
    except OSError as error:
        raise OptionError(f"cannot read it: {error.strerror}", source=str(path)) from None
    except OptionError as error:
        raise OptionError(error.message, source=str(path)) from None


def check_frequencies(frequencies: npt.NDArray[np.uint32]) -> None:
    """Raise OptionError unless each row sums to 2^16 and only C is ever forbidden."""
    check_row_sums(frequencies)
    if (zeros := np.argwhere(frequencies[:, L:] == 0)).size:
        row, column = zeros[0]
        raise OptionError(f"model table: row {row} forbids {SYMBOLS[L + column]}; only C may be")


def check_row_sums(frequencies: npt.NDArray[np.uint32]) -> None:
    """Raise OptionError unless each row sums to 2^16."""
    sums = frequencies.sum(axis=1, dtype=np.uint64)
    if (wrong := np.flatnonzero(sums != TOTAL)).size:
        raise OptionError(f"model table: row {wrong[0]} sums to {sums[wrong[0]]}, not {TOTAL}")


def _check_successors(successors: npt.NDArray[np.uint16], allowed: npt.NDArray[np.bool_]) -> None:
    n = len(successors)
    wrong = np.argwhere((successors >= n) | (~allowed & (successors != 0)))
    if wrong.size:
        row, column = wrong[0]
        raise OptionError(
            f"model table: row {row}, {SYMBOLS[column]}: successor {successors[row, column]} "
            + (f"of {n} states" if allowed[row, column] else "of a forbidden symbol")
        )
