"""Floats <-> integers: the lattice on which coordinates are predicted and coded.

A lattice turns coordinates into 64-bit integers and back.  What does not come back as it must is
an exception, stored bit for bit.  Both directions are IEEE operations on whole arrays, correctly
rounded, so every machine gets the same integers and the same coordinates.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels

Floats = npt.NDArray[Any]
Integers = npt.NDArray[np.int64]
Origin = tuple[float, float, float]

NO_ORIGIN = (0.0, 0.0, 0.0)
MAX_BITS = 30
MAX_MULTIPLE = 2.0**40
MAX_DIGITS = {4: 10, 8: 15}
MAX_SINGLE_DIGITS = 15


@dataclass(frozen=True)
class FloatLattice:
    """Every float of the dtype is a point: the bits of the float, ordered as the floats are."""

    kind = "float"

    def integers(self, coordinates: Floats) -> Integers:
        bits: Integers = bit_patterns(coordinates).astype(np.int64)
        return np.where(bits < 0, bits ^ _magnitude_mask(coordinates.dtype), bits)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        integers = integers.astype(np.int64, copy=False)
        bits = np.where(integers < 0, integers ^ _magnitude_mask(dtype), integers)
        restored: Floats = bits.astype(f"i{dtype.itemsize}").view(dtype)
        return restored


@dataclass(frozen=True)
class SingleLattice:
    """Float64 that were float32: as they are (0 digits), or rounded to significant digits."""

    digits: int
    kind = "single"

    @np.errstate(over="ignore", under="ignore")
    def integers(self, coordinates: Floats) -> Integers:
        # What is not a number would not come back on every machine.
        singles = np.where(np.isnan(coordinates), 0, coordinates).astype(np.float32)
        return FloatLattice().integers(singles)

    @np.errstate(all="ignore")
    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        singles = FloatLattice().coordinates(integers, np.dtype(np.float32))
        written = _kernels.write_singles(singles.reshape(-1), self.digits)
        return written.reshape(singles.shape).astype(dtype, copy=False)


@dataclass(frozen=True)
class DecimalLattice:
    """Multiples of 10^-digits, correctly rounded to the dtype."""

    digits: int
    kind = "decimal"

    def integers(self, coordinates: Floats) -> Integers:
        # NaN and what overflows become exceptions.
        with np.errstate(invalid="ignore", over="ignore"):
            return _to_integers(coordinates.astype(np.float64) * 10.0**self.digits)

    @np.errstate(all="ignore")
    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return (integers / 10.0**self.digits).astype(dtype)


@dataclass(frozen=True)
class BoxLattice:
    """2^bits points along the longest side of the bounding box, starting at its lower corner."""

    bits: int
    origin: Origin
    side: float
    kind = "box"

    @property
    def step(self) -> float:
        """The distance of neighbouring points, in model units."""
        return self.side / ((1 << self.bits) - 1)

    def integers(self, coordinates: Floats) -> Integers:
        return _multiples(coordinates, self.origin, self.step)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return _from_multiples(integers, self.origin, self.step, dtype)


@dataclass(frozen=True)
class StepLattice:
    """Multiples of a step, wherever the mesh is; the step is just below twice max_error."""

    max_error: float
    kind = "step"

    @property
    def step(self) -> float:
        """The distance of neighbouring points, in model units."""
        # The slack leaves room for rounding to the dtype, so that exceptions are rare.
        return 2 * self.max_error * (1 - 2.0**-12)

    def integers(self, coordinates: Floats) -> Integers:
        return _multiples(coordinates, NO_ORIGIN, self.step)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return _from_multiples(integers, NO_ORIGIN, self.step, dtype)


@dataclass(frozen=True)
class GridLattice:
    """origin + step * integers, wherever the mesh is: what meshes share, they decode alike.

    Whether a coordinate is an exception depends on the coordinate alone.
    """

    origin: Origin
    step: float
    kind = "grid"

    def integers(self, coordinates: Floats) -> Integers:
        return _multiples(coordinates, self.origin, self.step)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return _from_multiples(integers, self.origin, self.step, dtype)

    def reaches(self, coordinates: Floats) -> npt.NDArray[np.bool_]:
        """Which coordinates are few enough steps from the origin to have an integer."""
        offsets = coordinates.astype(np.float64) - np.array(self.origin)
        inside: npt.NDArray[np.bool_] = np.abs(offsets / self.step) <= MAX_MULTIPLE
        return inside


Lattice = FloatLattice | SingleLattice | DecimalLattice | BoxLattice | StepLattice | GridLattice


class Points(NamedTuple):
    """Coordinates on a lattice: (n, 3) integers, and the flat, ascending rows of exceptions."""

    lattice: Lattice
    integers: Integers
    exceptions: npt.NDArray[np.int64]

    def take(self, rows: npt.NDArray[Any]) -> "Points":
        """Those rows, in that order."""
        if not len(self.exceptions):
            return self._replace(integers=taken(self.integers, rows))
        marked = np.zeros(self.integers.shape, bool)
        marked.reshape(-1)[self.exceptions] = True
        return Points(self.lattice, taken(self.integers, rows), np.flatnonzero(marked[rows]))


def taken(values: npt.NDArray[Any], rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Those rows, which are all in range: "clip" spares the buffer of the other modes."""
    return np.take(values, rows, axis=0, mode="clip")


def restore(points: Points, dtype: np.dtype[Any], exact: Floats) -> Floats:
    """The (n, 3) coordinates that decoding yields; `exact` holds the exceptions in order."""
    coordinates = points.lattice.coordinates(points.integers, dtype)
    if len(exact):
        coordinates.reshape(-1)[points.exceptions] = exact
    return coordinates


def _multiples(coordinates: Floats, origin: Origin, step: float) -> Integers:
    multiples = _kernels.to_multiples(coordinates.reshape(-1), origin, step)
    return multiples.reshape(coordinates.shape)


def _from_multiples(
    integers: Integers, origin: Origin, step: float, dtype: np.dtype[Any]
) -> Floats:
    coordinates = np.empty(integers.shape, dtype)
    _kernels.from_multiples(integers, origin, step, coordinates.reshape(-1))
    return coordinates


def _to_integers(multiples: npt.NDArray[np.float64]) -> Integers:
    # What is no multiple in range becomes some integer in range, and then an exception.
    inside = np.abs(multiples) <= MAX_MULTIPLE
    return np.rint(np.where(inside, multiples, 0.0)).astype(np.int64)


def bit_patterns(coordinates: Floats) -> npt.NDArray[Any]:
    """The floats as signed integers of their size."""
    return coordinates.view(f"i{coordinates.dtype.itemsize}")


def _magnitude_mask(dtype: np.dtype[Any]) -> int:
    return int((1 << (8 * dtype.itemsize - 1)) - 1)
