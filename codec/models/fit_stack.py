"""The stack table: the probabilities with the least guaranteed bits per vertex, as integers.

With a potential Phi = P(l_1, k_1, c_1) F(l_2, c_2) F(l_3, c_3) ... over stacks, c_i the class of
the loops below the i-th, take p(s) = w_s Phi(after) / Phi(before).  Where these sum to at most one
on every stack, a word costs the sum of log2(1 / w_s) plus a constant: c_C + c_O bits per vertex
with c_L = c_R = c_O and c_S + c_E = 2 c_O.  The least c_C + c_O is a geometric program.

A constant times the total length of all loops may be added to log Phi, which shifts c_C against the
other costs; that freedom is fixed by a potential that is constant above the longest length told
apart.  So a tail that is a power of the length costs no constraints.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec.models.cone import ConeProgram, Term, summed
from ebz.codec.models.lower_loops import lower_classes, shape
from ebz.codec.models.solvers import Floats
from ebz.codec.models.stack import SHORTEST, StackTable
from ebz.codec.models.table import SYMBOLS, TOTAL, C, E, L, R, S

LENGTH_MAX = 16
CONFLICT_MAX = 8
# Variables: natural logarithms of 1 / w; c_S = 2 c_O - c_E.
COST_C, COST_O, COST_E = range(3)
N_COSTS = 3
COSTS: dict[int, list[Term]] = {
    C: [(COST_C, -1.0)],
    L: [(COST_O, -1.0)],
    R: [(COST_O, -1.0)],
    S: [(COST_O, -2.0), (COST_E, 1.0)],
    E: [(COST_E, -1.0)],
}
# Changes the bound by less than 0.0001 bits and removes the freedoms that stall the solver.
RIDGE = 1e-7


def fit_stack(length_max: int = LENGTH_MAX, conflict_max: int = CONFLICT_MAX) -> StackTable:
    """The stack table that ships, or one that tells fewer tops apart; needs clarabel.

    It minimises the bound of inequality (*) in docs/models.md, a geometric program.
    """
    table = shape(length_max, conflict_max, lower_classes())
    table.frequencies = _rounded(_probabilities(table))
    return table


@dataclass(frozen=True)
class _Variables:
    """Variables of log P(l, k, c), of log F(l, c), and of the largest ratio an S can lead to."""

    table: StackTable

    @property
    def n(self) -> int:
        t = self.table
        return N_COSTS + t.n_classes * (t.n_tops + t.length_cap + 1 + t.length_max + 1)

    def top(self, length: int, conflict: int, below: int) -> int:
        t = self.table
        remembered = conflict if conflict <= t.conflict_max else 0
        return N_COSTS + t.row((length, remembered, below))

    def under(self, length: int, below: int) -> int:
        t = self.table
        return N_COSTS + t.n_classes * (t.n_tops + min(length, t.length_cap)) + below

    def popped(self, length: int, below: int) -> int:
        t = self.table
        return N_COSTS + t.n_classes * (t.n_tops + t.length_cap + 1 + length) + below


def _probabilities(table: StackTable) -> Floats:
    """(rows, 5) the probabilities of the least guarantee."""
    at = _Variables(table)
    program = ConeProgram(at.n)
    # An open boundary of m edges has m fewer C, which must not cost more: c_C >= 0.
    program.at_most([(COST_C, -1.0)], 0.0)
    for top, under, popped in sorted(set(_joins(at))):
        program.at_most([(top, 1.0), (under, -1.0), (popped, -1.0)], 0.0)
    share = _shares(program, at)
    for row in sorted({row for row, _ in share}):
        terms = [(share[row, s], 1.0) for s in range(len(SYMBOLS)) if (row, s) in share]
        program.at_most(terms, 1.0)
    ridge = np.full(at.n, RIDGE)
    ridge[:N_COSTS] = 0.0
    found = program.minimum({COST_C: 1.0, COST_O: 1.0}, ridge)
    probabilities = np.zeros(table.frequencies.shape)
    for place, variable in share.items():
        probabilities[place] = found[variable]
    return np.asarray(probabilities / probabilities.sum(axis=1, keepdims=True))


def _shares(program: ConeProgram, at: _Variables) -> dict[tuple[int, int], int]:
    """The variable of each probability, at least w Phi(after) / Phi(before) on all its stacks."""
    share: dict[tuple[int, int], int] = {}
    for place, ratios in _ratios(at).items():
        share[place] = program.variable()
        if len(ratios) == 1:
            program.exponential_at_most(ratios[0], share[place])
            continue
        largest = program.variable()
        for ratio in ratios:
            program.at_most([*ratio, (largest, -1.0)], 0.0)
        program.exponential_at_most([(largest, 1.0)], share[place])
    return share


def _ratios(at: _Variables) -> dict[tuple[int, int], list[list[Term]]]:
    """log(w Phi(after) / Phi(before)) of each row and symbol, for each kind of stack after it."""
    found: dict[tuple[int, int], dict[tuple[int, ...], list[Term]]] = {}
    for below in range(at.table.n_classes):
        for length, conflict in at.table.tops():
            here = at.top(length, conflict, below)
            row = at.table.row((length, conflict, below))
            for symbol, after in _steps(at, length, conflict, below):
                ratio = summed([*((v, 1.0) for v in after), (here, -1.0), *COSTS[symbol]])
                found.setdefault((row, symbol), {})[(here, *after)] = ratio
    return {place: list(ratios.values()) for place, ratios in found.items()}


def _steps(
    at: _Variables, length: int, conflict: int, below: int
) -> Iterator[tuple[int, list[int]]]:
    """Each symbol allowed with the potentials after it; a clipped length leads to several."""
    table = at.table
    if length > SHORTEST and conflict != 1:
        left = max(conflict - 1, 0)
        if left <= length - 1 - SHORTEST:
            yield C, [at.top(length - 1, left, below)]
        if length == table.length_max:
            yield C, [at.top(length, left, below)]
    yield L, [at.top(length + 1, 1, below)]
    yield R, [at.top(length + 1, 0, below)]
    yield S, [at.popped(length, below)]
    longest = length if length < table.length_max else max(length, table.length_cap)
    for real in range(length, longest + 1):
        pushed = table.step_over((real, 0, below))
        yield E, [at.top(SHORTEST, 0, pushed), at.under(real, below)]


def _joins(at: _Variables) -> Iterator[tuple[int, int, int]]:
    """(top after, under before, popped) of every S: log top - log under <= log popped."""
    table = at.table
    for below in range(table.n_classes):
        for under in range(SHORTEST, max(table.length_max, table.length_cap) + 1):
            here = table.step_over((under, 0, below))
            for length in range(SHORTEST, table.length_max + 1):
                after = at.top(length + under - 1, under - 1, below)
                yield after, at.under(under, below), at.popped(length, here)


def _rounded(probabilities: Floats) -> npt.NDArray[np.uint32]:
    """Shares of 2^16 by largest remainder, at least 1 where p > 0."""
    allowed = probabilities > 0
    exact = probabilities * TOTAL
    shares = np.maximum(np.floor(exact), allowed).astype(np.int64)
    for row, missing in enumerate(TOTAL - shares.sum(axis=1)):
        order = np.argsort(shares[row] - exact[row], kind="stable")
        order = order[allowed[row, order]]
        if missing < 0:
            shares[row, shares[row].argmax()] += missing
        for i in range(missing):
            shares[row, order[i % len(order)]] += 1
    return shares.astype(np.uint32)
