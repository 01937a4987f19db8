"""What the table of an automaton guarantees, derived from its integers and from nothing else.

Cost: with costs w(i, s) = 16 - log2 f(i, s) and a potential phi of the states, a linear program
finds the least c_C + c_O such that on every transition i -s-> j

    w(i, s) + phi(j) - phi(i) <= c(s),     c(C) = c_C, c(L) = c(R) = c_O, c(S), c(E) = c_O +- delta.

Summed over a word the potentials telescope: the word costs at most c_C #C + c_O (#L + #R + #S + #E)
plus constants.  #S = #E up to the special S and the components, which cancels delta, and
#C = #L + #R + #S + #E on closed meshes of genus 0, which makes B = c_C + c_O bits per vertex.

Soundness: bounds of the stack (loops.py) are carried through the automaton to a fixed point; every
state that forbids C must bound k1 by 1 there.  That proves that no allowed C is ever forbidden, in
words of any length.  Driving the table through every stack of few triangles, by the exact rules
(language.py), checks the bounds' own rules.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.models.certificate import Band, Certificate, rounded_up
from ebz.codec.models.language import N_CHECKED_TRIANGLES, check_stacks
from ebz.codec.models.loops import UNBOUNDED, UNKNOWN, State, canonical, successors
from ebz.codec.models.table import FREQUENCY_BITS, C, E, S, Table

Floats = npt.NDArray[np.float64]

# How often the bounds of a state may grow before a bound that still grows counts as unknown.
WIDENING = 64
# What the linear program's tolerance and the sums over a word may add to a cost.
TOLERANCE = 1e-9


def certify_automaton(table: Table, n_triangles: int = N_CHECKED_TRIANGLES) -> Certificate:
    """The guarantee of a table; raises OptionError, with the reason, where there is none.

    n_triangles: up to how many triangles every stack is tried, besides the proof.
    """
    table.check()
    proved = check_sound(table)
    check_stacks(table, n_triangles)
    return _certificate(_transitions(table, proved), table, n_triangles)


def check_sound(table: Table) -> list[State]:
    """The bounds proved for each state, () where it is not reached.

    Raises OptionError where a state forbids C though its bounds allow a stack that has one.
    """
    proved = _bounds(table)
    for state, bounds in enumerate(proved):
        if bounds and not table.frequencies[state, C] and bounds[1] != 1:
            raise OptionError(
                f"model {table.name!r}: unsound: state {state} forbids C, "
                f"but a stack that allows it may lead there ({describe(bounds)})"
            )
    return proved


def describe(bounds: State) -> str:
    """The bounds of a state in words: l1 <= 4, k1 <= 2, l2 <= 6."""
    names = ["l1", "k1", *(f"l{i}" for i in range(2, len(bounds)))]
    known = [f"{n} <= {b}" for n, b in zip(names, bounds, strict=True) if b != UNBOUNDED]
    return ", ".join(known) or "nothing known"


def _bounds(table: Table) -> list[State]:
    """The least bounds that hold in each state: start unknown, each transition keeps them."""
    successor = table.successors.tolist()
    bounds: list[State] = [()] * len(successor)
    bounds[0] = UNKNOWN
    n_grown = [0] * len(successor)
    todo = [0]
    while todo:
        state = todo.pop()
        for symbol, after in successors(bounds[state]):
            if symbol == C and not table.frequencies[state, C]:
                continue
            target = successor[state][symbol]
            joined = _join(bounds[target], after)
            if joined != bounds[target]:
                n_grown[target] += 1
                settled = n_grown[target] < WIDENING
                bounds[target] = joined if settled else _widened(bounds[target], joined)
                todo.append(target)
    return bounds


def _join(a: State, b: State) -> State:
    """The tightest bounds that hold wherever `a` or `b` do (() holds nowhere)."""
    return canonical(tuple(map(max, zip(a, b, strict=False)))) if a else b


def _widened(before: State, grown: State) -> State:
    """The bounds that did not grow; the others, which might grow for ever, become unknown."""
    kept = (new if new == old else UNBOUNDED for old, new in zip(before, grown, strict=False))
    return canonical(tuple(kept))


@dataclass(eq=False)
class _Transitions:
    """The transitions that words can take, with their costs in bits."""

    n_states: int
    source: npt.NDArray[np.intp]
    symbol: npt.NDArray[np.intp]
    target: npt.NDArray[np.intp]
    cost: Floats

    @property
    def sign(self) -> Floats:
        """+1 for S, -1 for E: what #S = #E cancels."""
        sign: Floats = (self.symbol == S).astype(float) - (self.symbol == E)
        return sign

    def matrix(self, columns: list[Floats]) -> Any:
        """Sparse rows phi(target) - phi(source), then those columns."""
        from ebz.codec.models.solvers import sparse_rows

        m, n = len(self.cost), self.n_states
        row = np.arange(m)
        values = np.r_[np.ones(m), -np.ones(m), *columns]
        places = [np.full(m, n + i) for i in range(len(columns))]
        entries = np.r_[self.target, self.source, *places]
        rows = np.tile(row, 2 + len(columns))
        return sparse_rows((values, rows, entries), (m, n + len(columns)))

    def solve(self, objective: list[float], columns: list[Floats], right: Floats) -> Floats:
        """Least objective of the last variables under matrix x <= right, with phi(0) = 0."""
        from ebz.codec.models.solvers import linear_program

        bounds = [(0, 0)] + [(None, None)] * (self.n_states - 1 + len(columns))
        costs = np.r_[np.zeros(self.n_states), objective]
        found = linear_program(costs, (self.matrix(columns), right), None, bounds)
        if found is None:
            raise OptionError("model table: its cost has no bound")
        return found


