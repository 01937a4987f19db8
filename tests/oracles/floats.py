"""Functions of floats and of integers with a sign that several oracles share, by section 9."""

import numpy as np

F = np.float32


def signed(x: int, n_bits: int = 32) -> int:
    half = 2 ** (n_bits - 1)
    return (x + half) % (2 * half) - half


def pattern(x: np.float32) -> int:
    return int(x.view(np.int32))


def octaves(x: np.float32) -> int:
    return (pattern(x + F(0.125)) >> 22) - 248


def within(x: np.float32, low: float, high: float) -> np.float32:
    return F(min(max(x, F(low)), F(high)))


def rounded(x: np.float32) -> int:
    return int(x + (F(-0.5) if np.signbit(x) else F(0.5)))
