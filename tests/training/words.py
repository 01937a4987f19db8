"""Writes the words from which priors are learnt: `python tests/training/words.py FOLDER [MESH]...`.

Generated meshes of common kinds, and any mesh files given.  A word file holds five int32 (symbols,
closed components, single triangles, special S, vertices), the symbols, and int64 pairs (position,
half-edge met) of the special S.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

import ebz
from ebz.codec import connectivity, sample
from ebz.codec.levels import word_models
from ebz.codec.mesh import Mesh


def generated() -> Iterator[tuple[str, Mesh]]:
    """Meshes of a few kinds and sizes, by name."""
    for n in (300, 1500, 6000):
        yield f"sphere-{n}", sample.sphere(2 * n)
        yield f"torus-{n}", sample.torus(2 * n)
        yield f"grid-{n}", sample.grid(2 * n)
        yield f"random-{n}", sample.random_triangulation(n, n)
        for noise in (0.3, 0.6, 1.5):
            yield f"plane-{n}-{noise}", _plane(n, noise)
        yield f"ball-{n}", _ball(n)
        yield f"diagonals-{n}", _diagonals(n)


def _plane(n: int, noise: float) -> Mesh:
    """Delaunay triangles of a hexagonal grid of points, each moved at random."""
    side = max(4, round(n**0.5))
    row, column = np.divmod(np.arange(side * side), side)
    points = np.stack([column + 0.5 * (row % 2), row * 0.866], axis=1)
    points += noise * np.random.default_rng(n).uniform(-0.5, 0.5, points.shape)
    return _flat(points, Delaunay(points).simplices)


def _ball(n: int) -> Mesh:
    """Delaunay triangles of random points on a sphere, oriented."""
    points = np.random.default_rng(n).normal(size=(n, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices
    inward = np.linalg.det(points[faces]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return Mesh(points, faces.astype(np.int64))


def _diagonals(n: int) -> Mesh:
    """A square grid whose cells are cut along a random diagonal."""
    side = max(3, round(n**0.5))
    index = np.arange(side * side).reshape(side, side)
    a, b, c, d = (index[i : side - 1 + i, j : side - 1 + j].ravel() for i, j in CELL)
    turned = np.random.default_rng(n).random(len(a)) < 0.5
    a, b, c, d = (np.where(turned, x, y) for x, y in zip((b, c, d, a), (a, b, c, d), strict=True))
    row, column = np.divmod(np.arange(side * side), side)
    return _flat(
        np.stack([column, row], axis=1), np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)
    )


CELL = ((0, 0), (0, 1), (1, 1), (1, 0))


def _flat(points: np.ndarray, faces: np.ndarray) -> Mesh:
    return Mesh(np.column_stack([points, np.zeros(len(points))]), faces.astype(np.int64))


def write(path: Path, mesh: Mesh) -> None:
    word, surface, _ = connectivity.encode(mesh.faces, len(mesh.vertices), word_models(1))
    counts = word.counts
    n_vertices = int(surface.vertex_of_piece.max(initial=-1)) + 1
    sizes = counts.n_symbols, counts.n_closed, counts.n_single, counts.n_specials, n_vertices
    path.write_bytes(
        np.array(sizes, "<i4").tobytes() + word.symbols.tobytes() + word.specials.tobytes()
    )


def main(folder: Path, files: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in generated():
        write(folder / name, mesh)
    for file in files:
        write(folder / Path(file).stem, ebz.read(file, triangulate=True))


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
