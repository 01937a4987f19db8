"""Optimal Markov models of regular languages, with linear constraints on symbol counts.

S. Gumhold, Optimizing Markov Models with Applications to Triangular Connectivity Coding, 2005,
Theorem 3.1 and section 4.  Where the paper leaves open whether its iteration finds the optimum
under constraints, here the dual is minimised, which is convex: with a multiplier for each
constraint, bits per symbol are log2 of the Perron root of the weighted adjacency matrix, and the
logarithm of the root is convex in the logarithms of the entries (Kingman 1961).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.models.automaton import Automaton
from ebz.codec.models.solvers import (
    Floats,
    Perron,
    linear_program,
    minimise,
    perron,
    sparse,
    sparse_rows,
)

GRADIENT_TOLERANCE = 1e-8
# Beyond this a minimisation has run away: weights of e^40 to one.
MAX_MULTIPLIER = 40.0
# From here on a linear program is asked whether there is a minimum at all.
SUSPECT_MULTIPLIER = 10.0
# A smaller flow through every transition is none: the linear program's tolerance.
MIN_FLOW = 1e-9


@dataclass(eq=False)
class MarkovModel:
    """The Markov model that minimises the worst bits per symbol over a language.

    probabilities: (n, a) of each symbol in each state, 0 where forbidden; rows sum to 1.
    states: (n,) stationary probabilities of the states; symbols: (a,) of the symbols.
    multipliers: (m,) in nats, for the constraints divided by their largest entries.
    weights: (a,) of the symbols.
    residual: relative width of the bracket of the Perron root.
    """

    automaton: Automaton
    bits_per_symbol: float
    probabilities: Floats
    states: Floats
    symbols: Floats
    multipliers: Floats
    weights: Floats
    residual: float


def optimal_model(
    automaton: Automaton, constraints: npt.ArrayLike | None = None, start: npt.ArrayLike = ()
) -> MarkovModel:
    """The optimal Markov model of the words whose symbol counts n satisfy constraints n = 0.

    constraints: (m, a) integers.  start: (m,) multipliers to start from.
    Without constraints this is Theorem 3.1: p(s | i) = r_j / (alpha r_i) for i -s-> j, with alpha
    the Perron root and r its right vector, and bits per symbol log2 alpha.  With constraints the
    weight of a symbol s is exp(sum_i mu_i A_is), and mu minimises log alpha; the gradient is the
    constraint at the stationary symbol probabilities.
    Raises OptionError unless the automaton is strongly connected and words that use every
    transition can meet the constraints.
    """
    automaton.check_strongly_connected()
    n_symbols = len(automaton.alphabet)
    matrix = np.zeros((0, n_symbols)) if constraints is None else np.array(constraints, float)
    if matrix.ndim != 2 or matrix.shape[1] != n_symbols:
        raise OptionError(f"constraints: shape {matrix.shape} is not (m, {n_symbols})")
    matrix = matrix / np.maximum(np.abs(matrix).max(axis=1, keepdims=True, initial=0), 1)
    if not len(matrix):
        return _model(automaton, matrix, np.zeros(0), None)
    return _constrained(automaton, matrix, np.asarray(start, float))


class _RanAwayError(Exception):
    pass


def _constrained(automaton: Automaton, matrix: Floats, start: Floats) -> MarkovModel:
    last: Perron | None = None

    def log_root(multipliers: Floats) -> tuple[float, Floats]:
        nonlocal last
        if np.abs(multipliers @ matrix).max() > MAX_MULTIPLIER:
            raise _RanAwayError
        weights = np.exp(multipliers @ matrix)
        last = _perron(automaton, weights, last)
        return float(np.log(last.root)), matrix @ _symbols(automaton, weights, last)

    start = start if start.size else np.zeros(len(matrix))
    try:
        multipliers, gradient = minimise(log_root, start, GRADIENT_TOLERANCE)
    except _RanAwayError:
        gradient = np.inf
    far = np.isinf(gradient) or np.abs(multipliers @ matrix).max() > SUSPECT_MULTIPLIER
    if (far or gradient > 1e-6) and (reason := _why_infeasible(automaton, matrix)):
        raise OptionError(f"constraints: {reason}")
    if gradient > 1e-6:
        raise OptionError(f"constraints: no convergence (gradient {gradient:.1e})")
    return _model(automaton, matrix, multipliers, last)


def _why_infeasible(automaton: Automaton, matrix: Floats) -> str | None:
    """What stands against the constraints, by the circulation whose least edge flow is largest.

    A circulation is a mix of cycles; the flow of edge e is x_e + t, and t > 0 is what makes the
    minimum of the dual attained.
    """
    source, symbol, target = automaton.edges()
    n, m, n_rows = len(automaton), len(source), len(matrix)
    edge = np.arange(m)
    row = np.repeat(np.arange(n, n + n_rows), m)
    values = np.r_[np.ones(m), -np.ones(m), matrix[:, symbol].ravel(), np.ones(m)]
    rows = np.r_[source, target, row, np.full(m, n + n_rows)]
    columns = np.r_[edge, edge, np.tile(edge, n_rows), edge]
    all_rows = sparse_rows((values, rows, columns), (n + n_rows + 1, m))
    sums = np.asarray(all_rows.sum(axis=1)).ravel()
    entries = (
        np.r_[values, sums],
        np.r_[rows, np.arange(len(sums))],
        np.r_[columns, np.full(len(sums), m)],
    )
    equal = sparse_rows(entries, (n + n_rows + 1, m + 1))
    right = np.r_[np.zeros(n + n_rows), 1.0]
    flow = linear_program(np.r_[np.zeros(m), -1.0], None, (equal, right), [(0, None)] * (m + 1))
    if flow is None:
        return "no infinite word of the automaton satisfies them"
    if flow[-1] < MIN_FLOW:
        return "only words that avoid some transition satisfy them"
    return None


def _perron(automaton: Automaton, weights: Floats, start: Perron | None) -> Perron:
    source, symbol, target = automaton.edges()
    return perron(sparse(source, target, weights[symbol], len(automaton)), start)


def _symbols(automaton: Automaton, weights: Floats, vectors: Perron) -> Floats:
    """Stationary symbol probabilities: the derivative of log alpha by the log of each weight."""
    source, symbol, target = automaton.edges()
    flow = vectors.left[source] * weights[symbol] * vectors.right[target]
    return np.bincount(symbol, flow / flow.sum(), minlength=len(weights)).astype(float)


def _model(
    automaton: Automaton, matrix: Floats, multipliers: Floats, start: Perron | None
) -> MarkovModel:
    weights = np.exp(multipliers @ matrix)
    found = _perron(automaton, weights, start)
    source, symbol, target = automaton.edges()
    probabilities = np.zeros(automaton.targets.shape)
    probabilities[source, symbol] = weights[symbol] * found.right[target] / found.right[source]
    probabilities /= probabilities.sum(axis=1, keepdims=True)
    states = found.left * found.right
    return MarkovModel(
        automaton=automaton,
        bits_per_symbol=float(np.log2(found.root)),
        probabilities=probabilities,
        states=states / states.sum(),
        symbols=_symbols(automaton, weights, found),
        multipliers=multipliers,
        weights=weights,
        residual=found.residual,
    )
