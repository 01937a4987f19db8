"""From the probabilities of a model to the integers of a table."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ebz.codec.models.markov import MarkovModel
from ebz.codec.models.table import TOTAL, Table

Floats = npt.NDArray[np.float64]


def table_of(model: MarkovModel, name: str) -> Table:
    """The table of a loop automaton's optimal model (Theorem 3.1), probabilities in 16 bits.

    It is certified only if the automaton is sound.
    """
    targets = model.automaton.targets
    return Table(
        name=name,
        frequencies=rounded(model.probabilities),
        successors=np.maximum(targets, 0).astype(np.uint16),
    )


def rounded(probabilities: Floats) -> npt.NDArray[np.uint32]:
    """(n, a) integers next to 2^16 p, at least 1 where p > 0, whose rows sum to 2^16.

    The largest of a row takes what the others' rounding leaves: at most a / 2 units, which is
    less than 0.0002 bits of its cost when it is a third of the row.
    """
    frequencies = np.maximum(np.rint(probabilities * TOTAL), probabilities > 0).astype(np.int64)
    row = np.arange(len(frequencies))
    largest = probabilities.argmax(axis=1)
    frequencies[row, largest] += TOTAL - frequencies.sum(axis=1)
    return frequencies.astype(np.uint32)
