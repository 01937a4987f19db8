"""Words are as long as the certificates of the built-in tables say, on meshes of every kind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebz.codec import sample
from ebz.codec.models.certify import certify
from ebz.codec.models.load import load
from tests import meshes, surgery
from tests.guarantees.coded import Coded, Faces, files
from tests.surgery import n_used
from tests.topology import topology

LOOP, STACK = load("loop-60"), load("stack")
LOOP_CERTIFICATE, STACK_CERTIFICATE = certify(LOOP), certify(STACK)
SHARE = 0.001
BITS_PER_COMPONENT = 64
# The stream ends at a byte; three vertices less than v are paid for.
END_BITS = 3


def assert_in_band(coded: Coded) -> None:
    """Within 0.1 % of the price both ways, and 64 bits per component.

    A special S makes the model forget, which costs at most what the certificate says, and is worth
    no more than that.
    """
    price = coded.price(LOOP_CERTIFICATE)
    allowed = SHARE * price + BITS_PER_COMPONENT * coded.n_components
    for_specials = LOOP_CERTIFICATE.bits_per_special * coded.n_specials
    assert price - allowed <= coded.word_bits <= price + allowed + for_specials
    # With the special S counted as symbols, the upper bound needs no allowance for them.
    assert coded.word_bits <= allowed + price + LOOP_CERTIFICATE.bits_per_other * coded.n_specials
    assert coded.word_bits <= coded.limit(LOOP_CERTIFICATE)


def assert_all(faces: Faces, n_vertices: int) -> None:
    assert_in_band(Coded.of(faces, n_vertices, LOOP))
    coded = Coded.of(faces, n_vertices, STACK)
    assert coded.word_bits <= coded.limit(STACK_CERTIFICATE)


def assert_bits_per_vertex(faces: Faces, n_vertices: int) -> None:
    """On a connected closed mesh of genus 0."""
    bits = Coded.of(faces, n_vertices, LOOP).word_bits
    most = LOOP_CERTIFICATE.bits_per_vertex * n_vertices
    assert abs(bits - most) <= SHARE * most + BITS_PER_COMPONENT
    bits = Coded.of(faces, n_vertices, STACK).word_bits
    assert bits <= STACK_CERTIFICATE.bits_per_vertex * n_vertices + END_BITS


@pytest.mark.parametrize(
    ("faces", "n_vertices"), [pytest.param(*rest, id=name) for name, *rest in files()]
)
def test_files(faces: Faces, n_vertices: int) -> None:
    assert_all(faces, n_vertices)
    if len(faces) == 2 * n_vertices - 4 and topology(faces) == (1, 2, 0, 0, 0, 0):
        assert_bits_per_vertex(faces, n_vertices)


@given(meshes.face_lists())
def test_faces_of_every_kind(faces: Faces) -> None:
    assert_all(faces, n_used(faces))


@given(meshes.spheres(200))
def test_random_spheres(faces: Faces) -> None:
    assert_all(faces, n_used(faces))
    assert_bits_per_vertex(faces, n_used(faces))


@settings(max_examples=20)
@given(st.integers(0, 12), st.integers(0, 12), st.floats(0, 2), meshes.rngs)
def test_no_c_is_wrongly_forbidden_after_a_special_s(
    n_handles: int, n_holes: int, n_flips: float, rng: np.random.Generator
) -> None:
    """`Coded.of` would raise: the tables trust what they know of the loops below."""
    faces = surgery.surface(n_handles, n_holes, rng, n_flips)
    assert_all(faces, n_used(faces))


@pytest.mark.parametrize("seed", range(3))
def test_dense_handles(seed: int) -> None:
    """Grids joined both ways with few vertices, pinched and flipped: many special S close by."""
    rng = np.random.default_rng(seed)
    grids = [sample.glued_grid(3, 3 + i % 5, "join", "join")[2] for i in range(40)]
    faces = surgery.flip_edges(surgery.union(grids), 4000, rng)
    assert_all(faces, n_used(faces))


def test_large_random_triangulations() -> None:
    n = 20_000
    faces = sample.random_triangulation(n, 3).faces
    assert_bits_per_vertex(faces, n)
    bits = Coded.of(faces, n, STACK).word_bits / n
    assert 3.245 < bits < STACK_CERTIFICATE.bits_per_vertex
