"""Metadata <-> bytes: JSON-like values, with byte strings besides."""

import json
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.encoded import EncodedText
from ebz.codec.errors import CorruptError, MeshError
from ebz.codec.metadata_prior import PRIOR

# An object with this one key holds a byte string in hexadecimal.
BYTES = "$bytes"


def encode(metadata: dict[str, Any]) -> EncodedText | None:
    """The coded text, None where there is nothing; raises MeshError for what JSON cannot hold."""
    if not metadata:
        return None
    text = to_text(metadata)
    return EncodedText(len(text), _kernels.encode_text(_view(PRIOR), _view(text)))


def decode(encoded: EncodedText | None) -> dict[str, Any]:
    """The values; raises CorruptError where the text is not a JSON object."""
    if encoded is None:
        return {}
    return from_text(
        _kernels.decode_text(_view(PRIOR), _view(encoded.data), encoded.n_bytes).tobytes()
    )


def to_text(metadata: dict[str, Any]) -> bytes:
    """Compact JSON in UTF-8; raises MeshError for what JSON cannot hold."""
    try:
        text = json.dumps(_to_json(metadata), ensure_ascii=False, separators=(",", ":"))
    except (TypeError, ValueError, RecursionError) as error:
        raise MeshError(f"metadata: {error}") from None
    return text.encode("utf-8", "surrogatepass")


def from_text(text: bytes) -> dict[str, Any]:
    """The values; raises CorruptError where the bytes are not a JSON object."""
    try:
        metadata = json.loads(text.decode("utf-8", "surrogatepass"), object_hook=_from_json)
        if not isinstance(metadata, dict):
            raise CorruptError("not an object")
        # What is decoded must be a mesh that can be encoded: nested too deep, for one, it cannot.
        to_text(metadata)
    except (TypeError, ValueError, RecursionError) as error:
        raise CorruptError(str(error)) from None
    except MeshError as error:
        raise CorruptError(error.message) from None
    return metadata


def _view(data: bytes) -> npt.NDArray[np.uint8]:
    return np.frombuffer(data, np.uint8)


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
