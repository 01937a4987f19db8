"""What has a counterpart before it costs little: mirrored halves, repeated parts."""

import numpy as np
import numpy.typing as npt
import pytest

import ebz

Points = npt.NDArray[np.float32]
Faces = npt.NDArray[np.int64]

# Of the positions of a mesh whose other half, or other parts, are told by the first one.
MOST_OF_MIRRORED, MOST_OF_REPEATED = 0.12, 0.2


def rough_sheet(n: int) -> tuple[Points, Faces]:
    """n x n vertices at random heights and places, the first n of them on the plane x = 0."""
    rng = np.random.default_rng(5)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    points = 16 * np.stack([x, y, np.zeros_like(x)], 1) + rng.integers(-7, 8, (n * n, 3))
    points[:n, 0] = 0
    corner = (n * x + y).reshape(n, n)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    quads = np.stack([a, b, c, d], -1).reshape(-1, 4)
    return points.astype(np.float32), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def mirrored(points: Points, faces: Faces, axis: int) -> ebz.Mesh:
    """With its mirror image in the plane of its first vertices, which both share."""
    is_shared = points[:, 0] == 0
    number = np.where(is_shared, np.arange(len(points)), len(points) + np.cumsum(~is_shared) - 1)
    image = points[~is_shared] * np.array([-1, 1, 1], np.float32)
    vertices = np.concatenate([points, image])
    both = np.concatenate([faces, number[faces[:, ::-1]]])
    return ebz.Mesh(vertices=np.roll(vertices, axis, axis=1), faces=both)


def repeated(points: Points, faces: Faces, n: int, away: tuple[int, int, int]) -> ebz.Mesh:
    """The same part n times."""
    parts = [points + i * np.array(away, np.float32) for i in range(n)]
    shifted = [faces + i * len(points) for i in range(n)]
    return ebz.Mesh(vertices=np.concatenate(parts), faces=np.concatenate(shifted))


def positions_size(mesh: ebz.Mesh, level: int) -> int:
    data = ebz.compress(mesh, level=level)
    assert ebz.verify(data, against=mesh).equal
    return ebz.stats(data).geometry_bytes


@pytest.mark.parametrize("level", [6, 9])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_mirrored_half_costs_little(level, axis):
    points, faces = rough_sheet(40)
    half = positions_size(ebz.Mesh(vertices=points, faces=faces), level)
    both = positions_size(mirrored(points, faces, axis), level)
    assert both < (1 + MOST_OF_MIRRORED) * half


@pytest.mark.parametrize("level", [6, 9])
@pytest.mark.parametrize("away", [(0, 1000, 0), (900, 700, 11)])
def test_repeated_parts_cost_little(level, away):
    points, faces = rough_sheet(40)
    part = positions_size(ebz.Mesh(vertices=points, faces=faces), level)
    four = positions_size(repeated(points, faces, 4, away), level)
    assert four < (1 + 3 * MOST_OF_REPEATED) * part
