"""Elements (lines, edges, whatever stands beside faces) <-> streams, rows in their order."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.arrays import Attributes
from ebz.codec.attributes import coding
from ebz.codec.attributes.bundles import Bundle
from ebz.codec.attributes.items import Floats, Sites, rows
from ebz.codec.attributes.precision import AttributePrecision
from ebz.codec.elements import Element
from ebz.codec.encoded import EncodedArray, EncodedElement
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.codec.surface import Int32s

Renumber = Callable[[npt.NDArray[Any]], npt.NDArray[Any]]


def encode(
    elements: dict[str, Element], renumber: Renumber, precision: AttributePrecision, sites: Sites
) -> list[EncodedElement]:
    """An element each; renumber: from vertices of the source to those of the output."""
    return [
        _encode(name, element, renumber, precision, sites) for name, element in elements.items()
    ]


def decode(elements: Sequence[EncodedElement], sites: Sites) -> dict[str, Element]:
    """The elements by name, corners being vertices of the output; raises CorruptError."""
    return {element.name: _decode(element, sites) for element in elements}


def renumbered(elements: dict[str, Element], renumber: Renumber) -> dict[str, Element]:
    """The elements with other numbers for vertices."""
    return {
        name: replace(element, corners=renumber(element.corners))
        for name, element in elements.items()
    }


def _encode(
    name: str,
    element: Element,
    renumber: Renumber,
    precision: AttributePrecision,
    sites: Sites,
) -> EncodedElement:
    lengths = np.diff(element.offsets)
    width = int(lengths[0]) if len(lengths) else 0
    is_uniform = bool((lengths == width).all())
    corners = renumber(element.corners).astype(np.int32)
    numbers, links = _encode_one(corners.reshape(-1, max(1, width * is_uniform))), b""
    if corners.size:
        links = _kernels.encode_links(*_edges(sites), element.offsets, corners)
    is_linked = 0 < len(links) < len(numbers.data) + len(numbers.plan.labels)
    return EncodedElement(
        name=name,
        n_rows=len(element),
        n_corners=corners.size,
        lengths=None if is_uniform else _encode_one(lengths),
        corners=None if is_linked else numbers,
        links=links if is_linked else b"",
        attributes=_encode_all(element.attributes, len(element), precision),
        corner_attributes=_encode_all(element.corner_attributes, corners.size, precision),
    )


def _encode_one(values: npt.NDArray[Any]) -> EncodedArray:
    return coding.encode_bundle(Bundle(("",), values), rows(len(values)))


def _encode_all(
    attributes: Attributes, n: int, precision: AttributePrecision
) -> list[EncodedArray]:
    return coding.encode(attributes, np.arange(n), rows(n), precision)


def _edges(sites: Sites) -> tuple[Int32s, Int32s, Floats]:
    """Of the faces, and where they lie."""
    offsets = sites.face_offsets
    if sites.polygons is None:
        offsets = np.arange(0, len(sites.vertex) + 1, 3, dtype=np.int32)
    return sites.of_faces(sites.vertex), offsets, sites.points.reshape(-1)


def _decode(element: EncodedElement, sites: Sites) -> Element:
    with corrupt_at(element.place):
        offsets = _offsets(element)
        corners = _corners(element, offsets, sites)
    return Element(
        offsets,
        corners,
        coding.decode(element.attributes, rows(element.n_rows)),
        coding.decode(element.corner_attributes, rows(element.n_corners)),
    )


def _offsets(element: EncodedElement) -> npt.NDArray[np.int64]:
    n, k = element.n_rows, element.n_corners
    if element.lengths is None:
        if k % max(n, 1) or (k and not n):
            raise CorruptError(f"{k} corners in {n} rows of the same length")
        return np.arange(n + 1, dtype=np.int64) * (k // max(n, 1))
    lengths = coding.decode_array(element.lengths, rows(n))
    if (lengths < 0).any() or (lengths > k).any() or int(lengths.sum()) != k:
        raise CorruptError(f"rows whose lengths are not those of {k} corners")
    return np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)


def _corners(
    element: EncodedElement, offsets: npt.NDArray[np.int64], sites: Sites
) -> npt.NDArray[Any]:
    if element.corners is None:
        return _kernels.decode_links(element.links, *_edges(sites), offsets)
    width = element.corners.shape[0]
    if element.n_corners % width:
        raise CorruptError(f"{element.n_corners} corners by {width}")
    corners = coding.decode_array(element.corners, rows(element.n_corners // width)).reshape(-1)
    if corners.size and (corners.min() < 0 or corners.max() >= sites.n_vertices):
        raise CorruptError(f"a corner that is none of the {sites.n_vertices} vertices")
    return corners
