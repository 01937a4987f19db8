"""Mesh <-> bytes in memory."""

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, overload

import numpy as np

from ebz.codec import scenes
from ebz.codec.attributes.octahedral import NORMAL_BITS
from ebz.codec.attributes.precision import AttributePrecision
from ebz.codec.attributes.rounding import require_names
from ebz.codec.connectivity import OutputOrder
from ebz.codec.errors import MeshError, OptionError
from ebz.codec.fitting import Precision
from ebz.codec.lattice import MAX_BITS, GridLattice
from ebz.codec.levels import DEFAULT_LEVEL, DEFAULT_TABLE, LEVELS
from ebz.codec.mesh import Mesh
from ebz.codec.models.guarantee import guaranteed_bits
from ebz.codec.models.load import AnyTable, load
from ebz.codec.models.table import table_names
from ebz.codec.order import Permutation
from ebz.codec.pipeline import Progress
from ebz.codec.scene import Scene
from ebz.codec.scenes import Encoded
from ebz.codec.threads import using as run_on
from ebz.formats import ebz_file
from ebz.formats.limits import DEFAULT_MEMORY_LIMIT

BytesLike = bytes | bytearray | memoryview
Grid = tuple[float | Sequence[float], float]


@overload
def compress(
    mesh: Mesh | Scene,
    *,
    bits: int | None = ...,
    max_error: float | None = ...,
    grid: Grid | None = ...,
    attribute_bits: Mapping[str, int] | None = ...,
    attribute_error: Mapping[str, float] | None = ...,
    normal_bits: int | None = ...,
    keep_order: bool = ...,
    return_permutation: Literal[False] = ...,
    level: int = ...,
    model: str | os.PathLike[str] | AnyTable | None = ...,
    embed_model: bool = ...,
    threads: int = ...,
    progress: Progress | None = ...,
) -> bytes: ...


@overload
def compress(
    mesh: Mesh,
    *,
    bits: int | None = ...,
    max_error: float | None = ...,
    grid: Grid | None = ...,
    attribute_bits: Mapping[str, int] | None = ...,
    attribute_error: Mapping[str, float] | None = ...,
    normal_bits: int | None = ...,
    keep_order: bool = ...,
    return_permutation: Literal[True],
    level: int = ...,
    model: str | os.PathLike[str] | AnyTable | None = ...,
    embed_model: bool = ...,
    threads: int = ...,
    progress: Progress | None = ...,
) -> tuple[bytes, Permutation]: ...


@overload
def compress(
    mesh: Scene,
    *,
    bits: int | None = ...,
    max_error: float | None = ...,
    grid: Grid | None = ...,
    attribute_bits: Mapping[str, int] | None = ...,
    attribute_error: Mapping[str, float] | None = ...,
    normal_bits: int | None = ...,
    keep_order: bool = ...,
    return_permutation: Literal[True],
    level: int = ...,
    model: str | os.PathLike[str] | AnyTable | None = ...,
    embed_model: bool = ...,
    progress: Progress | None = ...,
) -> tuple[bytes, list[Permutation]]: ...


def compress(
    mesh: Mesh | Scene,
    *,
    bits: int | None = None,
    max_error: float | None = None,
    grid: Grid | None = None,
    attribute_bits: Mapping[str, int] | None = None,
    attribute_error: Mapping[str, float] | None = None,
    normal_bits: int | None = None,
    keep_order: bool = False,
    return_permutation: bool = False,
    level: int = DEFAULT_LEVEL,
    model: str | os.PathLike[str] | AnyTable | None = None,
    embed_model: bool = False,
    threads: int = 1,
    progress: Progress | None = None,
) -> bytes | tuple[bytes, Permutation | list[Permutation]]:
    """The .ebz bytes of a mesh or scene; without options that say so nothing is lost.

    bits: 1 to 30; the grid's step is the longest side of the bounding box / (2^bits - 1).  Parts of
    a scene are in one box.
    max_error: in model units; no coordinate moves by more.
    grid: (origin, step), origin a number or three: coordinates move to the nearest origin + step *
    integer, so that meshes which share vertices still do.  At most one of these three.
    attribute_bits: by attribute's name, 1 to 30: values move to 2^bits steps along the widest range
    of a component.  attribute_error: by name, no value moves by more.  Weights that add up to one
    (floats, none negative) still do, to within a step, and may move by one.
    normal_bits: 2 to 16: unit vectors named as normals become one of about 4^bits directions, and
    stay unit vectors.
    keep_order: vertices, faces and the first corner of each face come back as they are; without it
    their order may change.
    return_permutation: also return where the vertices and faces of the decoded mesh come from; of a
    scene, a list of that.
    level: 1 (fast) to 9 (small).
    model: name of a built-in table, path of a table file, or a table, which must have a
    certificate (ebz.models.certify): the word is coded with it; None: with the level's adaptive
    model, or with the built-in table where that is shorter.
    embed_model: code the word with a table and store that in the file.
    threads: at most so many, 0 for one per core; the bytes are the same.
    progress: called as progress(stage, done, total).

    compress(decompress(data)) gives the same bytes with the same options.  Raises OptionError and
    MeshError.
    """
    if not isinstance(mesh, Mesh | Scene):
        raise MeshError(f"{type(mesh).__name__} is neither a Mesh nor a Scene")
    lattice = None if grid is None else _grid(grid)
    _check_options(bits, max_error, lattice, level)
    table = None if model is None and not embed_model else load_model(model)
    attributes = _attribute_precision(attribute_bits or {}, attribute_error or {}, normal_bits)
    require_names(mesh.parts if isinstance(mesh, Scene) else [mesh], attributes)
    with run_on(threads):
        encoded, orders = scenes.encode(
            mesh,
            table,
            level=level,
            precision=Precision(bits, max_error, lattice),
            attribute_precision=attributes,
            keep_order=keep_order,
            progress=progress,
        )
    data = ebz_file.write(encoded, embed_model=embed_model or _is_file(model))
    if not return_permutation:
        return data
    permutations = [_permutation(order, keep_order) for order in orders]
    return data, permutations if isinstance(mesh, Scene) else permutations[0]


