"""Meshes -> primitives of glTF: those of faces, of lines and of points."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ebz.codec.elements import Element
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.gltf.accessors import Array
from ebz.formats.gltf.attributes import TARGET, as_gltf
from ebz.formats.gltf.document import Builder
from ebz.formats.gltf.primitives import LINE_STRIP, LINES, POINTS, PRIMITIVE


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
            is_strip = len(element) == 1 and len(element.corners) > 2
            yield (LINE_STRIP, element.corners) if is_strip else (LINES, _segments(element))
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
    for name, values in as_gltf(mesh.vertex_attributes).items():
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
