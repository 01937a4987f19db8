"""Attributes of corners: which corners at a vertex share a value (its wedges), and the values."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.arrays import Attributes
from ebz.codec.attributes import coding
from ebz.codec.attributes.bundles import Bundle
from ebz.codec.attributes.items import Sites
from ebz.codec.attributes.plan import Effort
from ebz.codec.attributes.precision import AttributePrecision
from ebz.codec.encoded import EncodedArray
from ebz.codec.errors import corrupt_at
from ebz.codec.surface import Int32s, Int64s


def encode(
    attributes: Attributes,
    order: npt.NDArray[Any],
    sites: Sites,
    precision: AttributePrecision,
    *,
    effort: Effort,
) -> list[EncodedArray]:
    """A stream per bundle; `order` gives the source corner of each corner of the output."""
    one = partial(_encode, sites=sites, precision=precision, effort=effort)
    return coding.encode_each(attributes, order, precision, one)


def decode(arrays: Sequence[EncodedArray], sites: Sites) -> Attributes:
    """The attributes of the 3m corners of the output; raises CorruptError."""
    return coding.decode_each(arrays, partial(_decode, sites=sites))


def _encode(
    bundle: Bundle, sites: Sites, precision: AttributePrecision, *, effort: Effort
) -> EncodedArray:
    corners, kinds = _kinds(bundle.values, sites.vertex)
    seams, wedge, _, kind = _kernels.encode_splits(*_fans(sites), kinds)
    n_wedges = len(kind)
    bundle = bundle._replace(values=bundle.values[corners[kind]])
    array = coding.encode_bundle(bundle, sites.by_wedge(wedge, n_wedges), precision, effort=effort)
    return array._replace(seams=seams if n_wedges > sites.n_used else b"")


def _decode(array: EncodedArray, sites: Sites) -> npt.NDArray[Any]:
    wedge, n_wedges = sites.vertex, sites.n_used
    if array.seams:
        with corrupt_at(array.place):
            wedge, more = _kernels.decode_splits(array.seams, *_fans(sites))
        n_wedges += len(more)
    return coding.decode_array(array, sites.by_wedge(wedge, n_wedges))[wedge]


def _fans(sites: Sites) -> tuple[Int32s, Int32s, Int32s, Int32s, int]:
    """As those of sites (welding.py), of vertices."""
    fan, vertex_of_fan = _kernels.fans_at_points(sites.opposite, sites.vertex)
    return sites.opposite, fan, sites.vertex, vertex_of_fan, sites.n_used


def _kinds(values: npt.NDArray[Any], vertex: Int32s) -> tuple[Int64s, Int32s]:
    """A corner of each kind, and the kind of each: that of corners of one vertex and value."""
    n, size = len(values), values.itemsize * math.prod(values.shape[1:])
    keys = np.ascontiguousarray(values).reshape(-1).view(np.uint8).reshape(n, size)
    columns = np.concatenate(
        [np.ascontiguousarray(vertex).view(np.uint8).reshape(n, 4), keys], axis=1
    )
    rows = np.ascontiguousarray(columns).view(np.dtype((np.void, columns.shape[1])))[:, 0]
    _, corners, kinds = np.unique(rows, return_index=True, return_inverse=True)
    return corners, kinds.astype(np.int32)