def decompress(
    data: BytesLike,
    *,
    memory_limit: int = DEFAULT_MEMORY_LIMIT,
    threads: int = 1,
    progress: Progress | None = None,
) -> Mesh | Scene:
    """The mesh or the scene of an .ebz file's bytes, as it was compressed.

    memory_limit: in bytes; what decoding would take is checked before anything is allocated.
    threads: at most so many, 0 for one per core.
    Raises NotEbzError, VersionError, TruncatedError, CorruptError and MemoryLimitError.
    """
    with run_on(threads):
        return scenes.decode(parse(data, memory_limit), progress=progress)


def parse(data: BytesLike, memory_limit: int) -> Encoded:
    """The structure of an .ebz file, its declared sizes checked."""
    return ebz_file.read(as_bytes(data), memory_limit=memory_limit)


def as_bytes(data: BytesLike) -> memoryview:
    """A view of anything bytes-like, byte by byte."""
    view = memoryview(data)
    return view.cast("B") if view.c_contiguous else memoryview(view.tobytes())


def load_model(model: str | os.PathLike[str] | AnyTable | None) -> AnyTable:
    """The table that a `model` option means.

    Raises OptionError where there is none, or where the table guarantees nothing.  Those built in
    are not certified again.
    """
    table = model if isinstance(model, AnyTable) else load(model or DEFAULT_TABLE)
    try:
        guaranteed_bits(table)
    except OptionError as error:
        source = None if isinstance(model, AnyTable) or model is None else os.fspath(model)
        raise OptionError(f"it guarantees nothing: {error.message}", source=source) from None
    return table


def _permutation(order: OutputOrder, keep_order: bool) -> Permutation:
    if keep_order:
        return Permutation(np.arange(len(order.vertices)), np.arange(len(order.faces)))
    return Permutation(order.vertices.astype(np.int64), order.faces.astype(np.int64))


def _is_file(model: Any) -> bool:
    return model is not None and not isinstance(model, AnyTable) and str(model) not in table_names()


def _grid(grid: Grid) -> GridLattice:
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


def _attribute_precision(
    bits: Mapping[str, int], error: Mapping[str, float], normal_bits: int | None
) -> AttributePrecision:
    for name, n in bits.items():
        if name in error:
            raise OptionError(f"bits and error of attribute {name!r} exclude each other")
        if n not in range(1, MAX_BITS + 1):
            raise OptionError(f"bits of attribute {name!r} are {n}, not 1 to {MAX_BITS}")
    for name, limit in error.items():
        if not (math.isfinite(limit) and limit >= 0):
            raise OptionError(f"error of attribute {name!r} is {limit}, not at least 0 and finite")
    if normal_bits is not None and normal_bits not in NORMAL_BITS:
        raise OptionError(f"normal_bits is {normal_bits}, not 2 to {NORMAL_BITS[-1]}")
    return AttributePrecision(dict(bits), dict(error), normal_bits)


def _check_options(
    bits: int | None, max_error: float | None, grid: GridLattice | None, level: int
) -> None:
    if sum(option is not None for option in (bits, max_error, grid)) > 1:
        raise OptionError("bits, max_error and grid exclude each other")
    if bits is not None and bits not in range(1, MAX_BITS + 1):
        raise OptionError(f"bits is {bits}, not 1 to {MAX_BITS}")
    if max_error is not None and not (math.isfinite(max_error) and max_error >= 0):
        raise OptionError(f"max_error is {max_error}, not a finite number of at least 0")
    if level not in LEVELS:
        raise OptionError(f"level is {level}, not {LEVELS[0]} to {LEVELS[-1]}")
