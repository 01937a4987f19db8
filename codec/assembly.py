"""What the streams of a mesh hold along its decoded surface, and the mesh that this makes."""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import lattice, metadata, positions
from ebz.codec import order as source_order
from ebz.codec import points as free_points
from ebz.codec.arrays import Attributes, face_dtype
from ebz.codec.attributes import coding, corners, rows
from ebz.codec.attributes.items import Sites
from ebz.codec.elements import Element
from ebz.codec.encoded import EncodedMesh
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.codec.integers import decode_columns, from_gaps
from ebz.codec.mesh import Mesh
from ebz.codec.order import SourceOrder
from ebz.codec.surface import Surface
from ebz.codec.welding import Split


class Carried(NamedTuple):
    """What a mesh has besides its surface, in output order."""

    vertices: Attributes
    faces: Attributes
    corners: Attributes
    elements: dict[str, Element]
    metadata: dict[str, Any]


NOTHING = Carried({}, {}, {}, {}, {})


def decode_integers(encoded: EncodedMesh, surface: Surface, n_sites: int) -> lattice.Integers:
    """(n_sites, 3) on the lattice: those along the surface, and points beside it."""
    streams = encoded.streams
    n_along = n_sites if streams.points is None else surface.n_vertices
    coded = positions.Coded(streams.positions, encoded.coding, streams.listing)
    with corrupt_at(encoded.place("positions")):
        integers = positions.decode(coded, surface, n_along)
    if streams.points is None:
        return integers
    with corrupt_at(encoded.place("points")):
        free = free_points.decode(streams.points, n_sites - n_along)
    return np.concatenate([integers, free])


def decode_coordinates(encoded: EncodedMesh, integers: lattice.Integers) -> lattice.Floats:
    """(n, 3) coordinates of these integers, exceptions among them."""
    if not encoded.n_exceptions:
        return encoded.lattice.coordinates(integers, encoded.dtype)
    with corrupt_at(encoded.place("exceptions")):
        rows, exact = _decode_exceptions(encoded, len(integers)), _decode_values(encoded)
    points = lattice.Points(encoded.lattice, integers, rows)
    return lattice.restore(points, encoded.dtype, exact)


def decode_carried(encoded: EncodedMesh, sites: Sites) -> Carried:
    """What a mesh has besides its surface, in output order."""
    if not encoded.carries_more:
        return NOTHING
    with corrupt_at(encoded.place("metadata")):
        values = metadata.decode(encoded.metadata)
    of_vertices, of_faces = encoded.vertex_attributes, encoded.face_attributes
    return Carried(
        coding.decode(of_vertices, sites.by_vertex) if of_vertices else {},
        coding.decode(of_faces, sites.by_face) if of_faces else {},
        corners.decode(encoded.corner_attributes, sites),
        rows.decode(encoded.elements, sites),
        values,
    )


def decode_order(
    encoded: EncodedMesh, surface: Surface, split: Split, integers: lattice.Integers
) -> SourceOrder:
    """What is kept of the order of the source."""
    streams = encoded.streams.order
    if not streams.any:
        offsets = None if surface.polygons is None else surface.polygons.offsets
        return SourceOrder(offsets=offsets)
    at = split.at_sites(integers)
    known = source_order.Known(surface.opposite, split.vertex, at, surface.polygons)
    return source_order.decode(streams, known, place=encoded.place)


def arranged(sites: Sites, kept: SourceOrder, carried: Carried) -> Mesh:
    """The mesh from what is in output order."""
    vertices = kept.place_vertices(sites.vertices)
    indices = kept.source_vertices(kept.place_values(sites.of_faces(sites.vertex)))
    indices = indices.astype(face_dtype(sites.n_vertices), copy=False)
    if kept.offsets is None:
        mesh = Mesh.of_triangles(vertices, indices.reshape(-1, 3))
    else:
        mesh = Mesh(vertices, indices, face_offsets=kept.source_offsets)
    if carried is not NOTHING:
        _add_carried(mesh, sites, kept, carried)
    return mesh


def _add_carried(mesh: Mesh, sites: Sites, kept: SourceOrder, carried: Carried) -> None:
    mesh.vertex_attributes = {k: kept.place_vertices(v) for k, v in carried.vertices.items()}
    mesh.face_attributes = {k: kept.place_faces(v) for k, v in carried.faces.items()}
    mesh.corner_attributes = {
        k: kept.place_values(sites.of_faces(v)) for k, v in carried.corners.items()
    }
    mesh.elements = rows.renumbered(carried.elements, kept.source_vertices)
    mesh.metadata = carried.metadata
    mesh.check_carried()


def _decode_values(encoded: EncodedMesh) -> lattice.Floats:
    data, little = encoded.streams.exception_values, encoded.dtype.newbyteorder("<")
    if len(data) != encoded.n_exceptions * little.itemsize:
        raise CorruptError(f"{len(data)} bytes for {encoded.n_exceptions} values")
    return np.frombuffer(data, little)


def _decode_exceptions(encoded: EncodedMesh, n_sites: int) -> npt.NDArray[np.int64]:
    (gap,) = decode_columns(encoded.streams.exception_rows, encoded.n_exceptions, 1)
    rows = from_gaps(gap)
    if (np.diff(rows, prepend=-1) <= 0).any() or (rows >= 3 * n_sites).any():
        raise CorruptError("rows do not ascend within the coordinates")
    return rows
