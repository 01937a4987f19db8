"""Optimal models: closed forms, the equal cost of all words, constraints met or recognised."""

from math import log2, sqrt

import numpy as np
import pytest

from ebz.codec.errors import OptionError
from ebz.codec.models import theory
from ebz.codec.models.automaton import from_edges
from ebz.codec.models.loops import CONSTRAINTS, loop_automaton
from ebz.codec.models.markov import optimal_model

GOLDEN = (1 + sqrt(5)) / 2


def test_figure_1_to_its_last_digit() -> None:
    found = theory.figure_1()
    assert f"{found['p(a|0)']:.3f} {found['p(b|0)']:.3f}" == "0.618 0.382"
    assert f"{found['bits_per_symbol']:.3f}" == "0.694"
    assert [row["g_m(0)"] for row in found["rows"]][:6] == [2, 3, 5, 8, 13, 21]
    assert found["rows"][-1]["p_m(a|0)"] == pytest.approx(1 / GOLDEN, abs=1e-4)


def test_figure_2_is_its_closed_form() -> None:
    for row in theory.figure_2()["rows"]:
        assert row["bits_per_symbol"] == pytest.approx(row["closed_form"], abs=1e-9)
    assert theory.golden_mean_entropy((1 - 1 / sqrt(5)) / 2) == pytest.approx(log2(GOLDEN))


def test_every_cycle_costs_the_same_per_symbol() -> None:
    """Theorem 3.1: costs differ from log2 alpha by a difference of potentials only."""
    automaton = loop_automaton(2, 6, 4)
    model = optimal_model(automaton)
    rng = np.random.default_rng(1)
    seen: dict[int, float] = {}
    state, surplus = 0, 0.0
    for _ in range(20000):
        assert surplus == pytest.approx(seen.setdefault(state, surplus), abs=1e-6)
        symbol = rng.choice(np.flatnonzero(automaton.targets[state] >= 0))
        surplus -= log2(model.probabilities[state, symbol]) + model.bits_per_symbol
        state = automaton.targets[state, symbol]


def test_stationary_probabilities_are_stationary() -> None:
    model = optimal_model(loop_automaton(2, 6, 4), CONSTRAINTS)
    source, symbol, target = model.automaton.edges()
    flow = model.states[source] * model.probabilities[source, symbol]
    assert np.bincount(target, flow) == pytest.approx(model.states, abs=1e-9)
    assert np.bincount(symbol, flow) == pytest.approx(model.symbols, abs=1e-9)
    assert model.residual < 1e-9


def test_entropy_of_the_model_is_its_bits() -> None:
    model = optimal_model(loop_automaton(2, 6, 4), CONSTRAINTS)
    p = model.probabilities
    entropy = -(p * np.log2(np.where(p > 0, p, 1))).sum(axis=1)
    assert model.states @ entropy == pytest.approx(model.bits_per_symbol, abs=1e-8)


def test_constraints_are_met() -> None:
    model = optimal_model(loop_automaton(2, 12, 12), CONSTRAINTS)
    assert np.abs(np.array(CONSTRAINTS) @ model.symbols).max() < 1e-8


@pytest.mark.parametrize(
    ("limits", "bits"), [((1, 12, 12), 3.3791), ((2, 12, 12), 3.3200), ((3, 8, 8), 3.3072)]
)
def test_bounds_of_loop_automata(limits: tuple[int, int, int], bits: float) -> None:
    model = optimal_model(loop_automaton(*limits), CONSTRAINTS)
    assert 2 * model.bits_per_symbol == pytest.approx(bits, abs=5e-5)


@pytest.mark.parametrize(
    ("constraint", "message"),
    [
        ([-2, 1], "no infinite word"),  # twice as many b as a
        ([1, 1], "no infinite word"),
        ([-1, 1], "only words that avoid some transition"),  # as many b as a: only (ab)*
    ],
)
def test_infeasible_constraints_are_recognised(constraint: list[int], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        optimal_model(theory.golden_mean(), [constraint])


def test_constraints_of_another_shape_are_refused() -> None:
    with pytest.raises(OptionError, match=r"shape \(1, 3\) is not \(m, 2\)"):
        optimal_model(theory.golden_mean(), [[1, 2, 3]])


def test_an_automaton_of_one_state_needs_no_iteration() -> None:
    model = optimal_model(from_edges("abcd", [(0, s, 0) for s in "abcd"]))
    assert model.bits_per_symbol == pytest.approx(2)
    assert model.probabilities == pytest.approx(np.full((1, 4), 0.25))
