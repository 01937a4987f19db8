"""Decisions about attributes once more, by sections 9.2 and 12.4 of FORMAT.md."""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np

from tests.oracles.floats import F

TABLES = Path(__file__).parents[2] / "docs" / "format-tables.md"
WORD = 2**64
N = 8
UNSEEN = (2**21, 0)


class Coder(Protocol):
    def bit(self, bit: bool, p1: int) -> bool: ...

    def raw(self, value: int, n_bits: int) -> int: ...


def clamp(x: np.float32, low: float, high: float) -> np.float32:
    return F(max(min(x, F(high)), F(low)))


def exp2(x: np.float32) -> np.float32:
    k = int(x + F(128)) - 128
    t = x - F(k)
    return F(2.0**k) * (F(1) + t * (F(0.6565) + F(0.3435) * t))


def log2(x: np.float32) -> np.float32:
    mantissa, exponent = np.frexp(x)
    t = mantissa * F(2) - F(1)
    return F(exponent - 1) + t * (F(1.343) - F(0.343) * t)


def squash(x: np.float32) -> np.float32:
    return F(1) / (F(1) + exp2(-x))


def logit(p: np.float32) -> np.float32:
    return log2(p) - log2(F(1) - p)


def key(a: int, b: int) -> int:
    x = (a + 0x9E3779B97F4A7C15) * 0xBF58476D1CE4E5B9 % WORD
    x ^= (b + 0xD6E8FEB86659FD93) * 0x94D049BB133111EB % WORD
    x ^= x >> 31
    return x * 0x9E3779B97F4A7C15 % WORD >> 32


def learnt(counter: tuple[int, int], bit: bool, start: int, *, alone: bool) -> tuple[int, int]:
    p, n = counter
    old = F(start if n == 0 else p)
    off = (F(4194303) if bit else F(0)) - old
    count = F(n) + F(1.6)
    new = old + (off * (F(1) / count) if alone else off / count)
    return int(new), min(n + 1, 90)


def opinion(counter: tuple[int, int]) -> np.float32:
    p, n = F(counter[0]), F(counter[1])
    one = p + F(0.5)
    other = F(4194304.5) - one
    ratio = F(int(one.view(np.int32)) - int(other.view(np.int32))) * F(2.0**-23)
    return ratio * (n / (n + F(1.5)))


class Decisions:
    """n_values: of all; table: the name of the weights; beyond: the row of a node that has none."""

    def __init__(
        self, coder: Coder, n_values: int, table: str, beyond: Callable[[int], int]
    ) -> None:
        self.coder = coder
        self.b = min(max(n_values.bit_length(), 9), 14)
        rows = weights(table)
        of_node = [rows[node if node < len(rows) else beyond(node)] for node in range(32)]
        self.a = [np.pad(row, (0, 7)) for row in of_node]
        self.by_level: dict[tuple[int, int, int], np.ndarray] = {}
        self.curves: dict[tuple[int, int], list[np.float32]] = {}
        self.lines: list[dict[int, tuple[int, dict[int, tuple[int, int]]]]] = [{} for _ in range(N)]
        self.agreement: dict[tuple[int, int, int], tuple[int, int]] = {}
        self.hits: dict[tuple[int, int], tuple[int, int]] = {}
        self.n_decisions = F(0)

    def enter(self, hashes: Sequence[int]) -> None:
        self.line = []
        for lines, tag in zip(self.lines, hashes, strict=True):
            at = tag >> (32 - self.b)
            if lines.get(at, (0, None))[0] != tag or at not in lines:
                lines[at] = tag, {}
            self.line.append(lines[at][1])

    def consider(self, candidates: Iterable[int], contexts: Sequence[int]) -> None:
        self.offered, self.contexts = set(candidates), contexts
        told = {i: self.hits.get((i, contexts[i]), UNSEEN)[0] >> 6 for i in self.offered}
        self.alive = {i for i in self.offered if told[i] >= 1024}

    def settle(self, right: set[int]) -> None:
        for i in self.offered:
            at = i, self.contexts[i]
            self.hits[at] = learnt(self.hits.get(at, UNSEEN), i in right, 1048576, alone=True)

    def code(
        self,
        bit: bool,
        node: int,
        slot: int | None,
        turn: int,
        level: int,
        upper: set[int],
        odds: Sequence[np.float32] = (F(0),) * N,
    ) -> bool:
        """Those of the candidates that do not tell the bit are alive no more."""
        x = np.zeros(32, F)
        counters = [line.get(slot, UNSEEN) for line in self.line] if slot is not None else []
        x[: len(counters)] = [opinion(c) for c in counters]
        x[8:16] = odds
        for i in self.alive:
            p, n = self.agreement.get((i, self.contexts[i], node), UNSEEN)
            told = logit((F(p >> 10) + F(0.5)) / F(4096)) if n else F(0)
            x[16 + i] = told if i in upper else -told
        x[24] = 0.4
        place = node, min(turn, 2)
        b = self.by_level.setdefault((*place, level), np.zeros(32, F))
        weighted = (self.a[node] + b) * x
        t = np.zeros(N, F)
        for i in range(4):
            t = t + weighted[8 * i : 8 * i + 8]
        total = ((t[0] + t[4]) + (t[1] + t[5])) + ((t[2] + t[6]) + (t[3] + t[7]))
        m = clamp(total, -16, 16)
        p = squash(m)
        curve = self.curves.setdefault(place, [squash((F(j) - F(16)) * F(0.75)) for j in range(33)])
        at = clamp(m, -11.9, 11.9) * (F(1) / F(0.75)) + F(16)
        j = int(at)
        f = at - F(j)
        refined = curve[j] + (curve[j + 1] - curve[j]) * f
        z = min(max(int((p + F(0.5) * (refined - p)) * F(65536)), 1), 65535)
        bit = self.coder.bit(bit, z)
        target = F(bit)
        self.n_decisions += F(1)
        rate = F(0.0005) * (F(1) + F(5) / (F(1) + self.n_decisions * (F(1) / F(4000))))
        step = (target - p) * rate * x
        self.a[node] = self.a[node] + step
        b += step
        curve[j] += (target - curve[j]) * F(0.02) * (F(1) - f)
        curve[j + 1] += (target - curve[j + 1]) * F(0.02) * f
        for line, counter in zip(self.line, counters, strict=False):
            line[slot or 0] = learnt(counter, bit, 64 * z, alone=False)
        for i in self.alive:
            place_of = i, self.contexts[i], node
            told_it = bit == (i in upper)
            before = self.agreement.get(place_of, UNSEEN)
            self.agreement[place_of] = learnt(before, told_it, 3145728, alone=True)
        self.alive = self.alive & upper if bit else self.alive - upper
        return bit


def weights(table: str) -> list[np.ndarray]:
    """The rows of docs/format-tables.md."""
    section = TABLES.read_text("utf-8").split(f"`{table}`")[1].split("\n## ")[0]
    rows = [line.split() for line in section.splitlines() if line.startswith("    ")]
    return [np.array([float(x) for x in row], F) for row in rows]
