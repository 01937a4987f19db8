"""Fits a table to the language: the loop automaton, its optimal model, the integers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ebz.codec.errors import OptionError
from ebz.codec.models.automaton import Automaton
from ebz.codec.models.integers import table_of
from ebz.codec.models.loops import CONSTRAINTS, UNBOUNDED, UNKNOWN, State, loop_automaton
from ebz.codec.models.markov import optimal_model
from ebz.codec.models.search import Candidates, Search, automaton_of, candidates
from ebz.codec.models.table import MAX_STATES, Table

MAX_CHOSEN = 400
MAX_CANDIDATES = 1 << 16
# After this many states were added the weights are fitted anew.
GROWTH = 10
# The unknown stack, the one after L, and the loops of three and four edges, which need each other.
FIRST: tuple[State, ...] = (UNKNOWN, (UNBOUNDED, 1), (3, 1), (4, 1), (4, 2))


def fit(
    loops: int, max_length: int, max_conflict: int, n_states: int | None = None, name: str = "fit"
) -> Table:
    """The table of a sound loop automaton, with the optimal probabilities in 16 bits.

    The automata are those of the paper's section 6, made sound, the probabilities those of
    Theorem 3.1 under the constraints of section 4.

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
    """The best automaton of n_states found: states added one by one, then exchanged.

    Raises OptionError where a limit is out of range.
    """
    if not len(FIRST) <= n_states <= MAX_CHOSEN:
        raise OptionError(f"fit: {n_states} states to choose, not {len(FIRST)} to {MAX_CHOSEN}")
    search = _search(loops, max_length, max_conflict)
    for n in (*range(GROWTH, n_states, GROWTH), n_states):
        _grow(search, n)
    search.settle()
    search.refit()
    return automaton_of(search.among, search.best)


def growing_automata(
    loops: int, max_length: int, max_conflict: int, sizes: Iterable[int]
) -> Iterator[Automaton]:
    """Automata of increasing numbers of states, added one by one and never exchanged."""
    search = _search(loops, max_length, max_conflict)
    for n in sizes:
        _grow(search, n)
        yield automaton_of(search.among, search.best)


def _grow(search: Search, n: int) -> None:
    search.grow(n)
    search.refit()


def _search(loops: int, max_length: int, max_conflict: int) -> Search:
    """A search that starts from states none of which helps alone."""
    among = _candidates(loops, max_length, max_conflict)
    return Search(among, [among.states.index(state) for state in FIRST if state in among.states])


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
