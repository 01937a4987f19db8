"""Scenes -> glTF and GLB files."""

import json
from base64 import b64encode
from typing import Any

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.gltf.document import Builder, check_nodes
from ebz.formats.gltf.glb import make_glb
from ebz.formats.gltf.parts import write_primitives
from ebz.formats.gltf.primitives import PRIMITIVE
from ebz.formats.polygons import triangulated
from ebz.formats.split import split_vertices

DOCUMENT = "gltf"


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
        check_nodes(content.metadata.get(DOCUMENT, {}).get("document", {}))
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
