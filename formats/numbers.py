"""Decimal text <-> floats and integers, exactly, at the speed of whole arrays.

Text is read through Python's correctly rounded float(). A float is written as the shortest decimal
that reads back as the same float of its dtype (Steele and White, How to print floating-point
numbers accurately, 1990). Whole arrays of float32 get there by way of float64: a decimal of at most
15 digits is the shortest decimal of the float64 nearest to it, so the float64 nearest to the
shortest decimal of a float32 says the same as the text does.
"""

import warnings
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import DroppedWarning

FloatArray: TypeAlias = npt.NDArray[np.float64]

SURE_DIGITS_FLOAT32 = 6
MAX_DIGITS_FLOAT32 = 9
MAX_FAST_DIGITS = 12
# m / 10^k and m * 10^k are correctly rounded where m < 2^53 and 10^k is a float64: k <= 22.
MAX_EXACT_POWER = 22
POWERS = 10.0 ** np.arange(MAX_EXACT_POWER + 1)
QUIET_NAN_BITS = {4: 0x7FC00000, 8: 0x7FF8000000000000}


def parse_floats(tokens: Sequence[bytes]) -> FloatArray:
    """The float64 nearest to each token; ValueError where one is no number."""
    return np.fromiter(map(_float, tokens) if _odd(tokens) else map(float, tokens), np.float64)


def parse_integers(tokens: Sequence[bytes]) -> npt.NDArray[np.int64]:
    """Each token as int64, `2.0` included; ValueError where one is no integer or too large."""
    try:
        if _odd(tokens):
            raise ValueError
        return np.fromiter(map(int, tokens), np.int64, len(tokens))
    except (ValueError, OverflowError):
        return np.fromiter(map(_integer, tokens), np.int64, len(tokens))


def first_bad(tokens: Iterable[bytes], *, integer: bool) -> int:
    """The index of the first token that is no number (or no integer)."""
    parse = _integer if integer else _float
    for index, token in enumerate(tokens):
        try:
            parse(token)
        except ValueError:
            return index
    raise AssertionError("every token is a number")


def shown(token: bytes) -> str:
    """A token as messages quote it: printable, and short."""
    return repr(token[:24].decode("latin-1") + ("..." if len(token) > 24 else ""))


def _odd(tokens: Sequence[bytes]) -> bool:
    """Whether Python would take what no mesh format means: underscores between digits."""
    return any(b"_" in b" ".join(tokens[i : i + 65536]) for i in range(0, len(tokens), 65536))


def _float(token: bytes) -> float:
    if b"_" in token:
        raise ValueError(token)
    return float(token)


def _integer(token: bytes) -> int:
    if b"_" in token or len(token) > 40:
        raise ValueError(token)
    try:
        value = int(token)
    except ValueError:
        as_float = float(token)
        if not as_float.is_integer():
            raise
        value = int(as_float)
    if not -(2**63) <= value < 2**63:
        raise ValueError(token)
    return value


