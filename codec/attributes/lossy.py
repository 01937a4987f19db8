"""Values of an attribute on a lattice of the precision that was asked for.

Every lattice gives the integers of what it decodes to again, or `fit` refuses it: that makes
compression canonical.  Values that are not finite are beside the lattice, bit for bit.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.attributes.lattices import Values, nearest
from ebz.codec.attributes.octahedral import Octahedral
from ebz.codec.lattice import MAX_MULTIPLE, Integers

MAX_BITS = 30


@dataclass(frozen=True)
class Box:
    """2^bits values along the widest range of a component, from the least of each."""

    bits: int
    origin: tuple[float, ...]
    side: float
    kind = "box"

    @property
    def step(self) -> float:
        """The distance of neighbouring values."""
        return self.side / ((1 << self.bits) - 1)

    @property
    def allowed_error(self) -> float:
        """How far a value may move, but for the rounding of the dtype."""
        return self.step / 2

    def integers(self, values: Values) -> Integers:
        return nearest(self.positions(values.astype(np.float64)))

    def positions(self, values: Values) -> Values:
        offsets = values - np.array(self.origin)
        return offsets / self.step if self.step else np.zeros_like(offsets)

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        moved: npt.NDArray[np.float64] = np.array(self.origin) + integers * self.step
        return to_dtype(moved, dtype)


@dataclass(frozen=True)
class Step:
    """Multiples of a step just below twice max_error."""

    max_error: float
    kind = "step"

    @property
    def step(self) -> float:
        """The distance of neighbouring values."""
        return 2 * self.max_error * (1 - 2.0**-12)

    @property
    def allowed_error(self) -> float:
        """How far a value may move."""
        return self.max_error

    def integers(self, values: Values) -> Integers:
        return nearest(self.positions(values.astype(np.float64)))

    def positions(self, values: Values) -> Values:
        return values / self.step

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return to_dtype((integers * self.step).astype(np.float64), dtype)


@dataclass(frozen=True)
class Shares:
    """Multiples of 1 / (2^bits - 1) that add up to one: what the sums so far are rounded to."""

    bits: int
    kind = "shares"

    @property
    def one(self) -> float:
        """The integer of 1."""
        return float((1 << self.bits) - 1)

    @property
    def step(self) -> float:
        """The distance of neighbouring values."""
        return 1 / self.one

    @property
    def allowed_error(self) -> float:
        """How far a value may move: each of two sums by half a step, and what they lack of one."""
        return self.step * 1.01

    def integers(self, values: Values) -> Integers:
        sums = np.cumsum(values.astype(np.float64), axis=1)
        total = np.where(sums[:, -1:] != 0, sums[:, -1:], 1.0)
        return np.diff(nearest(sums / total * self.one), axis=1, prepend=0)

    def positions(self, values: Values) -> Values:
        return values * self.one

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> Values:
        return (integers / self.one).astype(dtype)


Lossy = Box | Step | Shares | Octahedral


@np.errstate(all="ignore")
def box(values: Values, bits: int) -> Box | None:
    """The box of the finite values, None where there is none that comes back as itself."""
    finite = np.isfinite(values.astype(np.float64))
    if not finite.any(axis=0).all():
        return None
    wide = np.where(finite, values.astype(np.float64), np.nan)
    # Adding zero turns -0.0 into 0.0.
    low = np.nanmin(wide, axis=0) + 0.0
    side = float((np.nanmax(wide, axis=0) - low).max()) + 0.0
    return Box(bits, tuple(low.tolist()), side) if np.isfinite(side) else None


@np.errstate(all="ignore")
def fits(lattice: Lossy, values: Values) -> bool:
    """Whether compressing what decodes gives the same again, within the error that is allowed."""
    integers = lattice.integers(values)
    decoded = lattice.values(integers, values.dtype)
    finite = np.isfinite(values.astype(np.float64))
    again = lattice.integers(np.where(finite, decoded, values))
    if isinstance(lattice, Box):
        if box(np.where(finite, decoded, values), lattice.bits) != lattice:
            return False
    elif isinstance(lattice, Step):
        largest = np.abs(np.where(finite, values.astype(np.float64), 0.0)).max(initial=0)
        if not 0 < lattice.step < np.inf or largest / lattice.step > MAX_MULTIPLE:
            return False
    if isinstance(lattice, Octahedral):
        return bool((again == integers).all())
    return bool((again == integers)[finite].all() and np.isfinite(decoded[finite]).all())


def adds_up(values: Values) -> bool:
    """Whether the components of every entry are shares of one."""
    if values.dtype.kind != "f" or values.shape[1] < 2 or not len(values):
        return False
    wide = values.astype(np.float64)
    return bool((wide >= 0).all() and (np.abs(wide.sum(axis=1) - 1) < 1e-3).all())


def to_dtype(values: npt.NDArray[np.float64], dtype: np.dtype[Any]) -> Values:
    """Rounded to a dtype, integers to the nearest that it has."""
    if dtype.kind == "f":
        return values.astype(dtype)
    if dtype.kind == "b":
        return np.asarray(values >= 0.5)
    limits = np.iinfo(dtype)
    rounded = np.clip(np.rint(values), float(limits.min), float(limits.max))
    # The greatest integers of 64 bits have no double: they round up, past the limit.
    top = np.nextafter(float(limits.max) + 1, 0) if limits.bits == 64 else float(limits.max)
    whole: Values = np.minimum(rounded, top).astype(dtype)
    return whole
