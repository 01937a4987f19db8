"""Floats <-> integers: the lattice on which coordinates are predicted and coded.

A lattice turns coordinates into 64-bit integers and back.  What does not come back as it must is
an exception, stored bit for bit.  Both directions are IEEE operations on whole arrays, correctly
rounded, so every machine gets the same integers and the same coordinates.

Fitting depends on the set of coordinates alone, not on their order, and gives the same lattice for
the coordinates it decodes to: that makes compression canonical.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.errors import MeshError, OptionError

Floats = npt.NDArray[Any]
Integers = npt.NDArray[np.int64]

MAX_BITS = 30
MAX_MULTIPLE = 2.0**40
# A lattice of many more points than a float has predicts worse than the floats themselves.
MAX_POINTS = {4: 2.0**26, 8: MAX_MULTIPLE}
MAX_DIGITS = {4: 10, 8: 15}
# An exception costs some 40 bits and a coordinate on a lattice saves about 8.
MISSES_SHIFT = 6


@dataclass(frozen=True)
class FloatLattice:
    """Every float of the dtype is a point: the bits of the float, ordered as the floats are."""

    kind = "float"

    def integers(self, coordinates: Floats) -> Integers:
        bits: Integers = _bits(coordinates).astype(np.int64)
        return np.where(bits < 0, bits ^ _magnitude_mask(coordinates.dtype), bits)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        bits = np.where(integers < 0, integers ^ _magnitude_mask(dtype), integers)
        restored: Floats = bits.astype(f"i{dtype.itemsize}").view(dtype)
        return restored


@dataclass(frozen=True)
class DecimalLattice:
    """Multiples of 10^-digits, correctly rounded to the dtype."""

    digits: int
    kind = "decimal"

    def integers(self, coordinates: Floats) -> Integers:
        # NaN and what overflows become exceptions.
        with np.errstate(invalid="ignore", over="ignore"):
            return _to_integers(coordinates.astype(np.float64) * 10.0**self.digits)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return (integers / 10.0**self.digits).astype(dtype)


@dataclass(frozen=True)
class BoxLattice:
    """2^bits points along the longest side of the bounding box, starting at its lower corner."""

    bits: int
    origin: tuple[float, float, float]
    side: float
    kind = "box"

    @property
    def step(self) -> float:
        """The distance of neighbouring points, in model units."""
        return self.side / ((1 << self.bits) - 1)

    def integers(self, coordinates: Floats) -> Integers:
        offsets = coordinates.astype(np.float64) - np.array(self.origin)
        return _to_integers(offsets / self.step if self.step else np.zeros_like(offsets))

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        moved: Floats = np.array(self.origin) + integers * self.step
        return moved.astype(dtype)


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
        return _to_integers(coordinates.astype(np.float64) / self.step)

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        return (integers * self.step).astype(dtype)


@dataclass(frozen=True)
class GridLattice:
    """origin + step * integers, wherever the mesh is: what meshes share, they decode alike.

    Whether a coordinate is an exception depends on the coordinate alone.
    """

    origin: tuple[float, float, float]
    step: float
    kind = "grid"

    def integers(self, coordinates: Floats) -> Integers:
        return _to_integers(self._multiples(coordinates))

    def coordinates(self, integers: Integers, dtype: np.dtype[Any]) -> Floats:
        moved: Floats = np.array(self.origin) + integers * self.step
        return moved.astype(dtype)

    def reaches(self, coordinates: Floats) -> npt.NDArray[np.bool_]:
        """Which coordinates are few enough steps from the origin to have an integer."""
        return np.abs(self._multiples(coordinates)) <= MAX_MULTIPLE

    def _multiples(self, coordinates: Floats) -> npt.NDArray[np.float64]:
        multiples: npt.NDArray[np.float64] = coordinates.astype(np.float64) - np.array(self.origin)
        return multiples / self.step


Lattice = FloatLattice | DecimalLattice | BoxLattice | StepLattice | GridLattice


@dataclass(frozen=True)
class Points:
    """Coordinates on a lattice: (n, 3) integers, and the flat, ascending rows of exceptions."""

    lattice: Lattice
    integers: Integers
    exceptions: npt.NDArray[np.int64]

    def take(self, rows: npt.NDArray[Any]) -> "Points":
        """Those rows, in that order."""
        if not len(self.exceptions):
            return replace(self, integers=self.integers[rows])
        marked = np.zeros(self.integers.shape, bool)
        marked.reshape(-1)[self.exceptions] = True
        return Points(self.lattice, self.integers[rows], np.flatnonzero(marked[rows]))


# Whatever overflows or is not a number comes back different, and so becomes an exception.
@np.errstate(all="ignore")
def fit(
    coordinates: Floats,
    bits: int | None = None,
    max_error: float | None = None,
    grid: GridLattice | None = None,
) -> Points:
    """The coordinates on the lattice asked for; without bits, max_error and grid, nothing is lost.

    A lattice finer than the floats themselves gives way to one that loses nothing, but for a grid,
    which others share.
    Where something may be lost, the coordinates must be finite: see require_finite.
    """
    if grid is not None:
        return _on_grid(coordinates, grid)
    if bits is None and not max_error:
        return _lossless(coordinates)
    points = (
        _in_box(coordinates, bits) if bits is not None else _within(coordinates, max_error or 0.0)
    )
    return points or _lossless(coordinates)


def require_finite(vertices: Floats) -> None:
    """Raise MeshError, naming the first vertex that is not finite: it cannot be rounded."""
    if not np.isfinite(vertices).all():
        row, axis = np.argwhere(~np.isfinite(vertices))[0]
        value = vertices[row, axis]
        raise MeshError(f"vertex {row}: {'xyz'[axis]} is {value}, which cannot be quantised")


@np.errstate(all="ignore")
def require_on_grid(vertices: Floats, grid: GridLattice) -> None:
    """Raise OptionError, naming the first vertex that is too many steps from the grid's origin."""
    inside = grid.reaches(vertices)
    if not inside.all():
        row, axis = np.argwhere(~inside)[0]
        raise OptionError(
            f"vertex {row}: {'xyz'[axis]} is {vertices[row, axis]}, more than 2^40 steps of the "
            "grid from its origin"
        )