def narrowed(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Float64 read from text of unknown type: float32 where every shortest decimal survives that.

    This depends on the values alone, so text that ebz wrote is read back as it was.
    """
    single = _single(values)
    near = shortest_as_float64(single)
    return single if _same_numbers(near, values) else values


def rendered(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Float64 read from text declared float: float32 where every text is a rendering of one.

    A rendering is the float32 rounded to some number of significant digits: what printf writes,
    be it %.6f, %g, %.9g or %.17g. Anything else says more than float32 holds and stays float64.
    """
    single = _single(values)
    exact = single.astype(np.float64)
    rest = np.flatnonzero((values != exact) & (values != shortest_as_float64(single)))
    rest = rest[~np.isnan(values.ravel()[rest])]
    flat, flat_exact = values.ravel(), exact.ravel()
    for digits in range(SURE_DIGITS_FLOAT32, MAX_FAST_DIGITS + 1):
        rest = rest[flat[rest] != rounded(flat_exact[rest], digits)]
        if not rest.size:
            return single
    return values if any(_no_rendering(flat[i], flat_exact[i]) for i in rest.tolist()) else single


def _no_rendering(value: float, exact: float) -> bool:
    return all(value != float(f"{exact:.{digits - 1}e}") for digits in range(1, 18))


def _single(values: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        return values.astype(np.float32)


def _same_numbers(near: FloatArray, values: npt.NDArray[Any]) -> bool:
    return bool(np.array_equal(near, values, equal_nan=True))


def shortest_as_float64(single: npt.NDArray[np.float32]) -> FloatArray:
    """The float64 nearest to the shortest decimal of each float32."""
    exact = single.astype(np.float64).ravel()
    result = exact.copy()
    todo = np.flatnonzero(np.isfinite(exact) & (exact != 0))
    # At a power of two the gap below is half the gap above, and the shortest decimal need not be
    # the nearest of its length; six digits are unique everywhere but among denormals.
    power_of_two = np.abs(np.frexp(exact)[0]) == 0.5
    slow = [todo[np.abs(exact[todo]) < np.finfo(np.float32).tiny]]
    todo = todo[np.abs(exact[todo]) >= np.finfo(np.float32).tiny]
    for digits in range(SURE_DIGITS_FLOAT32, MAX_DIGITS_FLOAT32 + 1):
        near = rounded(exact[todo], digits)
        found = _single(near) == exact[todo]
        if digits > SURE_DIGITS_FLOAT32:
            slow.append(todo[found & power_of_two[todo]])
        result[todo[found]] = near[found]
        todo = todo[~found]
        if not todo.size:
            break
    flat = single.ravel()
    for index in np.concatenate([*slow, todo]).tolist():
        result[index] = float(str(flat[index]))
    return result.reshape(single.shape)


def rounded(values: FloatArray, digits: int) -> FloatArray:
    """The float64 nearest to each finite value rounded to `digits` digits, at most 15."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        exponent = np.floor(np.log10(np.abs(values)))
        power = digits - 1 - exponent
        simple = np.abs(power) <= MAX_EXACT_POWER
        scale = POWERS[np.where(simple, np.abs(power), 0).astype(np.intp)]
        scaled = np.where(power < 0, values / scale, values * scale)
        mantissa = np.rint(scaled)
        result: FloatArray = np.where(power < 0, mantissa * scale, mantissa / scale)
        # The product is off by 2^-53 of itself at most: only near a tie can that matter.
        near_tie = np.abs(np.abs(scaled - mantissa) - 0.5) <= np.abs(mantissa) * 2.0**-51
        simple &= ~near_tie & (np.abs(mantissa) >= 10.0 ** (digits - 1))
        simple &= np.abs(mantissa) < 10.0**digits
    for index in np.flatnonzero(~simple).tolist():
        result[index] = float(f"{values[index]:.{digits - 1}e}")
    return result


def format_numbers(values: npt.NDArray[Any]) -> list[str]:
    """The shortest decimal of each number of a 1-d array that reads back in its dtype.

    Warns where a NaN has a payload, which no decimal shows.
    """
    if values.dtype.kind != "f":
        return list(map(str, values.tolist()))
    _warn_of_nan_payloads(values)
    single = values.dtype == np.float32
    wide = shortest_as_float64(values) if single else values.astype(np.float64)
    texts = [t[:-2] if t.endswith(".0") else t for t in map(repr, wide.tolist())]
    for index in np.flatnonzero(np.isnan(values) & np.signbit(values)).tolist():
        texts[index] = "-nan"
    return texts


def _warn_of_nan_payloads(values: npt.NDArray[Any]) -> None:
    nan = values[np.isnan(values)]
    if not nan.size or nan.dtype.itemsize not in QUIET_NAN_BITS:
        return
    bits = np.abs(nan).view(f"u{nan.dtype.itemsize}")
    n_odd = int(np.count_nonzero(bits != QUIET_NAN_BITS[nan.dtype.itemsize]))
    if n_odd:
        warnings.warn(f"the payload of {n_odd} NaN", DroppedWarning, stacklevel=2)
