"""The numbers behind the paper's figures 1, 2 and 4, computed anew.

S. Gumhold, Optimizing Markov Models with Applications to Triangular Connectivity Coding, 2005.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from fractions import Fraction
from itertools import pairwise
from math import log2
from typing import Any

from ebz.codec.models.automaton import Automaton, from_edges
from ebz.codec.models.fit import growing_automata
from ebz.codec.models.loops import (
    CONSTRAINTS,
    SYMBOLS_PER_VERTEX,
    loop_automaton,
    redirected_automaton,
)
from ebz.codec.models.markov import optimal_model

# Bits per vertex: Tutte's limit log2(256 / 27), and the guarantees of earlier unconstrained codes.
TUTTE = log2(256 / 27)
KING_ROSSIGNAC = 3.67
GUMHOLD_2000 = 3.552


def golden_mean() -> Automaton:
    """The words over a and b in which no b follows a b; state 0 comes after a, state 1 after b."""
    return from_edges("ab", [(0, "a", 0), (0, "b", 1), (1, "a", 0)])


def figure_1(max_length: int = 12) -> dict[str, Any]:
    """Figure 1: counting words gives the optimal probabilities in the limit (Theorem 3.1).

    g_m(i) is the number of words of length m from state i, Fibonacci numbers here.  Giving each
    of the g_m(0) words the same probability means p_m(a | 0) = g_{m-1}(0) / g_m(0), which tends to
    1 / golden ratio = 0.618, and log2 g_m / m tends to log2 of the golden ratio = 0.694.
    """
    automaton = golden_mean()
    model = optimal_model(automaton)
    counts = automaton.counts(max_length)
    rows = [
        {
            "m": m,
            "g_m(0)": now[0],
            "g_m(1)": now[1],
            "p_m(a|0)": before[0] / now[0],
            "p_m(b|0)": before[1] / now[0],
            "bits_per_symbol": log2(now[0]) / m,
        }
        for m, (before, now) in enumerate(pairwise(counts), 1)
    ]
    return {
        "rows": rows,
        "p(a|0)": float(model.probabilities[0, 0]),
        "p(b|0)": float(model.probabilities[0, 1]),
        "bits_per_symbol": model.bits_per_symbol,
    }


def golden_mean_entropy(p_b: float) -> float:
    """Bits per symbol of the golden-mean language in which a fraction p_b of the symbols is b.

    State 1 has probability p_b, since each b leads there and only b does, and state 0 the rest.
    State 1 allows only a.  So p_b = (1 - p_b) p(b | 0), p(b | 0) = q = p_b / (1 - p_b), and the
    entropy is (1 - p_b) (-q log2 q - (1 - q) log2 (1 - q)), which is

        (1 - p_b) log2 (1 - p_b) - p_b log2 p_b - (1 - 2 p_b) log2 (1 - 2 p_b).

    It vanishes at 0 and 1/2 and is largest, log2 of the golden ratio, at (1 - 1/sqrt 5) / 2.
    """
    return _x_log2_x(1 - p_b) - _x_log2_x(p_b) - _x_log2_x(1 - 2 * p_b)


def figure_2(n: int = 40) -> dict[str, Any]:
    """Figure 2: bits per symbol under the constraint P(b) = p_b, closed form and computed."""
    automaton = golden_mean()
    rows = []
    for i in range(1, n):
        share = Fraction(i, 2 * n)
        constraint = [-share.numerator, share.denominator - share.numerator]
        model = optimal_model(automaton, [constraint])
        rows.append(
            {
                "p_b": float(share),
                "bits_per_symbol": model.bits_per_symbol,
                "closed_form": golden_mean_entropy(float(share)),
            }
        )
    return {"rows": rows}


def _x_log2_x(x: float) -> float:
    return x * log2(x) if x > 0 else 0.0


@dataclass(frozen=True)
class Point:
    """One automaton of figure 4; both rates are of optimal models, in bits.

    log2_alpha is per symbol and without constraints: the growth of the automaton's language.
    """

    curve: str
    states: int
    bits_per_vertex: float
    log2_alpha: float
    sound: bool


# Limits (lengths and conflicts) for each number of loops; the largest has 19926 states.
LIMITS = {1: (4, 6, 8, 12, 16), 2: (4, 6, 8, 12, 20), 3: (4, 5, 6, 8, 12), 4: (5, 7, 10)}
# Near the multipliers of all of them: where to start from.
MULTIPLIERS = (0.78, -0.93)
CHOSEN = (5, 7, 10, 20, 30, 40, 60)


def figure_4() -> dict[str, Any]:
    """Figure 4: bound and growth against the number of states; a Point as a dict in each row."""
    return {"rows": [asdict(point) for point in _points()]}


def _points() -> Iterator[Point]:
    for loops, limits in LIMITS.items():
        for limit in limits:
            yield _point(f"{loops} loops", loop_automaton(loops, limit, limit))
    for automaton in growing_automata(3, 10, 8, CHOSEN):
        yield _point("best states", automaton)
    for limit in range(5, 11):
        yield _point("redirected", redirected_automaton(2, limit), sound=False)


def _point(curve: str, automaton: Automaton, *, sound: bool = True) -> Point:
    model = optimal_model(automaton, CONSTRAINTS, MULTIPLIERS)
    return Point(
        curve=curve,
        states=len(automaton),
        bits_per_vertex=SYMBOLS_PER_VERTEX * model.bits_per_symbol,
        log2_alpha=optimal_model(automaton).bits_per_symbol,
        sound=sound,
    )


FIGURES: dict[int, Callable[[], dict[str, Any]]] = {1: figure_1, 2: figure_2, 4: figure_4}
