"""Rows of attributes as FORMAT.md has them agree with the kernels, byte by byte."""

import numpy as np
import pytest

from ebz.codec import _kernels
from tests.oracles.attributes import Numbers
from tests.oracles.labels import code_symbols
from tests.oracles.range_coder import Decoder, Encoder

NONE = np.zeros(0, np.int32)


def encoded(values: np.ndarray, method: int) -> bytes:
    n, width = values.shape
    known = {"opposite": NONE, "item": NONE, "offsets": NONE, "n": n, "n_components": width}
    known |= {"points": np.zeros(0), "site": NONE, "guess": np.zeros(0), "method": method}
    known |= {"space": 0, "relation": 0, "total": 0.0, "heights": False, "by_area": False}
    return _kernels.encode_attribute(**known, values=values.reshape(-1).astype(np.int64))


def walk(n: int, width: int, step: int) -> np.ndarray:
    steps = np.random.default_rng(n + width).integers(-step, step + 1, (n, width))
    return np.cumsum(steps, axis=0)


def repeating(n: int, width: int) -> np.ndarray:
    rng = np.random.default_rng(width)
    return rng.choice([-70000, -3, 0, 5, 900], (n // 4, width)).repeat(4, axis=0)


NUMBERS = {
    "few": walk(3, 1, 5),
    "smooth": walk(150, 3, 2),
    "steep": walk(100, 2, 10**6),
    "repeating": repeating(120, 2),
    "constant": np.full((60, 1), -9),
    "random": np.random.default_rng(1).integers(-(2**40), 2**40, (40, 2)),
}
SYMBOLS = {
    "bits": np.random.default_rng(2).integers(0, 2, (80, 1)),
    "runs": np.random.default_rng(3).integers(0, 900, (30, 2)).repeat(3, axis=0),
    "wide": np.random.default_rng(4).integers(0, 2**16, (40, 3)),
    "zeros": np.zeros((30, 1), np.int64),
}


@pytest.mark.parametrize("values", NUMBERS.values(), ids=NUMBERS.keys())
def test_numbers_are_coded_alike(values):
    encoder, rows = Encoder(), values.tolist()
    Numbers(encoder, rows).run()
    data = encoder.finish()
    assert encoded(values, 0) == data
    blank = [[0] * values.shape[1] for _ in values]
    Numbers(Decoder(data), blank).run()
    assert blank == values.tolist()


@pytest.mark.parametrize("values", SYMBOLS.values(), ids=SYMBOLS.keys())
def test_symbols_are_coded_alike(values):
    encoder = Encoder()
    code_symbols(encoder, values.tolist())
    data = encoder.finish()
    assert encoded(values, 1) == data
    blank = [[0] * values.shape[1] for _ in values]
    code_symbols(Decoder(data), blank)
    assert blank == values.tolist()
