"""The lattice for coordinates, by what may be lost.

Fitting depends on the set of coordinates alone, not on their order, and gives the same lattice for
the coordinates it decodes to: that makes compression canonical.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ebz.codec import _kernels
from ebz.codec.errors import MeshError, OptionError
from ebz.codec.lattice import (
    MAX_DIGITS,
    MAX_MULTIPLE,
    BoxLattice,
    DecimalLattice,
    FloatLattice,
    Floats,
    GridLattice,
    Lattice,
    Points,
    SingleLattice,
    StepLattice,
    bit_patterns,
)

# A lattice of many more points than a float has predicts worse than the floats themselves.
MAX_POINTS = {4: 2.0**26, 8: MAX_MULTIPLE}
# An exception costs some 40 bits and a coordinate on a lattice saves about 8.
MISSES_SHIFT = 6


class Precision(NamedTuple):
    """How far coordinates may move: not at all, or as one of these says.

    bits: 2^bits points along the longest side.  max_error: in model units.  grid: shared by meshes.
    """

    bits: int | None = None
    max_error: float | None = None
    grid: GridLattice | None = None

    @property
    def is_lossless(self) -> bool:
        return self.bits is None and not self.max_error and self.grid is None


LOSSLESS = Precision()


@np.errstate(all="ignore")
def check(vertices: Floats, precision: Precision) -> None:
    """Raise MeshError or OptionError, naming the first vertex that cannot be rounded so."""
    if precision.is_lossless:
        return
    if len(vertices) and math.isinf(_kernels.bounds(vertices.reshape(-1))[0][0]):
        row, axis = np.argwhere(~np.isfinite(vertices))[0]
        value = vertices[row, axis]
        raise MeshError(f"vertex {row}: {'xyz'[axis]} is {value}, which cannot be quantised")
    if precision.grid is not None and not (inside := precision.grid.reaches(vertices)).all():
        row, axis = np.argwhere(~inside)[0]
        raise OptionError(
            f"vertex {row}: {'xyz'[axis]} is {vertices[row, axis]}, more than 2^40 steps of the "
            "grid from its origin"
        )


def fit(coordinates: Floats, precision: Precision = LOSSLESS) -> Points:
    """The coordinates on the lattice asked for.

    A lattice finer than the floats themselves gives way to one that loses nothing, but for a grid,
    which others share.  Where something may be lost, the coordinates must be finite: see check.
    """
    return fit_together([coordinates], precision)[0]


# Whatever overflows or is not a number comes back different, and so becomes an exception.
@np.errstate(all="ignore")
def fit_together(parts: Sequence[Floats], precision: Precision = LOSSLESS) -> list[Points]:
    """Each part on its lattice; bits are of one box, so that what parts share stays shared."""
    if precision.grid is not None:
        return [_on_grid(part, precision.grid) for part in parts]
    if precision.bits is not None:
        return _in_boxes(parts, precision.bits)
    if precision.max_error:
        return [_within(part, precision.max_error) or _lossless(part) for part in parts]
    return [_lossless(part) for part in parts]


def _lossless(coordinates: Floats) -> Points:
    return _with_exceptions(_exact_lattice(coordinates.reshape(-1)), coordinates)


def _exact_lattice(flat: Floats) -> Lattice:
    """The coarsest lattice that nearly all of the coordinates are on."""
    misses = flat.size >> MISSES_SHIFT
    digits = _kernels.decimal_digits(flat, MAX_DIGITS[flat.itemsize], misses)
    decimals, most = DecimalLattice(digits), MAX_MULTIPLE
    if digits >= 0 and flat.size:
        most = float(np.abs(decimals.integers(flat)).max())
    if most < MAX_POINTS[4]:
        return decimals
    if flat.itemsize == 8 and flat.size:
        digits = _kernels.single_digits(flat, misses)
        if digits >= 0:
            return SingleLattice(digits)
    return decimals if most < MAX_POINTS[flat.itemsize] else FloatLattice()


def _with_exceptions(lattice: Lattice, coordinates: Floats) -> Points:
    integers = lattice.integers(coordinates)
    decoded = lattice.coordinates(integers, coordinates.dtype)
    return Points(
        lattice, integers, np.flatnonzero(bit_patterns(decoded) != bit_patterns(coordinates))
    )


def _in_boxes(parts: Sequence[Floats], bits: int) -> list[Points]:
    by_dtype = {
        dtype: _in_box([part for part in parts if part.dtype == dtype], bits)
        for dtype in {part.dtype for part in parts}
    }
    return [next(by_dtype[part.dtype]) for part in parts]


def _in_box(parts: list[Floats], bits: int) -> Iterator[Points]:
    lattice = _box(parts, bits)
    if lattice is not None:
        integers = [lattice.integers(part) for part in parts]
        decoded = [
            lattice.coordinates(rows, part.dtype)
            for rows, part in zip(integers, parts, strict=True)
        ]
        # Where the step is close to the resolution of the floats, the box or a point may move.
        if _box(decoded, bits) == lattice and all(
            np.array_equal(lattice.integers(part), rows)
            for part, rows in zip(decoded, integers, strict=True)
        ):
            return (Points(lattice, rows, np.zeros(0, np.int64)) for rows in integers)
    return (_lossless(part) for part in parts)


def _box(parts: Sequence[Floats], bits: int) -> BoxLattice | None:
    extremes = [_kernels.bounds(part.reshape(-1)) for part in parts if len(part)]
    if not extremes:
        return None
    # Adding zero turns -0.0 into 0.0: which of the two an extreme is depends on the order.
    x, y, z = (min(lows) + 0.0 for lows in zip(*(low for low, _ in extremes), strict=True))
    highs = (max(highs) for highs in zip(*(high for _, high in extremes), strict=True))
    side = max(high - low for high, low in zip(highs, (x, y, z), strict=True)) + 0.0
    return BoxLattice(bits, (x, y, z), side) if math.isfinite(side) else None


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
