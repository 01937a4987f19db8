"""Where pieces touch: cheap to tell if the mesh goes on touching, and checked when told."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import connectivity
from ebz.codec.models.adaptive import Effort
from tests.meshes import face_lists, rngs
from tests.surgery import n_used


def checkerboard(n: int) -> np.ndarray:
    """The black squares of n x n, each as two triangles: they touch at their corners only."""
    i, j = np.divmod(np.arange(n * n), n)
    at = (i * (n + 1) + j)[(i + j) % 2 == 0]
    a, b, c, d = at, at + 1, at + n + 2, at + n + 1
    return np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)


def book(n_pages: int, length: int) -> np.ndarray:
    """Strips of squares along one spine, which is in n_pages of them."""
    rows = np.arange(length)
    pages = []
    for page in range(1, n_pages + 1):
        a, b, c, d = rows, rows + 1, page * (length + 1) + rows + 1, page * (length + 1) + rows
        pages.append(np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3))
    return np.concatenate(pages)


def encoded(faces: np.ndarray) -> connectivity.EncodedWord:
    word, _, _ = connectivity.encode(faces, n_used(faces), [Effort.FAST])
    return word


@pytest.mark.parametrize(
    ("faces", "bits_per_copy"),
    [(checkerboard(40), 6), (book(6, 200), 1)],
    ids=["corners", "edges"],
)
@pytest.mark.parametrize("seed", [1, 2])
def test_pieces_that_go_on_touching_cost_little(faces, bits_per_copy, seed):
    """A site is one of about a thousand: told by its number it would cost ten bits."""
    rng = np.random.default_rng(seed)
    numbers = rng.permutation(n_used(faces)).astype(np.int32)
    word = encoded(numbers[rng.permutation(faces)])
    assert word.counts.n_copies > 700
    assert 8 * len(word.gluing) < bits_per_copy * word.counts.n_copies


@settings(max_examples=100, deadline=None)
@given(face_lists(), rngs, st.booleans())
def test_the_order_of_components_is_canonical(faces, rng, keep_rotations):
    """Also where faces keep the corner that they start with, which need not be at the gate."""
    n = n_used(faces)
    values = rng.random((len(faces), 3)) if keep_rotations else rng.random(len(faces))
    mesh = ebz.Mesh(rng.random((n, 3)), faces, face_attributes={"values": values})
    data = ebz.compress(mesh)
    assert ebz.compress(ebz.decompress(data)) == data


def test_a_copy_of_what_is_not_there_is_corrupt():
    word = encoded(checkerboard(6))
    for damage in range(1, 256):
        damaged = bytes([word.gluing[0] ^ damage]) + word.gluing[1:]
        parts = (word.word, word.special_integers, damaged, word.counts, word.model)
        try:
            _, surface = connectivity.decode(*parts)
        except ebz.CorruptError as error:
            assert "gluing" in str(error)
            continue
        assert len(surface.vertex_of_piece) - surface.n_vertices == word.counts.n_copies
