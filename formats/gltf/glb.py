"""The JSON and the buffers of glTF and GLB files.

Source: The Khronos Group, glTF 2.0 Specification.
"""

import json
import re
from base64 import b64decode
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

from ebz.codec.errors import MeshError

GLB_HEADER_SIZE = 12
CHUNK_HEADER_SIZE = 8
JSON_CHUNK = 0x4E4F534A
BIN_CHUNK = 0x004E4942


def split_glb(data: bytes) -> tuple[Any, bytes]:
    """The JSON and the binary chunk of a GLB file."""
    if len(data) < GLB_HEADER_SIZE + CHUNK_HEADER_SIZE or data[:4] != b"glTF":
        raise MeshError("offset 0: not a GLB header")
    version = int.from_bytes(data[4:8], "little")
    if version != 2:
        raise MeshError(f"offset 4: glTF version {version} is not read, only 2")
    chunks: dict[int, bytes] = {}
    offset = GLB_HEADER_SIZE
    while offset + CHUNK_HEADER_SIZE <= len(data):
        size = int.from_bytes(data[offset : offset + 4], "little")
        kind = int.from_bytes(data[offset + 4 : offset + 8], "little")
        begin = offset + CHUNK_HEADER_SIZE
        if begin + size > len(data):
            raise MeshError(f"offset {offset}: early end of file in a chunk of {size} bytes")
        chunks.setdefault(kind, data[begin : begin + size])
        offset = begin + size
    if JSON_CHUNK not in chunks:
        raise MeshError(f"offset {GLB_HEADER_SIZE}: there is no JSON chunk")
    return parse_json(chunks[JSON_CHUNK]), chunks.get(BIN_CHUNK, b"")


def parse_json(text: bytes) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MeshError(f"glTF: malformed JSON: {error}") from None


def make_glb(document: Any, binary: bytes) -> bytes:
    """A GLB file; without a binary chunk where there is nothing in it."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    parts = []
    for kind, chunk in [(JSON_CHUNK, text), *([(BIN_CHUNK, binary)] if binary else [])]:
        parts += [len(chunk).to_bytes(4, "little"), kind.to_bytes(4, "little"), chunk]
    size = GLB_HEADER_SIZE + sum(map(len, parts))
    head = [b"glTF", (2).to_bytes(4, "little"), size.to_bytes(4, "little")]
    return b"".join([*head, *parts])


def joined_buffers(document: Any, binary: bytes, folder: Path | None) -> bytearray:
    """All buffers one after another; the document's views are changed to look there.

    binary: what the first buffer is if it has no address.  folder: where files of buffers are.
    """
    body = bytearray()
    offsets = []
    for number, buffer in enumerate(document.get("buffers", [])):
        size = buffer["byteLength"]
        if "uri" not in buffer and number == 0:
            part = binary
        else:
            part = _at_address(buffer.get("uri"), size, folder, f"glTF: buffer {number}")
        if len(part) < size:
            raise MeshError(f"glTF: buffer {number}: early end at {len(part)} bytes")
        body += b"\0" * (-len(body) % 4)
        offsets.append(len(body))
        body += part
    for number, view in enumerate(document.get("bufferViews", [])):
        offset = offsets[view["buffer"]] + view.get("byteOffset", 0)
        if view["byteLength"] < 0 or offset < 0 or offset + view["byteLength"] > len(body):
            raise MeshError(f"glTF: buffer view {number} is out of range")
        view |= {"buffer": 0, "byteOffset": offset}
    return body


def _at_address(uri: Any, size: int, folder: Path | None, place: str) -> bytes:
    """The bytes of a buffer within a URI, or the first of a file in the folder or below."""
    if not isinstance(uri, str):
        raise MeshError(f"{place}: {uri!r} is no address")
    if uri.startswith("data:"):
        try:
            return b64decode(uri.split(";base64,", 1)[1], validate=True)
        except (IndexError, ValueError):
            raise MeshError(f"{place}: malformed base64 in its address") from None
    name = PurePosixPath(unquote(uri))
    if re.match(r"[A-Za-z][A-Za-z0-9+.-]*:", uri) or name.is_absolute() or ".." in name.parts:
        raise MeshError(f"{place} is at {uri!r}, which is not below the file's folder")
    if folder is None:
        raise MeshError(f"{place} is in another file, {uri!r}: name the file, or use a .glb file")
    try:
        with (folder / name).open("rb") as file:
            return file.read(size)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise MeshError(f"{place}: {uri}: {reason}") from None
