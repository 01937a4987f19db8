"""Surgery on lists of faces, (m, 3) int64, by which meshes of every kind are generated."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.mesh import Mesh
from ebz.codec.sample import sphere

Faces = npt.NDArray[np.int64]
Rng = np.random.Generator


def n_used(faces: Faces) -> int:
    return int(faces.max(initial=-1)) + 1


def surface(n_handles: int, n_holes: int, rng: Rng, n_flips_per_edge: float = 1.0) -> Faces:
    """A connected simple oriented surface: its genus, and its boundary loops of three edges."""
    n_cuts = 2 * n_handles + n_holes
    faces = sphere(20 + 90 * n_cuts).faces.astype(np.int64)
    cuts = _faces_apart(faces, n_cuts, rng)
    tubes = [_tube(faces[a], faces[b]) for a, b in cuts[: 2 * n_handles].reshape(-1, 2)]
    faces = np.concatenate([np.delete(faces, cuts, axis=0), *tubes])
    return flip_edges(faces, int(n_flips_per_edge * 1.5 * len(faces)), rng)


def flip_edges(faces: Faces, n_tries: int, rng: Rng) -> Faces:
    """Flips random edges with two consistently oriented faces where no double edge arises."""
    n_tries = n_tries if len(faces) else 0
    triangles = [tuple(face) for face in faces.tolist()]
    owner: dict[tuple[int, int], int] = {}
    fixed = set()  # half-edges that several faces share
    for index, face in enumerate(triangles):
        for edge in _half_edges(*face):
            if edge in owner:
                fixed |= {edge, edge[::-1]}
            owner[edge] = index
    picks = rng.integers(max(1, 3 * len(faces)), size=n_tries)
    for index, corner in zip(*divmod(picks, 3), strict=True):
        a, b, c = np.roll(triangles[index], corner).tolist()
        twin = owner.get((b, a))
        if twin is None or (a, b) in fixed:
            continue
        d = sum(triangles[twin]) - a - b
        if len({a, b, c, d}) < 4 or (c, d) in owner or (d, c) in owner:
            continue
        del owner[a, b], owner[b, a]
        for at, face in ((index, (a, d, c)), (twin, (d, b, c))):
            triangles[at] = face
            owner |= dict.fromkeys(_half_edges(*face), at)
    return np.array(triangles, np.int64).reshape(-1, 3)


def delete_faces(faces: Faces, n: int, rng: Rng) -> Faces:
    return np.delete(faces, rng.permutation(len(faces))[:n], axis=0)


def identify_vertices(faces: Faces, n: int, rng: Rng) -> Faces:
    """Makes n random pairs of vertices one, whatever that does to the faces."""
    name = np.arange(n_used(faces))
    for a, b in rng.choice(name, (n, 2)) if len(name) else ():
        name[name == name[a]] = name[b]
    return name[faces]


def turn_faces(faces: Faces, n: int, rng: Rng) -> Faces:
    """Reverses the orientation of n random faces."""
    turned = faces.copy()
    chosen = rng.permutation(len(faces))[:n]
    turned[chosen] = faces[chosen, ::-1]
    return turned


def repeat_faces(faces: Faces, n: int, rng: Rng) -> Faces:
    """Adds n random faces once more, each turned by chance."""
    again = faces[rng.integers(len(faces), size=n)] if len(faces) else faces
    return np.concatenate([faces, turn_faces(again, n // 2, rng)])


def add_degenerate_faces(faces: Faces, n: int, rng: Rng) -> Faces:
    """Adds n faces with two or three equal corners."""
    a, b = rng.integers(max(1, n_used(faces)), size=(2, n))
    return np.concatenate([faces, rng.permuted(np.stack([a, a, b], axis=1), axis=1)])


def add_faces(faces: Faces, n: int, rng: Rng) -> Faces:
    """Adds n faces between random vertices."""
    return np.concatenate([faces, rng.integers(max(1, n_used(faces)), size=(n, 3))])


def union(parts: list[Faces]) -> Faces:
    starts = np.cumsum([0] + [n_used(part) for part in parts])
    shifted = [part + start for part, start in zip(parts, starts, strict=False)]
    return np.concatenate([np.zeros((0, 3), np.int64), *shifted])


def shuffled(mesh: Mesh, rng: Rng) -> tuple[Mesh, npt.NDArray[np.int64]]:
    """The mesh in another order of vertices, faces and corners; vertex i was order[i]."""
    order, face_order = rng.permutation(len(mesh.vertices)), rng.permutation(len(mesh.faces))
    name = np.argsort(order)
    faces = name[mesh.faces[face_order]].reshape(-1, 3)
    corners = (np.arange(3) + rng.integers(3, size=(len(faces), 1))) % 3
    return Mesh(
        mesh.vertices[order],
        np.take_along_axis(faces, corners, axis=1),
        _reordered(mesh.vertex_attributes, order),
        _reordered(mesh.face_attributes, face_order),
        mesh.metadata,
    ), order


def _reordered(
    attributes: dict[str, npt.NDArray[Any]], order: npt.NDArray[np.int64]
) -> dict[str, npt.NDArray[Any]]:
    return {name: values[order] for name, values in attributes.items()}


def _half_edges(a: int, b: int, c: int) -> tuple[tuple[int, int], ...]:
    return (a, b), (b, c), (c, a)


def _faces_apart(faces: Faces, n: int, rng: Rng) -> npt.NDArray[np.int64]:
    """Random faces of which no two have adjacent vertices, so that tubes make no double edges."""
    blocked = np.zeros(n_used(faces), bool)
    neighbours: list[set[int]] = [set() for _ in blocked]
    for face in faces.tolist():
        for vertex in face:
            neighbours[vertex].update(face)
    chosen: list[int] = []
    for index in rng.permutation(len(faces)):
        if len(chosen) == n:
            break
        if not blocked[faces[index]].any():
            chosen.append(int(index))
            for vertex in faces[index]:
                blocked[list(neighbours[vertex])] = True
    assert len(chosen) == n
    return np.array(chosen, np.int64)


def _tube(a: npt.NDArray[np.int64], b: npt.NDArray[np.int64]) -> Faces:
    """Six faces from the boundary that face a leaves to the one that face b leaves."""
    c = b[[0, 2, 1]]
    sides = [((a[i], a[i - 2], c[i - 2]), (a[i], c[i - 2], c[i])) for i in range(3)]
    return np.array(sides, np.int64).reshape(-1, 3)
