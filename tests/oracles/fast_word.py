"""Words of direct and fast without special S once more, by section 5a of FORMAT.md."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.oracles.floats import F
from tests.oracles.streams import Row, Streams
from tests.oracles.text import squash

TABLES = Path(__file__).parents[2] / "docs" / "format-tables.md"
C, L, R, S, E = range(5)
WORD, LONG = 2**32, 2**64
MOST = 15
BOUNDS, BOUNDS_OF_MATCH = (2, 4, 12, 30, 80, 255), (15, 20, 24, 31, 100, 400)
RATE, LEAST = F(0.04), F(0.00005)


class OneState(Streams):
    """A stream of one state, without plain bits."""

    def __init__(self, data: bytes) -> None:
        self.words, self.at = data, 7
        self.states = [int.from_bytes(data[:7], "little")]


@dataclass
class Edge:
    """Of a loop: what is known of the vertex where it starts."""

    degree: int = 2
    excess: int = 8

    def add(self, degree: int, excess: int = 0) -> None:
        self.degree = min(self.degree + degree, MOST)
        self.excess = min(max(self.excess + excess, 0), 15)


class Loops:
    """A stack of loops, each from its gate on."""

    def __init__(self) -> None:
        self.stack: list[list[Edge]] = []

    def apply(self, symbol: int) -> None:
        if symbol == E:
            self.stack.append([Edge(), Edge(), Edge()])
            return
        gate, *rest = self.stack.pop()
        if symbol in (L, R):
            gate.add(1)
        rest[0].add(1, gate.degree - 6 if symbol == C else 0)
        match symbol:
            case 1:
                loop = [Edge(), *rest, gate]
            case 2:
                loop = [gate, Edge(), *rest]
            case 0:
                rest[-1].add(1, gate.degree - 6)
                loop = [rest[-1], *rest[:-1]]
            case _:
                met, beyond, *others = self.stack.pop()
                met.add(1)
                beyond.add(gate.degree, gate.excess - 8)
                loop = [met, *rest, beyond, *others]
        self.stack.append(loop)


class Match:
    """Far; symbols: from the first coded on."""

    def __init__(self, n_symbols: int) -> None:
        self.shift = 64 - min(max(n_symbols.bit_length(), 8), 14)
        self.places: dict[int, tuple[int, int]] = {}
        self.length, self.at = 0, 0
        self.predicted, self.confidence = 5, 0

    def advance(self, symbols: Sequence[int]) -> None:
        if self.length > 0 and symbols[self.at] == symbols[-1]:
            self.length, self.at = min(self.length + 1, 512), self.at + 1
        else:
            self.length = 0
        mixed = latest(symbols, 20) * 0x9E3779B97F4A7C15 % LONG
        place, check = mixed >> self.shift, (mixed >> (self.shift - 32)) % WORD
        known, after = self.places.get(place, (None, 0))
        if self.length == 0 and known == check:
            self.length, self.at = alike(symbols, after), after
        self.places[place] = check, len(symbols)
        self.predicted = symbols[self.at] if self.length else 5
        passed = 1 + sum(self.length > bound for bound in BOUNDS_OF_MATCH)
        self.confidence = passed if self.length else 0


def alike(symbols: Sequence[int], after: int) -> int:
    """Symbols before that place that are the latest ones, 0 if fewer than 20."""
    n = 0
    while n < min(32, after) and symbols[after - 1 - n] == symbols[-1 - n]:
        n += 1
    return n if n >= 20 else 0


class Mixed:
    """The rows of fast."""

    def __init__(self, n_symbols: int) -> None:
        self.first: dict[int, list[int]] = {}
        self.rows: dict[tuple[int, int], tuple[int, list[int]]] = {}
        self.shift = 32 - min(max(n_symbols.bit_length() - 2, 8), 13)
        self.weights: dict[int, list[np.float32]] = {}
        self.match = Match(n_symbols)

    def decode(
        self, stream: Streams, loop: Sequence[Edge], symbols: Sequence[int], closed: int
    ) -> int:
        gate, l0 = loop[0], loop[0].degree
        first = self.first.setdefault(
            l0 << 6 | latest(symbols, 2), [4, *begin(l0, latest(symbols, 2))[1:5]]
        )
        _, matched = self._row(
            2, (self.match.predicted * 8 + self.match.confidence) * 16 + l0, 0, first
        )
        hashes = [
            hashed(0, latest(symbols, 8), pack(closed % 16**3, l0)),
            hashed(1, pack(l0, loop[-1].degree, gate.excess, loop[1].degree), closed % 16**2),
        ]
        known, rows = self.match.confidence, [first, matched]
        for i, h in enumerate(hashes):
            is_known, row = self._row(i, h >> self.shift, h % 2**16 | 1, first)
            known = 2 * known + is_known
            rows.append(row)
        weights = self.weights.setdefault(known, [F(0.25)] * 4)
        shares = [int(w * F(65530)) for w in weights]
        starts = [
            sum(row[k] * w >> 16 for row, w in zip(rows, shares, strict=True)) for k in range(1, 5)
        ]
        symbol = stream.mixed(0, [0, *starts, 2**15])
        bounds = [[0, *row[1:], 2**15] for row in rows]
        self.weights[known] = learnt(weights, [F(x[symbol + 1] - x[symbol]) for x in bounds])
        for row in rows:
            learn(row, symbol)
        return symbol

    def _row(self, table: int, place: int, check: int, first: list[int]) -> tuple[bool, list[int]]:
        was, row = self.rows.get((table, place), (None, []))
        if was == check:
            return True, row
        self.rows[table, place] = check, [0, *first[1:]]
        return False, self.rows[table, place][1]


def learn(row: list[int], symbol: int) -> None:
    """row: the count, then four starts."""
    rate = 1 + sum(row[0] >= bound for bound in BOUNDS)
    row[0] = min(row[0] + 1, 255)
    for k in range(1, 5):
        row[k] += (8 * k + (32728 if k > symbol else 0) - row[k]) >> rate


def learnt(weights: Sequence[np.float32], frequencies: Sequence[np.float32]) -> list[np.float32]:
    s = [w * f for w, f in zip(weights, frequencies, strict=True)]
    gain, kept = RATE / ((s[0] + s[1]) + (s[2] + s[3])), F(1) - (RATE + F(4) * LEAST)
    return [(w * kept + x * gain) + LEAST for w, x in zip(weights, s, strict=True)]


def latest(symbols: Sequence[int], n: int) -> int:
    found = 0
    for symbol in symbols[-n:]:
        found = found << 3 | (symbol + 1)
    return found


def pack(first: int, *others: int) -> int:
    for other in others:
        first = first << 4 | other
    return first % WORD


def hashed(number: int, a: int, b: int) -> int:
    key = (b << 32 | a) + 0xC2B2AE3D27D4EB4F + number
    return key * 0x9E3779B97F4A7C15 % LONG >> 32


def begin(degree: int, two: int) -> list[int]:
    """What a row starts from."""
    left, shares = 2**16, [0] * 5
    for decision, symbol in enumerate((C, R, L, S)):
        prior = PRIOR.get((decision, degree), [0] * 64)[two]
        shares[symbol] = left * squash(16 * prior) >> 16
        left -= shares[symbol]
    shares[E] = left
    return [8 * i + (32704 * sum(shares[:i]) >> 16) for i in range(9)]


def _prior() -> dict[tuple[int, int], list[int]]:
    section = TABLES.read_text("utf-8").split("\n## ")[1]
    rows = [line.split(":") for line in section.splitlines() if line.startswith("    ")]
    keys = [tuple(int(x) for x in key.split()) for key, _ in rows]
    return {
        (key[0], key[1]): [int(x) for x in values.split()]
        for key, (_, values) in zip(keys, rows, strict=True)
    }


PRIOR = _prior()


def decode(data: bytes, n_symbols: int, n_single: int, *, fast: bool) -> list[int]:
    """The symbols, the last of the word first."""
    stream, loops = OneState(data), Loops()
    symbols = [E] * min(max(n_single, 1), n_symbols)
    mixed, direct, closed = Mixed(n_symbols), {}, 0x66666666
    for n in range(len(symbols)):
        loops.apply(E)
        mixed.match.advance(symbols[: n + 1])
    while len(symbols) < n_symbols:
        loop = loops.stack[-1]
        gate = loop[0].degree
        if fast:
            symbol = mixed.decode(stream, loop, symbols, closed)
        else:
            context = gate, latest(symbols, 2)
            symbol = stream.symbol(0, direct.setdefault(context, Row(begin(*context))))
        symbols.append(symbol)
        if symbol == C:
            closed = (closed << 4 | gate) % WORD
        loops.apply(symbol)
        mixed.match.advance(symbols)
    return symbols
