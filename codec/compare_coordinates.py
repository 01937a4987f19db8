"""How far coordinates of a decoded mesh are from those of the original, and how far they may be."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.fitting import Precision, fit
from ebz.codec.lattice import BoxLattice, GridLattice, Lattice, Points, StepLattice, restore
from ebz.codec.mesh import Mesh


def allowed_error(lattice: Lattice, original: Mesh) -> float:
    """How far a coordinate may move, in model units."""
    if isinstance(lattice, StepLattice):
        return lattice.max_error
    largest = float(np.abs(original.vertices).max(initial=0))
    if isinstance(lattice, BoxLattice):
        reach = largest + lattice.side
    elif isinstance(lattice, GridLattice):
        reach = 2 * largest + max(map(abs, lattice.origin))
    else:
        return 0.0
    # Half a step, half the spacing of the floats there, and a few roundings of doubles.
    floats, doubles = np.finfo(original.vertices.dtype), np.finfo(np.float64)
    spacing = float(floats.eps) * largest + float(floats.eps) * lattice.step
    rounding = 4 * float(doubles.eps) * reach
    return lattice.step / 2 + spacing / 2 + rounding + float(floats.smallest_subnormal)


def as_stored(vertices: npt.NDArray[Any], lattice: Lattice) -> npt.NDArray[Any]:
    """The coordinates that compressing at the same precision would store."""
    return restored(points_of(vertices, lattice), vertices)


def points_of(vertices: npt.NDArray[Any], lattice: Lattice) -> Points:
    """The points of compressing at the same precision."""
    if np.isfinite(vertices).all():
        if isinstance(lattice, GridLattice):
            return fit(vertices, Precision(grid=lattice))
        if isinstance(lattice, BoxLattice):
            return Points(lattice, lattice.integers(vertices), np.zeros(0, np.int64))
        if isinstance(lattice, StepLattice):
            return fit(vertices, Precision(max_error=lattice.max_error))
    return fit(vertices)


def restored(points: Points, vertices: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The coordinates that decoding yields."""
    return restore(points, vertices.dtype, vertices.reshape(-1)[points.exceptions])


def errors(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> dict[str, float]:
    """The largest distance per coordinate, and the root mean square per vertex."""
    error = distances(got, source)
    largest = float(error.max(initial=0.0))
    # Scaled, so that no square overflows.
    scaled = error / largest if np.isfinite(largest) and largest > 0 else np.zeros_like(error)
    rms = largest * float(np.sqrt((scaled**2).sum() / len(error))) if len(error) else 0.0
    return {"largest_error": largest, "rms_error": rms}


@np.errstate(all="ignore")
def distances(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Per coordinate; zero where the bits are the same."""
    distances: npt.NDArray[np.float64] = np.abs(got.astype(np.float64) - source.astype(np.float64))
    distances[_same_bits(got, source)] = 0.0
    return distances


def moved(got: npt.NDArray[Any], source: npt.NDArray[Any], allowed: float) -> str | None:
    """The first coordinate that is farther off than allowed."""
    same = _same_bits(got, source)
    if allowed:
        same |= distances(got, source) <= allowed
    if same.all():
        return None
    row, axis = np.argwhere(~same)[0]
    values = f"{got[row, axis]!r}, not {source[row, axis]!r}"
    return f"vertex {row} of the decoded mesh: {'xyz'[axis]} is {values}"


def _same_bits(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    bits = f"u{got.dtype.itemsize}"
    return np.asarray(
        np.ascontiguousarray(got).view(bits) == np.ascontiguousarray(source).view(bits)
    )
