"""Normals of the surface: what entries that are directions are expected to be.

Reference: N. Max, "Weights for computing vertex normals from facet normals", 1999, lists the means.
Only + - * / and square roots of doubles in a fixed order, so that every machine has the same.
"""

import numpy as np
import numpy.typing as npt

from ebz.codec.attributes.items import Items
from ebz.codec.attributes.lattices import IntegerLattice
from ebz.codec.attributes.octahedral import Octahedral
from ebz.codec.attributes.plan import Guess, Plan, Relation
from ebz.codec.lattice import Integers

Vectors = npt.NDArray[np.float64]
MEANS = (Guess.AREA, Guess.ANGLE, Guess.UNIFORM)
# Halvings before the series of the arc tangent: its argument is below 0.2 then.
HALVINGS, TERMS = 3, 12


def best(plan: Plan, values: npt.NDArray[np.generic], items: Items) -> Guess:
    """The normals nearest to the entries; NONE where they are no directions, or there are none."""
    is_direction = plan.relation == Relation.UNIT or isinstance(plan.lattice, Octahedral)
    if not is_direction or not items.has_surface:
        return Guess.NONE
    wide = np.nan_to_num(values.astype(np.float64), posinf=0, neginf=0)
    errors = {}
    for guess in MEANS if items.is_by_corner else (Guess.UNIFORM,):
        normals = _normals(guess, items)
        sides = [np.abs(wide / _scale(plan) - sign * normals).mean() for sign in (1, -1)]
        errors[guess], errors[Guess(guess + Guess.INVERTED)] = sides
    return min(errors, key=lambda guess: errors[guess])


@np.errstate(all="ignore")
def integers(plan: Plan, dtype: np.dtype[np.generic], items: Items) -> Integers:
    """(n, components) of the guess, on the plan's lattice."""
    inverted = plan.guess > Guess.INVERTED
    normals = _normals(Guess(plan.guess - Guess.INVERTED * inverted), items)
    normals = -normals if inverted else normals
    if isinstance(plan.lattice, IntegerLattice):
        return np.rint(normals * plan.total).astype(np.int64)
    return plan.lattice.integers(normals.astype(dtype))


def _scale(plan: Plan) -> float:
    return plan.total if isinstance(plan.lattice, IntegerLattice) else 1.0


@np.errstate(all="ignore")
def _normals(guess: Guess, items: Items) -> Vectors:
    """(n, 3) unit vectors; zeros where there is no direction."""
    a, b, c = (items.corner_points[i::3] for i in range(3))
    faces = np.cross(b - a, c - a)
    if guess != Guess.AREA:
        faces = _unit(faces)
    if not items.is_by_corner:
        return faces
    by_corner = np.repeat(faces, 3, axis=0)
    if guess == Guess.ANGLE:
        by_corner *= _angles(items.corner_points)[:, None]
    by_corner = np.where(np.isfinite(by_corner), by_corner, 0.0)
    columns = [np.bincount(items.item, by_corner[:, d], items.n) for d in range(3)]
    return _unit(np.stack(columns, axis=1))


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
