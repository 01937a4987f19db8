"""Whether attributes as decoded are those of the original, within what their precision allows."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import matching
from ebz.codec.arrays import Attributes
from ebz.codec.attributes import specials
from ebz.codec.attributes.octahedral import Octahedral, have_direction
from ebz.codec.attributes.plan import Lattice
from ebz.codec.elements import Element
from ebz.codec.encoded import EncodedArray, EncodedMesh
from ebz.codec.mesh import Mesh

Order = npt.NDArray[Any] | slice
# By what has the attribute and by its name; exact where there is none.
Lattices = Mapping[tuple[str, str], tuple[Lattice, tuple[str, ...]]]


def lattices_of(encoded: EncodedMesh) -> Lattices:
    """The precision of the attributes of a file that need not be exact, with their bundles."""
    owners: list[tuple[str, Iterable[EncodedArray]]] = [
        ("vertex", encoded.vertex_attributes),
        ("face", encoded.face_attributes),
        ("corner", encoded.corner_attributes),
    ]
    for element in encoded.elements:
        owners.append((element.name, element.attributes))
        owners.append((f"{element.name} corner", element.corner_attributes))
    return {
        (owner, name): (array.plan.lattice, array.names)
        for owner, arrays in owners
        for array in arrays
        for name in array.names
        if hasattr(array.plan.lattice, "allowed_error")
    }


def kinds_differ(owner: str, got: Attributes, wanted: Attributes) -> str | None:
    """What is missing, or of another kind."""
    for name in sorted(got.keys() | wanted.keys()):
        if name not in got or name not in wanted:
            return f"{owner} attribute {name!r}: {'missing' if name in wanted else 'not in MESH'}"
        for ours, theirs in zip(_kind(got[name]), _kind(wanted[name]), strict=True):
            if ours != theirs:
                return f"{owner} attribute {name!r}: {ours}, not {theirs}"
    return None


def element_kinds_differ(got: dict[str, Element], wanted: dict[str, Element]) -> str | None:
    """What is missing of the elements, or of another kind."""
    for name in sorted(got.keys() | wanted.keys()):
        if name not in got or name not in wanted:
            return f"element {name!r}: {'missing' if name in wanted else 'not in MESH'}"
        ours, theirs = got[name], wanted[name]
        if not np.array_equal(ours.offsets, theirs.offsets):
            return f"element {name!r}: rows of other lengths"
        difference = kinds_differ(name, ours.attributes, theirs.attributes) or kinds_differ(
            f"{name} corner", ours.corner_attributes, theirs.corner_attributes
        )
        if difference:
            return difference
    return None


def values_differ(
    owner: str, got: Attributes, wanted: Attributes, order: Order, lattices: Lattices
) -> str | None:
    """The first attribute whose values differ; order: the original's entry of each of ours."""
    for name in sorted(got):
        source = wanted[name][order]
        if np.array_equal(matching.as_bytes(got[name]), matching.as_bytes(source)):
            continue
        if (owner, name) not in lattices:
            return f"{owner} attribute {name!r}: values differ"
        lattice, names = lattices[owner, name]
        ours, theirs = (_bundle(names, name, all) for all in (got, wanted))
        if not _within(ours, theirs[order], lattice):
            return f"{owner} attribute {name!r}: values differ by more than its precision"
    return None


def elements_differ(
    got: dict[str, Element],
    wanted: dict[str, Element],
    vertices: npt.NDArray[Any],
    lattices: Lattices,
) -> str | None:
    """The first difference of elements; vertices: the original's vertex of each of ours."""
    everything = slice(None)
    for name, ours in got.items():
        theirs = wanted[name]
        if not np.array_equal(vertices[ours.corners], theirs.corners):
            return f"element {name!r}: corners at other vertices"
        difference = values_differ(name, ours.attributes, theirs.attributes, everything, lattices)
        difference = difference or values_differ(
            f"{name} corner", ours.corner_attributes, theirs.corner_attributes, everything, lattices
        )
        if difference:
            return difference
    return None


def as_stored(mesh: Mesh, lattices: Lattices) -> Mesh:
    """The mesh whose vertices and faces have attributes as compressing them would store."""
    by_vertex, by_face = dict(mesh.vertex_attributes), dict(mesh.face_attributes)
    for (owner, name), (lattice, names) in lattices.items():
        attributes = {"vertex": by_vertex, "face": by_face}.get(owner)
        if attributes is None or name != names[0]:
            continue
        values = _bundle(names, name, attributes)
        plan, integers = specials.integers(values, lattice)
        stored = specials.values(integers, plan, values.dtype)
        columns = [stored[:, i] for i in range(len(names))]
        whole = [stored.reshape(attributes[name].shape)]
        attributes |= dict(zip(names, whole if len(names) == 1 else columns, strict=True))
    return replace(mesh, vertex_attributes=by_vertex, face_attributes=by_face)


def _kind(values: npt.NDArray[Any]) -> tuple[str, str]:
    return values.dtype.name, f"entries of shape {values.shape[1:]}"


def _bundle(names: tuple[str, ...], name: str, values: Attributes) -> npt.NDArray[Any]:
    """(n, components) of the attributes that are coded together."""
    if len(names) == 1:
        return values[name].reshape(len(values[name]), -1)
    return np.stack([values[other] for other in names], axis=1)


@np.errstate(all="ignore")
def _within(got: npt.NDArray[Any], source: npt.NDArray[Any], lattice: Lattice) -> bool:
    same = np.asarray(got == source) | (np.isnan(got) & np.isnan(source))
    ours, theirs = got.astype(np.float64), source.astype(np.float64)
    if isinstance(lattice, Octahedral):
        directed = have_direction(source)[:, None]
        length = np.sqrt((theirs * theirs).sum(axis=1))[:, None]
        theirs = np.where(directed, theirs / length, theirs)
        same &= ~directed
    allowed = getattr(lattice, "allowed_error", 0.0) + rounding(got.dtype, theirs)
    return bool((same | (np.abs(ours - theirs) <= allowed)).all())


def rounding(dtype: np.dtype[Any], values: npt.NDArray[np.float64]) -> float:
    """How far the dtype and the doubles in between may move a value besides."""
    largest = float(np.abs(values[np.isfinite(values)]).max(initial=0))
    if dtype.kind != "f":
        return 0.5 + 1e-15 * largest
    return float(np.finfo(dtype).eps) * largest + float(np.finfo(dtype).smallest_subnormal)
