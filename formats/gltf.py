"""glTF and GLB files <-> scenes: every primitive is a part, and all else is kept as it is.

A file of one primitive is a mesh, whose metadata are those of the part and of the scene.  Nodes are
kept, and no transformation is applied: metadata["gltf"]["document"] is the file's JSON without the
geometry, metadata["gltf"]["binary"] what else it refers to.
"""

import json
from base64 import b64encode
from pathlib import Path
from typing import Any

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.gltf_document import Builder, remove_extension, without_geometry
from ebz.formats.gltf_json import joined_buffers, make_glb, parse_json, split_glb
from ebz.formats.gltf_parts import write_primitives
from ebz.formats.gltf_primitives import COMPRESSED, PRIMITIVE, read_primitives
from ebz.formats.polygons import triangulated
from ebz.formats.split import split_vertices

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
        _check_nodes(document)
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


def _check_nodes(document: Any) -> None:
    """Raise MeshError where a node shows what is no mesh."""
    n_meshes = len(document.get("meshes", []))
    for number, node in enumerate(document.get("nodes", [])):
        mesh = node.get("mesh", 0)
        if type(mesh) is not int or not 0 <= mesh < max(n_meshes, "mesh" not in node):
            raise MeshError(f"glTF: node {number}: there is no mesh {mesh!r}")


def write_gltf(content: Mesh | Scene) -> bytes:
    """A glTF file with an embedded buffer; warns of what is left out."""
    document, body = _write(content)
    if body:
        address = "data:application/octet-stream;base64," + b64encode(body).decode()
        document["buffers"][0]["uri"] = address
    return json.dumps(document, separators=(",", ":")).encode()


def write_glb(content: Mesh | Scene) -> bytes:
    """A GLB file; warns of what is left out."""
    return make_glb(*_write(content))


def _write(content: Mesh | Scene) -> tuple[dict[str, Any], bytes]:
    """The document and its buffer; metadata may come from a file, and are checked like one."""
    try:
        _check_nodes(content.metadata.get(DOCUMENT, {}).get("document", {}))
        return _built(content)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise MeshError(f"metadata 'gltf' is no glTF document: {error!r}") from None


def _built(content: Mesh | Scene) -> tuple[dict[str, Any], bytes]:
    parts = content.parts if isinstance(content, Scene) else [content]
    builder = Builder(content.metadata.get(DOCUMENT))
    meshes = builder.document.setdefault("meshes", [])
    for mesh in meshes:
        mesh["primitives"] = []
    for part in (split_vertices(triangulated(part, "glTF"), "glTF") for part in parts):
        primitives = list(write_primitives(part, builder))
        place = part.metadata.get(PRIMITIVE, {}).get("mesh")
        if place is not None and place < len(meshes):
            meshes[place]["primitives"] += primitives
        elif primitives:
            _add_mesh(builder.document, part, primitives)
    _remove_empty(builder.document)
    return builder.finished()


def _add_mesh(document: dict[str, Any], part: Mesh, primitives: list[dict[str, Any]]) -> None:
    """A mesh that no node shows yet, and a node of the scene that shows it."""
    name = part.metadata.get("name")
    named = {"name": name} if isinstance(name, str) else {}
    document["meshes"].append(named | {"primitives": primitives})
    nodes, scenes = document.setdefault("nodes", []), document.setdefault("scenes", [{}])
    nodes.append({"mesh": len(document["meshes"]) - 1})
    scene = scenes[document.setdefault("scene", 0)]
    scene.setdefault("nodes", []).append(len(nodes) - 1)


def _remove_empty(document: dict[str, Any]) -> None:
    """Meshes without primitives, which glTF does not allow, and the list if it is empty."""
    left = [bool(mesh["primitives"]) for mesh in document["meshes"]]
    number = [sum(left[:i]) for i in range(len(left))]
    for node in document.get("nodes", []):
        if "mesh" not in node:
            continue
        if left[node["mesh"]]:
            node["mesh"] = number[node["mesh"]]
        else:
            del node["mesh"]
    document["meshes"] = [mesh for mesh in document["meshes"] if mesh["primitives"]]
    if not document["meshes"]:
        del document["meshes"]
