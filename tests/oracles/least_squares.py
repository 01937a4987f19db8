"""Least squares once more, by sections 9.3, 9.5 and 12.3 of FORMAT.md."""

from collections.abc import Sequence

import numpy as np

from tests.oracles.floats import F

D = 3
RIDGE = 50.0
FORGET = F(1) - F(32) / F(2000)
WIDEST = 10000.0


class Fit:
    """Of three inputs; sums are kept for each of three axes."""

    def __init__(self, prior: Sequence[float]) -> None:
        self.prior = [float(F(w)) for w in prior]
        self.weights = [F(w) for w in prior]
        self.a = np.zeros((D, D, 3), F)
        self.b = np.zeros((D, 3), F)
        self.n, self.due = 0, 1

    def output(self, x: Sequence[np.float32]) -> np.float32:
        w = self.weights
        return (w[0] * x[0] + w[1] * x[1]) + w[2] * x[2]

    def add(self, axis: int, x: Sequence[np.float32], y: np.float32, weight: np.float32) -> None:
        for i in range(D):
            z = weight * x[i]
            for j in range(i + 1):
                self.a[i, j, axis] += z * x[j]
            self.b[i, axis] += z * y

    def tick(self) -> None:
        self.n += 1
        if self.n < self.due:
            return
        self._solve()
        self.due = self.n + (1 if self.n < 4 else self.n // 4 if self.n < 128 else 32)
        if self.n >= 128:
            self.a *= FORGET
            self.b *= FORGET

    def _solve(self) -> None:
        w = solved(over_axes(self.a), over_axes(self.b), self.prior, RIDGE)
        self.weights = [F(min(max(x, -WIDEST), WIDEST)) for x in w]


def solved(a: np.ndarray, b: np.ndarray, prior: Sequence[float], ridge: float) -> np.ndarray:
    """The weights near the prior; a: the lower half of the sums, of any number of inputs."""
    n = len(b)
    lower, d, w = np.eye(n), np.zeros(n), np.zeros(n)
    for i in range(n):
        w[i] = b[i] + ridge * prior[i]
        for j in range(i + 1):
            s = a[i, j] + (ridge if i == j else 0)
            for k in range(j):
                s -= lower[i, k] * lower[j, k] * d[k]
            if i == j:
                d[i] = s if s > 0.5 * ridge else 0.5 * ridge
            else:
                lower[i, j] = s / d[j]
        for k in range(i):
            w[i] -= lower[i, k] * w[k]
    w /= d
    for i in reversed(range(n)):
        for k in range(i + 1, n):
            w[i] -= lower[k, i] * w[k]
    return w


def over_axes(sums: np.ndarray) -> np.ndarray:
    of = sums.astype(np.float64)
    return (of[..., 0] + of[..., 1]) + of[..., 2]
