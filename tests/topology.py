"""What kind of surface a list of triangles is: slow, short, and independent of the codec."""

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt


class Topology(NamedTuple):
    """Counts over used vertices; genus only where the surface is a manifold and orientable."""

    components: int
    euler: int
    boundary_loops: int  # those that touch count as one
    singular_edges: int  # with more than two faces
    singular_vertices: int  # whose triangles are not one fan or one cycle
    clashing_edges: int  # with two faces that go the same way along them

    @property
    def genus(self) -> int:
        return (2 * self.components - self.boundary_loops - self.euler) // 2


def topology(faces: npt.NDArray[Any]) -> Topology:
    """For faces (m, 3) with three distinct vertices each."""
    triangles = [tuple(face) for face in faces.tolist()]
    directed = Counter((face[i], face[(i + 1) % 3]) for face in triangles for i in range(3))
    edges: Counter[tuple[int, int]] = Counter()
    for (a, b), count in directed.items():
        edges[min(a, b), max(a, b)] += count
    links: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
    for face in triangles:
        for i in range(3):
            links[face[i]].append((face[(i + 1) % 3], face[(i + 2) % 3]))
    return Topology(
        components=n_parts(edges),
        euler=len(links) - len(edges) + len(triangles),
        boundary_loops=n_parts(edge for edge, count in edges.items() if count == 1),
        singular_edges=sum(count > 2 for count in edges.values()),
        singular_vertices=sum(not _is_one_curve(link) for link in links.values()),
        clashing_edges=sum(count > 1 for count in directed.values()),
    )


def n_parts(edges: Iterable[tuple[Hashable, Hashable]]) -> int:
    """The number of connected components of a graph."""
    parent: dict[Hashable, Hashable] = {}

    def root(node: Hashable) -> Hashable:
        while parent.setdefault(node, node) != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    for a, b in edges:
        parent[root(a)] = root(b)
    return sum(root(node) == node for node in list(parent))


def is_simple_sphere(faces: npt.NDArray[Any]) -> bool:
    """Whether the faces are a consistently oriented sphere without double edges."""
    edges = {tuple(edge) for edge in np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)).tolist()}
    return 2 * len(edges) == 3 * len(faces) and topology(faces) == (1, 2, 0, 0, 0, 0)


def _is_one_curve(link: list[tuple[int, int]]) -> bool:
    degrees = Counter(end for edge in link for end in edge)
    return n_parts(link) == 1 and max(degrees.values()) <= 2
