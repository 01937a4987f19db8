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
from ebz.codec.attributes.items import Items, Sites
from ebz.codec.attributes.precision import AttributePrecision
from ebz.codec.connectivity import Int32s
from ebz.codec.encoded import EncodedArray
from ebz.codec.errors import corrupt_at


def encode(
    attributes: Attributes,
    order: npt.NDArray[Any],
    sites: Sites,
    precision: AttributePrecision,
    *,
    fast: bool,
) -> list[EncodedArray]:
    """A stream per bundle; `order` gives the source corner of each corner of the output."""
    one = partial(_encode, sites=sites, precision=precision, fast=fast)
    return coding.encode_each(attributes, order, precision, one)


def decode(arrays: Sequence[EncodedArray], sites: Sites) -> Attributes:
    """The attributes of the 3m corners of the output; raises CorruptError."""
    return coding.decode_each(arrays, partial(_decode, sites=sites))


def _encode(
    bundle: Bundle, sites: Sites, precision: AttributePrecision, *, fast: bool
) -> EncodedArray:
    wedge, is_first = _wedges(bundle.values, sites.vertex)
    seams = b""
    if int(wedge.max(initial=-1)) != int(sites.vertex.max(initial=-1)):
        seams = _kernels.encode_splits(sites.opposite, sites.vertex, sites.n_vertices, wedge)
    bundle = bundle._replace(values=bundle.values[is_first])
    array = coding.encode_bundle(bundle, _items(wedge, sites), precision, fast=fast)
    return array._replace(seams=seams)


def _decode(array: EncodedArray, sites: Sites) -> npt.NDArray[Any]:
    wedge, _ = _kernels.number_by_first_use(sites.vertex, sites.n_vertices)
    if array.seams:
        data = np.frombuffer(array.seams, np.uint8)
        with corrupt_at(array.place):
            wedge, _ = _kernels.decode_splits(data, sites.opposite, sites.vertex, sites.n_vertices)
    return coding.decode_array(array, _items(wedge, sites))[wedge]


def _items(wedge: Int32s, sites: Sites) -> Items:
    return sites.by_wedge(wedge, int(wedge.max(initial=-1)) + 1)


def _wedges(values: npt.NDArray[Any], vertex: Int32s) -> tuple[Int32s, npt.NDArray[np.bool_]]:
    """The wedge of each corner, numbered by first use, and which corners are the first of one."""
    n, size = len(values), values.itemsize * math.prod(values.shape[1:])
    keys = np.ascontiguousarray(values).reshape(-1).view(np.uint8).reshape(n, size)
    columns = np.concatenate(
        [np.ascontiguousarray(vertex).view(np.uint8).reshape(n, 4), keys], axis=1
    )
    rows = np.ascontiguousarray(columns).view(np.dtype((np.void, columns.shape[1])))[:, 0]
    kinds = np.unique(rows, return_inverse=True)[1].astype(np.int32)
    wedge, _ = _kernels.number_by_first_use(kinds, len(kinds))
    return wedge, np.diff(np.maximum.accumulate(wedge), prepend=-1) > 0
