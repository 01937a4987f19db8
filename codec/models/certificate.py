"""What a certificate says, whatever the kind of table."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import ceil
from typing import Any

# Certified prices have five decimals.
UNITS_PER_BIT = 100_000


def rounded_up(bits: float) -> float:
    """The bits with five decimals, none too few."""
    return ceil(bits * UNITS_PER_BIT) / UNITS_PER_BIT


@dataclass(frozen=True)
class Band:
    """How far below its certified price a word can be, in bits.

    At least (1 - spread) (bits_per_c n_C + bits_per_other n_O) less bits_per_word,
    bits_per_component n_P and bits_per_special n_X.
    """

    spread: float
    bits_per_word: float
    bits_per_component: float
    bits_per_special: float


@dataclass(frozen=True)
class Certificate:
    """What the integers of a table guarantee, in bits.

    A word with n_C symbols C, n_O others, n_X special S besides and n_P components costs at most
    bits_per_c n_C + bits_per_other n_O + bits_per_special n_X + bits_per_component n_P
    + bits_per_word.  bits_per_vertex is bits_per_c + bits_per_other.
    A special S is not coded, since its position is stored; but the model forgets what it knew.
    prices: what the proof charges for each symbol.
    below: what the word costs at least, where that is certified too.
    contexts: rows of the table.  method: what was derived and checked, in words.
    """

    model: str
    kind: str
    contexts: int
    bits_per_vertex: float
    bits_per_c: float
    bits_per_other: float
    prices: dict[str, float]
    bits_per_word: float
    bits_per_component: float
    bits_per_special: float
    below: Band | None
    method: str

    def as_dict(self) -> dict[str, Any]:
        """The fields by name."""
        return asdict(self)
