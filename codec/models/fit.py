"""Fits a table to the language: the loop automaton, its optimal model, the integers."""

from __future__ import annotations

import numpy as np

from ebz.codec.errors import OptionError
from ebz.codec.models.automaton import Automaton
from ebz.codec.models.integers import table_of
from ebz.codec.models.loops import CONSTRAINTS, loop_automaton
from ebz.codec.models.markov import optimal_model
from ebz.codec.models.search import Candidates, Search, automaton_of, candidates
from ebz.codec.models.table import MAX_STATES, Table

MAX_CHOSEN = 400
MAX_CANDIDATES = 1 << 16
# After this many states were added the weights are fitted anew.
GROWTH = 10
N_SHAKES = 2
SHAKEN = 10


def fit(
    loops: int, max_length: int, max_conflict: int, n_states: int | None = None, name: str = "fit"
) -> Table:
    """The table of a sound loop automaton, with the optimal probabilities in 16 bits.

    Without n_states: every state within the limits (loops.loop_automaton).  With it: the best
    n_states found among the bounds within the limits; the i-th loop's length is then at most
    3 + (max_length - 3) // i, since what is known of deeper loops is worth less.
    Raises OptionError where a limit is out of range.
    """
    if n_states is None:
        automaton = loop_automaton(loops, max_length, max_conflict, MAX_STATES)
    else:
        automaton = best_automaton(loops, max_length, max_conflict, n_states)
    return table_of(optimal_model(automaton, CONSTRAINTS), name)


def best_automaton(loops: int, max_length: int, max_conflict: int, n_states: int) -> Automaton:
    """The best automaton of n_states found: states added, exchanged, and shaken with a fixed seed.

    Raises OptionError where a limit is out of range.
    """
    if not 2 <= n_states <= MAX_CHOSEN:
        raise OptionError(f"fit: {n_states} states to choose, not 2 to {MAX_CHOSEN}")
    search = Search(_candidates(loops, max_length, max_conflict))
    for n in (*range(GROWTH, n_states, GROWTH), n_states):
        search.grow(n)
        search.refit()
    search.settle()
    search.refit()
    rng = np.random.default_rng(60)
    for _ in range(N_SHAKES):
        search.shake(min(SHAKEN, n_states - 1), rng)
        search.refit()
    return automaton_of(search.among, search.best)


def _candidates(loops: int, max_length: int, max_conflict: int) -> Candidates:
    if not (1 <= loops <= 8 and 3 <= max_length <= 100 and 1 <= max_conflict <= 100):
        raise OptionError(
            f"fit: {loops} loops, length {max_length}, conflict {max_conflict}: "
            "need 1 to 8 loops, lengths of 3 to 100 and conflicts of 1 to 100"
        )
    lengths = [range(3, 4 + (max_length - 3) // i) for i in range(1, loops + 1)]
    n = (max_conflict + 1) * int(np.prod([len(choice) + 1 for choice in lengths], dtype=object))
    if n > 8 * MAX_CANDIDATES:
        raise OptionError(f"fit: about {n} states to choose from; lower the limits")
    return candidates(lengths, max_conflict)
