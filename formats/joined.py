"""A scene as one mesh, for formats that hold one: its parts one after another."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.elements import Element
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.dropped import warn_dropped

Array = npt.NDArray[Any]

# The face attribute that tells which part a face is of, and the names of the parts.
OBJECT, OBJECTS = "object", "objects"


def join(scene: Scene, format: str) -> Mesh:
    """The mesh; warns of what it cannot carry.

    Attributes stay where all parts with such items have them alike.  The face attribute "object"
    is the number of the part, and metadata["obj"]["objects"] has the names.
    """
    parts = scene.parts
    warn_dropped(f"{format.upper()} holds one mesh: the {len(parts)} parts are joined")
    starts = np.cumsum([0, *(part.n_vertices for part in parts)])
    corners = [part.corners + start for part, start in zip(parts, starts, strict=False)]
    offsets = _joined_offsets([part.offsets for part in parts])
    faces = _common("face", [(part.face_attributes, part.n_faces) for part in parts])
    number = np.repeat(np.arange(len(parts), dtype=np.int32), [part.n_faces for part in parts])
    return Mesh(
        vertices=np.concatenate([np.zeros((0, 3), np.float32), *(p.vertices for p in parts)]),
        faces=np.concatenate([np.zeros(0, np.int32), *corners]),
        face_offsets=offsets,
        vertex_attributes=_common("vertex", [(p.vertex_attributes, p.n_vertices) for p in parts]),
        face_attributes=faces | {OBJECT: number},
        corner_attributes=_common("corner", [(p.corner_attributes, p.n_corners) for p in parts]),
        elements=_joined_elements(parts, starts),
        metadata={"obj": {OBJECTS: _different(scene.names)}},
    )


def _different(names: Sequence[str | None]) -> list[str]:
    """The names, those that are missing or there already with a number behind."""
    found: list[str] = []
    for number, name in enumerate(names):
        own = name or f"part {number}"
        found.append(own if own not in found else f"{own}.{number}")
    return found


def _joined_offsets(parts: Sequence[Array]) -> Array:
    lengths = [np.diff(part) for part in parts]
    return np.cumsum(np.concatenate([[0], *lengths]), dtype=np.int64)


def _common(owner: str, parts: Sequence[tuple[Attributes, int]]) -> Attributes:
    """The attributes that all parts with items have, of one type; warns of others."""
    owners = [attributes for attributes, n in parts if n]
    names = list(dict.fromkeys(name for attributes in owners for name in attributes))
    joined, dropped = {}, []
    for name in names:
        columns = [attributes[name] for attributes in owners if name in attributes]
        kinds = {(column.dtype, column.shape[1:]) for column in columns}
        if len(columns) == len(owners) and len(kinds) == 1:
            joined[name] = np.concatenate(columns)
        else:
            dropped.append(repr(name))
    if dropped:
        warn_dropped(f"parts differ in {owner} attributes: {', '.join(dropped)}")
    return joined


def _joined_elements(parts: Sequence[Mesh], starts: Array) -> dict[str, Element]:
    joined = {}
    for name in dict.fromkeys(name for part in parts for name in part.elements):
        found = [
            (p.elements[name], n) for p, n in zip(parts, starts, strict=False) if name in p.elements
        ]
        joined[name] = Element(
            offsets=_joined_offsets([rows.offsets for rows, _ in found]),
            corners=np.concatenate([rows.corners + start for rows, start in found]),
            attributes=_common(name, [(rows.attributes, len(rows)) for rows, _ in found]),
            corner_attributes=_common(
                f"{name} corner", [(rows.corner_attributes, len(rows.corners)) for rows, _ in found]
            ),
        )
    return joined
