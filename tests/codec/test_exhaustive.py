"""Everything small: all words, all stacks, all lists of few triangles."""

from collections import Counter
from collections.abc import Iterator
from functools import cache
from itertools import combinations_with_replacement, product
from math import factorial

import numpy as np
import pytest

from ebz.codec import _kernels, connectivity
from ebz.codec.models.language import check_stacks
from ebz.codec.models.load import load
from ebz.codec.models.table import Table, table_names
from ebz.codec.word import kernel_model

TABLE = Table.load("loop-60")
MODEL = kernel_model(TABLE)
NO_SPECIALS = np.zeros(0, np.int64)

Stack = tuple[tuple[int, int], ...]  # (length, conflict) from the top down, 0 for no conflict


def steps(stack: Stack) -> Iterator[tuple[str, Stack]]:
    """The reverse operations that a stack of loops allows."""
    yield "E", ((3, 0), *stack)
    if not stack:
        return
    (length, conflict), *below = stack
    yield "R", ((length + 1, 0), *below)
    yield "L", ((length + 1, 1), *below)
    if length > 3 and conflict != 1:
        yield "C", ((length - 1, max(conflict - 1, 0)), *below)
    if below:
        (left, _), *others = below
        yield "S", ((length + left - 1, left - 1), *others)


@cache
def words(n: int) -> dict[str, Stack]:
    """Every forward word of n symbols, with the stack that its reverse leaves."""
    if n == 0:
        return {"": ()}
    return {
        symbol + word: after
        for word, stack in words(n - 1).items()
        for symbol, after in steps(stack)
    }


def decode(word: str, n_closed: int):
    symbols = np.array(["CLRSE".index(symbol) for symbol in word], np.uint8)
    data = _kernels.encode_symbols(symbols, NO_SPECIALS, MODEL)
    n_single = int(word == "E")
    return symbols, _kernels.decode_connectivity(
        data, len(word), n_closed, n_single, NO_SPECIALS, MODEL
    )


def check(word: str, n_closed: int) -> bytes:
    """The surface of a word, as bytes; its own word is the same again."""
    symbols, (decoded, opposite, vertex, n_vertices) = decode(word, n_closed)
    assert np.array_equal(decoded, symbols)
    again = _kernels.encode_connectivity(vertex, n_vertices)
    assert np.array_equal(again[0], symbols), word
    assert not len(again[1])
    assert again[2] == n_closed
    assert np.array_equal(again[5], opposite)
    return opposite.tobytes()


def n_discs(n_triangles: int) -> int:
    """W. G. Brown, "Enumeration of triangulations of the disk", 1964: simple and rooted."""
    total = 0
    for inner in range((n_triangles - 1) // 2 + 1):
        m = n_triangles - 1 - 2 * inner  # there are m + 3 boundary edges
        top = 2 * factorial(2 * m + 3) * factorial(4 * inner + 2 * m + 1)
        bottom = factorial(m + 2) * factorial(m) * factorial(inner)
        total += top // (bottom * factorial(3 * inner + 2 * m + 3))
    return total


@pytest.mark.parametrize("n", range(1, 9))
def test_every_word_of_one_loop_is_a_disc_of_its_own(n):
    found = {check(word, 0) for word, stack in words(n).items() if len(stack) == 1}
    assert len(found) == n_discs(n)


# W. T. Tutte, "A census of planar triangulations", 1962: rooted simple triangulations.
@pytest.mark.parametrize(("n", "tutte"), [(3, 1), (5, 3), (7, 13)])
def test_the_words_of_closed_surfaces_are_as_many_as_tutte_counted(n, tutte):
    closed = [w for w, stack in words(n).items() if len(stack) == 1 and stack[0][0] == 3]
    assert len({check(word, 1) for word in closed}) == len(closed) == tutte


def test_the_automaton_forbids_nothing_that_a_stack_of_up_to_13_triangles_allows():
    assert check_stacks(TABLE, 13) > 100_000


@pytest.mark.parametrize("name", table_names())
def test_every_word_can_be_coded_with_every_table(name):
    model = kernel_model(load(name))
    for word in words(7):
        symbols = np.array(["CLRSE".index(symbol) for symbol in word], np.uint8)
        assert _kernels.encode_symbols(symbols, NO_SPECIALS, model)


def triangles(n_vertices: int) -> list[tuple[int, int, int]]:
    """Every triangle up to rotation, degenerate ones included."""
    return [t for t in product(range(n_vertices), repeat=3) if t == min(rotations(*t))]


def rotations(a: int, b: int, c: int) -> list[tuple[int, int, int]]:
    return [(a, b, c), (b, c, a), (c, a, b)]


def check_faces(rows, n_vertices: int) -> None:
    faces = np.array(rows, np.int64).reshape(-1, 3)
    word, surface, order = connectivity.encode(faces, n_vertices, [TABLE])
    parts = (word.word, word.special_integers, word.gluing, word.counts)
    _, decoded = connectivity.decode(*parts, TABLE)
    assert np.array_equal(decoded.vertex, surface.vertex)
    got = order.vertices[decoded.vertex].reshape(-1, 3).tolist()
    assert Counter(min(rotations(*f)) for f in got) == Counter(rows), rows
    again = connectivity.encode(decoded.vertex.reshape(-1, 3), n_vertices, [TABLE])[0]
    assert (again.word, again.special_integers, again.gluing, again.counts) == parts, rows


def test_every_list_of_up_to_three_triangles_on_four_vertices():
    for n in range(4):
        for rows in combinations_with_replacement(triangles(4), n):
            check_faces(rows, 4)


def test_some_lists_of_four_triangles_on_five_vertices():
    rng, kinds = np.random.default_rng(0), triangles(5)
    for chosen in rng.integers(len(kinds), size=(2500, 4)):
        check_faces([kinds[i] for i in chosen], 5)
