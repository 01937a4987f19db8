"""Meshes in files: mesh formats and .ebz alike."""

import os
from pathlib import Path
from typing import BinaryIO

from ebz.codec.errors import EbzError, OptionError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats import meshes
from ebz.formats.ebz.limits import DEFAULT_MEMORY_LIMIT
from ebz.options import content

EBZ = "ebz"
EBZ_SUFFIX = ".ebz"

PathOrFile = str | os.PathLike[str] | BinaryIO


def read(
    path_or_file: PathOrFile,
    *,
    format: str | None = None,
    triangulate: bool = False,
    memory_limit: int = DEFAULT_MEMORY_LIMIT,
) -> Mesh | Scene:
    """The mesh in a file, or its scene; the format is recognised by content, then by suffix.

    path_or_file: a path or a binary file object, read to its end.  Buffers of glTF in other files
    are read from the folder of a path.
    format: "ply", "obj", "off", "stl", "gltf", "glb" or "ebz" where it is not to be recognised.
    triangulate: cut polygons into fans of triangles.
    Raises EbzError (its `source` is the file's name) and OSError.
    """
    name = _name(path_or_file, "read")
    data = _content(path_or_file)
    try:
        if format == EBZ or (format is None and _is_ebz(data)):
            from ebz.coding import decompress

            return decompress(data, memory_limit=memory_limit)
        return meshes.read_mesh(
            data,
            format=format,
            name=name,
            folder=_folder(path_or_file),
            triangulate=triangulate,
        )
    except EbzError as error:
        error.source = error.source or name
        raise


def write(path_or_file: PathOrFile, mesh: Mesh | Scene, *, format: str | None = None) -> None:
    """Write a mesh or scene in the format given, else that of the suffix, else the one it had.

    What the format cannot carry is a DroppedWarning that names it.  Raises EbzError and OSError.
    """
    name = _name(path_or_file, "write")
    mesh = content(mesh)
    try:
        data = _encode(mesh, format or _format_for(name, mesh))
    except EbzError as error:
        error.source = error.source or name
        raise
    if isinstance(path_or_file, str | os.PathLike):
        Path(path_or_file).write_bytes(data)
    else:
        path_or_file.write(data)


def _encode(mesh: Mesh | Scene, format: str) -> bytes:
    if format == EBZ:
        from ebz.coding import compress

        return compress(mesh)
    return meshes.write_mesh(mesh, format)


def _format_for(name: str | None, mesh: Mesh | Scene) -> str:
    suffix = Path(name).suffix.lower() if name else ""
    if suffix == EBZ_SUFFIX:
        return EBZ
    default = "glb" if isinstance(mesh, Scene) else "ply"
    return meshes.format_of_suffix(suffix) or str(mesh.metadata.get("format", default))


def _name(path_or_file: PathOrFile, method: str) -> str | None:
    """What errors call the file; raises OptionError where it is none."""
    if isinstance(path_or_file, str | os.PathLike):
        return os.fspath(path_or_file)
    if not hasattr(path_or_file, method):
        kind = type(path_or_file).__name__
        raise OptionError(f"{kind} is neither a path nor a binary file to {method}")
    name = getattr(path_or_file, "name", None)
    return name if isinstance(name, str) else None


def _folder(path_or_file: PathOrFile) -> Path | None:
    return Path(path_or_file).parent if isinstance(path_or_file, str | os.PathLike) else None


def _content(path_or_file: PathOrFile) -> bytes:
    if isinstance(path_or_file, str | os.PathLike):
        return Path(path_or_file).read_bytes()
    return path_or_file.read()


def _is_ebz(data: bytes) -> bool:
    # The first bytes suffice: what is cut short within them is a truncated .ebz file.
    return data[:4] == b"\x89EBZ"
