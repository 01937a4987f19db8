"""The sampler: closed and simple, and every rooted triangulation exactly equally likely."""

from collections import Counter
from functools import cache
from hashlib import sha256
from itertools import combinations
from math import factorial, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.sample import close_word, random_triangulation
from tests.topology import is_simple_sphere

# W. T. Tutte, "A census of planar triangulations", 1962, from three vertices on.
TUTTE = {3: 1, 4: 1, 5: 3, 6: 13, 7: 68, 8: 399}

Code = tuple[int, ...]
Corners = dict[tuple[int, int], int]  # the third corner of the face on the left of a half-edge


def corners_of(faces: np.ndarray) -> Corners:
    half_edges = [(a, b, c) for face in faces.tolist() for a, b, c in _rotations(*face)]
    return {(a, b): c for a, b, c in half_edges}


def rooted_code(corners: Corners, root: tuple[int, int]) -> Code:
    """Equal for two triangulations if and only if some isomorphism takes root to root."""
    name = {root[0]: 0, root[1]: 1}
    code, queue, seen = [], [root], set()
    for a, b in queue:
        if (a, b) not in seen:
            c = corners[a, b]
            seen |= {(a, b), (b, c), (c, a)}
            code.append(name.setdefault(c, len(name)))
            queue += [(a, c), (c, b)]
    return tuple(code)


@cache
def all_codes(n_vertices: int) -> frozenset[Code]:
    """Every rooted triangulation, by flips from one: the graph of flips is connected (Wagner)."""
    start = corners_of(random_triangulation(n_vertices).faces)
    found, pending = set(codes_of(start)), [start]
    while pending:
        corners = pending.pop()
        for edge in corners:
            flipped = _flip(corners, *edge)
            if flipped and not (codes := codes_of(flipped)) <= found:
                found |= codes
                pending.append(flipped)
    return frozenset(found)


def codes_of(corners: Corners) -> set[Code]:
    return {rooted_code(corners, edge) for edge in corners}


def _flip(corners: Corners, a: int, b: int) -> Corners | None:
    c, d = corners[a, b], corners[b, a]
    if c == d or (c, d) in corners:
        return None
    kept = {edge: apex for edge, apex in corners.items() if edge not in ((a, b), (b, a))}
    faces = [*_rotations(a, d, c), *_rotations(d, b, c)]
    return kept | {(x, y): z for x, y, z in faces}


def _rotations(a: int, b: int, c: int) -> list[tuple[int, int, int]]:
    return [(a, b, c), (b, c, a), (c, a, b)]


def sampled_code(faces: np.ndarray) -> Code:
    last = int(faces.max())
    return rooted_code(corners_of(faces), (last - 1, last))


@pytest.mark.parametrize("n_vertices", range(4, 9))
def test_there_are_as_many_rooted_triangulations_as_tutte_counted(n_vertices):
    assert len(all_codes(n_vertices)) == TUTTE[n_vertices]


@pytest.mark.parametrize("n_nodes", range(2, 6))
def test_all_words_together_give_every_rooted_triangulation_equally_often(n_nodes):
    length, n_ones = 4 * n_nodes - 2, n_nodes - 1
    hits: Counter[Code] = Counter()
    for ones in combinations(range(length), n_ones):
        word = np.isin(np.arange(length), ones)
        for choices in ((0, 0), (0, 1), (1, 0), (1, 1)):
            hits[sampled_code(close_word(word, *choices))] += 1
    assert hits.keys() == all_codes(n_nodes + 2)
    assert len(set(hits.values())) == 1


@pytest.mark.parametrize("n_vertices", [5, 6, 7])
def test_seeds_hit_every_rooted_triangulation_about_equally_often(n_vertices):
    n_kinds, n_each = TUTTE[n_vertices], 60
    samples = [random_triangulation(n_vertices, seed).faces for seed in range(n_each * n_kinds)]
    hits = Counter(map(sampled_code, samples))
    assert hits.keys() == all_codes(n_vertices)
    chi_square = sum((n - n_each) ** 2 / n_each for n in hits.values())
    assert chi_square < (n_kinds - 1) + 4 * sqrt(2 * (n_kinds - 1))


