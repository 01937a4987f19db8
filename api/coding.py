"""Mesh <-> bytes in memory."""

import os
from collections.abc import Mapping
from typing import Any, Literal, overload

import numpy as np

from ebz import options
from ebz.codec import scenes
from ebz.codec.attributes.rounding import require_names
from ebz.codec.errors import OptionError
from ebz.codec.levels import DEFAULT_LEVEL, DEFAULT_TABLE
from ebz.codec.mesh import Mesh
from ebz.codec.models.guarantee import guaranteed_bits
from ebz.codec.models.load import AnyTable, load
from ebz.codec.models.table import table_names
from ebz.codec.order import Permutation
from ebz.codec.pipeline import Progress
from ebz.codec.scene import Scene
from ebz.codec.scenes import Encoded
from ebz.codec.surface import OutputOrder
from ebz.codec.threads import using as run_on
from ebz.formats.ebz import file
from ebz.formats.ebz.limits import DEFAULT_MEMORY_LIMIT
from ebz.options import Grid

BytesLike = bytes | bytearray | memoryview


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
    mesh = options.content(mesh)
    level, precision = options.level(level), options.precision(bits, max_error, grid)
    table = None if model is None and not embed_model else load_model(model)
    attributes = options.attribute_precision(attribute_bits, attribute_error, normal_bits)
    require_names(mesh.parts if isinstance(mesh, Scene) else [mesh], attributes)
    with run_on(threads):
        encoded, orders = scenes.encode(
            mesh,
            table,
            level=level,
            precision=precision,
            attribute_precision=attributes,
            keep_order=keep_order,
            progress=options.progress(progress),
        )
    data = file.write(encoded, embed_model=embed_model or _is_file(model))
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
        return scenes.decode(parse(data, memory_limit), progress=options.progress(progress))


def parse(data: BytesLike, memory_limit: int) -> Encoded:
    """The structure of an .ebz file, its declared sizes checked."""
    limit = options.memory_limit(memory_limit)
    return file.read(options.as_bytes(data), memory_limit=limit)


def load_model(model: str | os.PathLike[str] | AnyTable | None) -> AnyTable:
    """The table that a `model` option means.

    Raises OptionError where there is none, or where the table guarantees nothing.  Those built in
    are not certified again.
    """
    if not isinstance(model, AnyTable | str | os.PathLike | None):
        raise OptionError(f"model is {model!r}, neither a name, a path nor a table")
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
