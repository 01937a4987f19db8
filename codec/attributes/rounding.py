"""The mesh that decoding will yield: attributes at the precision that was asked for."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.codec.attributes import specials
from ebz.codec.attributes.bundles import bundles
from ebz.codec.attributes.precision import Asked, AttributePrecision, lattice_of
from ebz.codec.elements import Element
from ebz.codec.errors import OptionError
from ebz.codec.mesh import Mesh


def rounded(mesh: Mesh, precision: AttributePrecision) -> Mesh:
    """The mesh with its attributes as they will be decoded.

    Of what is decoded the same lattices are found again.
    """
    if precision == AttributePrecision():
        return mesh
    elements = {name: _rounded(element, precision) for name, element in mesh.elements.items()}
    return replace(
        mesh,
        vertex_attributes=_all_rounded(mesh.vertex_attributes, precision),
        face_attributes=_all_rounded(mesh.face_attributes, precision),
        corner_attributes=_all_rounded(mesh.corner_attributes, precision),
        elements=elements,
    )


def _rounded(element: Element, precision: AttributePrecision) -> Element:
    return replace(
        element,
        attributes=_all_rounded(element.attributes, precision),
        corner_attributes=_all_rounded(element.corner_attributes, precision),
    )


def _all_rounded(attributes: Attributes, precision: AttributePrecision) -> Attributes:
    result: Attributes = {}
    for bundle in bundles(attributes, precision.of):
        values = _values(bundle.values, precision.of(bundle.names[0]))
        if len(bundle.names) == 1:
            result[bundle.names[0]] = values
        else:
            result |= {
                name: np.ascontiguousarray(values[:, i]) for i, name in enumerate(bundle.names)
            }
    return result


def _values(values: npt.NDArray[Any], asked: Asked) -> npt.NDArray[Any]:
    flat = values.reshape(len(values), -1) if values.size else values
    lattice = lattice_of(flat, asked) if values.size else None
    if lattice is None:
        return values
    plan, integers = specials.integers(flat, lattice)
    return specials.values(integers, plan, values.dtype).reshape(values.shape)


def require_names(meshes: Iterable[Mesh], precision: AttributePrecision) -> None:
    """Raise OptionError where none of the meshes has an attribute of a name."""
    names: set[str] = set()
    for mesh in meshes:
        names |= {*mesh.vertex_attributes, *mesh.face_attributes, *mesh.corner_attributes}
        for element in mesh.elements.values():
            names |= {*element.attributes, *element.corner_attributes}
    for name in (*precision.bits, *precision.error):
        if name not in names:
            raise OptionError(f"there is no attribute {name!r} whose precision could be less")
