"""Deterministic finite automata whose states all accept: the languages of the paper's section 3.

S. Gumhold, Optimizing Markov Models with Applications to Triangular Connectivity Coding, 2005.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError

FORBIDDEN = -1


@dataclass(eq=False)
class Automaton:
    """A deterministic automaton over any alphabet.

    alphabet: the symbols, one column each.
    targets: (n, len(alphabet)) int32, the state that a symbol leads to, -1 where it is forbidden.
    labels: what each state stands for, where that is known.
    State 0 is the start.  Raises OptionError where a target is out of range.
    """

    alphabet: tuple[str, ...]
    targets: npt.NDArray[np.int32]
    labels: tuple[Any, ...] = ()

    def __post_init__(self) -> None:
        self.alphabet = tuple(self.alphabet)
        self.targets = np.asarray(self.targets, np.int32)
        n = len(self.targets)
        if n == 0 or self.targets.shape != (n, len(self.alphabet)):
            raise OptionError(f"automaton: targets of shape {self.targets.shape}")
        if self.targets.min() < FORBIDDEN or self.targets.max() >= n:
            raise OptionError(f"automaton: a target is not one of the {n} states")

    def __len__(self) -> int:
        return len(self.targets)

    @property
    def allowed(self) -> npt.NDArray[np.bool_]:
        """(n, len(alphabet)) bool: which symbols each state allows."""
        allowed: npt.NDArray[np.bool_] = self.targets != FORBIDDEN
        return allowed

    def edges(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.int32]]:
        """Source, symbol and target of each transition, by source and then symbol."""
        source, symbol = np.nonzero(self.allowed)
        return source, symbol, self.targets[source, symbol]

    def check_strongly_connected(self) -> None:
        """Raise OptionError unless every state is reached from, and reaches, the start."""
        source, _, target = self.edges()
        for tails, heads, verb in ((source, target, "is not reached from"),
                                   (target, source, "does not lead back to")):  # fmt: skip
            missing = np.flatnonzero(~_reached(len(self), tails, heads))
            if missing.size:
                raise OptionError(f"automaton: state {missing[0]} {verb} the start")

    def minimised(self) -> Automaton:
        """The smallest automaton of the same language (Moore's partition refinement)."""
        block = np.unique(self.allowed, axis=0, return_inverse=True)[1].ravel()
        n_blocks = 0
        while n_blocks != (n_blocks := int(block.max()) + 1):
            signature = np.where(self.allowed, block[self.targets], FORBIDDEN)
            rows = np.column_stack([block, signature])
            block = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
        _, first = np.unique(block, return_index=True)
        order = np.argsort(first)  # blocks in the order of their first state: the start stays 0
        number = np.empty_like(order)
        number[order] = np.arange(len(order))
        kept = first[order]
        targets = np.where(
            self.allowed[kept], number[block[self.targets[kept]]], FORBIDDEN
        )  # fmt: skip
        labels = tuple(self.labels[i] for i in kept) if self.labels else ()
        return Automaton(self.alphabet, targets.astype(np.int32), labels)

    def counts(self, length: int) -> list[list[int]]:
        """Row m: how many words of length m each state starts, for m = 0 to `length`."""
        rows = [[1] * len(self)]
        for _ in range(length):
            last = rows[-1]
            rows.append([sum(last[t] for t in row if t >= 0) for row in self.targets.tolist()])
        return rows


def build(
    alphabet: Iterable[str],
    start: Hashable,
    successors: Callable[[Any], Iterable[tuple[int, Hashable]]],
    max_states: int = 1 << 20,
) -> Automaton:
    """The automaton of all states reached from `start`.

    successors(state) yields (column of the symbol, next state).
    Raises OptionError where a state gives a symbol twice (not deterministic) or above max_states.
    """
    alphabet = tuple(alphabet)
    index, states, targets = {start: 0}, [start], []
    for state in states:  # grows while it is walked
        row = [FORBIDDEN] * len(alphabet)
        for symbol, target in successors(state):
            if row[symbol] != FORBIDDEN:
                raise OptionError(f"automaton: state {state} has {alphabet[symbol]} twice")
            if target not in index:
                if len(states) >= max_states:
                    raise OptionError(f"automaton: more than {max_states} states")
                index[target] = len(states)
                states.append(target)
            row[symbol] = index[target]
        targets.append(row)
    return Automaton(alphabet, np.array(targets, np.int32), tuple(states))


def from_edges(alphabet: Iterable[str], edges: Iterable[tuple[int, str, int]]) -> Automaton:
    """The automaton with transitions (source, symbol, target); state 0 is the start.

    Raises OptionError where a source has a symbol twice or a symbol is not in the alphabet.
    """
    alphabet = tuple(alphabet)
    rows: dict[int, list[tuple[int, int]]] = {}
    for source, symbol, target in edges:
        if symbol not in alphabet:
            raise OptionError(f"automaton: symbol {symbol!r} is not in the alphabet")
        rows.setdefault(source, []).append((alphabet.index(symbol), target))
    return build(alphabet, 0, lambda state: rows.get(state, ()))


def _reached(
    n: int, tails: npt.NDArray[np.integer[Any]], heads: npt.NDArray[np.integer[Any]]
) -> npt.NDArray[np.bool_]:
    reached = np.zeros(n, bool)
    reached[0] = True
    n_reached = 0
    while n_reached != (n_reached := int(reached.sum())):
        reached[heads[reached[tails]]] = True
    return reached
