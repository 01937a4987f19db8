"""Attributes under the names and in the types of glTF."""

import re

import numpy as np

from ebz.codec.arrays import Attributes
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.gltf.accessors import COMPONENT_OF, TYPE_OF, Array

SEMANTIC = re.compile(r"NORMAL|TANGENT|(TEXCOORD|COLOR|JOINTS|WEIGHTS)_\d+")
TARGET = re.compile(r"target (\d+)/(.+)")
# Names of other formats; several that make one attribute are in one type.
NAMES = {
    "normal": "NORMAL",
    "uv": "TEXCOORD_0",
    "st": "TEXCOORD_0",
    "texcoord": "TEXCOORD_0",
    "rgb": "COLOR_0",
    "rgba": "COLOR_0",
}
COLUMNS = {
    ("nx", "ny", "nz"): "NORMAL",
    ("red", "green", "blue", "alpha"): "COLOR_0",
    ("red", "green", "blue"): "COLOR_0",
    ("s", "t"): "TEXCOORD_0",
    ("u", "v"): "TEXCOORD_0",
}
EXACT = [np.dtype(name) for name in ("u1", "i1", "u2", "i2", "f4")]


def as_gltf(attributes: Attributes) -> Attributes:
    """What glTF can hold of the attributes of vertices; warns of what is rounded or left out."""
    carried, dropped, rounded = {}, {}, []
    for name, values in _joined(attributes).items():
        own = NAMES.get(name, name)
        if not (SEMANTIC.fullmatch(own) or TARGET.fullmatch(own) or own.startswith("_")):
            own = f"_{own}"
        fitting = _exact(values)
        if fitting is None and SEMANTIC.fullmatch(own) and values.dtype == np.float64:
            fitting = values.astype(np.float32)
            rounded.append(name)
        if fitting is None or own in carried:
            dropped[name] = values
        else:
            carried[own] = fitting
    warn_attributes("glTF", vertex=dropped)
    if rounded:
        warn_dropped(f"glTF cannot carry float64: rounded to float32 are {', '.join(rounded)}")
    return carried


def _joined(attributes: Attributes) -> Attributes:
    """Columns that make one attribute as that, in place of the first."""
    joined = dict(attributes)
    for names, own in COLUMNS.items():
        columns = [joined[name] for name in names if name in joined]
        kinds = {(column.dtype, column.ndim) for column in columns}
        if own in joined or len(columns) < len(names) or len(kinds) > 1 or columns[0].ndim > 1:
            continue
        first, merged = names[0], np.stack(columns, axis=1)
        joined = {
            own if name == first else name: merged if name == first else values
            for name, values in joined.items()
            if name not in names[1:]
        }
    return joined


def _exact(values: Array) -> Array | None:
    """The values in a shape and a type that glTF has, where one holds them exactly."""
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape[1:] not in TYPE_OF:
        return None
    if values.dtype in COMPONENT_OF and values.dtype != np.uint32:
        return values
    for dtype in EXACT:
        with np.errstate(all="ignore"):
            cast = values.astype(dtype)
        if np.array_equal(cast.astype(values.dtype), values, equal_nan=values.dtype.kind == "f"):
            return cast
    return None
