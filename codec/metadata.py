"""Metadata <-> bytes: JSON-like values, with byte strings besides."""

import json
from typing import Any

from ebz.codec.errors import CorruptError, MeshError

# An object with this one key holds a byte string in hexadecimal.
BYTES = "$bytes"


def encode(metadata: dict[str, Any]) -> bytes:
    """Compact JSON in UTF-8; raises MeshError for what JSON cannot hold."""
    try:
        text = json.dumps(_to_json(metadata), ensure_ascii=False, separators=(",", ":"))
    except (TypeError, ValueError, RecursionError) as error:
        raise MeshError(f"metadata: {error}") from None
    return text.encode("utf-8", "surrogatepass")


def decode(data: bytes) -> dict[str, Any]:
    """The values; raises CorruptError where the bytes are not a JSON object."""
    try:
        metadata = json.loads(data.decode("utf-8", "surrogatepass"), object_hook=_from_json)
        if not isinstance(metadata, dict):
            raise CorruptError("not an object")
        # What is decoded must be a mesh that can be encoded: nested too deep, for one, it cannot.
        encode(metadata)
    except (TypeError, ValueError, RecursionError) as error:
        raise CorruptError(str(error)) from None
    except MeshError as error:
        raise CorruptError(error.message) from None
    return metadata


def _to_json(value: Any) -> Any:
    if isinstance(value, bytes):
        return {BYTES: value.hex()}
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise MeshError(f"metadata: key {key!r} is not a string")
        if BYTES in value:
            raise MeshError(f"metadata: key {BYTES!r} is reserved")
        return {key: _to_json(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_to_json(item) for item in value]
    return value


def _from_json(value: dict[str, Any]) -> Any:
    return bytes.fromhex(value[BYTES]) if value.keys() == {BYTES} else value
