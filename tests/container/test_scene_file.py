"""Files of scenes: any bytes decode to something or to an error that names the part."""

import numpy as np
import pytest

import ebz
from ebz.codec.sample import sphere, torus
from tests.container.files import START, checksum, varint

PARTS = [
    ebz.Mesh(sphere(20).vertices, sphere(20).faces, metadata={"name": "ball"}),
    ebz.Mesh([], []),
    ebz.Mesh(torus(20).vertices, []),
]
DATA = ebz.compress(ebz.Scene(PARTS, {"who": "me"}))
BODIES = [ebz.compress(part)[START:] for part in PARTS]


def scene_file(payload: bytes, *bodies: bytes) -> bytes:
    chunk = b"L" + varint(len(payload)) + payload
    return DATA[:START] + chunk + checksum(chunk) + b"".join(bodies)


def payload() -> bytes:
    return DATA[START + 2 : START + 2 + DATA[START + 1]]


def error(data: bytes, kind: type[ebz.EbzError]) -> str:
    for decode in (ebz.decompress, ebz.verify, ebz.stats):
        with pytest.raises(ebz.EbzError) as raised:
            decode(data)
        assert type(raised.value) is kind, raised.value
    return str(raised.value)


def test_parts_are_what_files_of_one_mesh_hold():
    assert scene_file(payload(), *BODIES) == DATA
    alone = ebz.decompress(scene_file(b"\x01\x00", BODIES[0]))
    assert alone.metadata == {}
    assert alone.names == ["ball"]


def test_every_prefix_is_truncated():
    for length in range(1, len(DATA)):
        with pytest.raises(ebz.TruncatedError):
            ebz.decompress(DATA[:length])


def test_every_flipped_bit_is_noticed():
    for at in range(8 * START, 8 * len(DATA)):
        damaged = bytearray(DATA)
        damaged[at // 8] ^= 1 << at % 8
        with pytest.raises(ebz.EbzError):
            ebz.decompress(bytes(damaged))


def test_bytes_behind_the_last_part_are_noticed():
    assert "1 bytes after the end chunk" in error(DATA + b"\0", ebz.CorruptError)
    fewer = varint(2) + payload()[1:]
    assert "after the end chunk" in error(scene_file(fewer, *BODIES), ebz.CorruptError)


@pytest.mark.parametrize("n", [4, 2**31, 2**63, 2**69])
def test_more_parts_than_there_are_take_nothing(n):
    message = error(scene_file(varint(n) + payload()[1:], *BODIES), ebz.TruncatedError)
    assert message.startswith("part 3: the file ends")


def test_very_many_parts_need_memory():
    many = scene_file(varint(1000) + b"\0", *(1000 * [BODIES[1]]))
    assert len(ebz.decompress(many).parts) == 1000
    with pytest.raises(ebz.MemoryLimitError):
        ebz.decompress(many, memory_limit=10 << 20)


def test_flipped_bits_under_right_checksums_are_noticed_or_harmless():
    for at in range(8 * len(payload())):
        damaged = bytearray(payload())
        damaged[at // 8] ^= 1 << at % 8
        try:
            decoded = ebz.decompress(scene_file(bytes(damaged), *BODIES))
        except (ebz.CorruptError, ebz.TruncatedError):
            continue
        assert len(decoded.parts) == len(PARTS)


@pytest.mark.parametrize("head", [b"", b"\xff" * 12, b"\x03", b"\x03\xff", b"\x03\x05"])
def test_malformed_scenes_are_corrupt(head):
    assert "chunk 'L' at offset 9" in error(scene_file(head, *BODIES), ebz.CorruptError)


def test_damage_names_the_part():
    assert error(scene_file(payload(), BODIES[0], BODIES[1], b"Q"), ebz.TruncatedError).startswith(
        "part 2: "
    )
    crossed = bytearray(BODIES[0])
    crossed[-1] ^= 1
    message = error(scene_file(payload(), bytes(crossed), *BODIES[1:]), ebz.CorruptError)
    assert message.startswith("part 0: chunk 'Z' at offset ")


def test_a_scene_within_a_scene_is_refused():
    message = error(scene_file(b"\x01\x00", scene_file(payload())[START:]), ebz.VersionError)
    assert message.startswith("part 0: chunk 'L'")
    assert np.array_equal(ebz.decompress(DATA).parts[1].vertices, PARTS[1].vertices)
