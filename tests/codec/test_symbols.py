"""How many symbols and special S a surface takes, known from its topology."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebz.codec import connectivity
from ebz.codec.models.table import Table
from tests import surgery
from tests.meshes import discs, face_lists, simple_surfaces, spheres, surfaces
from tests.topology import topology

TABLE = Table.load("loop-60")


def encode(faces) -> connectivity.EncodedWord:
    return connectivity.encode(faces, surgery.n_used(faces), [TABLE])[0]


def count(word: connectivity.EncodedWord) -> Counter[str]:
    return Counter("CLRSE"[symbol] for symbol in word.symbols)


@pytest.mark.parametrize("n_holes", range(6))
@pytest.mark.parametrize("n_handles", range(7))
def test_a_surface_takes_two_special_s_per_handle_and_one_per_hole_after_the_first(
    n_handles, n_holes
):
    rng = np.random.default_rng([n_handles, n_holes])
    for _ in range(3):
        word = encode(surgery.surface(n_handles, n_holes, rng))
        assert word.counts.n_specials == 2 * n_handles + max(n_holes - 1, 0)
        assert word.counts.n_closed == (n_holes == 0)
        assert word.counts.n_copies == 0


@settings(max_examples=10, deadline=None)
@given(st.lists(surfaces(max_handles=2, max_holes=3), min_size=2, max_size=3))
def test_components_share_one_word_and_add_up(parts):
    word = encode(surgery.union(parts))
    kinds = [topology(part) for part in parts]
    expected = sum(2 * kind.genus + max(kind.boundary_loops - 1, 0) for kind in kinds)
    assert word.counts.n_specials == expected
    assert word.counts.n_closed == sum(kind.boundary_loops == 0 for kind in kinds)
    assert len(word.symbols) == sum(map(len, parts)) - word.counts.n_closed


@settings(max_examples=60, deadline=None)
@given(spheres())
def test_a_closed_surface_of_genus_zero_has_as_many_c_as_other_symbols_but_one(faces):
    symbols, n_vertices = count(encode(faces)), surgery.n_used(faces)
    assert symbols["C"] == n_vertices - 3
    assert symbols["L"] + symbols["R"] + symbols["S"] + symbols["E"] == n_vertices - 2
    assert symbols["E"] == symbols["S"] + 1


@settings(max_examples=60, deadline=None)
@given(discs())
def test_a_disc_has_one_c_per_inner_vertex(faces):
    symbols = count(encode(faces))
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
    ends, uses = np.unique(edges, axis=0, return_counts=True)
    n_inner = len(np.unique(faces)) - len(np.unique(ends[uses == 1]))
    assert symbols["C"] == n_inner
    assert symbols["E"] == symbols["S"] + 1


@settings(max_examples=60, deadline=None)
@given(simple_surfaces())
def test_every_ordinary_s_has_its_e(faces):
    word = encode(faces)
    symbols = count(word)
    assert symbols["E"] == symbols["S"] - word.counts.n_specials + 1


@settings(max_examples=100, deadline=None)
@given(face_lists())
def test_special_s_are_listed_in_order_and_meet_what_comes_later(faces):
    word = encode(faces)
    positions, meets = word.specials[0::2], word.specials[1::2]
    assert (np.diff(positions) > 0).all()
    assert all("CLRSE"[word.symbols[position]] == "S" for position in positions)
    assert (meets // 2 > positions).all()
    assert (meets // 2 < len(word.symbols)).all()


@settings(max_examples=100, deadline=None)
@given(face_lists())
def test_every_face_but_first_ones_of_closed_components_has_a_symbol(faces):
    counts = encode(faces).counts
    assert counts.n_symbols + counts.n_closed == len(faces)


@pytest.mark.parametrize(
    ("faces", "word"),
    [
        ([(0, 1, 2)], "E"),
        ([(0, 1, 2), (3, 4, 5)], "EE"),
        ([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)], "CRE"),
    ],
    ids=["triangle", "two triangles", "tetrahedron"],
)
def test_words_of_the_smallest_meshes(faces, word):
    assert "".join("CLRSE"[symbol] for symbol in encode(np.array(faces)).symbols) == word
