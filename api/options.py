"""Options as callers give them -> what the codec takes; all that makes no sense is refused here."""

import math
import operator
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ebz.codec.attributes.octahedral import NORMAL_BITS
from ebz.codec.attributes.precision import AttributePrecision
from ebz.codec.errors import MeshError, NotEbzError, OptionError
from ebz.codec.fitting import Precision
from ebz.codec.lattice import MAX_BITS, GridLattice
from ebz.codec.levels import LEVELS
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene

Grid = tuple[float | Sequence[float], float]
ALLOWED_BITS = range(1, MAX_BITS + 1)


def content(mesh: Any) -> Mesh | Scene:
    """A mesh or a scene of meshes, as it is; raises MeshError."""
    if isinstance(mesh, Scene):
        if not isinstance(mesh.parts, list | tuple):
            raise MeshError(f"the parts of the scene are {_kind(mesh.parts)}, not a list")
        for number, part in enumerate(mesh.parts):
            if not isinstance(part, Mesh):
                raise MeshError(f"part {number} is {_kind(part)}, not a Mesh")
    elif not isinstance(mesh, Mesh):
        raise MeshError(f"{type(mesh).__name__} is neither a Mesh nor a Scene")
    checked: Mesh | Scene = mesh
    return checked


def as_bytes(data: Any) -> memoryview:
    """A view of anything bytes-like, byte by byte; raises NotEbzError."""
    try:
        view = memoryview(data)
    except TypeError:
        told = (
            f"{type(data).__name__} is not bytes: files are read by ebz.read, written by ebz.write"
        )
        raise NotEbzError(told) from None
    return view.cast("B") if view.c_contiguous else memoryview(view.tobytes())


def level(value: Any) -> int:
    """A level; raises OptionError."""
    return _integer("level is", value, LEVELS)


def memory_limit(value: Any) -> Any:
    """A number of bytes; raises OptionError."""
    if not isinstance(value, int | float | np.number):
        raise OptionError(f"memory_limit is {value!r}, not a number of bytes")
    return value


def progress(value: Any) -> Any:
    """Something to call, or None; raises OptionError."""
    if value is not None and not callable(value):
        raise OptionError(f"progress is {value!r}, not a function")
    return value


def precision(bits: Any, max_error: Any, grid: Any) -> Precision:
    """What may be lost of coordinates; raises OptionError."""
    if sum(option is not None for option in (bits, max_error, grid)) > 1:
        raise OptionError("bits, max_error and grid exclude each other")
    return Precision(
        None if bits is None else _integer("bits is", bits, ALLOWED_BITS),
        None if max_error is None else _error("max_error is", max_error),
        None if grid is None else _grid(grid),
    )


def attribute_precision(bits: Any, error: Any, normal_bits: Any) -> AttributePrecision:
    """What may be lost of attributes; raises OptionError."""
    bits, error = _mapping("attribute_bits", bits), _mapping("attribute_error", error)
    for name in bits:
        if name in error:
            raise OptionError(f"bits and error of attribute {name!r} exclude each other")
    return AttributePrecision(
        {n: _integer(f"bits of attribute {n!r} are", x, ALLOWED_BITS) for n, x in bits.items()},
        {n: _error(f"error of attribute {n!r} is", x) for n, x in error.items()},
        None if normal_bits is None else _integer("normal_bits is", normal_bits, NORMAL_BITS),
    )


def _kind(value: Any) -> str:
    return f"of type {type(value).__name__}"


def _integer(what: str, value: Any, allowed: range) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        number = allowed.start - 1
    if number not in allowed:
        raise OptionError(f"{what} {value!r}, not {allowed[0]} to {allowed[-1]}")
    return number


def _error(what: str, value: Any) -> float:
    try:
        number = math.nan if isinstance(value, str | bytes) else float(value)
    except (OverflowError, TypeError, ValueError):
        number = math.nan
    if not (math.isfinite(number) and number >= 0):
        raise OptionError(f"{what} {value!r}, not a finite number of at least 0")
    return number


def _mapping(name: str, value: Any) -> Mapping[str, Any]:
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise OptionError(f"{name} is {value!r}, not a dict by attribute's name")
    return value


def _grid(grid: Any) -> GridLattice:
    try:
        origin, step = grid
        x, y, z = np.broadcast_to(np.asarray(origin, np.float64), 3).tolist()
        step = float(step)
    except (TypeError, ValueError):
        raise OptionError(f"grid is {grid!r}, not (origin, step)") from None
    if not (math.isfinite(step) and step > 0):
        raise OptionError(f"the step of the grid is {step}, not a finite number above 0")
    if not all(map(math.isfinite, (x, y, z))):
        raise OptionError(f"the origin of the grid is {origin}, not finite")
    return GridLattice((x, y, z), step)
