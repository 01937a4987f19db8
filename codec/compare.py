"""Whether a decoded mesh is the original, up to the order of vertices and faces.

The correspondence comes from running the encoder's traversal on the original; where that leads to
other faces, because the original's own order differs in a way that matters, vertices are matched by
their exact data, refined by the data of the faces around them.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from ebz.codec import correspondence
from ebz.codec.attributes import comparison
from ebz.codec.attributes.comparison import Lattices
from ebz.codec.compare_coordinates import allowed_error, distances, errors, moved
from ebz.codec.correspondence import Correspondence
from ebz.codec.errors import EbzError
from ebz.codec.lattice import Lattice
from ebz.codec.mesh import Mesh


class UndecidedError(EbzError):
    """Neither the traversal nor the data tell which vertex is which."""


@dataclass(frozen=True)
class Verification:
    """What was checked and how it came out; as_dict() is what --json prints.

    equal: nothing differs beyond what the file's precision allows.  first_difference: its name,
    None where there is none.  Errors are distances in model units, per coordinate (largest) and per
    vertex (root mean square); None where nothing was compared.
    """

    equal: bool
    checked: list[str]
    vertices: int
    faces: int
    first_difference: str | None = None
    matched_by: str | None = None
    largest_error: float | None = None
    rms_error: float | None = None
    allowed_error: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """The fields by name."""
        return asdict(self)


def compare(
    decoded: Mesh,
    original: Mesh,
    lattice: Lattice,
    checked: list[str],
    *,
    lattices: Lattices | None = None,
    keeps_order: bool = False,
) -> Verification:
    """The verdict on a decoded mesh; raises UndecidedError where there is none.

    lattice, lattices: the precision at which the mesh and its attributes were stored.
    keeps_order: whether its order was.
    """
    original = replace(original)  # its arrays may have been exchanged since they were checked
    lattices = lattices or {}
    difference = _different_kind(decoded, original)
    if difference:
        return _refusal(decoded, difference, checked)
    allowed = allowed_error(lattice, original)
    if keeps_order:
        ordered = correspondence.by_order(decoded, original)
        if isinstance(ordered, str):
            return _refusal(decoded, ordered, checked)
        checked = [*checked, "order of vertices and faces"]
        return _verdict(decoded, original, ordered, allowed, lattices, checked)
    match = correspondence.by_traversal(decoded, original, lattice)
    verdict = match and _verdict(decoded, original, match, allowed, lattices, checked)
    if verdict and verdict.equal:
        return verdict
    # Symmetric surfaces are traversed alike in several ways: the data have the last word.
    matched = correspondence.by_data(decoded, comparison.as_stored(original, lattices), lattice)
    if isinstance(matched, tuple):
        corners = correspondence.corresponding_corners(decoded, original, *matched)
        match = Correspondence(*matched, corners, "data")
        return _verdict(decoded, original, match, allowed, lattices, checked)
    difference = matched or correspondence.different_face_data(decoded, original)
    if difference and (not allowed or _cannot_be_allowed(decoded, original, match, allowed)):
        return verdict or _refusal(decoded, difference, checked)
    raise UndecidedError("cannot tell which vertex is which: compare with the mesh as compressed")


def _refusal(decoded: Mesh, difference: str, checked: list[str]) -> Verification:
    n_vertices, n_faces = decoded.n_vertices, decoded.n_faces
    return Verification(False, checked, n_vertices, n_faces, first_difference=difference)


def _verdict(
    decoded: Mesh,
    original: Mesh,
    match: Correspondence,
    allowed: float,
    lattices: Lattices,
    checked: list[str],
) -> Verification:
    checked = [*checked, "faces and their orientation", "coordinates"]
    source, got = original.vertices[match.vertices], decoded.vertices
    difference = moved(got, source, allowed) or _other_attributes(
        decoded, original, match, checked, lattices
    )
    return Verification(
        equal=difference is None,
        checked=checked,
        vertices=len(decoded.vertices),
        faces=decoded.n_faces,
        first_difference=difference,
        matched_by=match.how,
        allowed_error=allowed,
        **errors(got, source),
    )


def _different_kind(decoded: Mesh, original: Mesh) -> str | None:
    for what, got, wanted in (
        ("number of vertices", len(decoded.vertices), len(original.vertices)),
        ("number of faces", decoded.n_faces, original.n_faces),
        ("number of corners", decoded.n_corners, original.n_corners),
        ("type of coordinates", decoded.vertices.dtype.name, original.vertices.dtype.name),
    ):
        if got != wanted:
            return f"{what}: {got}, not {wanted}"
    for owner, ours, theirs in (
        ("vertex", decoded.vertex_attributes, original.vertex_attributes),
        ("face", decoded.face_attributes, original.face_attributes),
        ("corner", decoded.corner_attributes, original.corner_attributes),
    ):
        difference = comparison.kinds_differ(owner, ours, theirs)
        if difference:
            return difference
    return comparison.element_kinds_differ(decoded.elements, original.elements)


def _cannot_be_allowed(
    decoded: Mesh, original: Mesh, match: Correspondence | None, allowed: float
) -> bool:
    """Whether coordinates within the error that is allowed cannot explain a difference of data."""
    if match:
        # The surfaces are the same, and so is where most vertices are.
        near = distances(decoded.vertices, original.vertices[match.vertices]) <= allowed
        if 2 * np.count_nonzero(near.all(axis=1)) > len(near):
            return True
    sorted_distances = distances(np.sort(decoded.vertices, 0), np.sort(original.vertices, 0))
    return not (sorted_distances <= allowed).all()


def _other_attributes(
    decoded: Mesh,
    original: Mesh,
    match: Correspondence,
    checked: list[str],
    lattices: Lattices,
) -> str | None:
    for owner, got, wanted, order in (
        ("vertex", decoded.vertex_attributes, original.vertex_attributes, match.vertices),
        ("face", decoded.face_attributes, original.face_attributes, match.faces),
        ("corner", decoded.corner_attributes, original.corner_attributes, match.corners),
    ):
        if got or wanted:
            checked.append(f"{owner} attributes")
        difference = comparison.values_differ(owner, got, wanted, order, lattices)
        if difference:
            return difference
    if decoded.elements:
        checked.append("elements")
    return comparison.elements_differ(decoded.elements, original.elements, match.vertices, lattices)
