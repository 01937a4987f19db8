"""What a reader promises about bytes that are not a whole .ebz file.

Whatever the bytes are, decompress returns exactly the mesh that was compressed or raises an
EbzError: NotEbzError if they do not start as an .ebz file does, VersionError if they need another
reader, TruncatedError if the file would go on, CorruptError, which names chunk and offset, if they
contradict a checksum or themselves, MemoryLimitError if they ask for more memory than is allowed.
It never takes time or memory out of proportion to the bytes there are and the memory limit.
"""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import ebz
from tests.container.files import (
    START,
    attribute,
    files,
    join,
    offset,
    read_header,
    split,
    varint,
    with_header,
    with_payload,
)

FILES = files()
MESHES = {name: ebz.decompress(data) for name, data in FILES.items()}
MEMORY_LIMIT = 64 << 20

every_file = pytest.mark.parametrize("name", FILES)


def arrays(mesh: ebz.Mesh) -> list:
    named = [*mesh.vertex_attributes.items(), *mesh.face_attributes.items()]
    named += mesh.corner_attributes.items()
    for name, element in mesh.elements.items():
        named += [(name, element.offsets), (name, element.corners)]
        named += [*element.attributes.items(), *element.corner_attributes.items()]
    columns = [("", mesh.vertices), ("", mesh.faces), *named]
    return [(name, a.dtype, a.shape, a.tobytes()) for name, a in columns] + [mesh.metadata]


def error(data: bytes, kind: type[ebz.EbzError] = ebz.EbzError) -> str:
    """The message of the error that is raised; errors in a file name their place."""
    with pytest.raises(kind) as raised:
        ebz.decompress(data, memory_limit=MEMORY_LIMIT)
    check_place(raised.value)
    return str(raised.value)


def check_place(error: ebz.EbzError) -> None:
    if isinstance(error, ebz.CorruptError):
        assert " at offset " in str(error)


def error_or_same(data: bytes, name: str) -> None:
    try:
        mesh = ebz.decompress(data, memory_limit=MEMORY_LIMIT)
    except ebz.EbzError as found:
        check_place(found)
    else:
        assert arrays(mesh) == arrays(MESHES[name])


def test_the_files_have_every_kind_of_chunk():
    found = {kind for data in FILES.values() for kind, _ in split(data)}
    assert found == {bytes([letter]) for letter in b"HMWSGIPQXNORVFCEDZ"}
    assert {read_header(data)[0]["lattice"] for data in FILES.values()} == {0, 1, 2, 3, 4, 5}


@every_file
def test_taking_a_file_apart_and_together_gives_the_file(name):
    assert join(split(FILES[name])) == with_header(FILES[name]) == FILES[name]


@every_file
def test_every_prefix_is_truncated(name):
    data = FILES[name]
    for length in range(1, len(data)):
        assert "the file ends" in error(data[:length], ebz.TruncatedError)


@pytest.mark.parametrize("data", [b"", b"ply\n", b"\x89PNG\r\n\x1a\n", b"\0" * 50, b"\x89EBZ\n"])
def test_other_files_are_not_ebz(data):
    assert "not an .ebz file" in error(data, ebz.NotEbzError)


