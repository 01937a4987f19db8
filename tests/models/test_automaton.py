"""Automata of any alphabet: what building checks, and that minimising keeps the language."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.models.automaton import Automaton, from_edges


def words(automaton: Automaton, length: int) -> set[tuple[int, ...]]:
    """All words of that length, by walking every one."""
    found = set()
    for word in product(range(len(automaton.alphabet)), repeat=length):
        state = 0
        for symbol in word:
            state = automaton.targets[state, symbol] if state >= 0 else -1
        if state >= 0:
            found.add(word)
    return found


automata = st.integers(1, 6).flatmap(
    lambda n: st.lists(
        st.lists(st.integers(-1, n - 1), min_size=2, max_size=2), min_size=n, max_size=n
    ).map(lambda rows: Automaton(("a", "b"), np.array(rows)))
)


def test_a_symbol_twice_is_not_deterministic() -> None:
    with pytest.raises(OptionError, match="state 0 has a twice"):
        from_edges("ab", [(0, "a", 0), (0, "a", 1)])


def test_a_symbol_outside_the_alphabet_is_refused() -> None:
    with pytest.raises(OptionError, match="'c' is not in the alphabet"):
        from_edges("ab", [(0, "c", 0)])


def test_a_target_out_of_range_is_refused() -> None:
    with pytest.raises(OptionError, match="not one of the 1 states"):
        Automaton(("a",), np.array([[1]]))


@pytest.mark.parametrize(
    ("targets", "message"),
    [
        ([[1, -1], [1, -1]], "state 0|state 1 does not lead back"),
        ([[0, -1], [0, -1]], "state 1 is not reached from"),
    ],
)
def test_strong_connection_is_checked_both_ways(targets: list[list[int]], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        Automaton(("a", "b"), np.array(targets)).check_strongly_connected()


@given(automata)
def test_minimising_keeps_every_word(automaton: Automaton) -> None:
    small = automaton.minimised()
    assert len(small) <= len(automaton)
    for length in range(7):
        assert words(small, length) == words(automaton, length)


@given(automata)
def test_a_minimal_automaton_stays_as_it_is(automaton: Automaton) -> None:
    small = automaton.minimised()
    assert (small.minimised().targets == small.targets).all()


@given(automata)
def test_counts_are_the_numbers_of_words(automaton: Automaton) -> None:
    assert [row[0] for row in automaton.counts(6)] == [len(words(automaton, m)) for m in range(7)]
