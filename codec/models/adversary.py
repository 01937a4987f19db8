"""Searches the words that cost a stack table most: how tight its certificate is.

In the proof (certify_stack.py) a symbol s may cost less than price(s) + phi(before) - phi(after);
the difference is what the word loses against the certificate, whatever follows.  A beam search
keeps the words that have lost least.  Words of an automaton need no search: they cost all the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.errors import OptionError
from ebz.codec.models.certificate import Certificate
from ebz.codec.models.certify_stack import UNIT, prove
from ebz.codec.models.load import AnyTable
from ebz.codec.models.stack import SHORTEST, Loop, StackTable
from ebz.codec.models.table import FREQUENCY_BITS, SYMBOLS, C, E, L, R, S

MIN_VERTICES, MAX_VERTICES, MAX_WIDTH = 4, 100_000, 10_000
# Charged in the ranking for each edge of the loops, which takes symbols to close in the end.
BITS_PER_OPEN_EDGE = 0.02
# Of words whose upper loops are alike only the best is kept.
N_COMPARED_LOOPS = 3
# What each symbol adds to the number of edges of all loops.
NEW_EDGES = (-1, 1, 1, -1, 3)
# Shares of a model of one context, to build a mesh with: nearly equal, 2^16 in all.
EQUAL_SHARES = np.array([13108, 13107, 13107, 13107, 13107], np.uint32)


@dataclass(frozen=True)
class CostlyWord:
    """A reverse word of a closed mesh of genus 0, up to its last triangle, which has no symbol."""

    symbols: str
    bits: float

    @property
    def n_vertices(self) -> int:
        """Of the mesh."""
        return self.symbols.count("C") + 3

    def limit(self, found: Certificate) -> float:
        """What the certificate grants the word, in bits."""
        n_c = self.symbols.count("C")
        price = found.bits_per_c * n_c + found.bits_per_other * (len(self.symbols) - n_c)
        return price + found.bits_per_component + found.bits_per_word

    def faces(self) -> npt.NDArray[np.int32]:
        """(2 n_vertices - 4, 3) the faces of the mesh, in the order that encodes to this word."""
        symbols = np.array([SYMBOLS.index(letter) for letter in reversed(self.symbols)], np.uint8)
        any_model = _kernels.automaton(EQUAL_SHARES, np.zeros(len(SYMBOLS), np.uint16))
        none = np.zeros(0, np.int64)
        data = _kernels.encode_symbols(symbols, none, any_model)
        decoded = _kernels.decode_connectivity(data, len(symbols), 1, 0, none, any_model)
        return decoded[2].reshape(-1, 3)


@dataclass(frozen=True)
class _Word:
    """A word so far: its last symbol and the word before, its stack with the top last, the number
    of edges of all loops, its cost, and by how much that lags behind the certificate."""

    symbol: int
    before: _Word | None
    stack: tuple[Loop, ...]
    n_edges: int
    bits: float
    lost: float

    @property
    def rank(self) -> float:
        return self.lost + BITS_PER_OPEN_EDGE * self.n_edges

    @property
    def kind(self) -> tuple[tuple[Loop, ...], int]:
        return self.stack[-N_COMPARED_LOOPS:], self.n_edges

    def text(self) -> str:
        letters, word = [], self
        while word.before:
            letters.append(SYMBOLS[word.symbol])
            word = word.before
        return "".join(reversed(letters))


def costly_word(table: StackTable, n_vertices: int, width: int = 30) -> CostlyWord:
    """The costliest word found for a mesh with about n_vertices, by a beam of `width` words.

    Raises OptionError where a number is out of range, or where the table has no certificate.
    """
    if not (MIN_VERTICES <= n_vertices <= MAX_VERTICES and 1 <= width <= MAX_WIDTH):
        raise OptionError(
            f"adversary: {n_vertices} vertices, width {width}: need {MIN_VERTICES} to "
            f"{MAX_VERTICES} vertices and a width of 1 to {MAX_WIDTH}"
        )
    search = _Search(table)
    beam = [search.start()]
    for _ in range(2 * n_vertices - 6):
        beam = search.grown(beam, width)
    ended = min((search.ended(word) for word in beam), key=lambda word: word.lost)
    return CostlyWord(ended.text(), ended.bits)


def stack_table(table: AnyTable) -> StackTable:
    """The table itself; raises OptionError for an automaton, for which there is nothing to find."""
    if isinstance(table, StackTable):
        return table
    raise OptionError(f"model {table.name!r}: an automaton, whose words all cost what is certified")


class _Search:
    def __init__(self, table: StackTable) -> None:
        proof = prove(table)
        self._table, self._kinds = table, proof.kinds
        self._bits = (FREQUENCY_BITS - np.log2(np.maximum(table.frequencies, 1))).tolist()
        self._price = [price / UNIT for price in proof.price]
        self._phi = (proof.phi / UNIT).tolist()

    def start(self) -> _Word:
        """The word of one triangle."""
        nothing = _Word(E, None, tuple(self._table.start()), 0, 0.0, 0.0)
        return self._with(nothing, E)

    def grown(self, beam: list[_Word], width: int) -> list[_Word]:
        """The best of the words with one more symbol."""
        best: dict[tuple[tuple[Loop, ...], int], _Word] = {}
        for word in beam:
            for symbol in self._allowed(word):
                new = self._with(word, symbol)
                known = best.get(new.kind)
                if known is None or new.lost < known.lost:
                    best[new.kind] = new
        return sorted(best.values(), key=lambda word: word.rank)[:width]

    def ended(self, word: _Word) -> _Word:
        """Joins all loops, and closes what is left down to a triangle."""
        while S in self._allowed(word):
            word = self._with(word, S)
        while word.n_edges > SHORTEST:
            word = self._with(word, C if C in self._allowed(word) else R)
        return word

    def _allowed(self, word: _Word) -> list[int]:
        length, conflict, _ = word.stack[-1]
        closes = [C] if length > SHORTEST and conflict != 1 else []
        joins = [S] if len(word.stack) > 2 else []  # the lowest loop is virtual
        return [*closes, L, R, *joins, E]

    def _with(self, word: _Word, symbol: int) -> _Word:
        stack = list(word.stack)
        self._table.apply(stack, symbol)
        bits = self._bits[self._table.row(word.stack[-1])][symbol]
        # Loops below the upper two keep their potential.
        fall = self._upper(word.stack, 1 + (symbol == S)) - self._upper(stack, 1 + (symbol == E))
        lost = word.lost + self._price[symbol] + fall - bits
        n_edges = word.n_edges + NEW_EDGES[symbol]
        return _Word(symbol, word, tuple(stack), n_edges, word.bits + bits, lost)

    def _upper(self, stack: list[Loop] | tuple[Loop, ...], n_loops: int) -> float:
        """The potential of the top loop, and of the one under it where n_loops is 2."""
        potential: float = self._phi[self._kinds.top(*stack[-1])]
        if n_loops == 2:
            length, _, below = stack[-2]
            potential += self._phi[self._kinds.under(length, below)]
        return potential
