"""Short Python twins of the coder, the adaptive integers and the decoder agree with the kernels."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, connectivity, pipeline, welding
from ebz.codec.integers import decode_columns, encode_columns, zigzag
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable, load
from ebz.codec.models.table import table_names
from ebz.codec.sample import grid, random_triangulation, sphere
from ebz.formats.ebz import file
from tests import surgery
from tests.meshes import face_lists, meshes, rngs, surfaces
from tests.oracles import fast_word, integers, reverse, specials
from tests.oracles.gluing import Gluing
from tests.oracles.range_coder import Decoder, Encoder
from tests.oracles.splits import Splits
from tests.surgery import n_used

tables = st.sampled_from(table_names())
models = st.none() | tables

widths = st.integers(0, 64).flatmap(lambda bits: st.integers(0, 2**bits - 1))
rows = st.integers(1, 3).flatmap(
    lambda n: st.lists(st.lists(widths, min_size=n, max_size=n), min_size=1, max_size=60)
)


@settings(max_examples=100, deadline=None)
@given(rows)
def test_integers_are_coded_alike(values):
    data = integers.encode(values)
    assert encode_columns(*np.array(values, np.uint64).T) == data
    assert integers.decode(data, len(values), len(values[0])) == values
    columns = decode_columns(data, len(values), len(values[0]))
    assert np.array_equal(np.column_stack(columns), np.array(values, np.uint64))


@settings(max_examples=50, deadline=None)
@given(st.integers(1, 2000), st.sampled_from([0, 1, 2**64 - 1]))
def test_runs_of_one_value_are_coded_alike(n, value):
    data = integers.encode([[value]] * n)
    assert encode_columns(np.full(n, value, np.uint64)) == data
    assert integers.decode(data, n, 1) == [[value]] * n


@settings(max_examples=50, deadline=None)
@given(st.binary(max_size=40), st.integers(1, 40), st.integers(1, 3))
def test_any_bytes_are_decoded_alike(data, n_rows, n_columns):
    columns = decode_columns(data, n_rows, n_columns)
    assert np.column_stack(columns).tolist() == integers.decode(data, n_rows, n_columns)


operations = st.lists(
    st.tuples(st.just("bit"), st.booleans(), st.integers(1, 2**16 - 1))
    | st.integers(1, 16).flatmap(
        lambda bits: st.tuples(st.just("raw"), st.integers(0, 2**bits - 1), st.just(bits))
    ),
    max_size=80,
)


@settings(max_examples=100, deadline=None)
@given(operations)
def test_the_twin_decodes_what_it_encodes(messages):
    encoder = Encoder()
    for kind, value, parameter in messages:
        getattr(encoder, kind)(value, parameter)
    decoder = Decoder(encoder.finish())
    for kind, value, parameter in messages:
        assert getattr(decoder, kind)(None, parameter) == value


@pytest.mark.parametrize("p1", [1, 2**16 - 1])
def test_carries_run_through_many_bytes(p1):
    """Long runs at the edge of the range, then the other bit; the twin has no carries."""
    values = [2**64 - 1] * 40 + [0] * 40 + [2**63, 1] * 20
    assert encode_columns(np.array(values, np.uint64)) == integers.encode([[v] for v in values])
    encoder = Encoder()
    bits = [p1 > 1] * 3000 + [p1 == 1] + [p1 > 1] * 10
    for bit in bits:
        encoder.bit(bit, p1)
    decoder = Decoder(encoder.finish())
    assert [decoder.bit(False, p1) for _ in bits] == bits


def check_file(mesh: ebz.Mesh, model: str | None) -> None:
    """Decodes the connectivity of a file with nothing but the twins; no adaptive model."""
    data = ebz.compress(mesh, model=model)
    encoded = file.read(memoryview(data), memory_limit=1 << 30)
    counts, streams = encoded.counts, encoded.streams
    decoded = pipeline.decode(encoded)
    word = "".join("CLRSE"[symbol] for symbol in decoded.word.symbols)
    pairs = decoded.word.specials.tolist()
    met = dict(zip(pairs[0::2], pairs[1::2], strict=True))
    if isinstance(encoded.model, AnyTable):
        assert met == specials.decode(streams.special_integers, counts.n_specials, len(word))
        found = reverse.decode_word(streams.word, len(word), set(met), encoded.model)
        assert word == found
    opposite = reverse.opposites(word, met, counts.n_closed, counts.n_single)
    vertex = reverse.fans(opposite)
    assert opposite == decoded.surface.opposite.tolist()
    assert vertex == decoded.surface.piece_vertex.tolist()
    sites = Gluing(streams.gluing or b"", opposite, vertex)
    glued = sites.decode(counts.n_copies, max(vertex, default=-1) + 1)
    faces = np.array([glued[v] for v in vertex], int).reshape(-1, 3)
    assert np.array_equal(faces, decoded.mesh.faces)


@settings(max_examples=80, deadline=None)
@given(meshes(), models)
def test_connectivity_is_decoded_alike(mesh, model):
    check_file(mesh, model)


@settings(max_examples=15, deadline=None)
@given(meshes(surfaces(max_handles=6, max_holes=5)), models)
def test_handles_and_holes_are_decoded_alike(mesh, model):
    check_file(mesh, model)


@pytest.mark.parametrize("model", table_names())
def test_a_random_triangulation_is_decoded_alike(model):
    check_file(random_triangulation(1_500, seed=3), model)


@settings(max_examples=60, deadline=None)
@given(tables, face_lists())
def test_words_are_encoded_alike(name, faces):
    table = load(name)
    encoded, _, _ = connectivity.encode(faces, surgery.n_used(faces), [table])
    word = "".join("CLRSE"[symbol] for symbol in encoded.symbols)
    assert reverse.encode_word(word, set(encoded.specials[0::2].tolist()), table) == encoded.word


@given(st.lists(st.integers(-(2**63), 2**63 - 1), max_size=20))
def test_zigzag_is_the_textbook_one(values):
    expected = [2 * value if value >= 0 else -2 * value - 1 for value in values]
    assert zigzag(np.array(values, np.int64)).tolist() == expected


@settings(max_examples=200, deadline=None)
@given(face_lists() | surfaces(), rngs, st.integers(1, 5), st.floats(0, 1))
def test_splits_are_decoded_alike(faces, rng, n_most, share):
    """Any corners may be those of a vertex, also where a fan is at a part of its site only."""
    surface, _ = connectivity.traverse(faces, n_used(faces))
    check_splits(welding.fans(surface), labels(surface.vertex, rng, n_most, share))
    fan, site = _kernels.fans_at_points(surface.opposite, surface.vertex)
    assert np.array_equal(fan, surface.piece_vertex)
    assert np.array_equal(site, surface.vertex_of_piece)
    parts = labels(surface.vertex, rng, 2, share)
    points, _ = _kernels.number_by_first_use(parts, len(parts))
    fan, point = _kernels.fans_at_points(surface.opposite, points)
    of = surface.opposite, fan, points, point, int(points.max(initial=-1)) + 1
    check_splits(of, labels(points, rng, n_most, share))


def labels(point: np.ndarray, rng: np.random.Generator, n_most: int, share: float) -> np.ndarray:
    """One of up to n_most for each corner, at that share of the points; at some, one each."""
    n = int(point.max(initial=-1)) + 1
    several = rng.integers(1, n_most + 1, n)
    several[rng.random(n) > share] = 1
    label = n_most * point + rng.integers(0, several[point])
    apart = (rng.random(n) < share / 7)[point]
    label = np.where(apart, n_most * n + np.arange(len(point)), label)
    return np.unique(label, return_inverse=True)[1].astype(np.int32)


def check_splits(of: tuple, label: np.ndarray) -> None:
    opposite, _, point, _, n_points = of
    data, vertex, told, label_of = _kernels.encode_splits(*of, label)
    decoded, more = _kernels.decode_splits(data, *of)
    twin = Splits(data, opposite.tolist(), point.tolist())
    assert decoded.tolist() == vertex.tolist() == twin.decode()
    assert more.tolist() == told.tolist() == twin.more
    assert np.array_equal(label_of[vertex], label)
    pairs = np.unique(np.stack([vertex, label]), axis=1)
    assert np.array_equal(pairs[0], np.arange(n_points + len(more)))
    assert len(np.unique(pairs[1])) == pairs.shape[1]


def check_adaptive_word(faces: surgery.Faces, effort: Effort) -> None:
    """Those with special S are left out."""
    word, _, _ = connectivity.encode(faces, n_used(faces), [effort])
    counts = word.counts
    if counts.n_specials == 0:
        is_fast = effort == Effort.FAST
        symbols = fast_word.decode(word.word, counts.n_symbols, counts.n_single, fast=is_fast)
        assert symbols[::-1] == word.symbols.tolist()


@settings(max_examples=60, deadline=None)
@given(face_lists(), st.sampled_from([Effort.DIRECT, Effort.FAST]))
def test_words_in_one_step_a_symbol_are_decoded_alike(faces, effort):
    check_adaptive_word(faces, effort)


@pytest.mark.parametrize("effort", [Effort.DIRECT, Effort.FAST])
@pytest.mark.parametrize(
    "mesh",
    [random_triangulation(1000, 3), sphere(3000), grid(3000)],
    ids=["random", "sphere", "grid"],
)
def test_long_words_in_one_step_a_symbol_are_decoded_alike(mesh, effort):
    assert connectivity.encode(mesh.faces, len(mesh.vertices), [effort])[0].counts.n_specials == 0
    check_adaptive_word(mesh.faces, effort)
