"""How the entries of one attribute are coded: what its stream does not say."""

import enum
from typing import NamedTuple

from ebz.codec.attributes.lattices import IntegerLattice, Lossless
from ebz.codec.attributes.lossy import Lossy

Lattice = Lossless | Lossy


class Method(enum.IntEnum):
    """The numbers are those of Method in kernels/attributes."""

    NUMBERS = 0
    SYMBOLS = 1
    FAST = 2


class Effort(enum.IntEnum):
    """What decoding may take."""

    FAST = 0  # few operations a value, but for labels and float64
    MEDIUM = 1  # more for floats
    FULL = 2


class Relation(enum.IntEnum):
    """What components have to do with each other; numbers as in kernels/attributes."""

    NONE = 0
    UNIT = 1
    SUM = 2
    OCTAHEDRAL = 3


class Guess(enum.IntFlag, boundary=enum.STRICT):
    """Normals as means of those of the faces around: equal weights, by area or by angle.

    INVERTED: of the other side.  SUM: with the length that sums with such weights have.
    HEIGHTS: corrected by how far vertices seem to lie above or below where they were.
    CORNERS: not of polygons, but at each of their corners of the edges there.
    """

    NONE = 0
    NORMALS = 1
    AREA = 2
    ANGLE = 4
    INVERTED = 8
    SUM = 16
    HEIGHTS = 32
    CORNERS = 64


class Plan(NamedTuple):
    """Values -> integers of the lattice -> labels -> stream.

    specials: little-endian bits of values beside the lattice, which have the integers from
    special_start on.  labels: stream of the n_labels integers that occur, in ascending order; where
    there are some, what is coded is which of them.  total: of the relation, in the lattice's steps.
    in_source_order: entries are rows as the source has them, not along the surface.
    """

    lattice: Lattice = IntegerLattice()
    method: Method = Method.NUMBERS
    relation: Relation = Relation.NONE
    total: float = 0.0
    guess: Guess = Guess.NONE
    special_start: int = 0
    specials: bytes = b""
    n_labels: int = 0
    labels: bytes = b""
    in_source_order: bool = False
