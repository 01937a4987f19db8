"""Chunks: a type, a length, a payload and a checksum over all three."""

from collections.abc import Iterator
from typing import NamedTuple

import xxhash

from ebz.codec.errors import CorruptError, NotEbzError, TruncatedError, VersionError
from ebz.formats.ebz import layout

CHECKSUM_SIZE = 4


class Chunk(NamedTuple):
    """A chunk of a file; `offset` is that of its type."""

    type: bytes
    payload: bytes
    offset: int
    size: int  # with head and checksum

    def __str__(self) -> str:
        return f"chunk {self.type.decode('latin-1')!r} at offset {self.offset}"


def write(kind: bytes, payload: bytes) -> bytes:
    """The bytes of one chunk."""
    body = kind + layout.varint(len(payload)) + payload
    return body + checksum(body)


def checksum(body: bytes | memoryview) -> bytes:
    """That of type, length and payload."""
    return (xxhash.xxh3_64_intdigest(body) & 0xFFFFFFFF).to_bytes(CHECKSUM_SIZE, "little")


def start() -> bytes:
    """What comes before the first chunk."""
    return layout.MAGIC + bytes([layout.VERSION])


def sequence(data: memoryview, offset: int) -> Iterator[Chunk]:
    """The chunks from there on up to an end chunk, checked one by one.

    Raises TruncatedError or CorruptError.
    """
    while True:
        chunk = _read_one(data, offset)
        offset += chunk.size
        yield chunk
        if chunk.type == layout.END:
            break


def check_end(data: memoryview, offset: int) -> None:
    """Raises CorruptError where the file goes on after its last chunk."""
    if offset != len(data):
        raise CorruptError(f"{len(data) - offset} bytes after the end chunk, at offset {offset}")


def begin(data: memoryview) -> int:
    """Where the first chunk is; raises NotEbzError, VersionError or TruncatedError."""
    if len(data) <= len(layout.MAGIC) and layout.MAGIC.startswith(data) and len(data):
        raise TruncatedError(f"the file ends at byte {len(data)}, within its first bytes")
    if data[: len(layout.MAGIC)] != layout.MAGIC:
        raise NotEbzError("not an .ebz file" if len(data) else "not an .ebz file: it is empty")
    version = data[len(layout.MAGIC)]
    if version != layout.VERSION:
        raise VersionError(
            f"format version {version}; this ebz reads version {layout.VERSION} only"
        )
    return len(layout.MAGIC) + 1


def _read_one(data: memoryview, offset: int) -> Chunk:
    kind = bytes(data[offset : offset + 1])
    try:
        length, size = layout.read_varint(data, offset + 1)
    except ValueError:
        raise CorruptError(f"chunk at offset {offset}: its length is malformed") from None
    except IndexError:
        raise TruncatedError(f"the file ends at byte {len(data)}, within a chunk head") from None
    start = offset + 1 + size
    end = start + length
    if end + CHECKSUM_SIZE > len(data):
        missing = end + CHECKSUM_SIZE - len(data)
        name = kind.decode("latin-1")
        raise TruncatedError(
            f"chunk {name!r} at offset {offset}: the file ends {missing} bytes too early"
        )
    chunk = Chunk(kind, bytes(data[start:end]), offset, end + CHECKSUM_SIZE - offset)
    if data[end : end + CHECKSUM_SIZE] != checksum(data[offset:end]):
        raise CorruptError(f"{chunk}: checksum mismatch")
    return chunk
