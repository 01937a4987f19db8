"""A digest of everything that a mesh holds, the same on every machine."""

from typing import Any

import numpy as np
import numpy.typing as npt
import xxhash

from ebz.codec import metadata
from ebz.codec.mesh import Mesh

SIZE = 8


def digest(mesh: Mesh) -> bytes:
    """XXH3 (64 bits) of the arrays in little-endian order, their names and shapes, and metadata."""
    state = xxhash.xxh3_64()
    _add(state, "vertices", mesh.vertices)
    _add(state, "faces", mesh.faces)
    for name, values in mesh.vertex_attributes.items():
        _add(state, f"vertex {name}", values)
    for name, values in mesh.face_attributes.items():
        _add(state, f"face {name}", values)
    state.update(metadata.encode(mesh.metadata) if mesh.metadata else b"")
    return bytes(state.digest())


def _add(state: Any, name: str, values: npt.NDArray[Any]) -> None:
    dtype = values.dtype.newbyteorder("<")
    state.update(f"{name}\0{dtype.str}\0{values.shape}\0".encode("utf-8", "surrogatepass"))
    state.update(np.ascontiguousarray(values, dtype).reshape(-1).view(np.uint8).data)