@every_file
def test_every_flipped_bit_is_noticed(name):
    data = bytearray(FILES[name])
    for at in range(0, len(data), 1 + len(data) // 1500):
        for bit in range(8):
            data[at] ^= 1 << bit
            if at < START - 1:
                error(bytes(data), ebz.NotEbzError)
            elif at == START - 1:
                error(bytes(data), ebz.VersionError)
            else:
                error(bytes(data), (ebz.CorruptError, ebz.TruncatedError))
            data[at] ^= 1 << bit


@every_file
def test_an_extra_byte_at_the_end_is_noticed(name):
    message = f"1 bytes after the end chunk, at offset {len(FILES[name])}"
    assert message in error(FILES[name] + b"\0", ebz.CorruptError)


@pytest.mark.parametrize("version", [0, 1, 255])
def test_other_versions_are_refused(version):
    data = bytearray(FILES["everything"])
    data[START - 1] = version
    assert f"format version {version}" in error(bytes(data), ebz.VersionError)
    assert f"format version {version}" in error(bytes(data[:START]), ebz.VersionError)


@every_file
def test_chunks_out_of_order_are_corrupt(name):
    chunks = split(FILES[name])
    for i in range(len(chunks) - 1):
        error(join([*chunks[:i], chunks[i + 1], chunks[i], *chunks[i + 2 :]]), ebz.CorruptError)


@every_file
def test_chunks_that_come_twice_are_corrupt(name):
    chunks = split(FILES[name])
    for i in range(len(chunks)):
        message = error(join([*chunks[: i + 1], *chunks[i:]]), ebz.CorruptError)
        assert f" at offset {offset(chunks, i + 1)}" in message


@every_file
def test_missing_chunks_are_noticed(name):
    chunks = split(FILES[name])
    for i, (kind, _) in enumerate(chunks):
        expected = ebz.TruncatedError if kind == b"Z" else ebz.CorruptError
        error(join(chunks[:i] + chunks[i + 1 :]), expected)


def test_chunks_that_the_header_has_no_use_for_are_corrupt():
    everything = split(FILES["everything"]) + split(FILES["stack"])
    order = b"HMWSGIPXNORVFCEDZ"
    chunks = split(FILES["empty"])
    for kind, payload in everything:
        if kind in b"MWSGPX":
            more = sorted([*chunks, (kind, payload)], key=lambda chunk: order.index(chunk[0]))
            assert "no use for it" in error(join(more), ebz.CorruptError)


@every_file
def test_unknown_optional_chunks_are_skipped(name):
    chunks = split(FILES[name])
    for i in range(len(chunks)):
        data = join([*chunks[:i], (b"q", b"whatever"), *chunks[i:]])
        assert arrays(ebz.decompress(data)) == arrays(MESHES[name])


@pytest.mark.parametrize("kind", [b"?", b"0", b"\0", b"\xff", b" "])
def test_unknown_required_chunks_are_refused(kind):
    chunks = split(FILES["empty"])
    message = error(join([chunks[0], (kind, b""), chunks[1]]), ebz.VersionError)
    assert f"chunk {kind.decode('latin-1')!r} at offset {offset(chunks, 1)}" in message


@pytest.mark.parametrize("length", [2**32 - 1, 2**32, 2**63 - 1, 2**63, 2**64, 2**69])
def test_chunks_of_absurd_length_are_truncated(length):
    error(FILES["empty"][:START] + b"H" + varint(length) + bytes(100), ebz.TruncatedError)


def test_a_length_without_end_is_corrupt():
    error(FILES["empty"][:START] + b"H" + b"\xff" * 100, ebz.CorruptError)


COUNTS = ["n_vertices", "n_symbols", "n_closed", "n_single", "n_specials", "n_copies"]
COUNTS += ["n_exceptions"]
ABSURD = [2**n + d for n in (31, 32, 62, 63, 64) for d in (-1, 0, 1)] + [2**70 - 1]


@every_file
@pytest.mark.parametrize("field", COUNTS)
def test_absurd_counts_are_refused_before_anything_is_allocated(field, name):
    for count in [10_000_000, *ABSURD]:
        data = with_header(FILES[name], **{field: count})
        error(data, (ebz.CorruptError, ebz.MemoryLimitError))


@every_file
@pytest.mark.parametrize("field", COUNTS)
def test_wrong_counts_are_noticed(field, name):
    right = read_header(FILES[name])[0][field]
    for count in {0, 1, right - 1, right + 1, 2 * right, right + 100} - {right, -1}:
        error_or_same(with_header(FILES[name], **{field: count}), name)


@every_file
@pytest.mark.parametrize("field", ["itemsize", "model", "method", "lattice"])
def test_every_other_value_of_a_byte_of_the_header_is_noticed(field, name):
    right = read_header(FILES[name])[0][field]
    for value in set(range(256)) - {right}:
        error_or_same(with_header(FILES[name], **{field: value}), name)


def test_unknown_lattices_models_and_methods_need_another_reader():
    for field in ("lattice", "model", "method"):
        error(with_header(FILES["box"], **{field: 77}), ebz.VersionError)


DOUBLES = [np.inf, -np.inf, np.nan, -1.0, 0.0, 5e-324, 1e308, 1.7e308]


@pytest.mark.parametrize("value", DOUBLES)
@pytest.mark.parametrize("name", ["box", "step", "grid"])
def test_absurd_lattices_are_noticed(name, value):
    payload = split(FILES[name])[0][1]
    error(with_payload(FILES[name], b"H", payload[:-8] + np.float64(value).tobytes()))


def flipped(payload: bytes, step: int) -> Iterator[bytes]:
    for at in range(0, 8 * len(payload), step):
        byte = bytes([payload[at // 8] ^ 1 << at % 8])
        yield payload[: at // 8] + byte + payload[at // 8 + 1 :]


@every_file
def test_flipped_bits_under_right_checksums_are_noticed_or_harmless(name):
    chunks = split(FILES[name])
    for i, (kind, payload) in enumerate(chunks):
        # A hundred bits or so of long payloads; an odd step takes every bit of a byte in turn.
        for damaged in flipped(payload, len(payload) // 13 | 1):
            error_or_same(join([*chunks[:i], (kind, damaged), *chunks[i + 1 :]]), name)


@every_file
def test_payloads_cut_short_or_prolonged_are_noticed_or_harmless(name):
    chunks = split(FILES[name])
    for i, (kind, payload) in enumerate(chunks):
        step = 1 + len(payload) // 50
        shorter = [payload[:length] for length in range(0, len(payload), step)]
        for damaged in [*shorter, payload + b"\0", payload + b"\xff", payload * 2]:
            error_or_same(join([*chunks[:i], (kind, damaged), *chunks[i + 1 :]]), name)


def test_headers_and_tables_that_go_on_are_corrupt():
    for name, kind in (("box", b"H"), ("automaton", b"M"), ("stack", b"M")):
        payload = dict(split(FILES[name]))[kind]
        error(with_payload(FILES[name], kind, payload + b"\0"), ebz.CorruptError)


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(list(FILES)), st.data())
def test_any_payload_is_noticed_or_harmless(name, data):
    chunks = split(FILES[name])
    i = data.draw(st.integers(0, len(chunks) - 1))
    kind, payload = chunks[i]
    kept = data.draw(st.integers(0, len(payload)))
    damaged = payload[:kept] + data.draw(st.binary(max_size=40))
    error_or_same(join([*chunks[:i], (kind, damaged), *chunks[i + 1 :]]), name)


SHAPES = [
    *([2**31], [2**32], [2**63], [2**64 - 1] * 3, [0, 2**40], [0] + [2**20] * 4),
    *([1] * 31, [1] * 32, [1] * 255, [0] * 31, [0], [1, 0, 1]),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: str(shape)[:40])
@pytest.mark.parametrize("kind", [b"V", b"F", b"C"])
def test_attributes_of_absurd_shape_are_refused(kind, shape):
    payload = attribute(b"a", b"f", 8, shape, b"\0" * 20)
    error(with_payload(FILES["everything"], kind, payload), ebz.CorruptError)


def test_attributes_of_no_known_type_are_refused():
    for kind in range(256):
        for itemsize in (0, 1, 2, 3, 4, 5, 8, 16, 32, 255):
            payload = attribute(b"red", bytes([kind]), itemsize, [], b"\0" * 20)
            error(with_payload(FILES["everything"], b"V", payload), ebz.CorruptError)


def test_attribute_names_that_are_not_utf_8_are_refused():
    payload = attribute(b"\xff", b"f", 4, [], b"")
    assert "name" in error(with_payload(FILES["everything"], b"V", payload), ebz.CorruptError)


@pytest.mark.parametrize(
    "changes",
    [
        {"model": 129},
        {"model": 2},
        {"n_empty": 5},
        {"n_polygons": 2**31, "n_empty": 2**31 - 3},
        {"n_polygons": 12},
        {"n_polygon_corners": 13},
        {"n_polygon_corners": 2**64 - 1},
    ],
)
def test_polygons_that_their_triangles_cannot_make_are_refused(changes):
    damaged = with_header(FILES["polygons"], **changes)
    assert "polygons" in error(damaged, ebz.CorruptError)


def test_faces_of_another_kind_need_another_reader():
    damaged = with_header(FILES["box"], face_size=2)
    assert "unknown kind 2" in error(damaged, ebz.VersionError)


def test_heads_that_their_bytes_cannot_hold_are_refused():
    for n_head in (0, 1, 2**9 + 1, 2**63):
        payload = varint(n_head) + varint(3) + b"abc" + b"data"
        assert "head" in error(with_payload(FILES["everything"], b"V", payload), ebz.CorruptError)


def test_seams_beyond_the_payload_are_refused():
    payload = attribute(b"s", b"f", 8, [], b"\0" * 20, seams_size=21)
    assert "seams" in error(with_payload(FILES["everything"], b"C", payload), ebz.CorruptError)


def test_long_names_stand_as_they_are():
    names = ["a" * 500, "b" * 480]
    mesh = ebz.Mesh(np.eye(3), [[0, 1, 2]], {name: np.arange(3.0) for name in names})
    data = ebz.compress(mesh)
    assert list(ebz.decompress(data).vertex_attributes) == names
    assert names[0].encode() in data and names[1].encode() not in data


def test_two_attributes_of_one_name_are_corrupt():
    chunks = split(FILES["everything"])
    index = [kind for kind, _ in chunks].index(b"V")
    message = error(join([*chunks[:index], chunks[index], *chunks[index:]]), ebz.CorruptError)
    assert "'red'" in message


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=300))
@example(b"")
@example(b"\xff" * 10)
def test_any_bytes_after_the_start_are_an_error(data):
    error(FILES["empty"][:START] + data)
