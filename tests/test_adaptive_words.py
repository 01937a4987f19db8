"""Adaptive models of the word: symbols come back, in few bits, and from any bytes in bounds."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec import _kernels, connectivity, sample
from ebz.codec.errors import CorruptError
from ebz.codec.levels import DEFAULT_TABLE, LEVELS, word_models
from ebz.codec.models.adaptive import CHEAPEST_SYMBOL, Effort
from ebz.codec.models.load import load
from ebz.codec.word import EncodedWord
from tests import meshes
from tests.surgery import Faces, n_used

EFFORTS = st.sampled_from(list(Effort))


def encode(faces: npt.NDArray[np.integer], *models: connectivity.WordModel) -> EncodedWord:
    return connectivity.encode(faces, n_used(faces), models)[0]


def size(word: EncodedWord) -> int:
    return len(word.word) + len(word.special_integers)


@given(meshes.face_lists(), EFFORTS)
def test_words_come_back(faces: Faces, effort: Effort) -> None:
    word, surface, _ = connectivity.encode(faces, n_used(faces), [effort])
    decoded, restored = connectivity.decode(
        word.word, word.special_integers, word.gluing, word.counts, effort
    )
    assert decoded.symbols.tobytes() == word.symbols.tobytes()
    assert np.array_equal(restored.opposite, surface.opposite)
    assert np.array_equal(restored.vertex, surface.vertex)
    assert np.array_equal(decoded.specials, word.specials)


@given(meshes.face_lists(), st.sampled_from(LEVELS))
def test_no_level_takes_more_than_the_certified_table(faces: Faces, level: int) -> None:
    models = word_models(level)
    best = encode(faces, *models)
    alone = [encode(faces, model) for model in models]
    assert size(best) == min(size(word) for word in alone)


@pytest.mark.parametrize("effort", Effort)
@pytest.mark.parametrize(
    ("mesh", "bits_per_vertex"),
    [
        (sample.random_triangulation(5000, 1), 3.9),
        (sample.sphere(10_000), 0.3),
        (sample.torus(10_000), 0.1),
        (sample.grid(10_000), 0.1),
    ],
    ids=["random", "sphere", "torus", "grid"],
)
def test_words_are_short(effort: Effort, mesh: sample.Mesh, bits_per_vertex: float) -> None:
    adaptive, table = (encode(mesh.faces, model) for model in (effort, load(DEFAULT_TABLE)))
    assert 8 * len(adaptive.word) < bits_per_vertex * len(mesh.vertices)
    if bits_per_vertex < 1:
        assert len(adaptive.word) < len(table.word) / 10


def test_more_effort_gives_shorter_words() -> None:
    faces = sample.random_triangulation(5000, 2).faces
    direct, fast, strong = (len(encode(faces, effort).word) for effort in Effort)
    assert strong < fast < direct


@pytest.mark.parametrize("effort", Effort)
def test_every_coded_symbol_costs_what_limits_assume(effort: Effort) -> None:
    faces = sample.torus(80_000).faces
    word = encode(faces, effort)
    n_coded = len(word.symbols) - 1
    assert n_coded * CHEAPEST_SYMBOL <= 8 * len(word.word) + 8


def test_single_triangles_are_free() -> None:
    faces = np.arange(3000).reshape(-1, 3)
    for effort in Effort:
        assert len(encode(faces, effort).word) == 1


@given(
    st.binary(max_size=200),
    st.tuples(st.integers(0, 500), *[st.integers(0, 3)] * 2, st.integers(0, 9)),
    EFFORTS,
)
def test_any_bytes_decode_or_are_refused(
    data: bytes, counts: tuple[int, int, int, int], effort: Effort
) -> None:
    try:
        arrays, specials = _kernels.decode_adaptive(data, *counts, effort)
    except CorruptError:
        return
    symbols, opposite, _, _ = arrays
    assert (len(symbols), len(specials)) == (counts[0], 2 * counts[3])
    inner = np.flatnonzero(opposite >= 0)
    assert np.array_equal(opposite[opposite[inner]], inner)
