"""Mesh files of every format, by the format's name; formats are imported when they are used."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from ebz.codec.errors import OptionError
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene
from ebz.formats.detect import FORMATS, format_of, format_of_suffix, suffix_of
from ebz.formats.joined import join
from ebz.formats.polygons import fanned, triangulated

__all__ = ["FORMATS", "format_of_suffix", "read_mesh", "suffix_of", "write_mesh"]


# The folder of each, whose modules `reader` and `writer` have read_FORMAT and write_FORMAT.
FOLDERS = {name: name for name in FORMATS} | {"glb": "gltf"}
SCENES = ("gltf", "glb")
# May refer to files beside them.
WITH_FILES = SCENES


def read_mesh(
    data: bytes | bytearray | memoryview,
    *,
    format: str | None = None,
    name: str | None = None,
    folder: Path | None = None,
    triangulate: bool = False,
) -> Mesh | Scene:
    """The mesh or scene of a file's bytes; metadata["format"] says which format it had.

    format: one of FORMATS; None: by content, else by the suffix of `name`.
    folder: where files are that it refers to; None: none are read.
    triangulate: cut polygons into fans of triangles.
    Warns (DroppedWarning) of what is left out. Raises MeshError, OptionError.
    """
    content = data if isinstance(data, bytes) else bytes(data)
    chosen = format_of(content, name) if format is None else format
    reader = _function("reader", "read", chosen)
    found: Mesh | Scene = reader(content, folder) if chosen in WITH_FILES else reader(content)
    if not triangulate:
        return found
    if isinstance(found, Scene):
        return Scene([fanned(part) for part in found.parts], found.metadata)
    return fanned(found)


def write_mesh(mesh: Mesh | Scene, format: str) -> bytes:
    """The mesh or scene as a file of `format`, in the flavour that its metadata remembers.

    Where the format holds one mesh, the parts of a scene are joined.

    Warns (DroppedWarning) of what the format cannot carry. Raises MeshError, OptionError.
    """
    if format in SCENES:
        return _writer(format)(mesh)
    if "gltf" in mesh.metadata:
        from ebz.formats.gltf.nodes import placed

        mesh = placed(mesh, format)
    if isinstance(mesh, Scene):
        mesh = join(mesh, format)
    return _writer(format)(triangulated(mesh, format.upper()) if format == "stl" else mesh)


def _writer(format: str) -> Callable[[Any], bytes]:
    writer: Callable[[Any], bytes] = _function("writer", "write", format)
    return writer


def _function(module: str, verb: str, format: str) -> Any:
    if format not in FOLDERS:
        raise OptionError(f"unknown mesh format {format!r}: one of {', '.join(FORMATS)}")
    return getattr(import_module(f"ebz.formats.{FOLDERS[format]}.{module}"), f"{verb}_{format}")
