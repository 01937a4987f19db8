"""Lattices <-> the last of the header's bytes: a number and parameters."""

import math
import struct
from dataclasses import astuple
from functools import cache
from typing import Any

from ebz.codec.errors import CorruptError, VersionError
from ebz.codec.lattice import (
    MAX_BITS,
    MAX_DIGITS,
    MAX_SINGLE_DIGITS,
    BoxLattice,
    DecimalLattice,
    FloatLattice,
    GridLattice,
    Lattice,
    SingleLattice,
    StepLattice,
)

# In the order of their numbers.
PARAMETERS = {
    FloatLattice: "",
    DecimalLattice: "B",
    BoxLattice: "B 3{corner} d",  # the corner is of the dtype of the coordinates
    StepLattice: "d",
    GridLattice: "3d d",
    SingleLattice: "B",
}
LATTICES = tuple(PARAMETERS)


def write(lattice: Lattice, itemsize: int) -> bytes:
    """The bytes; itemsize: of the coordinates."""
    number = LATTICES.index(type(lattice))
    return _parameters(number, itemsize).pack(number, *_flat(astuple(lattice)))


def read(data: bytes, itemsize: int) -> Lattice:
    """The lattice; raises CorruptError and VersionError, IndexError or struct.error at the end."""
    number = data[0]
    if number >= len(LATTICES):
        raise VersionError(f"header: unknown lattice {number}")
    parameters = _parameters(number, itemsize)
    if len(data) > parameters.size:
        raise CorruptError("the header goes on after its last field")
    return _checked(LATTICES[number], parameters.unpack(data)[1:], itemsize)


@cache
def _parameters(number: int, itemsize: int) -> struct.Struct:
    corner = "f" if itemsize == 4 else "d"
    return struct.Struct("<B" + PARAMETERS[LATTICES[number]].format(corner=corner))


def _flat(values: tuple[Any, ...]) -> list[Any]:
    return [x for value in values for x in (value if isinstance(value, tuple) else (value,))]


def _checked(kind: type[Lattice], values: tuple[Any, ...], itemsize: int) -> Lattice:
    """The lattice of these parameters; raises CorruptError where they make no sense."""
    if not all(map(math.isfinite, values)):
        raise CorruptError(f"a lattice of {values}, not all finite")
    first, last = (values[0], values[-1]) if values else (0, 0)
    if kind is BoxLattice:
        if not 1 <= first <= MAX_BITS:
            raise CorruptError(f"a lattice of {first} bits")
        return BoxLattice(first, values[1:4], last)
    if kind is DecimalLattice:
        if first > MAX_DIGITS[itemsize]:
            raise CorruptError(f"a lattice of {first} decimals")
        return DecimalLattice(first)
    if kind is SingleLattice:
        if itemsize != 8 or first > MAX_SINGLE_DIGITS:
            raise CorruptError(f"float32 of {first} digits in {itemsize} bytes")
        return SingleLattice(first)
    if kind is StepLattice:
        if first <= 0:
            raise CorruptError(f"a maximal error of {first}")
        return StepLattice(first)
    if kind is GridLattice:
        if last <= 0:
            raise CorruptError(f"a grid of step {last}")
        return GridLattice(values[:3], last)
    return FloatLattice()
