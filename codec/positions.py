"""Lattice coordinates <-> the position stream, along a surface that both sides know."""

import enum
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, threads
from ebz.codec.connectivity import Surface
from ebz.codec.lattice import FloatLattice, Lattice, Points, SingleLattice


class Method(enum.IntEnum):
    """How positions are coded; the numbers are those of Method in the kernels."""

    FAST = 0
    LIGHT = 1
    STRONG = 2
    FLOAT32 = 3
    FLOAT64 = 4
    MEDIUM = 5


# Predictions in floats, for a lattice of floats.
FLOAT_METHODS = {4: Method.FLOAT32, 8: Method.FLOAT64}


# Where light takes fewer bits a point, values repeat so much that these may be shorter.
BELOW_LIGHT = {Method.MEDIUM: 7, Method.STRONG: 1}


def encode(
    surface: Surface, points: Points, n_along: int, dtype: np.dtype[Any], method: Method
) -> tuple[bytes, Method]:
    """The shortest stream by the method, or by those that suit such points.

    n_along: how many points are coded, the first; those past the surface have no neighbours.
    """
    values = points.integers[:n_along].reshape(-1)

    def by(chosen: Method) -> tuple[bytes, Method]:
        return _kernels.encode_positions(*_arrays(surface), n_along, values, chosen), chosen

    streams = threads.run(by, _candidates(points, dtype, method))
    stream, chosen = min(streams, key=_length)
    if not stream:  # more than the 32 bits of the fast and medium methods
        return encode(surface, points, n_along, dtype, Method.LIGHT)
    if chosen != Method.LIGHT:
        return stream, chosen
    n_bits = 8 * len(stream) / max(n_along, 1)
    others = [by(other) for other, few_bits in BELOW_LIGHT.items() if n_bits < few_bits]
    return min([(stream, chosen), *(other for other in others if other[0])], key=_length)


def _length(stream: tuple[bytes, Method]) -> int:
    return len(stream[0])


def decode(data: bytes, surface: Surface, n_vertices: int, method: Method) -> npt.NDArray[Any]:
    """(n, 3) int32 or int64 coordinates; whatever the bytes are, some come back."""
    stream = np.frombuffer(data, np.uint8)
    if method == Method.FAST:
        return _kernels.decode_positions_fast(stream, *_arrays(surface), n_vertices)
    if method == Method.MEDIUM:
        return _kernels.decode_positions_medium(stream, *_arrays(surface), n_vertices)
    values = _kernels.decode_positions(stream, *_arrays(surface), n_vertices, method)
    return values.reshape(-1, 3)


def _arrays(surface: Surface) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    return surface.opposite, surface.vertex


def float_method(lattice: Lattice, itemsize: int) -> Method | None:
    """The method that predicts in floats: None where the integers are no floats."""
    if isinstance(lattice, SingleLattice):
        return Method.FLOAT32
    return FLOAT_METHODS[itemsize] if isinstance(lattice, FloatLattice) else None


def _candidates(points: Points, dtype: np.dtype[Any], method: Method) -> Sequence[Method]:
    """Floats of 32 bits, by their order, are integers that every method can predict."""
    in_floats = float_method(points.lattice, dtype.itemsize)
    if in_floats is None:
        return [method]
    if in_floats == Method.FLOAT64:
        return [in_floats]
    return [method] if method in (Method.FAST, Method.MEDIUM) else [in_floats, method]
