"""The integers of special S: both forms come back, within their bound, from any bytes in bounds."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import CorruptError
from ebz.codec.specials import ADAPTIVE, PLAIN, Int64s, decode_specials, encode_specials


@st.composite
def specials(draw: st.DrawFn) -> tuple[Int64s, int]:
    n_symbols = draw(st.integers(1, 3000))
    places = st.lists(st.integers(0, n_symbols - 1), unique=True, max_size=300)
    positions = np.array(sorted(draw(places)), np.int64)
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    reach = 2 * n_symbols if draw(st.booleans()) else 4
    meets = [int(rng.integers(2 * p + 2, 2 * p + 2 + reach)) for p in positions]
    meets = np.minimum(meets, np.maximum(2 * positions + 2, 2 * n_symbols - 1)).astype(np.int64)
    return np.column_stack([positions, meets]).reshape(-1), n_symbols


@given(specials())
def test_what_goes_in_comes_out(given: tuple[Int64s, int]) -> None:
    values, n_symbols = given
    data = encode_specials(values, n_symbols)
    assert np.array_equal(decode_specials(data, len(values) // 2, n_symbols), values)


@given(specials())
def test_the_size_is_bounded(given: tuple[Int64s, int]) -> None:
    values, n = given
    s = len(values) // 2
    bits = 8 * len(encode_specials(values, n))
    if s:
        assert bits <= s * (2 + math.log2(n / s)) + s * (math.log2(n) + 2) + 15


def test_each_form_is_taken_where_it_is_shorter() -> None:
    positions = np.arange(0, 100_000, 50)
    near = np.column_stack([positions, 2 * positions + 5]).reshape(-1)
    assert encode_specials(near, 100_000).startswith(ADAPTIVE)
    rng = np.random.default_rng(1)
    few = np.sort(rng.choice(100_000, 20, replace=False))
    far = np.column_stack([few, 2 * few + rng.integers(2, 100_000, 20)]).reshape(-1)
    assert encode_specials(far, 200_000).startswith(PLAIN)


def test_no_special_takes_no_byte() -> None:
    assert encode_specials(np.zeros(0, np.int64), 10) == b""
    assert decode_specials(b"", 0, 10).size == 0


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "form  of the integers"),
        (b"\2abc", "form 02"),
        (PLAIN, "0 quotients for 2 special S"),
        (PLAIN + b"\xff" * 100, "quotients for 2 special S"),
        (ADAPTIVE, "do not ascend"),
    ],
)
def test_malformed_integers_are_refused(data: bytes, message: str) -> None:
    with pytest.raises(CorruptError, match=message):
        decode_specials(data, 2, 20)


@given(st.binary(max_size=60), st.integers(1, 50), st.integers(1, 500))
def test_any_bytes_decode_or_are_refused(data: bytes, n_specials: int, n_symbols: int) -> None:
    for form in (ADAPTIVE, PLAIN):
        try:
            values = decode_specials(form + data, n_specials, n_symbols)
        except CorruptError:
            continue
        positions = values[0::2]
        assert len(positions) == n_specials
        assert (np.diff(positions) > 0).all()
        assert positions[0] >= 0 and positions[-1] < n_symbols
