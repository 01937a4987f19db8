"""Metadata <-> bytes: JSON-like values, with byte strings besides."""

from typing import Any

from ebz.codec import text
from ebz.codec.encoded import EncodedText
from ebz.codec.errors import CorruptError, MeshError
from ebz.codec.metadata_prior import PRIOR

# An object with this one key holds a byte string: in hexadecimal, or how long it is.
BYTES = "$bytes"
# Byte strings from here on stand beside the text; shorter ones are coded with it.
LEAST_RAW = 256


def encode(metadata: dict[str, Any]) -> EncodedText | None:
    """The coded text, None where there is nothing; raises MeshError for what JSON cannot hold."""
    if not metadata:
        return None
    words, raw = to_text(metadata)
    coded = text.encode(b"", raw) if raw else b""
    return EncodedText(len(words), text.encode(PRIOR, words), len(raw), min(raw, coded, key=len))


def decode(encoded: EncodedText | None) -> dict[str, Any]:
    """The values; raises CorruptError where the text is not a JSON object."""
    if encoded is None:
        return {}
    words = text.decode(PRIOR, encoded.data, encoded.n_bytes)
    raw = encoded.raw
    if len(raw) < encoded.n_raw:
        raw = text.decode(b"", raw, encoded.n_raw)
    return from_text(words, raw)


def to_text(metadata: dict[str, Any]) -> tuple[bytes, bytes]:
    """Compact JSON in UTF-8 and long byte strings; raises MeshError for what JSON cannot hold."""
    import json

    raw: list[bytes] = []
    try:
        values = _to_json(metadata, raw)
        words = json.dumps(values, ensure_ascii=False, separators=(",", ":"))
    except (TypeError, ValueError, RecursionError) as error:
        raise MeshError(f"metadata: {error}") from None
    return words.encode("utf-8", "surrogatepass"), b"".join(raw)


def from_text(words: bytes, raw: bytes = b"") -> dict[str, Any]:
    """The values; raises CorruptError where the bytes are not a JSON object."""
    import json

    strings = _Strings(raw)
    try:
        metadata = json.loads(words.decode("utf-8", "surrogatepass"), object_hook=strings.replace)
        if not isinstance(metadata, dict):
            raise CorruptError("not an object")
        if strings.at != len(raw):
            raise CorruptError("byte strings that nothing stands for")
        # What is decoded must be a mesh that can be encoded: nested too deep, for one, it cannot.
        to_text(metadata)
    except (TypeError, ValueError, RecursionError) as error:
        raise CorruptError(str(error)) from None
    except MeshError as error:
        raise CorruptError(error.message) from None
    return metadata


class _Strings:
    """Byte strings by what stands for them in the text, in the order of the text."""

    def __init__(self, raw: bytes) -> None:
        self.at = 0
        self._raw = raw

    def replace(self, value: dict[str, Any]) -> Any:
        if value.keys() != {BYTES}:
            return value
        size = value[BYTES]
        if type(size) is not int:
            return bytes.fromhex(size)
        if not 0 <= size <= len(self._raw) - self.at:
            raise CorruptError(f"a byte string of {size} bytes, of which there are fewer")
        self.at += size
        return self._raw[self.at - size : self.at]


def _to_json(value: Any, raw: list[bytes]) -> Any:
    if isinstance(value, bytes):
        if len(value) < LEAST_RAW:
            return {BYTES: value.hex()}
        raw.append(value)
        return {BYTES: len(value)}
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise MeshError(f"metadata: key {key!r} is not a string")
        if BYTES in value:
            raise MeshError(f"metadata: key {BYTES!r} is reserved")
        return {key: _to_json(item, raw) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_to_json(item, raw) for item in value]
    return value
