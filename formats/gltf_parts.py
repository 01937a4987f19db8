"""Meshes -> primitives of glTF: what its attributes can hold, under their names."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from ebz.codec.arrays import Attributes
from ebz.codec.elements import Element
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.gltf_accessors import COMPONENT_OF, TYPE_OF, Array
from ebz.formats.gltf_document import Builder
from ebz.formats.gltf_primitives import LINES, POINTS, PRIMITIVE

STANDARD = re.compile(r"NORMAL|TANGENT|(TEXCOORD|COLOR|JOINTS|WEIGHTS)_\d+|_.*")
TARGET = re.compile(r"target (\d+)/(.+)")
# Names of other formats.
NAMES = {
    "normal": "NORMAL",
    "uv": "TEXCOORD_0",
    "st": "TEXCOORD_0",
    "rgb": "COLOR_0",
    "rgba": "COLOR_0",
}
EXACT = [np.dtype(name) for name in ("u1", "i1", "u2", "i2", "f4")]


def write_primitives(mesh: Mesh, builder: Builder) -> Iterator[dict[str, Any]]:
    """The primitives of a mesh: of its faces, its lines and its points."""
    kept = mesh.metadata.get(PRIMITIVE, {})
    warn_attributes("glTF", face=mesh.face_attributes, corner=mesh.corner_attributes)
    if not mesh.n_vertices:
        warn_dropped(f"glTF cannot hold the empty mesh {mesh.metadata.get('name', '')!r}")
        return
    shared = _vertices(mesh, kept, builder)
    shared |= {key: kept[key] for key in ("material", "extras", "extensions") if key in kept}
    modes = list(_modes(mesh, kept))
    for mode, corners in modes:
        indices = {} if corners is None else {"indices": builder.add_indices(corners)}
        yield shared | indices | ({} if mode is None else {"mode": mode})


def _modes(mesh: Mesh, kept: dict[str, Any]) -> Iterator[tuple[int | None, Array | None]]:
    if mesh.n_faces:
        yield None, mesh.corners
    for name, element in mesh.elements.items():
        if element.attributes or element.corner_attributes:
            names = [*element.attributes, *element.corner_attributes]
            warn_dropped(f"glTF cannot carry attributes of {name!r}: {', '.join(names)}")
        if name == "point" and len(element.corners):
            yield POINTS, element.corners
        elif name == "line" and len(element.corners):
            yield LINES, _segments(element)
        elif len(element):
            warn_dropped(f"glTF cannot carry elements: {name!r} ({len(element)})")
    if not mesh.n_faces and not mesh.elements:
        yield POINTS, None


def _segments(element: Element) -> Array:
    """The ends of every segment of every line."""
    first = np.ones(len(element.corners), bool)
    last = np.ones(len(element.corners), bool)
    lengths = np.diff(element.offsets)
    last[element.offsets[1:][lengths > 0] - 1] = False
    first[element.offsets[:-1][lengths > 0]] = False
    return np.stack([element.corners[last], element.corners[first]], axis=1).reshape(-1)


def _vertices(mesh: Mesh, kept: dict[str, Any], builder: Builder) -> dict[str, Any]:
    normalized = set(kept.get("normalized", []))
    positions = _positions(mesh).astype(kept.get("positions", "float32"))
    attributes = {
        "POSITION": builder.add(positions, normalized="POSITION" in normalized, bounds=True)
    }
    targets: dict[int, dict[str, int]] = {}
    for name, values in _carried(mesh.vertex_attributes).items():
        if found := TARGET.fullmatch(name):
            target = targets.setdefault(int(found[1]), {})
            target[found[2]] = builder.add(values, bounds=found[2] == "POSITION")
        else:
            scaled = name in normalized or (name.startswith("COLOR_") and values.dtype.kind == "u")
            attributes[name] = builder.add(values, normalized=scaled)
    result: dict[str, Any] = {"attributes": attributes}
    return result | ({"targets": [targets[i] for i in sorted(targets)]} if targets else {})


def _positions(mesh: Mesh) -> Array:
    with np.errstate(over="ignore", invalid="ignore"):
        single = mesh.vertices.astype(np.float32)
    if not np.array_equal(single, mesh.vertices, equal_nan=True):
        warn_dropped("glTF cannot carry float64: coordinates are rounded to float32")
    if not np.isfinite(single).all():
        bad = int(np.argmin(np.isfinite(single).all(axis=1)))
        raise MeshError(f"vertex {bad}: glTF holds finite coordinates only")
    return single


def _carried(attributes: Attributes) -> Attributes:
    """The attributes under names of glTF, in types of glTF; warns of those that have none."""
    carried, dropped = {}, {}
    for name, values in attributes.items():
        own = NAMES.get(name, name)
        if not STANDARD.fullmatch(own) and not TARGET.fullmatch(own):
            own = f"_{own}"
        exact = _exact(values)
        if exact is None or own in carried:
            dropped[name] = values
        else:
            carried[own] = exact
    warn_attributes("glTF", vertex=dropped)
    return carried


def _exact(values: Array) -> Array | None:
    """The values in a shape and a type that glTF has, where one holds them exactly."""
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape[1:] not in TYPE_OF:
        return None
    if values.dtype in COMPONENT_OF and values.dtype != np.uint32:
        return values
    for dtype in EXACT:
        with np.errstate(all="ignore"):
            cast = values.astype(dtype)
        if np.array_equal(cast.astype(values.dtype), values, equal_nan=values.dtype.kind == "f"):
            return cast
    return None
