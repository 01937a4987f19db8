"""The JSON of glTF without its geometry, and with it again.

Accessors and buffer views that meshes alone refer to leave holes in their lists, which geometry
fills again: the numbers by which animations, skins, images and extensions refer to the others stay.
"""

import copy
from collections.abc import Iterator
from typing import Any

import numpy as np

from ebz.codec.errors import MeshError
from ebz.formats.gltf.accessors import (
    ALIGNMENT,
    ARRAY_BUFFER,
    COMPONENT_OF,
    ELEMENT_ARRAY_BUFFER,
    TYPE_OF,
    Array,
    packed_rows,
)

# What stands where geometry was that is no more.
EMPTY_ACCESSOR = {"componentType": 5121, "count": 1, "type": "SCALAR"}
GENERATOR = {"version": "2.0", "generator": "ebz"}


def without_geometry(document: Any, body: bytes) -> dict[str, Any]:
    """{"document": the JSON that is kept, "binary": the bytes that it refers to}."""
    geometry = set(_geometry_accessors(document))
    kept = {key: copy.deepcopy(value) for key, value in document.items() if key != "buffers"}
    for mesh in kept.get("meshes", []):
        del mesh["primitives"]
    accessors = kept.get("accessors", [])
    kept["accessors"] = [None if i in geometry else accessors[i] for i in range(len(accessors))]
    views, used = kept.pop("bufferViews", []), set(_views_of(kept))
    binary = bytearray()
    kept["bufferViews"] = []
    for number, view in enumerate(views):
        if number not in used:
            kept["bufferViews"].append(None)
            continue
        begin = view["byteOffset"]
        kept["bufferViews"].append(
            view | {"byteOffset": append(binary, body[begin : begin + view["byteLength"]])}
        )
    for key in ("accessors", "bufferViews"):
        while kept[key] and kept[key][-1] is None:
            kept[key].pop()
        if not kept[key]:
            del kept[key]
    kept = dict(sorted(kept.items()))  # so that what is written and read again is the same
    return {"document": kept} | ({"binary": bytes(binary)} if binary else {})


def remove_extension(value: Any, name: str) -> None:
    """Whatever an extension adds, anywhere in a document."""
    if isinstance(value, dict):
        if isinstance(value.get("extensions"), dict):
            value["extensions"].pop(name, None)
        for item in value.values():
            remove_extension(item, name)
    elif isinstance(value, list):
        for item in value:
            remove_extension(item, name)


def check_nodes(document: Any) -> None:
    """Raise MeshError where a node shows what is no mesh."""
    n_meshes = len(document.get("meshes", []))
    for number, node in enumerate(document.get("nodes", [])):
        mesh = node.get("mesh", 0)
        if type(mesh) is not int or not 0 <= mesh < max(n_meshes, "mesh" not in node):
            raise MeshError(f"glTF: node {number}: there is no mesh {mesh!r}")


def append(body: bytearray, part: bytes | bytearray) -> int:
    """Where a part of a buffer stands that is appended to it."""
    body += b"\0" * (-len(body) % ALIGNMENT)
    begin = len(body)
    body += part
    return begin


def _geometry_accessors(document: Any) -> Iterator[int]:
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            yield from primitive["attributes"].values()
            yield from [primitive["indices"]] if "indices" in primitive else []
            for target in primitive.get("targets", []):
                yield from target.values()


def _views_of(value: Any) -> Iterator[int]:
    """Whatever is called bufferView, anywhere."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key == "bufferView" and type(item) is int:
                yield item
            else:
                yield from _views_of(item)
    elif isinstance(value, list):
        for item in value:
            yield from _views_of(item)


class Builder:
    """A document to which geometry is added."""

    def __init__(self, kept: dict[str, Any] | None) -> None:
        kept = kept or {}
        self.document: dict[str, Any] = copy.deepcopy(kept.get("document", {"asset": GENERATOR}))
        self.body = bytearray(kept.get("binary", b""))
        self._accessors = self.document.setdefault("accessors", [])
        self._views = self.document.setdefault("bufferViews", [])
        for view in filter(None, self._views):
            view["buffer"] = 0

    def add(self, values: Array, *, normalized: bool = False, bounds: bool = False) -> int:
        """The number of a new accessor with the values of vertices."""
        data, stride = packed_rows(values)
        view = {"target": ARRAY_BUFFER} | ({"byteStride": stride} if stride else {})
        accessor = self._accessor(values, data, view)
        accessor |= {"normalized": True} if normalized else {}
        if bounds:
            accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        return _fill(self._accessors, accessor)

    def add_indices(self, values: Array) -> int:
        """The number of a new accessor with indices of vertices."""
        # The largest number of a type restarts primitives.
        dtype = np.dtype(np.uint16 if values.max(initial=0) < 0xFFFF else np.uint32)
        indices = values.astype(dtype).reshape(-1)
        data = indices.astype(dtype.newbyteorder("<")).tobytes()
        view = {"target": ELEMENT_ARRAY_BUFFER}
        return _fill(self._accessors, self._accessor(indices, data, view))

    def _accessor(self, values: Array, data: bytes, view: dict[str, Any]) -> dict[str, Any]:
        place = {"buffer": 0, "byteOffset": append(self.body, data), "byteLength": len(data)}
        return {
            "bufferView": _fill(self._views, place | view),
            "componentType": COMPONENT_OF[values.dtype],
            "count": len(values),
            "type": TYPE_OF[values.shape[1:]],
        }

    def finished(self) -> tuple[dict[str, Any], bytes]:
        """The document, whose first buffer has no address, and that buffer."""
        hole = {"buffer": 0, "byteOffset": 0, "byteLength": 1}
        if None in self._views:
            append(self.body, b"\0" if not self.body else b"")
        self._views[:] = [view or hole for view in self._views]
        self._accessors[:] = [accessor or EMPTY_ACCESSOR for accessor in self._accessors]
        if self.body:
            self.document["buffers"] = [{"byteLength": len(self.body)}]
        for key in ("accessors", "bufferViews"):
            if not self.document[key]:
                del self.document[key]
        return self.document, bytes(self.body)


def _fill(items: list[Any], item: dict[str, Any]) -> int:
    """The number of the first hole, which the item fills, or of a new place."""
    if None in items:
        number = items.index(None)
        items[number] = item
        return number
    items.append(item)
    return len(items) - 1
