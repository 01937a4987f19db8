"""The JSON and the buffers of a glTF file, ready for open3d: geometry alone, in one GLB buffer.

Source: The Khronos Group, glTF 2.0 Specification.
"""

import json
from base64 import b64decode
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ebz.codec.errors import MeshError

GLB_HEADER_SIZE = 12
CHUNK_HEADER_SIZE = 8
JSON_CHUNK = 0x4E4F534A
BIN_CHUNK = 0x004E4942
TRIANGLES, STRIP, FAN = 4, 5, 6
COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")
# float32 counts vertices exactly up to here.
MAX_VERTICES = 1 << 24


@dataclass
class Content:
    """What the scene holds, counted once per node that shows it, and what is left out."""

    glb: bytes = b""
    n_vertices: int = 0
    n_faces: int = 0
    dropped: dict[str, int] = field(default_factory=dict)

    def drop(self, what: str, count: int = 1) -> None:
        if count:
            self.dropped[what] = self.dropped.get(what, 0) + count


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
    """A GLB file of two chunks."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    parts = []
    for kind, chunk in ((JSON_CHUNK, text), (BIN_CHUNK, binary)):
        parts += [len(chunk).to_bytes(4, "little"), kind.to_bytes(4, "little"), chunk]
    size = GLB_HEADER_SIZE + sum(map(len, parts))
    head = [b"glTF", (2).to_bytes(4, "little"), size.to_bytes(4, "little")]
    return b"".join([*head, *parts])


def geometry(document: Any, binary: bytes) -> Content:
    """The scene's triangles as a GLB file that names no other file, and what that leaves out.

    Each vertex gets its own texture coordinate, since the reader merges vertices that agree in
    everything. Raises MeshError where the document does not hang together.
    """
    try:
        return _geometry(document, binary)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise MeshError(f"glTF: malformed document: {error!r}") from None


def _geometry(document: Any, binary: bytes) -> Content:
    content = Content()
    for name in COMPRESSED:
        if name in document.get("extensionsRequired", []):
            raise MeshError(f"glTF: {name} is not read: decompress the file first")
    for key in ("materials", "textures", "images", "animations", "skins", "cameras"):
        content.drop(key, len(document.get(key, [])))
    body = joined_buffers(document, binary)
    uses = _uses_of_meshes(document)
    meshes = []
    for number, mesh in enumerate(document.get("meshes", [])):
        n_uses = uses.get(number, 0)
        content.drop("meshes outside the scene", int(not n_uses))
        content.drop("names of meshes", int(bool(n_uses) and "name" in mesh))
        primitives = [
            kept
            for primitive in mesh["primitives"]
            if (kept := _primitive(document, primitive, n_uses, content, body))
        ]
        meshes.append({"primitives": primitives})
    keys = ("asset", "scene", "scenes", "nodes", "accessors", "bufferViews")
    stripped = {key: document[key] for key in keys if key in document}
    stripped["nodes"] = [_node(node, meshes) for node in document.get("nodes", [])]
    stripped["meshes"] = meshes
    stripped["buffers"] = [{"byteLength": len(body)}]
    content.glb = make_glb(stripped, bytes(body))
    return content


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


def _uses_of_meshes(document: Any) -> dict[int, int]:
    """How many nodes of the scene show each mesh."""
    nodes = document.get("nodes", [])
    scenes = document.get("scenes", [])
    scene = scenes[document.get("scene", 0)] if scenes else {"nodes": range(len(nodes))}
    left = list(scene.get("nodes", []))
    uses: dict[int, int] = {}
    n_seen = 0
    while left:
        node = nodes[left.pop()]
        n_seen += 1
        if n_seen > len(nodes):
            raise MeshError("glTF: the nodes of the scene are no tree")
        left += node.get("children", [])
        if "mesh" in node:
            uses[node["mesh"]] = uses.get(node["mesh"], 0) + 1
    return uses


def _primitive(
    document: Any, primitive: Any, n_uses: int, content: Content, body: bytearray
) -> dict[str, Any] | None:
    """The primitive with positions, indices and one texture coordinate per vertex."""
    mode = primitive.get("mode", TRIANGLES)
    attributes = primitive["attributes"]
    if mode not in (TRIANGLES, STRIP, FAN) or "POSITION" not in attributes:
        content.drop("primitives that are no triangles", n_uses)
        return None
    content.drop("morph targets", n_uses * len(primitive.get("targets", [])))
    accessors = document["accessors"]
    position = accessors[attributes["POSITION"]]
    n_vertices = position["count"]
    if not 0 <= n_vertices <= min(len(body) // 6, MAX_VERTICES):
        raise MeshError(f"glTF: {n_vertices} positions declared in {len(body)} bytes")
    n_corners = n_vertices
    if "indices" in primitive:
        n_corners = accessors[primitive["indices"]]["count"]
    content.n_vertices += n_uses * n_vertices
    content.n_faces += n_uses * (n_corners // 3 if mode == TRIANGLES else max(n_corners - 2, 0))
    for name in attributes:
        if name != "POSITION":
            content.drop(name, n_uses)
    own = _append_vertex_numbers(document, n_vertices, body)
    kept = {"attributes": {"POSITION": attributes["POSITION"], "TEXCOORD_0": own}, "mode": mode}
    return kept | {key: primitive[key] for key in ("indices",) if key in primitive}


def _append_vertex_numbers(document: Any, n: int, body: bytearray) -> int:
    """The accessor of texture coordinates (i, 0), appended."""
    body += b"\0" * (-len(body) % 4)
    table = np.zeros((n, 2), "<f4")
    table[:, 0] = np.arange(n)
    view = {"buffer": 0, "byteOffset": len(body), "byteLength": table.nbytes}
    body += table.tobytes()
    document["bufferViews"].append(view)
    number = len(document["bufferViews"]) - 1
    accessor = {"bufferView": number, "componentType": 5126, "count": n, "type": "VEC2"}
    document["accessors"].append(accessor)
    return len(document["accessors"]) - 1


def _node(node: Any, meshes: list[Any]) -> dict[str, Any]:
    keys = ("children", "matrix", "translation", "rotation", "scale")
    kept = {key: node[key] for key in keys if key in node}
    if "mesh" in node and meshes[node["mesh"]]["primitives"]:
        kept["mesh"] = node["mesh"]
    return kept
