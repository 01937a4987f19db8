"""Unit vectors as points of a square: the octahedron unfolded.

Reference: Z. Cigolle et al., "A survey of efficient representations for independent unit vectors",
2014.  Only + - * / and square roots, so that every machine decodes the same vectors.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.lattice import Integers

NORMAL_BITS = range(2, 17)
# Vectors as short or long as these have no direction that doubles can tell.
SHORTEST, LONGEST = 1e-100, 1e100


@dataclass(frozen=True)
class Octahedral:
    """(2^bits - 1)^2 directions; the axes are among them."""

    bits: int
    kind = "octahedral"

    @property
    def last(self) -> int:
        """The integer of the square's upper end; the lower end is 0."""
        return (1 << self.bits) - 2

    @property
    def allowed_error(self) -> float:
        """How far a component of the unit vector may move."""
        # Half a step of 2 / last in both directions moves the third by a step: 1.23 steps on the
        # octahedron, which is at least 1 / sqrt(3) from the origin.
        return 1.23 * math.sqrt(3) * 2 / self.last

    def integers(self, vectors: npt.NDArray[Any]) -> Integers:
        """(n, 2) of (n, 3) unit vectors."""
        once = self._rounded(vectors.astype(np.float64))
        # Along the folds two points are one vector: the one that this vector has.
        return self._rounded(self._vectors(once).astype(vectors.dtype).astype(np.float64))

    def values(self, integers: Integers, dtype: np.dtype[Any]) -> npt.NDArray[Any]:
        """(n, 3) unit vectors of (n, 2) integers."""
        return self._vectors(integers).astype(dtype)

    def positions(self, vectors: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """(n, 2) of (n, 3) unit vectors, before rounding."""
        x, y, z = vectors.T
        size = np.abs(x) + np.abs(y) + np.abs(z)
        size = np.where(np.isfinite(size) & (size > 0), size, 1.0)
        u, v = np.nan_to_num(x / size), np.nan_to_num(y / size)
        below = z < 0
        folded_u = np.where(u >= 0, 1.0, -1.0) * (1 - np.abs(v))
        folded_v = np.where(v >= 0, 1.0, -1.0) * (1 - np.abs(u))
        square = np.stack([np.where(below, folded_u, u), np.where(below, folded_v, v)], axis=1)
        on_lattice: npt.NDArray[np.float64] = (square + 1) * (self.last / 2)
        return on_lattice

    def _rounded(self, vectors: npt.NDArray[np.float64]) -> Integers:
        return np.rint(self.positions(vectors)).astype(np.int64)

    def _vectors(self, integers: Integers) -> npt.NDArray[np.float64]:
        u, v = (np.clip(integers, 0, self.last) / (self.last / 2) - 1).T
        z = 1 - np.abs(u) - np.abs(v)
        below = np.where(z < 0, -z, 0.0)
        x, y = u - np.where(u >= 0, below, -below), v - np.where(v >= 0, below, -below)
        size = np.sqrt(x * x + y * y + z * z)
        return np.stack([x / size, y / size, z / size], axis=1)


def have_direction(vectors: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """Which of (n, 3) vectors are finite and not zero."""
    wide = np.abs(vectors.astype(np.float64))
    largest = wide.max(axis=1, initial=0)
    return np.asarray(np.isfinite(wide).all(axis=1) & (largest > SHORTEST) & (largest < LONGEST))
