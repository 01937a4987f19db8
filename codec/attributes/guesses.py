"""Normals of the surface: what entries that are directions are expected to be.

Reference: N. Max, "Weights for computing vertex normals from facet normals", 1999, lists the means.
Only + - * / and square roots of doubles in a fixed order, so that every machine has the same.
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
# Halvings before the series of the arc tangent: its argument is below 0.2 then.
HALVINGS, TERMS = 3, 12


@np.errstate(all="ignore")
def best(plan: Plan, values: npt.NDArray[Any], items: Items) -> Guess:
    """The normals nearest to the entries; NONE where there are none, or they are no directions."""
    if values.shape[1] != 3 or values.dtype.kind not in "fi" or not items.has_surface:
        return Guess.NONE
    is_direction = plan.relation in (Relation.UNIT, Relation.OCTAHEDRAL)
    wide = np.nan_to_num(values.astype(np.float64), posinf=0, neginf=0) / _scale(plan)
    errors = {Guess.NONE: np.inf if is_direction else CONVINCING * np.abs(wide).mean()}
    offs: dict[Guess, Vectors] = {}
    for weights in WEIGHTS if items.is_by_corner else WEIGHTS[:1]:
        for length in (Guess.NONE,) if is_direction else (Guess.NONE, Guess.SUM):
            guess = Guess.NORMALS | weights | length
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


@np.errstate(all="ignore")
def _normals(guess: Guess, items: Items) -> Vectors:
    """(n, 3), zeros where there is no direction."""
    faces = items.face_products
    if Guess.AREA not in guess:
        faces = _unit(faces)
    if not items.is_by_corner:
        return faces
    by_corner = np.repeat(faces, 3, axis=0)
    if Guess.ANGLE in guess:
        by_corner *= _angles(items.corner_points)[:, None]
    by_corner = np.where(np.isfinite(by_corner), by_corner, 0.0)
    columns = [np.bincount(items.item, by_corner[:, d], items.n) for d in range(3)]
    sums = np.stack(columns, axis=1).astype(np.float64)
    return sums if Guess.SUM in guess else _unit(sums)


def _unit(vectors: Vectors) -> Vectors:
    x, y, z = vectors.T
    length = np.sqrt(x * x + y * y + z * z)
    usable = np.isfinite(length) & (length > 0)
    return np.where(usable[:, None], vectors / np.where(usable, length, 1.0)[:, None], 0.0)


def _angles(corners: Vectors) -> Vectors:
    """The angle at each corner of triangles, (3m, 3)."""
    by_face = corners.reshape(-1, 3, 3)
    u = (np.roll(by_face, -1, axis=1) - by_face).reshape(-1, 3)
    v = (np.roll(by_face, 1, axis=1) - by_face).reshape(-1, 3)
    u, v = _unit(u), _unit(v)
    x, y, z = np.cross(u, v).T
    sine = np.sqrt(x * x + y * y + z * z)
    cosine = u[:, 0] * v[:, 0] + u[:, 1] * v[:, 1] + u[:, 2] * v[:, 2]
    # The tangent of half the angle; opposite directions make almost half a turn.
    half = sine / np.maximum(1 + cosine, 1e-12)
    for _ in range(HALVINGS):
        half = half / (1 + np.sqrt(1 + half * half))
    square, arc = half * half, np.zeros_like(half)
    for term in reversed(range(TERMS)):
        arc = 1 / (2 * term + 1) - square * arc
    angles: Vectors = 2 ** (HALVINGS + 1) * half * arc
    return angles
