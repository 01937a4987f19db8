"""What may be lost of each attribute."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from ebz.codec.attributes import lossy
from ebz.codec.attributes.lattices import Values
from ebz.codec.attributes.lossy import Lossy, Shares, Step
from ebz.codec.attributes.octahedral import NORMAL_BITS, Octahedral, have_direction

# Entries beside a lattice of directions (zeros, what is not finite) that are told apart.
MAX_SPECIAL_VECTORS = 256


# Bits, error, bits of a normal.
Asked = tuple[int | None, float | None, int | None]


NONE: Mapping[str, Any] = MappingProxyType({})


class AttributePrecision(NamedTuple):
    """bits, error: by attribute's name, whatever it belongs to.  normal_bits: of all normals."""

    bits: Mapping[str, int] = NONE
    error: Mapping[str, float] = NONE
    normal_bits: int | None = None

    def of(self, name: str) -> Asked:
        """What applies to an attribute."""
        bits, error = self.bits.get(name), self.error.get(name) or None
        if not is_name_of_normal(name):
            return bits, error, None
        if bits is None and error is None:
            return None, None, self.normal_bits
        return bits, error, _directions(bits, error)


def is_name_of_normal(name: str) -> bool:
    """Whether an attribute of this name holds normals, or one of their components."""
    return "normal" in name.lower() or name in ("nx", "ny", "nz")


def is_name_of_colour(name: str) -> bool:
    """Whether an attribute of this name holds colours."""
    return name in ("rgb", "rgba") or "color" in name.lower() or "colour" in name.lower()


def _directions(bits: int | None, error: float | None) -> int:
    """Bits of directions that are as precise as was asked, or as precise as can be."""
    if bits is not None:
        return min(max(bits, NORMAL_BITS[0]), NORMAL_BITS[-1])
    allowed = (n for n in NORMAL_BITS if Octahedral(n).allowed_error <= (error or 0.0))
    return next(allowed, NORMAL_BITS[-1])


def lattice_of(values: Values, asked: Asked) -> Lossy | None:
    """The lattice asked for; None: nothing is to be lost, or the lattice is finer than the values.

    values: (n, components).
    """
    bits, error, normal_bits = asked
    chosen: Lossy | None = None
    if normal_bits is not None and _are_directions(values):
        chosen = Octahedral(normal_bits)
        if error is not None and chosen.allowed_error > error:
            return None
    elif (bits is not None or error is not None) and lossy.adds_up(values):
        chosen = Shares(bits if bits is not None else _bits_for(error or 0.0))
    elif bits is not None:
        chosen = lossy.box(values, bits)
    elif error is not None:
        chosen = Step(error)
    return chosen if chosen is not None and lossy.fits(chosen, values) else None


def _are_directions(values: Values) -> bool:
    if values.shape[1] != 3 or values.dtype.kind != "f":
        return False
    others = values[~have_direction(values)]
    distinct = {row.tobytes() for row in others}
    return len(others) < len(values) and len(distinct) <= MAX_SPECIAL_VECTORS


def _bits_for(error: float) -> int:
    """The fewest bits of shares whose error is allowed."""
    for bits in range(1, lossy.MAX_BITS):
        if Shares(bits).allowed_error <= error:
            return bits
    return lossy.MAX_BITS
