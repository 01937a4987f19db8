"""Spirale Reversi once more, with loops as plain lists of half-edges, gate first.

M. Isenburg and J. Snoeyink, 2000; codec/kernels/word/reverse.cpp is what ebz uses.  A half-edge is
(triangle, side): side 0 is the triangle's gate, 1 its right edge, 2 its left one; triangles go by
the position of their symbol in the word, first triangles of closed components by ("first", i).
"""

from dataclasses import dataclass, field
from typing import Any

from ebz.codec.models.load import AnyTable
from ebz.codec.models.stack import StackTable
from tests.oracles.range_coder import Decoder, Encoder

HalfEdge = tuple[Any, int]
Loop = list[HalfEdge]


class Walk:
    """The row of a table that tells the probabilities of the next symbol."""

    def __init__(self, table: AnyTable) -> None:
        self.table, self.row = table, 0
        if isinstance(table, StackTable):
            self.loops = table.start()
            self.row = table.row(self.loops[-1])

    def frequencies(self) -> list[int]:
        return list(self.table.frequencies[self.row].tolist())

    def advance(self, symbol: int, special: bool) -> None:
        if isinstance(self.table, StackTable):
            self.table.apply(self.loops, symbol, special=special)
            self.row = self.table.row(self.loops[-1])
        else:
            self.row = 0 if special else int(self.table.successors[self.row, symbol])


def encode_word(word: str, special: set[int], table: AnyTable) -> bytes:
    """The word from the last symbol to the first, without its special S at `special`."""
    coder, walk = Encoder(), Walk(table)
    for position in reversed(range(len(word))):
        symbol, frequencies = "CLRSE".index(word[position]), walk.frequencies()
        if position not in special:
            coder.symbol(sum(frequencies[:symbol]), frequencies[symbol], 16)
        walk.advance(symbol, position in special)
    return coder.finish()


def decode_word(data: bytes, n_symbols: int, special: set[int], table: AnyTable) -> str:
    """The word, first symbol first."""
    coder, walk, word = Decoder(data), Walk(table), ""
    for position in reversed(range(n_symbols)):
        frequencies = walk.frequencies()
        starts = [sum(frequencies[:i]) for i in range(6)]
        symbol = "CLRSE".index("S") if position in special else coder.symbol(starts, 16)
        word = "CLRSE"[symbol] + word
        walk.advance(symbol, position in special)
    return word


@dataclass
class Surface:
    """Triangles under construction; `open_loops` are loops that a special S split off."""

    twins: dict[HalfEdge, HalfEdge] = field(default_factory=dict)
    stack: list[Loop] = field(default_factory=list)
    open_loops: list[Loop] = field(default_factory=list)

    def glue(self, a: HalfEdge, b: HalfEdge) -> None:
        assert a not in self.twins, a
        assert b not in self.twins, b
        self.twins[a], self.twins[b] = b, a

    def apply(self, symbol: str, triangle: int, met: HalfEdge | None) -> None:
        gate, right, left = ((triangle, side) for side in range(3))
        if symbol == "E":
            self.stack.append([gate, right, left])
            return
        first, *rest = self.stack.pop()
        self.glue(left if symbol == "R" else right, first)
        match symbol:
            case "R":
                loop = [gate, right, *rest]
            case "L":
                loop = [gate, *rest, left]
            case "C":
                *rest, last = rest
                self.glue(left, last)
                loop = [gate, *rest]
            case _:
                met, *others = [met, *self._after(met, rest)] if met else self.stack.pop()
                self.glue(left, met)
                loop = [gate, *(rest if met not in rest else rest[: rest.index(met)]), *others]
        self.stack.append(loop)

    def _after(self, met: HalfEdge, rest: Loop) -> Loop:
        """What follows the half-edge on another loop; nothing where the loop is split in two."""
        if met in rest:
            self.open_loops.append(rest[rest.index(met) + 1 :])
            return []
        loop = next(loop for loop in self.open_loops if met in loop)
        self.open_loops.remove(loop)
        at = loop.index(met)
        return loop[at + 1 :] + loop[:at]


def opposites(word: str, specials: dict[int, int], n_closed: int, n_single: int) -> list[int]:
    """The opposite of each half-edge in output order, -1 on a boundary."""
    surface, starts = Surface(), []
    for position in reversed(range(len(word))):
        meets = specials.get(position)
        met = None if meets is None else (meets // 2, 1 + meets % 2)
        surface.apply(word[position], position, met)
    components = surface.stack[::-1]  # in the order of the word
    n_open = len(components) - n_closed - n_single
    for i, loop in enumerate(components[n_open : n_open + n_closed]):
        gate, right, left = loop
        surface.glue((("first", i), 0), gate)
        surface.glue((("first", i), 1), left)
        surface.glue((("first", i), 2), right)
        starts.append(gate[0])
    order: list[Any] = []
    for position in range(len(word)):
        if position in starts:
            order.append(("first", starts.index(position)))
        order.append(position)
    index = {triangle: i for i, triangle in enumerate(order)}
    twins = [surface.twins.get((triangle, side)) for triangle in order for side in range(3)]
    return [-1 if twin is None else 3 * index[twin[0]] + twin[1] for twin in twins]


def fans(opposite: list[int]) -> list[int]:
    """The vertex of each corner, numbered by first corner: corners are joined through edges."""

    def neighbours(corner: int) -> list[int]:
        before, across = corner - corner % 3 + (corner + 2) % 3, opposite[corner]
        around = [opposite[before]] if opposite[before] >= 0 else []
        return around + ([across - across % 3 + (across + 1) % 3] if across >= 0 else [])

    vertex: dict[int, int] = {}
    n_vertices = 0
    for corner in range(len(opposite)):
        if corner in vertex:
            continue
        reached = [corner]
        while reached:
            c = reached.pop()
            if c not in vertex:
                vertex[c] = n_vertices
                reached += neighbours(c)
        n_vertices += 1
    return [vertex[corner] for corner in range(len(opposite))]
