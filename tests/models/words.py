"""Reverse CLRSE words for the tests: random ones, and the meshes that words stand for."""

from __future__ import annotations

import random

from ebz.codec.models.language import Stack, successors
from ebz.codec.models.table import SYMBOLS, E, S


def random_word(
    rng: random.Random, n_symbols: int, weights: list[float], special_share: float = 0.0
) -> tuple[str, list[int]]:
    """A word that the exact language allows, and the positions of its special S.

    After a special S nothing is known of the joined loop any more: it may be as long as wanted.
    """
    stack: Stack = ()
    word: list[int] = []
    special = []
    for position in range(n_symbols):
        if stack and rng.random() < special_share:
            word.append(S)
            special.append(position)
            stack = ((3 + rng.randrange(20), 0), *stack[1:])
            continue
        options = list(successors(stack))
        symbol, stack = rng.choices(options, [weights[s] for s, _ in options])[0]
        word.append(symbol)
    return "".join(SYMBOLS[symbol] for symbol in word), special


def mesh_of(word: str) -> list[tuple[int, int, int]]:
    """The triangles of a planar reverse word, the one that closes its last loop of three included.

    A loop is its vertices in order; its gate is the edge from the last one to the first.
    """
    loops: list[list[int]] = []
    faces: list[tuple[int, int, int]] = []
    n = 0
    for symbol in word:
        if symbol == SYMBOLS[E]:
            loops.append([n, n + 1, n + 2])
            faces.append((n, n + 1, n + 2))
            n += 3
            continue
        top = loops.pop()
        left, right = top[-1], top[0]
        if symbol == "R":
            faces.append((left, right, n))
            loops.append([n, *top])
            n += 1
        elif symbol == "L":
            faces.append((left, right, n))
            loops.append([*top, n])
            n += 1
        elif symbol == "C":
            faces.append((left, right, top[-2]))
            loops.append(top[:-1])
        else:
            below = loops.pop()
            merged = {below[0]: left}
            faces = [tuple(merged.get(v, v) for v in face) for face in faces]  # type: ignore[misc]
            faces.append((left, right, below[-1]))
            loops.append([*top, *below[1:]])
    (last,) = loops
    if len(last) == 3:
        faces.append((last[0], last[2], last[1]))
    return faces


def is_closed_sphere(faces: list[tuple[int, int, int]]) -> bool:
    """Every edge in two triangles, no edge twice between the same ends, Euler characteristic 2."""
    edges: dict[frozenset[int], int] = {}
    for face in faces:
        for i in range(3):
            edge = frozenset((face[i], face[i - 1]))
            edges[edge] = edges.get(edge, 0) + 1
    n_vertices = len(set().union(*map(set, faces)))
    simple = all(len(edge) == 2 for edge in edges) and set(edges.values()) == {2}
    return simple and n_vertices - len(edges) + len(faces) == 2
