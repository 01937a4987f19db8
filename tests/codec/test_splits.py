"""Vertices of one position: cheap to tell apart along seams, linear time where there are many."""

import numpy as np

import ebz
from tests.surgery import n_used


def n_bytes(mesh: ebz.Mesh) -> int:
    """Of the splits; the mesh comes back from its file with as many vertices, and the same file."""
    data = ebz.compress(mesh)
    decoded = ebz.decompress(data)
    assert decoded.n_vertices == mesh.n_vertices
    assert ebz.compress(decoded) == data
    return next(stream.bytes for stream in ebz.stats(data).streams if stream.name == "splits")


def grid(n: int) -> tuple[np.ndarray, np.ndarray]:
    """n x n squares in two triangles each, over points that differ."""
    i, j = np.divmod(np.arange(n * n), n)
    a = i * (n + 1) + j
    b, c, d = a + 1, a + n + 2, a + n + 1
    x, y = np.divmod(np.arange((n + 1) ** 2), n + 1)
    faces = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)
    return np.stack([x, y, x * y], axis=1).astype(np.float64), faces


def split_off(vertices: np.ndarray, faces: np.ndarray, which: np.ndarray) -> ebz.Mesh:
    """Those faces have vertices of their own."""
    moved = faces.copy()
    moved[which] += len(vertices)
    used, compact = np.unique(moved, return_inverse=True)
    return ebz.Mesh(vertices[used % len(vertices)], compact.reshape(-1, 3))


def test_a_triangle_soup_takes_a_byte():
    vertices, faces = grid(20)
    soup = ebz.Mesh(vertices[faces.reshape(-1)], np.arange(faces.size).reshape(-1, 3))
    assert n_bytes(soup) <= 13 + 1  # that of a chunk


def test_a_straight_seam_costs_less_than_three_bits_a_vertex():
    vertices, faces = grid(160)
    mesh = split_off(vertices, faces, faces.max(axis=1) > len(vertices) // 2)
    n_more = mesh.n_vertices - len(vertices)
    assert n_more > 160
    assert 8 * n_bytes(mesh) < 3 * n_more


def test_many_vertices_in_many_runs_at_one_point():
    """Telling a run's vertex by its number among hundreds takes no steps for each of these."""
    n, n_hubs = 12_000, 600
    rng = np.random.default_rng(1)
    hub = rng.permutation(np.arange(n) % n_hubs)
    rim = n_hubs + np.arange(n)
    angle = 2 * np.pi * np.arange(n) / n
    circle = np.stack([np.cos(angle), np.sin(angle), rng.random(n)], axis=1)
    faces = np.stack([hub, rim, np.roll(rim, -1)], axis=1)
    assert n_used(faces) == n + n_hubs
    assert n_bytes(ebz.Mesh(np.concatenate([np.zeros((n_hubs, 3)), circle]), faces)) < 2 * n
