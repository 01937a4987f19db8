"""glTF and GLB files -> scenes: every primitive is a part, and all else is kept as it is.

A file of one primitive is a mesh, whose metadata are those of the part and of the scene.  Nodes are
kept, and no transformation is applied: metadata["gltf"]["document"] is the file's JSON without the
geometry, metadata["gltf"]["binary"] what else it refers to.
"""

from pathlib import Path
from typing import Any

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.gltf.document import check_nodes, remove_extension, without_geometry
from ebz.formats.gltf.glb import joined_buffers, parse_json, split_glb
from ebz.formats.gltf.primitives import COMPRESSED, read_primitives

DOCUMENT = "gltf"


def read_gltf(data: bytes, folder: Path | None = None) -> Mesh | Scene:
    """The meshes of a glTF file whose buffers are embedded or in its folder. Raises MeshError."""
    return _read(parse_json(data.removeprefix(b"\xef\xbb\xbf")), b"", "gltf", folder)


def read_glb(data: bytes, folder: Path | None = None) -> Mesh | Scene:
    """The meshes of a GLB file. Raises MeshError."""
    document, binary = split_glb(data)
    return _read(document, binary, "glb", folder)


def _read(document: Any, binary: bytes, format: str, folder: Path | None) -> Mesh | Scene:
    if not isinstance(document, dict):
        raise MeshError("glTF: the document is no object")
    try:
        _check_compression(document)
        check_nodes(document)
        body = joined_buffers(document, binary, folder)
        parts = read_primitives(document, body)
        metadata = {"format": format, DOCUMENT: without_geometry(document, bytes(body))}
    except (AttributeError, IndexError, KeyError, OverflowError, TypeError, ValueError) as error:
        raise MeshError(f"glTF: malformed document: {error!r}") from None
    if len(parts) != 1:
        return Scene(parts, metadata)
    parts[0].metadata |= metadata
    return parts[0]


def _check_compression(document: Any) -> None:
    """Raise MeshError where there is nothing but compressed geometry; else forget about it."""
    for name in COMPRESSED:
        if name in document.get("extensionsRequired", []):
            raise MeshError(f"glTF: {name} is not read: decompress the file first")
        if name in document.get("extensionsUsed", []):
            document["extensionsUsed"].remove(name)
            remove_extension(document, name)
