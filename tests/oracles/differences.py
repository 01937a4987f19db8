"""Differences as decisions once more, by section 12.4 of FORMAT.md."""

import numpy as np

from tests.oracles.decisions import Decisions, clamp, log2, squash
from tests.oracles.floats import F

N = 8


class Tree:
    """A difference as decisions."""

    def __init__(
        self,
        decisions: Decisions,
        offsets: dict[int, int],
        means: dict[int, np.float32],
        scales: dict[int, np.float32],
        expected: int,
        level: int,
        turn: int,
    ) -> None:
        self.decisions, self.expected, self.level, self.turn = decisions, expected, level, turn
        self.offsets, self.means = offsets, means
        self.sharpness = {k: F(1.442695) / s for k, s in scales.items()}
        self.high = dict.fromkeys(offsets, F(0))
        self.low = dict.fromkeys(offsets, F(1))

    def code(self, e: int) -> int:
        self.negative = True
        if not self._split(0, 0, 0, -1 - e):
            self.negative = False
            self.high = dict.fromkeys(self.offsets, F(0))
            self.low = self._tails(0)
        a = -1 - e if self.negative else e
        k = self._class(a)
        a = k if k < 2 else self._digits(k - 1, a)
        return -1 - a if self.negative else a

    def _tails(self, at: int) -> dict[int, np.float32]:
        edge = F(at) - F(0.5)
        mean = {k: F(-1) - m if self.negative else m for k, m in self.means.items()}
        return {k: squash(clamp((m - edge) * self.sharpness[k], -80, 80)) for k, m in mean.items()}

    def _split(self, at: int, node: int, slot: int | None, a: int) -> bool:
        tails, odds = self._tails(at), [F(0)] * N
        for k, tail in tails.items():
            above = max(tail - self.high[k], F(1e-30))
            below = max(self.low[k] - tail, F(1e-30))
            odds[k] = clamp(log2(above) - log2(below), -11, 11)
        value = {k: -1 - o if self.negative else o for k, o in self.offsets.items()}
        upper = {k for k in self.decisions.alive if value[k] >= at}
        yes = self.decisions.code(a >= at, node, slot, self.turn, self.level, upper, odds)
        if yes:
            self.low = tails
        else:
            self.high = tails
        return yes

    def _class(self, a: int) -> int:
        def above(k: int) -> bool:
            j = min(max(k - self.expected + 3, 0), 6)
            return self._split(2**k, 1 + j, 1 + j + 7 * self.negative, a)

        k = self.expected
        if above(k):
            k += 1
            while k < 63 and above(k):
                k += 1
            return k
        while k > 0 and not above(k - 1):
            k -= 1
        return k

    def _digits(self, n: int, a: int) -> int:
        low, q, first = 2**n, min(max(n - 1 - self.expected + 3, 0), 3), False
        for i in range(n):
            left = n - i
            if i >= 3 and not self.decisions.alive:
                while left:
                    n_raw = min(left, 16)
                    left -= n_raw
                    low += self.decisions.coder.raw(a >> left & (2**n_raw - 1), n_raw) << left
                return low
            slots = (15 + 2 * q + self.negative, 23 + 2 * q + first)
            slot = slots[i] if i < 2 else None
            yes = self._split(low + 2 ** (left - 1), 8 + 4 * min(i, 5) + q, slot, a)
            first = yes if i == 0 else first
            low += yes * 2 ** (left - 1)
        return low