def test_eight_vertices_hit_all_399():
    hits = {sampled_code(random_triangulation(8, seed).faces) for seed in range(5000)}
    assert hits == all_codes(8)


@given(st.integers(4, 300), st.integers(0, 2**64))
def test_samples_are_simple_spheres(n_vertices, seed):
    faces = random_triangulation(n_vertices, seed).faces
    assert len(faces) == 2 * n_vertices - 4
    assert is_simple_sphere(faces)


def test_a_large_sample_is_a_simple_sphere():
    n = 100_000
    mesh = random_triangulation(n, 1)
    half_edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64)
    forward, backward = half_edges @ [n, 1], half_edges @ [1, n]
    assert len(np.unique(forward)) == 6 * n - 12
    assert np.array_equal(np.sort(forward), np.sort(backward))
    assert len(np.unique(mesh.faces)) == n
    assert len(np.unique(mesh.vertices, axis=0)) == n


def n_discs(m: int, n: int) -> int:
    """Simple triangulations of an (m + 3)-gon with n vertices inside, rooted on the boundary.

    W. G. Brown, "Enumeration of triangulations of the disk", 1964.
    """
    above = 2 * factorial(2 * m + 3) * factorial(4 * n + 2 * m + 1)
    below = factorial(m + 2) * factorial(m) * factorial(n) * factorial(3 * n + 2 * m + 3)
    return above // below


def expected_valences(n_vertices: int, largest: int) -> list[float]:
    """The expected number of vertices of each valence from 3 on.

    What is left of a triangulation without a vertex of valence k is a triangulated k-gon; each of
    the k corners may be the root among the 6 n - 12 half-edges.
    """
    n_all = n_discs(0, n_vertices - 3)
    rooted = [n_discs(k - 3, n_vertices - 1 - k) for k in range(3, largest + 1)]
    return [(6 * n_vertices - 12) * n / n_all / k for k, n in enumerate(rooted, 3)]


def test_the_law_of_valences_counts_every_vertex_once():
    assert [n_discs(0, n) for n in range(6)] == list(TUTTE.values())
    assert sum(expected_valences(30, 29)) == pytest.approx(30)


def test_valences_of_large_samples_follow_their_law():
    n_vertices, n_samples = 3000, 30
    counts = np.zeros(n_vertices)
    for seed in range(n_samples):
        faces = random_triangulation(n_vertices, seed).faces
        counts += np.bincount(np.bincount(faces.ravel()), minlength=n_vertices)
    expected = n_samples * np.array(expected_valences(n_vertices, 20))
    deviation = (counts[3:21] - expected) / np.sqrt(expected)
    assert np.abs(deviation).max() < 4


def test_a_seed_gives_the_same_mesh_for_ever():
    few = random_triangulation(6, seed=1).faces.tolist()
    assert few[:4] == [[3, 1, 0], [1, 2, 5], [5, 2, 4], [2, 1, 4]]
    assert few[4:] == [[1, 3, 4], [3, 0, 4], [4, 0, 5], [0, 1, 5]]
    mesh = random_triangulation(1000, seed=1)
    data = mesh.faces.astype("<i4").tobytes() + mesh.vertices.astype("<f4").tobytes()
    assert sha256(data).hexdigest() == (
        "2b4498f70f414ca4fb00d491785b865efe960479dfd00a514b18615de6d57881"
    )


@pytest.mark.parametrize(("n_vertices", "seed"), [(2, 0), (-1, 0), (5, -1)])
def test_impossible_arguments_are_refused(n_vertices, seed):
    with pytest.raises(OptionError, match=r"2 vertices|-1 vertices|seed -1"):
        random_triangulation(n_vertices, seed)
