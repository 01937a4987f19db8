"""Numbers in text: correctly rounded, shortest, and of the dtype that the text calls for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import DroppedWarning
from ebz.formats.numbers import (
    format_numbers,
    narrowed,
    parse_floats,
    parse_integers,
    rendered,
    rounded,
    shortest_as_float64,
)


def any_float32(n: int, seed: int) -> np.ndarray:
    bits = np.random.default_rng(seed).integers(0, 2**32, n, np.uint32)
    values = bits.view(np.float32)
    return values[np.isfinite(values)]


def everyday_float32(n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return (rng.standard_normal(n) * 10.0 ** rng.integers(-8, 8, n)).astype(np.float32)


def awkward_float32() -> np.ndarray:
    powers = np.float32(2.0) ** np.arange(-149, 128, dtype=np.float32)
    near = np.concatenate([np.nextafter(powers, np.float32(0)), powers])
    decimals = np.array([f"{d}e{e}" for d in (1, 5, 9.5, 1.25) for e in range(-44, 38)], np.float32)
    special = np.array([0, -0.0, np.inf, -np.inf, 3.4028235e38, 1e-45], np.float32)
    return np.concatenate([near, -near, decimals, special])


@pytest.mark.parametrize(
    "values", [any_float32(5000, 1), everyday_float32(20000, 2), awkward_float32()]
)
def test_shortest_decimal_of_float32_is_numpys(values: np.ndarray) -> None:
    expected = np.array([float(str(value)) for value in values])
    assert np.array_equal(shortest_as_float64(values), expected)


@pytest.mark.parametrize("digits", range(1, 16))
def test_rounding_to_digits_is_pythons(digits: int) -> None:
    values = np.concatenate([any_float32(500, 3), everyday_float32(3000, 4)]).astype(np.float64)
    ties = np.array([0.5, 1.5, 2.5, 0.125, 12345678.5, 1e22, 99999.95, 9.5, 0.1])
    values = np.concatenate([values, ties])
    expected = [float(f"{value:.{digits - 1}e}") for value in values]
    assert np.array_equal(rounded(values, digits), expected)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@given(data=st.data())
def test_written_numbers_are_read_back_bit_for_bit(dtype: type, data: st.DataObject) -> None:
    width = np.dtype(dtype).itemsize * 8
    floats = st.floats(width=width, allow_nan=False)
    values = np.array(data.draw(st.lists(floats, max_size=8)), dtype)
    texts = [text.encode() for text in format_numbers(values)]
    back = parse_floats(texts)
    assert back.astype(dtype).tobytes() == values.tobytes()
    if dtype is np.float32:
        assert narrowed(back).dtype == np.float32
        assert rendered(back).tobytes() == values.tobytes()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.1", np.float32),
        ("0.123457", np.float32),
        ("16777216", np.float32),
        ("16777217", np.float64),
        ("0.1234567891", np.float64),
        ("8.108999252319336", np.float64),
        ("0.123456791", np.float64),
        ("1e39", np.float64),
        ("1e-50", np.float64),
        ("nan", np.float32),
        ("-inf", np.float32),
        ("-0.0", np.float32),
    ],
)
def test_text_is_float32_where_its_shortest_decimal_survives(text: str, expected: type) -> None:
    values = parse_floats([b"0.5", text.encode()])
    result = narrowed(values)
    assert result.dtype == expected
    assert np.array_equal(result, values.astype(expected), equal_nan=True)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.1", np.float32),
        ("0.123456791", np.float32),  # %.9g of a float32
        ("8.108999252319336", np.float32),  # a float32 printed as a double
        ("0.10000000149", np.float32),  # %.11f
        ("0.1000000014901", np.float32),  # %.13f
        ("16.123457", np.float32),
        ("24.1234567", np.float64),
        ("16777217", np.float64),
        ("0.12345678901", np.float64),
        ("1e39", np.float64),
        ("nan", np.float32),
    ],
)
def test_text_declared_float_is_float32_where_it_renders_one(text: str, expected: type) -> None:
    assert rendered(parse_floats([text.encode(), b"0.5"])).dtype == expected


def test_whole_numbers_are_written_without_a_point() -> None:
    values = np.array([1.0, -0.0, 0.1, 1e22, 1e-5, 123456.0], np.float64)
    assert format_numbers(values) == ["1", "-0", "0.1", "1e+22", "1e-05", "123456"]


def test_sign_of_nan_survives_and_its_payload_is_a_warning() -> None:
    values = np.array([np.nan, -np.nan], np.float32)
    assert format_numbers(values) == ["nan", "-nan"]
    back = parse_floats([b"nan", b"-nan"]).astype(np.float32)
    assert back.tobytes() == values.tobytes()
    odd = np.array([0x7FC00001], np.uint32).view(np.float32)
    with pytest.warns(DroppedWarning, match="the payload of 1 NaN"):
        format_numbers(odd)


def test_what_only_python_takes_for_a_number_is_refused() -> None:
    with pytest.raises(ValueError, match="1_0"):
        parse_floats([b"1", b"1_0"])
    with pytest.raises(ValueError, match="1_0"):
        parse_integers([b"1_0"])


def test_integers_may_be_written_like_floats() -> None:
    assert parse_integers([b"2.0", b"1e3", b"-7"]).tolist() == [2, 1000, -7]
    for bad in (b"2.5", b"nan", b"inf", b"9223372036854775808", b"9" * 5000):
        with pytest.raises((ValueError, OverflowError)):
            parse_integers([bad])
