"""Surfaces by construction: embedded grids, boundaries of voxels, Delaunay flips.

Positions use + - * / and sqrt only, so that they are the same bits on every machine.
"""

import math
from collections import deque
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.sample import circle, glued_grid, uniform

Array = npt.NDArray[Any]
Surface = tuple[Array, Array]


def cylinder(n_rows: int, n_columns: int) -> Surface:
    row, column, faces = glued_grid(n_rows, n_columns, "open", "join")
    cos, sin = circle(column / n_columns)
    return np.stack([cos, sin, 2 * row / n_rows], axis=1), faces


def annulus(n_rows: int, n_columns: int) -> Surface:
    row, column, faces = glued_grid(n_rows, n_columns, "open", "join")
    cos, sin = circle(column / n_columns)
    radius = 2 - row / n_rows
    return np.stack([radius * cos, radius * sin, 0 * radius], axis=1), faces


def moebius_strip(n_rows: int, n_columns: int) -> Surface:
    row, column, faces = glued_grid(n_rows, n_columns, "open", "twist")
    across = 0.6 * row / n_rows - 0.3
    (cos, sin), (half_cos, half_sin) = circle(column / n_columns), circle(column / n_columns / 2)
    radius = 1 + across * half_cos
    return np.stack([radius * cos, radius * sin, across * half_sin], axis=1), faces


def klein_bottle(n_rows: int, n_columns: int) -> Surface:
    """The figure-eight immersion: a lemniscate that makes half a turn on its way around."""
    row, column, faces = glued_grid(n_rows, n_columns, "join", "twist")
    (cos, sin), (half_cos, half_sin) = circle(column / n_columns), circle(column / n_columns / 2)
    once, twice = circle(row / n_rows)[1], circle(2 * row / n_rows)[1]
    radius = 2 + half_cos * once - half_sin * twice
    height = half_sin * once + half_cos * twice
    return np.stack([radius * cos, radius * sin, height], axis=1), faces


def trefoil(n_rows: int, n_columns: int, seed: int) -> Surface:
    """A bumpy tube along a trefoil knot with irregular, locally Delaunay connectivity."""
    row, column, faces = glued_grid(n_rows, n_columns, "join", "join")
    jitter = 0.7 * (uniform(seed, (2, len(row))) - 0.5)
    t, s = (column + jitter[0]) / n_columns, (row + jitter[1]) / n_rows
    (cos2, sin2), (cos3, sin3), (cos, sin) = circle(2 * t), circle(3 * t), circle(s)
    ring = 2 + cos3
    centre = np.stack([ring * cos2, ring * sin2, sin3], axis=1)
    normal = np.stack([cos3 * cos2, cos3 * sin2, sin3], axis=1)
    tangent = np.stack(
        [-3 * sin3 * cos2 - 2 * ring * sin2, -3 * sin3 * sin2 + 2 * ring * cos2, 3 * cos3], axis=1
    )
    x, y, z = tangent.T
    binormal = np.cross(tangent / np.sqrt(x * x + y * y + z * z)[:, None], normal)
    radius = 0.42 + 0.03 * circle(15 * t)[0] * circle(3 * s)[0] + 0.02 * circle(7 * t + s)[1]
    vertices = centre + (radius * cos)[:, None] * normal + (radius * sin)[:, None] * binormal
    return vertices, delaunay_flips(vertices, faces[:, ::-1])


def voxels(filled: npt.ArrayLike) -> Surface:
    """The boundary of a set of unit cubes; cubes that only touch at edges or corners share them."""
    inside = np.pad(np.asarray(filled, bool), 1)
    index: dict[tuple[int, ...], int] = {}
    faces = []
    for cell in np.argwhere(inside):
        for axis in range(3):
            for side in (0, 1):
                step = np.eye(3, dtype=int)[axis] * (2 * side - 1)
                if not inside[tuple(cell + step)]:
                    quad = [tuple(map(int, corner)) for corner in _quad(cell, axis, side)]
                    a, b, c, d = (index.setdefault(corner, len(index)) for corner in quad)
                    faces += [(a, b, c), (a, c, d)]
    return np.array(list(index), float) - 1, np.array(faces)


def _quad(cell: Array, axis: int, side: int) -> list[Array]:
    unit = np.eye(3, dtype=int)
    u, v = unit[(axis + 1) % 3], unit[(axis + 2) % 3]
    if not side:
        u, v = v, u
    corner = cell + side * unit[axis]
    return [corner, corner + u, corner + u + v, corner + v]


def slab(n_holes: int, fineness: int) -> Surface:
    """A slab of cubes with a row of square holes: a surface of genus `n_holes`."""
    plan = np.ones((2 * n_holes + 1, 3), bool)
    plan[1::2, 1] = False
    return voxels(np.kron(plan[:, :, None], np.ones((fineness,) * 3, bool)))


def relax(surface: Surface, n_rounds: int) -> Surface:
    """Moves every vertex halfway to the mean of its neighbours, again and again."""
    vertices, faces = surface
    start = faces.ravel()
    end = faces[:, [1, 2, 0]].ravel()
    degree = np.bincount(start, minlength=len(vertices))
    for _ in range(n_rounds):
        sums = [np.bincount(start, vertices[end, axis], len(vertices)) for axis in range(3)]
        vertices = (vertices + np.stack(sums, axis=1) / degree[:, None]) / 2
    return vertices, faces


def delaunay_flips(vertices: Array, faces: Array) -> Array:
    """The faces after flipping edges of a closed surface until the angles opposite sum to <= pi."""
    opposite: dict[tuple[int, int], int] = {}
    for a, b, c in faces.tolist():
        opposite |= {(a, b): c, (b, c): a, (c, a): b}
    points = vertices.tolist()
    pending = deque(edge for edge in opposite if edge[0] < edge[1])
    # In the plane flips come to an end; on a curved surface only the bound says so.
    for _ in range(50 * len(opposite)):
        if not pending:
            break
        a, b = pending.popleft()
        if (a, b) not in opposite:
            continue
        c, d = opposite[a, b], opposite[b, a]
        if (c, d) in opposite or (d, c) in opposite or not _obtuse(points, a, b, c, d):
            continue
        del opposite[a, b], opposite[b, a]
        opposite |= {(a, d): c, (d, c): a, (c, a): d, (b, c): d, (c, d): b, (d, b): c}
        pending.extend([(a, d), (d, b), (b, c), (c, a)])
    return np.array([(a, b, c) for (a, b), c in opposite.items() if a < min(b, c)])


def _obtuse(points: list[list[float]], a: int, b: int, c: int, d: int) -> bool:
    return (
        _cotangent(points[a], points[b], points[c]) + _cotangent(points[a], points[b], points[d])
        < -1e-9
    )


def _cotangent(a: Iterable[float], b: Iterable[float], apex: Iterable[float]) -> float:
    ux, uy, uz = (x - y for x, y in zip(a, apex, strict=True))
    vx, vy, vz = (x - y for x, y in zip(b, apex, strict=True))
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return (ux * vx + uy * vy + uz * vz) / math.sqrt(x * x + y * y + z * z)


def compact(vertices: Array, faces: Array) -> Surface:
    """Without the vertices that no face uses."""
    used, index = np.unique(faces, return_inverse=True)
    return vertices[used], index.reshape(-1, 3)
