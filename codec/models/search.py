"""The best N states for a loop automaton: which bounds are worth remembering.

A set of states makes an automaton as soon as each symbol of each state is sent to one of the
states whose bounds are no tighter than the bounds after it (loops.py: any choice is sound).  With
fixed multipliers the best choice is the one of least value (the entry of the right Perron vector:
how many words still follow), found by policy iteration.  States are exchanged greedily: the gain
of each candidate is estimated to first order from the Perron vectors, and the few best are tried.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, product

import numpy as np
import numpy.typing as npt

from ebz.codec.models.automaton import FORBIDDEN, Automaton
from ebz.codec.models.loops import (
    CONSTRAINTS,
    UNBOUNDED,
    UNKNOWN,
    State,
    canonical,
    successors,
)
from ebz.codec.models.markov import optimal_model
from ebz.codec.models.table import SYMBOLS

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Bounds = npt.NDArray[np.uint8]

TRIED = 12
IMPROVEMENT = 1e-10


@dataclass(eq=False)
class Candidates:
    """All states that may be chosen, as bounds; state 0 is the unknown stack.

    bounds: (m, w) uint8.  after: (m, 5, w) uint8, the bounds after each symbol.
    allowed: (m, 5) bool.  exact: (m, 5), the candidate with just the bounds after, or -1.
    """

    states: list[State]
    bounds: Bounds
    after: Bounds
    allowed: Bools
    exact: npt.NDArray[np.intp]

    def __post_init__(self) -> None:
        self._into: dict[int, Bools] = {}
        self._out_of: dict[int, Bools] = {}

    def into(self, state: int) -> Bools:
        """(m, 5): whose symbols may lead to `state`."""
        if state not in self._into:
            self._into[state] = (self.after <= self.bounds[state]).all(axis=2) & self.allowed
        return self._into[state]

    def out_of(self, state: int) -> Bools:
        """(5, m): where the symbols of `state` may lead."""
        if state not in self._out_of:
            after = self.after[state][:, None, :] <= self.bounds
            self._out_of[state] = after.all(axis=2) & self.allowed[state][:, None]
        return self._out_of[state]


def candidates(lengths: Sequence[Sequence[int]], max_conflict: int) -> Candidates:
    """All bounds with the i-th loop's length in lengths[i], or unknown."""
    found = {UNKNOWN: None}
    for top, *below in product(*([*choice, UNBOUNDED] for choice in lengths)):
        for k in (*range(1, max_conflict + 1), UNBOUNDED):
            found[canonical((top, k, *below))] = None
    return candidates_of(list(found))


def candidates_of(states: Sequence[State]) -> Candidates:
    """These states, the first of which is the unknown stack."""
    width = max(map(len, states))
    after = np.full((len(states), len(SYMBOLS), width), UNBOUNDED, np.uint8)
    allowed = np.zeros((len(states), len(SYMBOLS)), bool)
    for i, state in enumerate(states):
        for symbol, target in successors(state):
            allowed[i, symbol] = True
            after[i, symbol] = _padded(target, width)
    bounds = np.array([_padded(state, width) for state in states], np.uint8)
    place = {row: i for i, row in enumerate(map(tuple, bounds.tolist()))}
    exact = [[place.get(tuple(row), FORBIDDEN) for row in rows] for rows in after.tolist()]
    return Candidates(list(states), bounds, after, allowed, np.array(exact))


def _padded(state: State, width: int) -> list[int]:
    return [*state, *[UNBOUNDED] * width][:width]


@dataclass(eq=False)
class Choice:
    """Chosen states with the best choice of targets, at fixed weights.

    chosen: indices of candidates.  targets: (n, 5) positions in chosen, -1 where forbidden.
    """

    chosen: list[int]
    targets: npt.NDArray[np.intp]
    root: float
    right: Floats
    left: Floats


