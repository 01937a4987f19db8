"""Polygon meshes by construction."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.sample import circle, sphere

Polygons = tuple[npt.NDArray[Any], list[list[int]]]


def quad_torus(n_rows: int, n_columns: int) -> Polygons:
    row, column = np.divmod(np.arange(n_rows * n_columns), n_columns)
    (cos_u, sin_u), (cos_v, sin_v) = circle(column / n_columns), circle(row / n_rows)
    radius = 1 + 0.4 * cos_v
    vertices = np.stack([radius * cos_u, radius * sin_u, 0.4 * sin_v], axis=1)
    right, up = (column + 1) % n_columns, (row + 1) % n_rows
    corners = [(row, column), (row, right), (up, right), (up, column)]
    return vertices, np.stack([r * n_columns + c for r, c in corners], axis=1).tolist()


def mixed_sphere(n_triangles: int) -> Polygons:
    """Pentagons where twelve vertices of valence 5 were, quads of some pairs of triangles."""
    mesh = sphere(n_triangles)
    faces = mesh.faces.tolist()
    rings: list[dict[int, int]] = [{} for _ in range(12)]
    rest = []
    for a, b, c in faces:
        first, then, last = min((a, b, c), (b, c, a), (c, a, b))
        if first < 12:
            rings[first][then] = last
        else:
            rest.append([first, then, last])
    pentagons = [_cycle(ring) for ring in rings]
    polygons = pentagons + _paired(rest)
    return mesh.vertices[12:], [[corner - 12 for corner in face] for face in polygons]


def _cycle(following: dict[int, int]) -> list[int]:
    cycle = [min(following)]
    while following[cycle[-1]] != cycle[0]:
        cycle.append(following[cycle[-1]])
    return cycle


def _paired(triangles: list[list[int]]) -> list[list[int]]:
    """Every third triangle makes a quad with one across an edge, where that is free."""
    behind = {(t[i - 1], t[i]): f for f, t in enumerate(triangles) for i in range(3)}
    taken: set[int] = set()
    quads = []
    for f in range(0, len(triangles), 3):
        a, b, c = triangles[f]
        g = behind.get((b, a))
        if f in taken or g is None or g in taken:
            continue
        (tip,) = set(triangles[g]) - {a, b}
        quads.append([a, tip, b, c])
        taken |= {f, g}
    return quads + [triangle for f, triangle in enumerate(triangles) if f not in taken]
