"""Loop automata never reject a word of the exact language; the paper's redirect does."""

from collections import Counter

import pytest

from ebz.codec.errors import OptionError
from ebz.codec.models.language import Stack, successors
from ebz.codec.models.loops import UNKNOWN, accepts, loop_automaton, redirected_automaton
from ebz.codec.models.loops import successors as bounds_after
from ebz.codec.models.table import C
from tests.models.words import is_closed_sphere, mesh_of

# Tutte, A census of planar triangulations, 1962: rooted triangulations with n inner vertices.
TUTTE = [1, 1, 3, 13, 68, 399, 2530]
REJECTED = "ERRRRCCCC"


def test_the_exact_language_counts_tutte_s_numbers() -> None:
    level: Counter[Stack] = Counter({((3, 0),): 1})
    found = []
    for n_triangles in range(1, 14):
        if n_triangles % 2:
            found.append(
                sum(n for stack, n in level.items() if [length for length, _ in stack] == [3])
            )
        following: Counter[Stack] = Counter()
        for stack, n in level.items():
            for _, after in successors(stack):
                following[after] += n
        level = following
    assert found == TUTTE


def test_unlimited_bounds_are_the_exact_language() -> None:
    level: list[tuple[Stack, tuple[int, ...]]] = [(((3, 0),), (3, 1))]
    for _ in range(7):
        following = []
        for stack, bounds in level:
            after = dict(bounds_after(bounds))
            exact = dict(successors(stack))
            assert (C in after) == (C in exact)
            following += [(exact[s], after[s]) for s in exact]
        level = following


@pytest.mark.parametrize("limits", [(1, 3, 1), (1, 5, 2), (2, 4, 4), (2, 6, 3), (3, 5, 5)])
def test_every_word_is_accepted(limits: tuple[int, int, int]) -> None:
    automaton = loop_automaton(*limits)
    level: set[tuple[Stack, int]] = {((), 0)}
    for _ in range(10):
        level = {
            (after, int(automaton.targets[state, symbol]))
            for stack, state in level
            for symbol, after in successors(stack)
        }
        assert min(state for _, state in level) >= 0


def test_the_redirect_rejects_the_word_of_a_mesh() -> None:
    faces = mesh_of(REJECTED)
    assert is_closed_sphere(faces)
    assert (len(faces), len(set().union(*map(set, faces)))) == (10, 7)
    assert accepts(loop_automaton(2, 6, 6), REJECTED)
    assert not accepts(redirected_automaton(2, 6), REJECTED)


def test_state_0_is_the_unknown_stack() -> None:
    automaton = loop_automaton(2, 6, 6)
    assert automaton.labels[0] == UNKNOWN
    assert automaton.allowed[0].all()


@pytest.mark.parametrize("limits", [(0, 5, 5), (9, 5, 5), (2, 2, 5), (2, 5, 0), (2, 255, 5)])
def test_limits_out_of_range_are_refused(limits: tuple[int, int, int]) -> None:
    with pytest.raises(OptionError, match="need 1 to 8 loops"):
        loop_automaton(*limits)


def test_too_many_states_are_refused() -> None:
    with pytest.raises(OptionError, match="more than 100 states"):
        loop_automaton(3, 8, 8, max_states=100)
