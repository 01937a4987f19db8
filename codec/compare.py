"""Whether a decoded mesh is the original, up to the order of vertices and faces.

The correspondence comes from running the encoder's traversal on the original; where that leads to
other faces, because the original's own order differs in a way that matters, vertices are matched by
their exact data, refined by the data of the faces around them.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import connectivity, cycles, matching, welding
from ebz.codec import points as free_points
from ebz.codec.attributes import comparison
from ebz.codec.attributes.comparison import Lattices
from ebz.codec.errors import EbzError
from ebz.codec.fitting import Precision, fit
from ebz.codec.lattice import BoxLattice, GridLattice, Lattice, Points, StepLattice, restore
from ebz.codec.mesh import Mesh

Order = npt.NDArray[Any]
Attributes = dict[str, npt.NDArray[Any]]


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


@dataclass(frozen=True)
class _Correspondence:
    """For each vertex, face and corner of the decoded mesh, that of the original."""

    vertices: Order
    faces: Order
    corners: Order
    how: str


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
        ordered = _by_order(decoded, original)
        if isinstance(ordered, str):
            return _refusal(decoded, ordered, checked)
        checked = [*checked, "order of vertices and faces"]
        return _verdict(decoded, original, ordered, allowed, lattices, checked)
    match = _by_traversal(decoded, original, lattice)
    verdict = match and _verdict(decoded, original, match, allowed, lattices, checked)
    if verdict and verdict.equal:
        return verdict
    # Symmetric surfaces are traversed alike in several ways: the data have the last word.
    matched = _by_data(decoded, comparison.as_stored(original, lattices), lattice)
    if isinstance(matched, tuple):
        corners = _corresponding_corners(decoded, original, *matched)
        match = _Correspondence(*matched, corners, "data")
        return _verdict(decoded, original, match, allowed, lattices, checked)
    difference = matched or _different_face_data(decoded, original)
    if difference and (not allowed or _cannot_be_allowed(decoded, original, match, allowed)):
        return verdict or _refusal(decoded, difference, checked)
    raise UndecidedError("cannot tell which vertex is which: compare with the mesh as compressed")


def _refusal(decoded: Mesh, difference: str, checked: list[str]) -> Verification:
    n_vertices, n_faces = decoded.n_vertices, decoded.n_faces
    return Verification(False, checked, n_vertices, n_faces, first_difference=difference)


def _verdict(
    decoded: Mesh,
    original: Mesh,
    match: _Correspondence,
    allowed: float,
    lattices: Lattices,
    checked: list[str],
) -> Verification:
    checked = [*checked, "faces and their orientation", "coordinates"]
    source, got = original.vertices[match.vertices], decoded.vertices
    difference = _moved(got, source, allowed) or _other_attributes(
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
        **_errors(got, source),
    )


def allowed_error(lattice: Lattice, original: Mesh) -> float:
    """How far a coordinate may move, in model units."""
    if isinstance(lattice, StepLattice):
        return lattice.max_error
    largest = float(np.abs(original.vertices).max(initial=0))
    if isinstance(lattice, BoxLattice):
        reach = largest + lattice.side
    elif isinstance(lattice, GridLattice):
        reach = 2 * largest + max(map(abs, lattice.origin))
    else:
        return 0.0
    # Half a step, half the spacing of the floats there, and a few roundings of doubles.
    floats, doubles = np.finfo(original.vertices.dtype), np.finfo(np.float64)
    spacing = float(floats.eps) * largest + float(floats.eps) * lattice.step
    rounding = 4 * float(doubles.eps) * reach
    return lattice.step / 2 + spacing / 2 + rounding + float(floats.smallest_subnormal)


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


def _by_order(decoded: Mesh, original: Mesh) -> _Correspondence | str:
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
    return _Correspondence(vertices, faces, corners, "order")


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


def _by_traversal(decoded: Mesh, original: Mesh, lattice: Lattice) -> _Correspondence | None:
    points, offsets = _points(original.vertices, lattice), original.face_offsets
    stored = _restored(points, original.vertices)
    welded = welding.weld(original.faces, stored, offsets)
    surface, order = connectivity.traverse(welded, len(original.vertices), offsets)
    arrangement = welding.arrange(original.faces, welded, surface, order)
    arrangement, _ = free_points.encode(arrangement, points.integers)
    order = replace(order, vertices=arrangement.vertices)
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
    corners = _corresponding_corners(decoded, original, order.vertices, order.faces)
    return _Correspondence(order.vertices, order.faces, corners, "traversal")


def _corresponding_corners(decoded: Mesh, original: Mesh, vertices: Order, faces: Order) -> Order:
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


def _by_data(decoded: Mesh, original: Mesh, lattice: Lattice) -> tuple[Order, Order] | str | None:
    """As matching.match: what was stored of the original is compared exactly."""
    stored = _as_stored(original.vertices, lattice)
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


def _different_face_data(decoded: Mesh, original: Mesh) -> str | None:
    n_faces = decoded.n_faces
    for name in decoded.face_attributes:
        ours, theirs = (
            _bytes({name: mesh.face_attributes[name]}, n_faces) for mesh in (decoded, original)
        )
        if not matching.same_rows(ours, theirs):
            return f"face attribute {name!r}: values differ"
    return None


def _cannot_be_allowed(
    decoded: Mesh, original: Mesh, match: _Correspondence | None, allowed: float
) -> bool:
    """Whether coordinates within the error that is allowed cannot explain a difference of data."""
    if match:
        # The surfaces are the same, and so is where most vertices are.
        near = _distances(decoded.vertices, original.vertices[match.vertices]) <= allowed
        if 2 * np.count_nonzero(near.all(axis=1)) > len(near):
            return True
    sorted_distances = _distances(np.sort(decoded.vertices, 0), np.sort(original.vertices, 0))
    return not (sorted_distances <= allowed).all()


def _as_stored(vertices: npt.NDArray[Any], lattice: Lattice) -> npt.NDArray[Any]:
    """The coordinates that compressing at the same precision would store."""
    return _restored(_points(vertices, lattice), vertices)


def _points(vertices: npt.NDArray[Any], lattice: Lattice) -> Points:
    """The points of compressing at the same precision."""
    if np.isfinite(vertices).all():
        if isinstance(lattice, GridLattice):
            return fit(vertices, Precision(grid=lattice))
        if isinstance(lattice, BoxLattice):
            return Points(lattice, lattice.integers(vertices), np.zeros(0, np.int64))
        if isinstance(lattice, StepLattice):
            return fit(vertices, Precision(max_error=lattice.max_error))
    return fit(vertices)


def _restored(points: Points, vertices: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return restore(points, vertices.dtype, vertices.reshape(-1)[points.exceptions])


def _errors(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> dict[str, float]:
    error = _distances(got, source)
    largest = float(error.max(initial=0.0))
    # Scaled, so that no square overflows.
    scaled = error / largest if np.isfinite(largest) and largest > 0 else np.zeros_like(error)
    rms = largest * float(np.sqrt((scaled**2).sum() / len(error))) if len(error) else 0.0
    return {"largest_error": largest, "rms_error": rms}


@np.errstate(all="ignore")
def _distances(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Per coordinate; zero where the bits are the same."""
    distances: npt.NDArray[np.float64] = np.abs(got.astype(np.float64) - source.astype(np.float64))
    distances[_same_bits(got, source)] = 0.0
    return distances


def _moved(got: npt.NDArray[Any], source: npt.NDArray[Any], allowed: float) -> str | None:
    same = _same_bits(got, source)
    if allowed:
        same |= _distances(got, source) <= allowed
    if same.all():
        return None
    row, axis = np.argwhere(~same)[0]
    values = f"{got[row, axis]!r}, not {source[row, axis]!r}"
    return f"vertex {row} of the decoded mesh: {'xyz'[axis]} is {values}"


def _same_bits(got: npt.NDArray[Any], source: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    bits = f"u{got.dtype.itemsize}"
    return np.asarray(
        np.ascontiguousarray(got).view(bits) == np.ascontiguousarray(source).view(bits)
    )


def _other_attributes(
    decoded: Mesh,
    original: Mesh,
    match: _Correspondence,
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
