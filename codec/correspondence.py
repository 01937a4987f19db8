"""Which vertex, face and corner of the original each of a decoded mesh is."""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import connectivity, cycles, matching, welding
from ebz.codec import points as free_points
from ebz.codec.arrays import Attributes
from ebz.codec.compare_coordinates import as_stored, points_of, restored
from ebz.codec.lattice import Lattice
from ebz.codec.mesh import Mesh

Order = npt.NDArray[Any]


class Correspondence(NamedTuple):
    """For each vertex, face and corner of the decoded mesh, that of the original."""

    vertices: Order
    faces: Order
    corners: Order
    how: str


def by_order(decoded: Mesh, original: Mesh) -> Correspondence | str:
    """The same indices, or the name of the first face that is another."""
    face = _first_other_face(decoded, original)
    if face is not None:
        got, wanted = (
            mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]].tolist()
            for mesh in (decoded, original)
        )
        return f"order: face {face} is {got}, not {wanted}"
    corners = np.arange(decoded.n_corners)
    vertices, faces = np.arange(decoded.n_vertices), np.arange(decoded.n_faces)
    return Correspondence(vertices, faces, corners, "order")


def _first_other_face(decoded: Mesh, original: Mesh) -> int | None:
    if np.array_equal(decoded.offsets, original.offsets):
        differs = np.flatnonzero(decoded.corners != original.corners)
        if not len(differs):
            return None
        return int(np.searchsorted(decoded.offsets, differs[0], side="right")) - 1
    n_same = int(np.argmax(decoded.offsets != original.offsets))
    same = decoded.corners[: decoded.offsets[n_same - 1]]
    differs = np.flatnonzero(same != original.corners[: len(same)])
    at = len(same) if not len(differs) else int(differs[0])
    return int(np.searchsorted(decoded.offsets[:n_same], at, side="right")) - 1


def by_traversal(decoded: Mesh, original: Mesh, lattice: Lattice) -> Correspondence | None:
    """By the encoder's traversal of the original; None where that leads to other faces."""
    points, offsets = points_of(original.vertices, lattice), original.face_offsets
    stored = restored(points, original.vertices)
    welded = welding.weld(original.faces, stored, offsets)
    surface, order = connectivity.traverse(welded, len(original.vertices), offsets)
    arrangement = welding.arrange(original.faces, welded, surface, order)
    arrangement, _ = free_points.encode(arrangement, points.integers)
    order = order._replace(vertices=arrangement.vertices)
    number = np.empty(len(order.vertices), np.int64)
    number[order.vertices] = np.arange(len(order.vertices))
    for faces, rows in cycles.by_size(decoded.offsets):
        theirs = order.faces[faces]
        if not (np.diff(original.offsets)[theirs] == rows.shape[1]).all():
            return None
        wanted = original.offsets[theirs][:, None] + np.arange(rows.shape[1])
        ours = decoded.corners[rows].astype(np.int64)
        if not cycles.turns_between(ours, number[original.corners[wanted]])[1].all():
            return None
    corners = corresponding_corners(decoded, original, order.vertices, order.faces)
    return Correspondence(order.vertices, order.faces, corners, "traversal")


def corresponding_corners(decoded: Mesh, original: Mesh, vertices: Order, faces: Order) -> Order:
    """The corner of the original for each of the decoded mesh, whose faces may be rotated.

    Where several corners fit, one whose values are the same.
    """
    got = np.asarray(vertices, np.int64)[decoded.corners]
    wanted = original.corners.astype(np.int64)
    got_values, wanted_values = _with_values(decoded, original, got, wanted)
    corners = np.empty(decoded.n_corners, np.int64)
    for rows, ours in cycles.by_size(decoded.offsets):
        theirs = original.offsets[faces[rows]][:, None] + np.arange(ours.shape[1])
        turns, _ = cycles.turns_between(got[ours], wanted[theirs])
        if decoded.corner_attributes:
            by_values, same = cycles.turns_between(got_values[ours], wanted_values[theirs])
            turns = np.where(same, by_values, turns)
        corners[ours] = cycles.turned(theirs, turns)
    return corners


def _with_values(decoded: Mesh, original: Mesh, got: Order, wanted: Order) -> tuple[Order, Order]:
    """Numbers of the corners, equal where vertices and the values of attributes are."""
    vertices = np.concatenate([got, wanted])
    if not decoded.corner_attributes:
        return got, wanted
    data = np.concatenate([_bytes(m.corner_attributes, m.n_corners) for m in (decoded, original)])
    ranks = matching.ranks(np.column_stack([matching.as_bytes(vertices), data]))
    return ranks[: len(got)], ranks[len(got) :]


def by_data(decoded: Mesh, original: Mesh, lattice: Lattice) -> tuple[Order, Order] | str | None:
    """As matching.match: what was stored of the original is compared exactly."""
    stored = as_stored(original.vertices, lattice)
    return matching.match(_labelled(decoded, decoded.vertices), _labelled(original, stored))


def _labelled(mesh: Mesh, vertices: npt.NDArray[Any]) -> matching.Labelled:
    return matching.Labelled(
        mesh.corners,
        mesh.offsets,
        np.column_stack(
            [matching.as_bytes(vertices), _bytes(mesh.vertex_attributes, len(vertices))]
        ),
        _bytes(mesh.face_attributes, mesh.n_faces),
    )


def _bytes(attributes: Attributes, n: int) -> npt.NDArray[np.uint8]:
    """The bytes of each of n entries."""
    columns = [matching.as_bytes(attributes[name]) for name in sorted(attributes)]
    return np.column_stack([np.zeros((n, 0), np.uint8), *columns])


def different_face_data(decoded: Mesh, original: Mesh) -> str | None:
    """The first attribute whose values are not those of the original in any order."""
    n_faces = decoded.n_faces
    for name in decoded.face_attributes:
        ours, theirs = (
            _bytes({name: mesh.face_attributes[name]}, n_faces) for mesh in (decoded, original)
        )
        if not matching.same_rows(ours, theirs):
            return f"face attribute {name!r}: values differ"
    return None
