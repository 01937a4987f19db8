"""Facet normals of STL: computed from the corners, and whether a file's say anything else."""

from typing import Any

import numpy as np
import numpy.typing as npt

# Normals that deviate from the computed ones by no more than this, in sine of the angle, were
# computed too; rounding of the coordinates adds more the thinner the facet is.
SINE_TOLERANCE = 0.01
ROUNDING = 2.0**-20


def facet_normals(corners: npt.NDArray[Any]) -> npt.NDArray[np.float32]:
    """(m, 3) float32 unit normals of corners (m, 3, 3); zero where a facet has none."""
    unit, _ = _normals(corners)
    return unit.astype(np.float32)


def _normals(corners: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Unit normals and twice the areas, in float64."""
    with np.errstate(all="ignore"):
        points = corners.astype(np.float64)
        cross = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        length = np.sqrt((cross * cross).sum(axis=1))
        unit = np.where(length[:, None] > 0, cross / length[:, None], 0.0)
    unit[~np.isfinite(unit).all(axis=1)] = 0.0
    return unit, length


def follow_from(normals: npt.NDArray[Any], corners: npt.NDArray[Any]) -> bool:
    """Whether every normal is zero or points where its corners say, as well as they tell."""
    given = normals.astype(np.float64)
    with np.errstate(all="ignore"):
        length = np.sqrt((given * given).sum(axis=1))
        unit, area2 = _normals(corners)
        points = corners.astype(np.float64)
        size = np.abs(points - points[:, :1]).max(axis=(1, 2), initial=0)
        reach = np.abs(points).max(axis=(1, 2), initial=0)
        off = np.sqrt(((given / length[:, None] - unit) ** 2).sum(axis=1))
        allowed = SINE_TOLERANCE + ROUNDING * reach * size / area2
        follows = (length == 0) | (area2 == 0) | (off <= allowed)
    return bool(follows.all())