class Search:
    """Exchanges states of a choice, at symbol weights that `refit` renews."""

    def __init__(self, among: Candidates, chosen: Sequence[int] = (0,)) -> None:
        self.among = among
        self.weights = np.array([2.17, 0.46, 0.46, 0.19, 1.10])
        self.best = self.evaluate(list(chosen))

    def evaluate(self, chosen: list[int]) -> Choice:
        """The best targets for these states by policy iteration, and the Perron vectors."""
        options = np.stack([self.among.into(state)[chosen] for state in chosen], axis=2)
        allowed = self.among.allowed[chosen]
        right = np.ones(len(chosen))
        targets = np.full(allowed.shape, FORBIDDEN)
        while True:
            values = np.where(options, right, np.inf)
            new = np.where(allowed, values.argmin(axis=2), FORBIDDEN)
            if targets.size and (new == targets).all():
                break
            kept = np.take_along_axis(values, np.maximum(targets, 0)[:, :, None], 2)[:, :, 0]
            better = np.take_along_axis(values, np.maximum(new, 0)[:, :, None], 2)[:, :, 0]
            same = (targets >= 0) & (better >= kept * (1 - 1e-9))
            if (same | ~allowed).all():
                break
            targets = np.where(same, targets, new)
            matrix = self._matrix(targets)
            root, right = _dominant(matrix, right)
        return Choice(chosen, targets, root, right, _dominant(matrix.T, np.ones(len(chosen)))[1])

    def _matrix(self, targets: npt.NDArray[np.intp]) -> Floats:
        matrix = np.zeros((len(targets), len(targets)))
        source, symbol = np.nonzero(targets >= 0)
        np.add.at(matrix, (source, targets[source, symbol]), self.weights[symbol])
        return matrix

    def gains(self, choice: Choice, *, ahead: bool = False) -> Floats:
        """(m,) how much, to first order, each candidate would lower the root.

        `ahead` supposes that the candidates just after it are added too.
        """
        among = self.among
        value = self._value_after(choice)
        own = (value @ self.weights) / choice.root
        if ahead:
            value = np.where(among.exact >= 0, np.minimum(value, own[among.exact]), value)
            value[~among.allowed] = 0
            own = (value @ self.weights) / choice.root
        gain = np.zeros(len(own))
        for i, state in enumerate(choice.chosen):
            out = among.out_of(state)
            for symbol in np.flatnonzero(among.allowed[state]):
                saved = np.maximum(choice.right[choice.targets[i, symbol]] - own, 0)
                gain += choice.left[i] * self.weights[symbol] * saved * out[symbol]
        gain[choice.chosen] = 0
        return gain

    def _value_after(self, choice: Choice) -> Floats:
        """(m, 5) least value of a chosen state where a candidate's symbol may lead, 0 forbidden."""
        value = np.full(self.among.allowed.shape, np.inf)
        for state, right in zip(choice.chosen, choice.right, strict=True):
            np.minimum(value, right, out=value, where=self.among.into(state))
        value[~self.among.allowed] = 0
        return value

    def losses(self, choice: Choice) -> Floats:
        """(n,) how much, to first order, leaving out each chosen state would raise the root."""
        options = np.stack([self.among.into(s)[choice.chosen] for s in choice.chosen], axis=2)
        values = np.where(options, choice.right, np.inf)
        source, symbol = np.nonzero(choice.targets > 0)
        target = choice.targets[source, symbol]
        rows = values[source, symbol]
        rows[np.arange(len(rows)), target] = np.inf
        more = (
            choice.left[source] * self.weights[symbol] * (rows.min(axis=1) - choice.right[target])
        )
        more[source == target] = 0
        loss = np.bincount(target, more, minlength=len(choice.chosen)).astype(float)
        loss[0] = np.inf
        return loss

    def grow(self, n: int) -> None:
        """Add states one by one, the best of those of largest estimated gain."""
        while len(self.best.chosen) < n:
            larger = self._larger(self.best)
            if larger is None:
                return
            self.best = larger

    def _larger(self, choice: Choice) -> Choice | None:
        return min(self._additions(choice), key=_root, default=None)

    def _smaller(self, choice: Choice) -> Choice:
        return min(self._removals(choice), key=_root)

    def _additions(self, choice: Choice, *, ahead: bool = False) -> Iterator[Choice]:
        gain = self.gains(choice, ahead=ahead)
        for state in np.argsort(-gain, kind="stable")[:TRIED]:
            if gain[state] > 0:
                yield self.evaluate([*choice.chosen, int(state)])

    def _removals(self, choice: Choice) -> Iterator[Choice]:
        for i in np.argsort(self.losses(choice), kind="stable")[:TRIED]:
            if i:
                yield self.evaluate([*choice.chosen[:i], *choice.chosen[i + 1 :]])

    def exchange(self) -> bool:
        """Exchange one or two states for others where that lowers the root; else False."""
        limit = self.best.root * (1 - IMPROVEMENT)
        for smaller in chain(self._single_exchanges(), self._double_exchanges()):
            if smaller.root < limit:
                self.best = smaller
                return True
        return False

    def _single_exchanges(self) -> Iterator[Choice]:
        for larger in sorted(self._additions(self.best), key=_root):
            yield self._smaller(larger)

    def _double_exchanges(self) -> Iterator[Choice]:
        for larger in self._additions(self.best, ahead=True):
            for largest in sorted(self._additions(larger), key=_root)[:2]:
                yield self._smaller(self._smaller(largest))

    def settle(self) -> None:
        """Exchange states until no exchange helps."""
        while self.exchange():
            pass

    def refit(self) -> float:
        """Take the weights that are optimal for the best choice; returns its bits per vertex."""
        model = optimal_model(automaton_of(self.among, self.best), CONSTRAINTS)
        self.weights = model.weights
        self.best = self.evaluate(self.best.chosen)
        return 2 * model.bits_per_symbol


def _root(choice: Choice) -> float:
    return choice.root


def _dominant(matrix: Floats, vector: Floats) -> tuple[float, Floats]:
    """Perron root and vector of a small matrix, by repeated squaring of M + 1."""
    power = matrix + np.eye(len(matrix))
    for _ in range(9):
        power = power @ power
        power /= power.max()
    vector = power @ (power @ vector)
    vector /= vector.sum()
    return float((matrix @ vector).sum()), vector


def automaton_of(among: Candidates, choice: Choice) -> Automaton:
    """The automaton of a choice, without the states that the start does not reach."""
    order, place = [0], {0: 0}
    for i in order:
        for target in choice.targets[i].tolist():
            if target >= 0 and target not in place:
                place[target] = len(order)
                order.append(target)
    targets = [[place.get(t, FORBIDDEN) for t in choice.targets[i].tolist()] for i in order]
    labels = tuple(among.states[choice.chosen[i]] for i in order)
    return Automaton(tuple(SYMBOLS), np.array(targets), labels)
