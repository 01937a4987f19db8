"""Lattice coordinates <-> the position stream, along a surface that both sides know."""

import enum
from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, threads
from ebz.codec.lattice import FloatLattice, Integers, Lattice, Points, SingleLattice
from ebz.codec.listing import Listing, listed
from ebz.codec.polygons import Cut
from ebz.codec.surface import Surface

Int32s = npt.NDArray[np.int32]


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


# What is tried too for so few points that it takes no time to speak of, but where speed is all.
NEXT = {Method.MEDIUM: Method.LIGHT, Method.LIGHT: Method.STRONG}
MAX_FEW = 1024

# Where the light method takes fewer bits a point, the first of these is tried too: strong on
# regular grids, medium on sheets that are as smooth.
OTHERS = {Method.STRONG: 1, Method.MEDIUM: 2}

# Those that are tried; of the other methods the first.
CUTS = {Method.LIGHT: (Cut.COMPLETING, Cut.TWICE), Method.STRONG: tuple(Cut)}
MAX_TWICE = (2**31 - 1) // 6  # triangles of which half-edges of twice as many have 31 bits


class Coding(NamedTuple):
    """How the positions of a mesh are coded; cut: of polygons; is_listed: as numbers in a list."""

    method: Method
    cut: Cut = Cut.COMPLETING
    is_listed: bool = False


class Along(NamedTuple):
    """The triangles along which positions are predicted.

    opposite, vertex: (3t,) the half-edge across and the vertex of each corner.  order: (n,) the
    site of each vertex; None where they are numbered alike.
    """

    opposite: Int32s
    vertex: Int32s
    n_vertices: int
    order: Int32s | None = None

    @property
    def arrays(self) -> tuple[Int32s, Int32s, int]:
        """What the kernels take."""
        return self.opposite, self.vertex, self.n_vertices


class Coded(NamedTuple):
    """The stream, and the list of the integers of which it says which are where, if any."""

    data: bytes
    coding: Coding
    listing: Listing | None = None

    @property
    def size(self) -> int:
        """The bytes of both."""
        return len(self.data) + (self.listing.size if self.listing else 0)


def encode(
    surface: Surface, points: Points, n_along: int, dtype: np.dtype[Any], method: Method
) -> Coded:
    """The shortest stream by the method, or by those that suit such points.

    n_along: how many points are coded, the first; those past the surface have no neighbours.
    """
    values = points.integers[:n_along]
    plain = partial(_first, surface, values, _candidates(points, dtype, method))
    found = listed(values)
    if found is None:
        return _at_last(surface, values, plain())
    listing, which = found
    first = _first(surface, which, _with_next(method, n_along))
    # A list of a third of many points' stream or less pays, but on regular grids, which need none.
    is_long = 3 * listing.size > first.size
    if n_along <= MAX_FEW or is_long or _is_regular(first, n_along):
        other = plain()
        if _is_regular(other, n_along) or other.size <= first.size + listing.size:
            return _at_last(surface, values, other)
    coded = _at_last(surface, which, first)
    return Coded(coded.data, coded.coding._replace(is_listed=True), listing)


def _first(surface: Surface, values: Integers, methods: Sequence[Method]) -> Coded:
    """The shortest by these methods."""
    best = min(_each(surface, values, methods), key=_size)
    if not best.data:  # more than the 32 bits of the fast and medium methods
        return _first(surface, values, [Method.LIGHT])
    return best


def _at_last(surface: Surface, values: Integers, first: Coded) -> Coded:
    """What is smooth or regular is coded by another method too, which may take far less."""
    other = next((x for x, bits in OTHERS.items() if _takes_less(first, bits, len(values))), None)
    tried = [] if other is None else _each(surface, values, [other])
    return min([first, *(coded for coded in tried if coded.data)], key=_size)


def _is_regular(coded: Coded, n: int) -> bool:
    return _takes_less(coded, OTHERS[Method.STRONG], n)


def _takes_less(coded: Coded, bits: int, n: int) -> bool:
    """Whether the light method takes less than so many bits a point."""
    return coded.coding.method == Method.LIGHT and 8 * len(coded.data) < bits * n


def _each(surface: Surface, values: Integers, methods: Sequence[Method]) -> list[Coded]:
    def by(chosen: Coding) -> Coded:
        along = _along(surface, len(values), chosen.cut)
        placed = values if along.order is None else values[along.order]
        flat = placed.reshape(-1)
        return Coded(_kernels.encode_positions(*along.arrays, flat, chosen.method), chosen)

    return threads.run(by, _cuts(surface, methods))


def _size(coded: Coded) -> int:
    return coded.size


def decode(coded: Coded, surface: Surface, n_vertices: int) -> npt.NDArray[Any]:
    """(n, 3) int32 or int64 coordinates; raises CorruptError where one is not in the list.

    Without a list some come back, whatever the bytes are.
    """
    along = _along(surface, n_vertices, coded.coding.cut)
    decoded = _decode(coded.data, along, coded.coding.method)
    if coded.listing is not None:
        decoded = coded.listing.at(decoded)
    if along.order is None:
        return decoded
    values = np.empty(decoded.shape, decoded.dtype)
    values[along.order] = decoded
    return values


def _decode(stream: bytes, along: Along, method: Method) -> npt.NDArray[Any]:
    if method == Method.FAST:
        return _kernels.decode_positions_fast(stream, *along.arrays)
    if method == Method.MEDIUM:
        return _kernels.decode_positions_medium(stream, *along.arrays)
    return _kernels.decode_positions(stream, *along.arrays, method).reshape(-1, 3)


def can_cut(n_triangles: int, way: Cut) -> bool:
    """Whether the kernels can number the half-edges of so many triangles."""
    return way != Cut.TWICE or n_triangles <= MAX_TWICE


def _cuts(surface: Surface, methods: Sequence[Method]) -> list[Coding]:
    """The methods with each way to cut polygons that is tried for them."""
    if surface.polygons is None:
        return [Coding(method) for method in methods]
    n_triangles = len(surface.opposite) // 3
    return [
        Coding(method, way)
        for method in methods
        for way in CUTS.get(method, (Cut.COMPLETING,))
        if can_cut(n_triangles, way)
    ]


def _along(surface: Surface, n_vertices: int, way: Cut) -> Along:
    """Of n vertices, those of the surface first."""
    if surface.polygons is None:
        return Along(surface.opposite, surface.vertex, n_vertices)
    is_usual = way == Cut.COMPLETING
    triangles = surface.triangles if is_usual else surface.cut(way)
    vertex, order = triangles.numbered(surface.vertex, n_vertices, as_they_are=True)
    return Along(triangles.opposite, vertex, n_vertices, order)


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
    in_integers = method in (Method.FAST, Method.MEDIUM)
    methods = [method] if in_integers else [in_floats, method]
    return methods + _with_next(method, len(points.integers))[1:]


def _with_next(method: Method, n: int) -> list[Method]:
    """Of n points, the method, and the next one where they are few."""
    return [method, NEXT[method]] if n <= MAX_FEW and method in NEXT else [method]
