"""Normals of the surface: what entries that are directions are expected to be.

codec/kernels/attributes/normals.hpp makes them.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.attributes.items import Items
from ebz.codec.attributes.lattices import IntegerLattice
from ebz.codec.attributes.plan import Guess, Plan, Relation

Vectors = npt.NDArray[np.float64]
WEIGHTS = (Guess.NONE, Guess.AREA, Guess.ANGLE)
# Where nothing says that entries are directions, a guess must be this good to be one.
CONVINCING = 0.3
# Closer to their entries in the middle, guesses do not suffer from positions that were rounded.
LEAST_ERROR = 1e-5


@np.errstate(all="ignore")
def best(plan: Plan, values: npt.NDArray[Any], items: Items) -> Guess:
    """The normals nearest to the entries; NONE where there are none, or they are no directions."""
    if values.shape[1] != 3 or values.dtype.kind not in "fi" or not items.has_surface:
        return Guess.NONE
    is_direction = plan.relation in (Relation.UNIT, Relation.OCTAHEDRAL)
    wide = np.nan_to_num(values.astype(np.float64), posinf=0, neginf=0) / _scale(plan)
    errors = {Guess.NONE: np.inf if is_direction else CONVINCING * np.abs(wide).mean()}
    offs: dict[Guess, Vectors] = {}
    for guess in _guesses(items, is_direction=is_direction):
        normals = _normals(guess, items)
        for side, off in ((Guess.NONE, wide - normals), (Guess.INVERTED, wide + normals)):
            offs[guess | side] = np.abs(off, out=off)
            errors[guess | side] = float(off.mean())
    guess = min(errors, key=lambda guess: errors[guess])
    if is_direction and items.is_by_corner and np.median(offs[guess].max(axis=1)) > LEAST_ERROR:
        guess |= Guess.HEIGHTS
    return guess


@np.errstate(all="ignore")
def positions(plan: Plan, items: Items) -> Vectors:
    """(n, components) of the guess, between the integers of the plan's lattice."""
    normals = _normals(plan.guess, items)
    normals = -normals if Guess.INVERTED in plan.guess else normals
    if isinstance(plan.lattice, IntegerLattice):
        return normals * _scale(plan)
    return plan.lattice.positions(normals)


def _scale(plan: Plan) -> float:
    is_integer = isinstance(plan.lattice, IntegerLattice) and plan.total
    return plan.total if is_integer else 1.0


def _guesses(items: Items, *, is_direction: bool) -> list[Guess]:
    """Those that differ; directions have length 1."""
    if not items.is_by_corner:
        weights = [Guess.NONE] if is_direction else [Guess.NONE, Guess.AREA]
        return [Guess.NORMALS | w for w in weights]
    weights = [*WEIGHTS, *(w | Guess.CORNERS for w in WEIGHTS if items.is_of_polygons)]
    lengths = [Guess.NONE] if is_direction else [Guess.NONE, Guess.SUM]
    return [Guess.NORMALS | w | length for w in weights for length in lengths]


def _normals(guess: Guess, items: Items) -> Vectors:
    """(n, 3), zeros where there is no direction."""
    return items.normals(
        by_area=Guess.AREA in guess,
        by_angle=Guess.ANGLE in guess,
        as_sums=Guess.SUM in guess,
        by_corner=Guess.CORNERS in guess,
    )
