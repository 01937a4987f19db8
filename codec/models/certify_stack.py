"""What a stack table guarantees, derived from its integers and from nothing else.

A potential over stacks (top first; c_i is the class of the loops below the i-th),

    phi = P(l_1, k_1, c_1) + F(l_2, c_2) + F(l_3, c_3) + ...     in bits,

bounds every word: if on every stack, for every symbol s that it allows,

    16 - log2 f(s) <= price(s) + phi(before) - phi(after),

then a word costs at most the sum of its prices plus phi(first stack) - phi(last stack).  A linear
program finds the potential, but proves nothing: it is rounded to multiples of 2^-24 bit, and the
prices are then *defined* as the largest left side less the fall of the potential over all kinds of
stacks, in integers, with logarithms rounded up.  A bad potential only makes the bound larger.

A clipped length stands for every real length above it, UNKNOWN included, and each inequality is
checked for all stacks that share its row.  The virtual loop at the bottom is one of unknown length.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError
from ebz.codec.models.certificate import Certificate, rounded_up
from ebz.codec.models.stack import SHORTEST, StackTable
from ebz.codec.models.table import FREQUENCY_BITS, SYMBOLS, C, E, L, R, S

Integers = npt.NDArray[np.int64]

UNIT = 1 << 24
# Column of an inequality without a second potential.
NONE = -1
# The linear program's box for potentials, in bits.
MAX_POTENTIAL = 64.0
# The rounding error of log2 is far below 1e-12, a part in 60000 of a unit.
LOG_ERROR_UNITS = 1e-3


@dataclass(frozen=True)
class Kinds:
    """The kinds of stacks of a table, and where P and F stand in the vector of potentials."""

    table: StackTable

    @property
    def n_potentials(self) -> int:
        return self.table.n_classes * (self._per_class + self.table.length_cap + 1)

    @property
    def _per_class(self) -> int:
        return (self.table.length_max + 1) * (self.table.conflict_max + 1)

    def top(self, length: int, conflict: int, below: int) -> int:
        clipped = min(length, self.table.length_max)
        return below * self._per_class + clipped * (self.table.conflict_max + 1) + conflict

    def under(self, length: int, below: int) -> int:
        clipped = min(length, self.table.length_cap)
        first = self.table.n_classes * self._per_class
        return first + below * (self.table.length_cap + 1) + clipped

    @property
    def lengths(self) -> range:
        """Real lengths; the last stands for itself and everything above, UNKNOWN included."""
        return range(SHORTEST, max(self.table.length_max, self.table.length_cap) + 2)

    def conflicts(self, length: int) -> range:
        """The conflicts that a loop of this length can have; none exceeds the length less three."""
        return range(min(self.table.conflict_max, length - SHORTEST) + 1)

    def tops(self) -> Iterator[tuple[int, int]]:
        return ((length, k) for length in self.lengths for k in self.conflicts(length))


@dataclass(frozen=True, eq=False)
class Proof:
    """A potential that bounds every word, in units of 2^-24 bit, and the prices that it allows.

    n_inequalities: how many were checked.  phi: (n_potentials + 1,) by Kinds.top and Kinds.under.
    """

    kinds: Kinds
    n_inequalities: int
    phi: Integers
    price: list[int]


def prove(table: StackTable) -> Proof:
    """The proof for a table; raises OptionError, with the reason, where there is none."""
    table.check()
    kinds = Kinds(table)
    rows = np.array(sorted(set(_inequalities(kinds))), np.int64)
    bits = _code_lengths(table)[rows[:, 1], rows[:, 0]]
    phi = _balanced(kinds, rows, bits, _potential(kinds, rows, bits))
    return Proof(kinds, len(rows), phi, _prices(rows, bits, phi))


def certify_stack(table: StackTable) -> Certificate:
    """The guarantee of a stack table; raises OptionError, with the reason, where there is none."""
    proof = prove(table)
    kinds, phi, price = proof.kinds, proof.phi, proof.price
    other = max(price[L], price[R], -(-(price[S] + price[E]) // 2))
    start = int(phi[kinds.top(kinds.lengths[-1], 0, table.bottom)])
    further = _fall_per_component(kinds, phi)
    first = max(_fall_onto(kinds, phi, start, kinds.lengths[-1], table.bottom) - further, 0)
    special = _rise_at_special(kinds, phi)
    bits_per_c, bits_per_other = rounded_up(price[C] / UNIT), rounded_up(other / UNIT)
    return Certificate(
        model=table.name,
        kind=table.kind,
        contexts=len(table.frequencies),
        bits_per_vertex=bits_per_c + bits_per_other,
        bits_per_c=bits_per_c,
        bits_per_other=bits_per_other,
        prices={letter: price[s] / UNIT for s, letter in enumerate(SYMBOLS)},
        bits_per_word=first / UNIT,
        bits_per_component=(further + price[E] - other) / UNIT,
        bits_per_special=special / UNIT,
        below=None,
        method=f"potential over stacks, {proof.n_inequalities} inequalities checked in multiples "
        "of 2^-24 bit, with tails, unknown lengths and the bottom of the stack; every allowed "
        "symbol has a share",
    )


Inequality = tuple[int, int, int, int, int, int]


def _inequalities(kinds: Kinds) -> Iterator[Inequality]:
    """Symbol, row, P and F before, P and F after (NONE without F) of every kind of stack."""
    for below in range(kinds.table.n_classes):
        for length in kinds.lengths:
            yield from _within_top(kinds, length, below)
            yield from _joins(kinds, length, below)


def _within_top(kinds: Kinds, length: int, below: int) -> Iterator[Inequality]:
    """C, L, R and E on a top loop of that length."""
    table = kinds.table
    for conflict in kinds.conflicts(length):
        row = table.row((length, conflict, below))
        here = kinds.top(length, conflict, below)
        if length > SHORTEST and conflict != 1:
            # The last length stands for longer ones too, which C leaves among them.
            shorter = (length - 1, length) if length == kinds.lengths[-1] else (length - 1,)
            for left in shorter:
                yield C, row, here, NONE, kinds.top(left, max(conflict - 1, 0), below), NONE
        yield L, row, here, NONE, kinds.top(length + 1, 1, below), NONE
        yield R, row, here, NONE, kinds.top(length + 1, 0, below), NONE
        pushed = kinds.top(SHORTEST, 0, table.step_over((length, conflict, below)))
        yield E, row, here, NONE, pushed, kinds.under(length, below)


def _joins(kinds: Kinds, length: int, below: int) -> Iterator[Inequality]:
    """S of every top loop with a second loop of that length; `below` is what lies under both."""
    table = kinds.table
    joined = length - 1 if length - 1 <= table.conflict_max else 0
    under, here = kinds.under(length, below), table.step_over((length, 0, below))
    for right in kinds.lengths:
        after = kinds.top(right + length - 1, joined, below)
        for conflict in kinds.conflicts(right):
            row = table.row((right, conflict, here))
            yield S, row, kinds.top(right, conflict, here), under, after, NONE


def _code_lengths(table: StackTable) -> Integers:
    """16 - log2 f of every row and symbol in units, never too small; meaningless where f is 0."""
    bits = FREQUENCY_BITS - np.log2(np.maximum(table.frequencies, 1))
    return np.ceil(bits * UNIT + LOG_ERROR_UNITS).astype(np.int64)


def _potential(kinds: Kinds, rows: Integers, bits: Integers) -> Integers:
    """Potentials of a linear program for the least price(C) + price(other)."""
    from ebz.codec.models.solvers import linear_program, sparse_rows

    used, index = np.unique(rows[:, 2:], return_inverse=True)
    index = index.reshape(len(rows), 4)
    n, line = len(used), np.arange(len(rows))
    c_c, c_other, c_e = n, n + 1, n + 2
    entries = [(-1.0, line, index[:, 0]), (-1.0, line, index[:, 1]),
               (1.0, line, index[:, 2]), (1.0, line, index[:, 3])]  # fmt: skip
    # price(S) = 2 price(other) - price(E), since there are as many S as E.
    for symbols, price, times in (((C,), c_c, -1.0), ((L, R), c_other, -1.0), ((E,), c_e, -1.0),
                                  ((S,), c_other, -2.0), ((S,), c_e, 1.0)):  # fmt: skip
        charged = line[np.isin(rows[:, 0], symbols)]
        entries.append((times, charged, np.full(len(charged), price)))
    values = np.concatenate([np.full(len(i), value) for value, i, _ in entries])
    places = [np.concatenate([entry[axis] for entry in entries]) for axis in (1, 2)]
    matrix = sparse_rows((values, places[0], places[1]), (len(rows), n + 3))
    objective = np.zeros(n + 3)
    objective[[c_c, c_other]] = 1
    box = [(0.0, 0.0) if place == NONE else (-MAX_POTENTIAL, MAX_POTENTIAL) for place in used]
    prices = [(0.0, None), (None, None), (None, None)]
    found = linear_program(objective, (matrix, -bits / UNIT), None, [*box, *prices])
    if found is None:
        raise OptionError("model table: its cost has no bound")
    phi = np.zeros(kinds.n_potentials + 1, np.int64)  # the last is that of NONE
    phi[used] = np.rint(found[:n] * UNIT).astype(np.int64)
    return phi


def _prices(rows: Integers, bits: Integers, phi: Integers) -> list[int]:
    """The least price of each symbol for which every inequality holds; that of C is not negative.

    An open boundary of m edges has m fewer C, which must not cost more than B v.
    """
    needed = bits + phi[rows[:, 4]] + phi[rows[:, 5]] - phi[rows[:, 2]] - phi[rows[:, 3]]
    price = [int(needed[rows[:, 0] == symbol].max()) for symbol in range(len(SYMBOLS))]
    return [max(price[C], 0), *price[L:]]


def _balanced(kinds: Kinds, rows: Integers, bits: Integers, phi: Integers) -> Integers:
    """The same potential with S and E at one price: a constant for each lower loop is free."""
    price = _prices(rows, bits, phi)
    balanced = phi.copy()
    balanced[kinds.under(0, 0) : -1] += (price[S] - price[E]) // 2
    return balanced


def _fall_onto(kinds: Kinds, phi: Integers, before: int, length: int, below: int) -> int:
    """Largest fall of the potential from a loop on top to any loop on top of that one."""
    pushed = kinds.table.step_over((length, 0, below))
    lowest = min(int(phi[kinds.top(*top, pushed)]) for top in kinds.tops())
    return before - int(phi[kinds.under(length, below)]) - lowest


def _fall_per_component(kinds: Kinds, phi: Integers) -> int:
    """Largest fall of the potential from a finished component on top to another on top of it."""
    return max(
        _fall_onto(kinds, phi, int(phi[kinds.top(length, conflict, below)]), length, below)
        for below in range(kinds.table.n_classes)
        for length, conflict in kinds.tops()
    )


def _rise_at_special(kinds: Kinds, phi: Integers) -> int:
    """Largest rise of the potential when a special S makes the loop on top unknown."""
    return max(
        int(phi[kinds.top(kinds.lengths[-1], 0, below)] - phi[kinds.top(length, conflict, below)])
        for below in range(kinds.table.n_classes)
        for length, conflict in kinds.tops()
    )
