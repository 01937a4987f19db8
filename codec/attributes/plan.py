"""How the entries of one attribute are coded: what its stream does not say."""

import enum
from dataclasses import dataclass, field

from ebz.codec.attributes.lattices import IntegerLattice, Lossless
from ebz.codec.attributes.lossy import Lossy

Lattice = Lossless | Lossy


class Method(enum.IntEnum):
    """The numbers are those of Method in kernels/attributes."""

    NUMBERS = 0
    SYMBOLS = 1


class Relation(enum.IntEnum):
    """What components have to do with each other; numbers as in kernels/attributes."""

    NONE = 0
    UNIT = 1
    SUM = 2


class Guess(enum.IntEnum):
    """What entries are expected to be: normals of the faces around, in a mean of some weights."""

    NONE = 0
    AREA = 1
    ANGLE = 2
    UNIFORM = 3
    INVERTED = 4  # to be added to one of the above: the other side of the surface
    INVERTED_AREA = 5
    INVERTED_ANGLE = 6
    INVERTED_UNIFORM = 7


@dataclass(frozen=True)
class Plan:
    """Values -> integers of the lattice -> labels -> stream.

    specials: little-endian bits of values beside the lattice, which have the integers from
    special_start on.  labels: stream of the n_labels integers that occur, in ascending order; where
    there are some, what is coded is which of them.  total: of the relation, in the lattice's steps.
    """

    lattice: Lattice = field(default_factory=IntegerLattice)
    method: Method = Method.NUMBERS
    relation: Relation = Relation.NONE
    total: float = 0.0
    guess: Guess = Guess.NONE
    special_start: int = 0
    specials: bytes = b""
    n_labels: int = 0
    labels: bytes = b""
