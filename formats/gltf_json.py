"""The JSON and the buffers of glTF and GLB files.

Source: The Khronos Group, glTF 2.0 Specification.
"""

import json
from base64 import b64decode
from typing import Any

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


def joined_buffers(document: Any, binary: bytes) -> bytearray:
    """All buffers one after another; the document's views are changed to look there."""
    body = bytearray()
    offsets = []
    for number, buffer in enumerate(document.get("buffers", [])):
        uri = buffer.get("uri")
        if uri is None and number == 0:
            part = binary
        elif isinstance(uri, str) and uri.startswith("data:") and ";base64," in uri:
            part = b64decode(uri.split(";base64,", 1)[1], validate=True)
        else:
            raise MeshError(f"glTF: buffer {number} is in another file, {uri!r}: use a .glb file")
        if len(part) < buffer["byteLength"]:
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
