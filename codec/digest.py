"""A digest of everything that a mesh holds, the same on every machine."""

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import xxhash

from ebz.codec import metadata
from ebz.codec.arrays import Attributes
from ebz.codec.mesh import Mesh

SIZE = 8


def digest(mesh: Mesh) -> bytes:
    """XXH3 (64 bits) of the arrays in little-endian order, their names and shapes, and metadata."""
    state = xxhash.xxh3_64()
    _add(state, "vertices", mesh.vertices)
    _add(state, "faces", mesh.faces)
    if mesh.face_offsets is not None:
        _add(state, "face offsets", mesh.face_offsets)
    for owner, attributes in (
        ("vertex", mesh.vertex_attributes),
        ("face", mesh.face_attributes),
        ("corner", mesh.corner_attributes),
    ):
        if attributes:
            _add_all(state, owner, attributes)
    for name, element in mesh.elements.items():
        _add(state, f"offsets of {name}", element.offsets)
        _add(state, f"corners of {name}", element.corners)
        _add_all(state, name, element.attributes)
        _add_all(state, f"{name} corner", element.corner_attributes)
    if mesh.metadata:
        for part in metadata.to_text(mesh.metadata):
            state.update(part)
    return bytes(state.digest())


@cache
def _little_endian(dtype: np.dtype[Any]) -> np.dtype[Any]:
    return dtype.newbyteorder("<")


def _add_all(state: Any, owner: str, attributes: Attributes) -> None:
    for name, values in attributes.items():
        _add(state, f"{owner} {name}", values)


def _add(state: Any, name: str, values: npt.NDArray[Any]) -> None:
    little = np.ascontiguousarray(values, _little_endian(values.dtype))
    head = f"{name}\0{little.dtype.str}\0{values.shape}\0"
    state.update(head.encode("utf-8", "surrogatepass"))
    state.update(little)
