"""Payloads of a few integers and byte strings: exceptions, metadata, the head of a scene.

Without construct, which takes longer to import than a small mesh to code.
"""

from ebz.codec.encoded import EncodedText
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.formats.ebz.chunks import Chunk
from ebz.formats.ebz.layout import read_varint, varint

NO_TEXT = EncodedText(0, b"")


class _Reader:
    """Reads one field after another; raises CorruptError where the payload ends within one."""

    def __init__(self, payload: bytes) -> None:
        self._rest = payload

    def integer(self) -> int:
        try:
            value, size = read_varint(self._rest)
        except IndexError:
            raise CorruptError("the data ends within an integer") from None
        except ValueError as error:
            raise CorruptError(str(error)) from None
        self._rest = self._rest[size:]
        return value

    def prefixed(self) -> bytes:
        """Bytes after their number."""
        size = self.integer()
        if size > len(self._rest):
            raise CorruptError(f"{len(self._rest)} bytes where there must be {size}")
        value, self._rest = self._rest[:size], self._rest[size:]
        return value

    def rest(self) -> bytes:
        return self._rest

    def text(self) -> EncodedText:
        size = self.integer()
        n_raw, raw = (self.integer(), self.prefixed()) if size & 1 else (0, b"")
        if len(raw) > n_raw:
            raise CorruptError(f"{len(raw)} bytes for {n_raw}")
        return EncodedText(size >> 1, self.rest(), n_raw, raw)


def _prefixed(data: bytes) -> bytes:
    return varint(len(data)) + data


def exceptions(rows: bytes, exact: bytes) -> bytes:
    """The payload of a chunk of exceptions: where they are, and their values."""
    return _prefixed(rows) + exact


def parse_exceptions(chunk: Chunk) -> tuple[bytes, bytes]:
    """The coded rows and the values of a chunk; raises CorruptError."""
    with corrupt_at(chunk):
        reader = _Reader(chunk.payload)
        return reader.prefixed(), reader.rest()


def text(encoded: EncodedText) -> bytes:
    """The payload of a metadata chunk."""
    size = varint(2 * encoded.n_bytes + (encoded.n_raw > 0))
    raw = varint(encoded.n_raw) + _prefixed(encoded.raw) if encoded.n_raw else b""
    return size + raw + encoded.data


def parse_text(chunk: Chunk) -> EncodedText:
    """The text of a metadata chunk; raises CorruptError."""
    with corrupt_at(chunk):
        return _Reader(chunk.payload).text()


def scene(n_parts: int, metadata: EncodedText | None) -> bytes:
    """The payload of a scene's chunk."""
    return varint(n_parts) + text(metadata or NO_TEXT)


def parse_scene(chunk: Chunk) -> tuple[int, EncodedText | None]:
    """How many parts there are, and the text beside them; raises CorruptError."""
    with corrupt_at(chunk):
        reader = _Reader(chunk.payload)
        n_parts, metadata = reader.integer(), reader.text()
    has_text = metadata.n_bytes or metadata.n_raw or metadata.raw
    return n_parts, metadata if has_text else None