def _transitions(table: Table, proved: list[State]) -> _Transitions:
    taken = np.zeros(table.frequencies.shape, bool)
    for state, bounds in enumerate(proved):
        if bounds:
            taken[state, [symbol for symbol, _ in successors(bounds)]] = True
    source, symbol = np.nonzero(taken & (table.frequencies > 0))
    cost = FREQUENCY_BITS - np.log2(table.frequencies[source, symbol])
    target = table.successors[source, symbol].astype(np.intp)
    return _Transitions(len(table.frequencies), source, symbol, target, cost)


def _certificate(moves: _Transitions, table: Table, n_triangles: int) -> Certificate:
    phi, c_c, c_other, delta = _upper(moves)
    psi, spread, delta_below = _lower(moves, c_c, c_other)
    at = np.unique(moves.source)
    return Certificate(
        model=table.name,
        kind=table.kind,
        contexts=moves.n_states,
        bits_per_vertex=c_c + c_other,
        bits_per_c=c_c,
        bits_per_other=c_other,
        prices={"C": c_c, "L": c_other, "R": c_other, "S": c_other + delta, "E": c_other - delta},
        bits_per_word=float(phi[0] - phi.min()),
        bits_per_component=-delta,
        bits_per_special=float((phi[0] - phi[at]).max()),
        below=Band(
            spread=spread,
            bits_per_word=float(psi.max() - psi[0]),
            bits_per_component=delta_below,
            bits_per_special=float((psi[at] - psi[0]).max()),
        ),
        method="cost: linear program over the transitions; soundness: bounds of the stack carried "
        f"to a fixed point, and every stack of at most {n_triangles} triangles",
    )


def _upper(moves: _Transitions) -> tuple[Floats, float, float, float]:
    """phi, c_C, c_O and delta of the least c_C + c_O."""
    is_c = (moves.symbol == C) * 1.0
    columns = [-is_c, is_c - 1, -moves.sign]
    x = moves.solve([1, 1, 0], columns, -moves.cost)
    # The solver's inequalities hold to its tolerance; the certificate's hold exactly.
    violation = max(0.0, float((moves.matrix(columns) @ x + moves.cost).max())) + TOLERANCE
    n = moves.n_states
    c_c, c_other = rounded_up(float(x[n]) + violation), rounded_up(float(x[n + 1]) + violation)
    return x[:n], c_c, c_other, float(x[n + 2])


def _lower(moves: _Transitions, c_c: float, c_other: float) -> tuple[Floats, float, float]:
    """psi, spread and delta of the least spread below c_C and c_O."""
    price = np.where(moves.symbol == C, c_c, c_other)
    columns, right = [-price, moves.sign], moves.cost - price
    x = moves.solve([1, 0], columns, right)  # x holds -psi
    violation = max(0.0, float((moves.matrix(columns) @ x - right).max())) + TOLERANCE
    n = moves.n_states
    return -x[:n], max(float(x[n]), 0.0) + violation / float(price.min()), float(x[n + 1])
