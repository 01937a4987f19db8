"""Values beside the lattice (what is not finite, the rare miss) -> integers beyond its own."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.attributes import lattices
from ebz.codec.attributes.lattices import Values
from ebz.codec.attributes.lossy import Box, Shares, Step
from ebz.codec.attributes.octahedral import Octahedral, have_direction
from ebz.codec.attributes.plan import Lattice, Plan
from ebz.codec.errors import CorruptError
from ebz.codec.lattice import Integers

# Beyond these and one in 64, exact bits cost less.
MAX_SPECIALS = 256


@np.errstate(all="ignore")
def integers(values: Values, lattice: Lattice) -> tuple[Plan, Integers]:
    """A plan and the (n, components) integers of (n, components) values."""
    found = lattice.integers(values)
    words, off = _beside(values, found, lattice)
    if not off.any():
        return Plan(lattice), found
    patterns, which = np.unique(words[off], return_inverse=True)
    if len(patterns) > max(MAX_SPECIALS, words.size >> lattices.MISSES_SHIFT):
        exact = lattices.exact(values.dtype)
        return Plan(exact), exact.integers(values)
    if isinstance(lattice, Octahedral):
        start = lattice.last + 1
        found[off] = np.stack([start + which, np.zeros_like(which)], axis=1)
    else:
        start = int(found[~off].max(initial=0)) + 1
        found[off] = start + which
    return Plan(lattice, special_start=start, specials=patterns.tobytes()), found


@np.errstate(all="ignore")
def values(integers: Integers, plan: Plan, dtype: np.dtype[Any]) -> Values:
    """The values of (n, components) integers; raises CorruptError."""
    found = plan.lattice.values(integers, dtype)
    if not plan.specials:
        return found
    is_row = isinstance(plan.lattice, Octahedral)
    size = dtype.itemsize * (3 if is_row else 1)
    if len(plan.specials) % size:
        raise CorruptError(f"{len(plan.specials)} bytes of special values of {size} bytes")
    exact = np.frombuffer(plan.specials, dtype.newbyteorder("<")).astype(dtype)
    exact = exact.reshape(-1, 3) if is_row else exact
    which = (integers[:, 0] if is_row else integers) - plan.special_start
    off = (which >= 0) & (which < len(exact))
    found[off] = exact[which[off]]
    return found


def _beside(
    values: Values, found: Integers, lattice: Lattice
) -> tuple[npt.NDArray[Any], npt.NDArray[np.bool_]]:
    """The bits of values (of entries that are directions), and which are not on the lattice."""
    little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    if isinstance(lattice, Octahedral):
        rows = little.view(np.dtype((np.void, 3 * values.dtype.itemsize)))
        return rows[:, 0], ~have_direction(values)
    words = lattices.bits(little)
    if isinstance(lattice, Box | Step | Shares):
        return words, ~np.isfinite(values.astype(np.float64))
    return words, lattices.bits(lattice.values(found, values.dtype)) != lattices.bits(values)
