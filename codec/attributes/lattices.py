"""Values of an attribute <-> integers: those of a lattice that holds them, or their own bits.

As in ebz.codec.lattice, which has the lattices of coordinates; here entries have any number of
components and any dtype.  All of this is exact or IEEE operations on whole arrays.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.lattice import (
    MAX_DIGITS,
    MAX_MULTIPLE,
    DecimalLattice,
    FloatLattice,
    Integers,
    SingleLattice,
)

Values = npt.NDArray[Any]
# A lattice of many more points than a float has predicts worse than the floats themselves.
MAX_POINTS = {4: 2.0**26, 8: MAX_MULTIPLE}
# One in 64 may miss a lattice; beyond that exact bits cost less.
MISSES_SHIFT = 6
# Bytes and words as shares of one, signed and unsigned.
DIVISORS = (255, 65535, 127, 32767)


@dataclass(frozen=True)
class IntegerLattice:
    """Integers as they are; those of 64 bits without sign keep their order."""

    kind = "exact"

    def integers(self, values: Values) -> Integers:
        if values.dtype == np.uint64:
            return (values ^ np.uint64(1 << 63)).view(np.int64)
        return values.astype(np.int64)

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        if dtype == np.uint64:
            return integers.view(np.uint64) ^ np.uint64(1 << 63)
        return integers.astype(dtype)


@dataclass(frozen=True)
class BitsLattice:
    """The bits of floats, ordered as the floats are."""

    kind = "exact"

    def integers(self, values: Values) -> Integers:
        return FloatLattice().integers(values)

    def positions(self, values: Values) -> Values:
        return values

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return FloatLattice().coordinates(integers, dtype)


@dataclass(frozen=True)
class Decimals:
    """Multiples of 10^-digits, correctly rounded to the dtype."""

    digits: int
    kind = "decimal"

    @property
    def one(self) -> float:
        """The integer of 1."""
        return 10.0**self.digits

    def integers(self, values: Values) -> Integers:
        return DecimalLattice(self.digits).integers(values)

    def positions(self, values: Values) -> Values:
        return values * self.one

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return DecimalLattice(self.digits).coordinates(integers, dtype)


@dataclass(frozen=True)
class Fractions:
    """Multiples of 1 / divisor, correctly rounded to the dtype."""

    divisor: int
    kind = "fraction"

    @property
    def one(self) -> float:
        """The integer of 1."""
        return float(self.divisor)

    def integers(self, values: Values) -> Integers:
        return nearest(self.positions(values.astype(np.float64)))

    def positions(self, values: Values) -> Values:
        return values * self.divisor

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return (integers / self.divisor).astype(dtype)


@dataclass(frozen=True)
class Singles:
    """Float64 that were float32: as they are (0 digits), or rounded to significant digits."""

    digits: int
    kind = "single"

    def integers(self, values: Values) -> Integers:
        return SingleLattice(self.digits).integers(values)

    def positions(self, values: Values) -> Values:
        return values

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return SingleLattice(self.digits).coordinates(integers, dtype)


Lossless = IntegerLattice | BitsLattice | Decimals | Fractions | Singles


def bytes_of_floats(lattice: object, dtype: np.dtype[Any]) -> int:
    """The size of the floats whose bits the integers are; 0 where they are none."""
    if isinstance(lattice, Singles):
        return 4
    return dtype.itemsize if isinstance(lattice, BitsLattice) else 0


def exact(dtype: np.dtype[Any]) -> Lossless:
    """The lattice that holds every value of a dtype."""
    return BitsLattice() if dtype.kind == "f" else IntegerLattice()


@np.errstate(all="ignore")
def fit(values: Values) -> Lossless:
    """The coarsest lattice that nearly all of the values are on."""
    if values.dtype.kind != "f" or values.dtype.itemsize == 2:
        return exact(values.dtype)
    flat = values.reshape(-1)
    flat = flat[np.isfinite(flat)]
    misses = flat.size >> MISSES_SHIFT
    multiples = _multiples(flat, misses)
    for lattice in multiples:
        if _fits(lattice, flat, MAX_POINTS[4], misses):
            return lattice
    if flat.itemsize == 4:
        return exact(values.dtype)
    digits = _kernels.single_digits(flat, misses)
    if flat.size and digits >= 0:
        return Singles(digits)
    fitting = (one for one in multiples if _fits(one, flat, MAX_POINTS[8], misses))
    return next(fitting, exact(values.dtype))


def _multiples(flat: Values, misses: int) -> list[Lossless]:
    """Lattices of multiples that the values may be on, the likeliest first."""
    digits = _kernels.decimal_digits(flat, MAX_DIGITS[flat.itemsize], misses)
    candidates: list[Lossless] = [Fractions(divisor) for divisor in DIVISORS]
    if digits >= 0:
        candidates.insert(0 if digits < 3 else len(candidates), Decimals(digits))
    return candidates


def _fits(lattice: Lossless, flat: Values, n_points: float, misses: int) -> bool:
    """Whether nearly all of the values are among so many points."""
    integers = lattice.integers(flat)
    off = bits(lattice.values(integers, flat.dtype)) != bits(flat)
    small = np.abs(integers).max(initial=0) < n_points
    return bool(small and np.count_nonzero(off) <= misses)


def nearest(multiples: npt.NDArray[np.float64]) -> Integers:
    """The nearest integers, halves to even; 0 for what is out of range or not a number."""
    inside = np.abs(multiples) <= MAX_MULTIPLE
    return np.rint(np.where(inside, multiples, 0.0)).astype(np.int64)


def bits(values: Values) -> Values:
    """The bits of the values, as unsigned integers."""
    return np.ascontiguousarray(values).view(f"u{values.dtype.itemsize}")