@np.errstate(all="ignore")
def restore(points: Points, dtype: np.dtype[Any], exact: Floats) -> Floats:
    """The (n, 3) coordinates that decoding yields; `exact` holds the exceptions in order."""
    coordinates = points.lattice.coordinates(points.integers, dtype)
    coordinates.reshape(-1)[points.exceptions] = exact
    return coordinates


def _lossless(coordinates: Floats) -> Points:
    flat = coordinates.reshape(-1)
    misses = flat.size >> MISSES_SHIFT
    digits = _kernels.decimal_digits(flat, MAX_DIGITS[flat.itemsize], misses)
    if digits >= 0 and flat.size:
        points = _with_exceptions(DecimalLattice(digits), coordinates)
        if np.abs(points.integers).max() < MAX_POINTS[flat.itemsize]:
            return points
    return _with_exceptions(FloatLattice(), coordinates)


def _with_exceptions(lattice: Lattice, coordinates: Floats) -> Points:
    integers = lattice.integers(coordinates)
    decoded = lattice.coordinates(integers, coordinates.dtype)
    return Points(lattice, integers, np.flatnonzero(_bits(decoded) != _bits(coordinates)))


def _in_box(coordinates: Floats, bits: int) -> Points | None:
    lattice = _box(coordinates, bits)
    if lattice is None:
        return None
    integers = lattice.integers(coordinates)
    decoded = lattice.coordinates(integers, coordinates.dtype)
    again = _box(decoded, bits)
    # Where the step is close to the resolution of the floats, the box or a point may move.
    if again != lattice or not np.array_equal(lattice.integers(decoded), integers):
        return None
    return Points(lattice, integers, np.zeros(0, np.int64))


def _box(coordinates: Floats, bits: int) -> BoxLattice | None:
    if not len(coordinates):
        return None
    # Adding zero turns -0.0 into 0.0: which of the two an extreme is depends on the order.
    low = coordinates.min(axis=0).astype(np.float64) + 0.0
    side = float((coordinates.max(axis=0).astype(np.float64) - low).max()) + 0.0
    if not np.isfinite(side):
        return None
    return BoxLattice(bits, (float(low[0]), float(low[1]), float(low[2])), side)


def _within(coordinates: Floats, max_error: float) -> Points | None:
    lattice = StepLattice(max_error)
    largest = float(np.abs(coordinates).max(initial=0))
    # Multiples of an infinite step would not be numbers.
    if not 0 < lattice.step < np.inf or largest / lattice.step > MAX_MULTIPLE:
        return None
    integers = lattice.integers(coordinates)
    decoded = lattice.coordinates(integers, coordinates.dtype)
    off = np.abs(decoded.astype(np.float64) - coordinates.astype(np.float64)) > max_error
    if not np.array_equal(lattice.integers(decoded), integers):
        return None
    return Points(lattice, integers, np.flatnonzero(off))


def _on_grid(coordinates: Floats, grid: GridLattice) -> Points:
    integers = grid.integers(coordinates)
    decoded = grid.coordinates(integers, coordinates.dtype)
    # Where the step is close to the resolution of the floats, a point may not come back as itself.
    off = (grid.integers(decoded) != integers) | ~np.isfinite(decoded)
    off |= ~grid.reaches(coordinates)
    return Points(grid, integers, np.flatnonzero(off))


def _to_integers(multiples: npt.NDArray[np.float64]) -> Integers:
    # What is no multiple in range becomes some integer in range, and then an exception.
    inside = np.abs(multiples) <= MAX_MULTIPLE
    return np.rint(np.where(inside, multiples, 0.0)).astype(np.int64)


def _bits(coordinates: Floats) -> npt.NDArray[Any]:
    return coordinates.view(f"i{coordinates.dtype.itemsize}")


def _magnitude_mask(dtype: np.dtype[Any]) -> int:
    return int((1 << (8 * dtype.itemsize - 1)) - 1)
