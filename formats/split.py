"""Attributes of corners as attributes of vertices, for formats that have no others."""

import numpy as np

from ebz.codec.elements import Element
from ebz.codec.matching import as_bytes
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped


def split_vertices(mesh: Mesh, format: str) -> Mesh:
    """The mesh with a vertex for each value that corners have at one; warns of how many are more.

    The order of vertices stays; elements keep the first of each.
    """
    carried = {
        name: values
        for name, values in mesh.corner_attributes.items()
        if name not in mesh.vertex_attributes
    }
    if not carried:
        return mesh
    corners = mesh.corners.astype(np.int64)
    keys = np.column_stack([as_bytes(values) for values in [corners, *carried.values()]])
    rows = np.ascontiguousarray(keys).view(np.dtype((np.void, keys.shape[1]))).reshape(-1)
    _, first, number = np.unique(rows, return_index=True, return_inverse=True)
    used = np.zeros(mesh.n_vertices, bool)
    used[corners] = True
    source = np.concatenate([corners[first], np.flatnonzero(~used)])
    if len(source) > mesh.n_vertices:
        more = len(source) - mesh.n_vertices
        warn_dropped(f"{format} holds attributes of vertices only: {more} vertices are split off")
    order = np.argsort(source, kind="stable")
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    source = source[order]
    n_free = len(source) - len(first)
    moved = {
        name: np.concatenate([values[first], np.zeros((n_free, *values.shape[1:]), values.dtype)])
        for name, values in carried.items()
    }
    first_of = np.searchsorted(source, np.arange(mesh.n_vertices))
    return Mesh(
        mesh.vertices[source],
        place[number.reshape(-1)].reshape(mesh.faces.shape),
        {name: values[source] for name, values in mesh.vertex_attributes.items()}
        | {name: values[order] for name, values in moved.items()},
        mesh.face_attributes,
        mesh.metadata,
        face_offsets=mesh.face_offsets,
        corner_attributes={k: v for k, v in mesh.corner_attributes.items() if k not in carried},
        elements={
            name: Element(e.offsets, first_of[e.corners], e.attributes, e.corner_attributes)
            for name, e in mesh.elements.items()
        },
    )
