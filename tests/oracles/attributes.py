"""Rows of integers once more, by sections 12.3 and 12.4 of FORMAT.md: both ways in one."""

from collections.abc import Sequence

import numpy as np

from tests.oracles.decisions import WORD, Coder, Decisions, key
from tests.oracles.differences import Tree
from tests.oracles.floats import F, signed
from tests.oracles.least_squares import solved
from tests.oracles.recall import Table

Rows = list[list[int]]
N = 8
FITTED, PARALLELOGRAM, AVERAGE, NEAR, SECOND, GUESS, IMPLIED, LAST = range(N)
N_FEATURES = 11  # the three of places are 0


class Fit:
    def __init__(self) -> None:
        self.prior = np.array([0.6, 0, 0, 0.5, 0.5] + [0.0] * 6)
        self.w = self.prior.copy()
        self.a, self.b = np.zeros((N_FEATURES, N_FEATURES)), np.zeros(N_FEATURES)
        self.n, self.due = 0, 1

    def output(self, x: Sequence[float]) -> float:
        total = 0.0
        for w, y in zip(self.w, x, strict=True):
            total += float(w) * y
        return total

    def learn(self, x: Sequence[float], y: float, weight: float) -> None:
        for i in range(N_FEATURES):
            z = weight * x[i]
            self.a[i, : i + 1] += z * np.array(x[: i + 1])
            self.b[i] += z * y
        self.n += 1
        if self.n < self.due:
            return
        self.w = solved(self.a, self.b, self.prior, 3.0)
        self.due = self.n + (1 if self.n < 4 else self.n // 4 if self.n < 128 else 32)
        if self.n >= 128:
            self.a *= 1.0 - 32.0 / 3000
            self.b *= 1.0 - 32.0 / 3000


class Turn:
    def __init__(self) -> None:
        self.fit = Fit()
        self.error, self.n, self.history, self.last = [0.0] * N, [0] * N, [0] * N, 0


def size(x: float) -> int:
    return int(min(max(x, 0.0), 1e15)).bit_length()


def kind(x: int) -> int:
    n = abs(x).bit_length()
    return x + 8 if n < 3 else 100 - n if x < 0 else 100 + n


class Numbers:
    """Rows without relations between components."""

    def __init__(self, coder: Coder, rows: Rows) -> None:
        self.coder, self.rows, self.width = coder, rows, len(rows[0])
        n_values = len(rows) * self.width
        self.decisions = Decisions(coder, n_values, "weights_of_numbers", lambda n: 20 + n % 4)
        self.turns = [Turn() for _ in range(min(self.width, 64))]
        self.sizes = [[F(0)] * self.width for _ in rows]
        self.recall = Table(14)

    def run(self) -> None:
        for r in range(len(self.rows)):
            self.hits: set[int] = set()
            self.told: list[tuple[float, float, int]] = []  # deviation, steepness, difference
            for turn in range(self.width):
                self._value(r, turn)

    def _value(self, r: int, turn: int) -> None:
        t, rows = self.turns[min(turn, 63)], self.rows
        around = [rows[r - 1 - k][turn] for k in range(min(r, 3))]
        mean = sum(map(float, around)) / len(around) if around else 0.0
        sign, recalled = self._recalled(r, turn, around)
        x = self._candidates(r, turn, around, mean)
        integers = {k: int(np.floor(v + 0.5)) for k, v in x.items()}
        if recalled:
            value = signed(recalled[0])
            integers[LAST] = value if sign > 0 else -value
            x[LAST] = float(integers[LAST])
        features = [x[k] - mean if k in x else 0.0 for k in (1, 3, 4, 5, 6)]
        past = self.told[::-1][:3]
        for which in (0, 1):
            features += [told[which] for told in past] + [0.0] * (3 - len(past))
        x[FITTED] = mean + t.fit.output(features)
        integers[FITTED] = int(np.floor(x[FITTED] + 0.5))
        typical = t.error[FITTED] if t.n[FITTED] else 1.0
        local = typical
        if around:
            sizes = sum(float(self.sizes[r - 1 - k][turn]) for k in range(len(around)))
            local = (sizes + typical) / (len(around) + 1)
        ratio = [t.error[k] / max(typical, 1e-300) if t.n[k] else 1.0 for k in range(N)]
        scale = {k: local * min(ratio[k], 1e6) for k in x}
        best = FITTED
        for k in range(N):
            if k in x and scale[k] < 0.8 * scale[best]:
                best = k
        base = integers[best]
        contexts = self._contexts(t, turn, integers, base, scale[best], len(around), r)
        self.decisions.enter(contexts)
        value_contexts = [
            8 * (0 if turn == 0 else 1 + (k in self.hits)) + t.history[k] for k in range(N)
        ]
        if recalled:
            value_contexts[LAST] = 23 + min(recalled[1], 8)
        self.decisions.consider(x, value_contexts)
        offsets = {k: i - base for k, i in integers.items()}
        means = {k: F(min(max(v - base, -1e18), 1e18)) for k, v in x.items()}
        scales = {k: F(min(max(0.6 * s, 0.08), 1e18)) for k, s in scale.items()}
        level = min(size(scale[best] * 2), 11)
        tree = Tree(self.decisions, offsets, means, scales, min(size(scale[best]), 56), level, turn)
        difference = tree.code(rows[r][turn] - base)
        value = rows[r][turn] = base + difference
        self.decisions.settle({k for k, o in offsets.items() if o == difference})
        t.fit.learn(features, value - mean, 1 / (local * local + 1e-4 + 1e-300))
        for k, v in x.items():
            t.n[k] = min(t.n[k] + 1, 40)
            t.error[k] += (abs(value - v) - t.error[k]) * (1.0 / t.n[k])
        self.hits = {k for k, i in integers.items() if i == value}
        t.history = [(2 * h + (k in self.hits)) % 8 for k, h in enumerate(t.history)]
        self.told.append((value - mean, x.get(PARALLELOGRAM, mean) - mean, difference))
        self.sizes[r][turn] = F(abs(difference))
        t.last = difference
        self.recall.learn(self.recall_key, value * sign)

    def _recalled(self, r: int, turn: int, around: list[int]) -> tuple[int, tuple[int, int] | None]:
        a, b = [*around, 0, 0][:2]
        sign = -1 if a < 0 else 1
        other = self.rows[r][turn - 1] if turn else sign * b
        self.recall_key = key(key(turn, sign * a % WORD), other % WORD)
        return sign, self.recall.find(self.recall_key)

    def _candidates(self, r: int, turn: int, around: list[int], mean: float) -> dict[int, float]:
        x: dict[int, float] = {}
        if r >= 2:
            x[PARALLELOGRAM] = float(around[0]) + float(around[0]) - float(around[1])
        if len(around) > 1:
            x[AVERAGE], x[SECOND] = mean, float(around[1])
        if around:
            x[NEAR] = float(around[0])
        if turn:
            x[GUESS] = float(self.rows[r][turn - 1])
        elif r:
            x[GUESS] = float(self.rows[r - 1][-1])
        return dict(sorted(x.items()))

    def _contexts(
        self,
        t: Turn,
        turn: int,
        integers: dict[int, int],
        base: int,
        q: float,
        n: int,
        r: int,
    ) -> list[int]:
        def off(k: int) -> int:
            return integers[k] - base if k in integers else 2**63 - 1

        e1, e2 = ([told[2] for told in self.told[::-1]] + [0, 0])[:2]
        c = [kind(off(k)) for k in range(N)]
        pairs = [
            (min(size(8 * q), 60), 0),
            (kind(e1), kind(e2)),
            (c[NEAR], c[PARALLELOGRAM] << 8 | c[IMPLIED]),
            (0, off(NEAR) * 31 + off(GUESS)),
            (kind(e1), base),
            (0, int(r >= 2)),
            (c[GUESS], c[AVERAGE] << 8 | kind(e1)),
            (kind(t.last), n),
        ]
        head = min(turn, 255) << 8 | min(size(q), 56)
        return [key(i << 60 | head << 44 | a, b % WORD) for i, (a, b) in enumerate(pairs)]
