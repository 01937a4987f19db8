"""Certificates: words never leave the certified band, unsound tables never get one."""

import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.models.certificate import Certificate
from ebz.codec.models.certify_automaton import certify_automaton, check_sound
from ebz.codec.models.fit import fit
from ebz.codec.models.integers import table_of
from ebz.codec.models.language import check_stacks, word_bits
from ebz.codec.models.loops import CONSTRAINTS, redirected_automaton
from ebz.codec.models.markov import optimal_model
from ebz.codec.models.table import C, E, S, Table
from tests.models.words import random_word

TABLE = Table.load("loop-60")
CERTIFICATE = certify_automaton(TABLE)
generators = st.integers(0, 2**32).map(random.Random)
weights = st.lists(st.floats(0.01, 1), min_size=5, max_size=5)


def allowance(found: Certificate, word: str, special: list[int]) -> tuple[float, float]:
    """The least and the largest cost that the certificate grants the word."""
    n_c = word.count("C")
    n_special = len(special)
    n_other = len(word) - n_c - n_special
    price = found.bits_per_c * n_c + found.bits_per_other * n_other
    below = found.below
    assert below is not None
    # A word that is cut off has more loops left than components: E without its S.
    n_open = word.count("E") - word.count("S") + n_special
    most = found.bits_per_word + found.bits_per_component * n_open
    least = below.bits_per_word + below.bits_per_component * n_open
    return (
        price * (1 - below.spread) - least - below.bits_per_special * n_special,
        price + most + found.bits_per_special * n_special,
    )


def test_the_bound_of_loop_60() -> None:
    assert CERTIFICATE.bits_per_vertex < 3.3172
    assert CERTIFICATE.below is not None
    assert CERTIFICATE.below.spread < 0.001
    for constants in (CERTIFICATE, CERTIFICATE.below):
        assert constants.bits_per_word + constants.bits_per_component < 64


@settings(deadline=None)
@given(generators, weights, st.sampled_from([0.0, 0.05, 0.5]))
def test_every_word_stays_in_the_certified_band(
    rng: random.Random, weights: list[float], special_share: float
) -> None:
    word, special = random_word(rng, 400, weights, special_share)
    least, most = allowance(CERTIFICATE, word, special)
    assert least <= word_bits(TABLE, word, special) <= most


@settings(deadline=None, max_examples=20)
@given(st.integers(1, 3), st.integers(3, 6), st.integers(1, 5), generators)
def test_fitted_tables_are_certified(
    loops: int, length: int, conflict: int, rng: random.Random
) -> None:
    table = fit(loops, length, conflict)
    found = certify_automaton(table, n_triangles=6)
    word, special = random_word(rng, 300, [1.0] * 5, 0.02)
    least, most = allowance(found, word, special)
    assert least <= word_bits(table, word, special) <= most


def test_the_integers_lose_little() -> None:
    table = fit(2, 8, 8)
    model = optimal_model_of(table)
    assert 0 <= certify_automaton(table, n_triangles=6).bits_per_vertex - 2 * model < 0.0005


def optimal_model_of(table: Table) -> float:
    """Bits per symbol of the optimal model on the table's automaton."""
    from ebz.codec.models.automaton import Automaton

    targets = np.where(table.frequencies > 0, table.successors.astype(int), -1)
    return optimal_model(Automaton(tuple("CLRSE"), targets), CONSTRAINTS).bits_per_symbol


def test_no_certificate_is_below_the_entropy_of_its_language() -> None:
    assert CERTIFICATE.bits_per_vertex >= 2 * optimal_model_of(TABLE)


def test_the_paper_s_redirect_is_refused_with_a_word() -> None:
    model = optimal_model(redirected_automaton(2, 6), CONSTRAINTS)
    table = table_of(model, "redirected")
    with pytest.raises(OptionError, match="unsound: state"):
        check_sound(table)
    with pytest.raises(OptionError, match="forbids C after the word E"):
        check_stacks(table)


@given(st.integers(0, 59))
def test_one_c_forbidden_too_many_is_found(state: int) -> None:
    frequencies, successors = TABLE.frequencies.copy(), TABLE.successors.copy()
    if not frequencies[state, C] or state == 0:
        return
    frequencies[state, E] += frequencies[state, C]
    frequencies[state, C] = 0
    successors[state, C] = 0
    with pytest.raises(OptionError, match="unsound"):
        check_sound(Table("x", frequencies, successors))


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 59), st.sampled_from([C, S, E]), st.integers(0, 59))
def test_a_redirected_transition_is_refused_where_it_rejects_a_word(
    state: int, symbol: int, target: int
) -> None:
    """The proof never accepts what the exhaustive search refutes."""
    successors = TABLE.successors.copy()
    if not TABLE.frequencies[state, symbol]:
        return
    successors[state, symbol] = target
    table = Table("x", TABLE.frequencies, successors)
    try:
        check_stacks(table, 9)
    except OptionError:
        with pytest.raises(OptionError, match="unsound"):
            check_sound(table)


def test_every_stack_of_few_triangles_is_met() -> None:
    assert check_stacks(TABLE) > 200_000


def test_limits_of_fit_are_checked() -> None:
    with pytest.raises(OptionError, match="states to choose"):
        fit(2, 8, 8, 3)
    with pytest.raises(OptionError, match="lower the limits"):
        fit(8, 100, 100, 60)
    with pytest.raises(OptionError, match="more than 65535 states"):
        fit(6, 12, 12)
