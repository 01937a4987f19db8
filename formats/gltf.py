"""glTF and GLB files <-> meshes, through open3d.

open3d gets and gives the geometry only, in one buffer. The transformations of the nodes are
applied, all primitives of the scene become one mesh, positions are float32. What glTF holds beyond
that is a warning that names and counts it, and so is every vertex that no triangle uses, since
open3d drops these. Files with buffers in other files are refused.
"""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import EbzError, MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.gltf_json import geometry, joined_buffers, make_glb, parse_json, split_glb

LIBUSB = "libusb-1.0.so.0"
# What a slim image lacks, by a part of the name of the library that is missing.
DEBIAN_PACKAGES = {
    "libusb": "libusb-1.0-0",
    "libGL.": "libgl1",
    "libEGL": "libegl1",
    "libX11": "libx11-6",
    "libgomp": "libgomp1",
}
MAX_WRITTEN = 2**31 - 1


def read_gltf(data: bytes, *, triangulate: bool = False) -> Mesh:
    """The triangles of a glTF file whose buffers are embedded. Raises MeshError."""
    return _read(parse_json(data.removeprefix(b"\xef\xbb\xbf")), b"", "gltf")


def read_glb(data: bytes, *, triangulate: bool = False) -> Mesh:
    """The triangles of a GLB file. Raises MeshError."""
    document, binary = split_glb(data)
    return _read(document, binary, "glb")


def _read(document: Any, binary: bytes, format: str) -> Mesh:
    content = geometry(document, binary)
    vertices, faces = _through_open3d(content.glb) if content.n_faces else _nothing()
    if not len(faces):
        raise MeshError("glTF: there is no triangle that can be read")
    if len(faces) != content.n_faces:
        raise MeshError(f"glTF: open3d read {len(faces)} of {content.n_faces} triangles")
    content.drop("vertices that no triangle uses", max(content.n_vertices - len(vertices), 0))
    if content.dropped:
        parts = ", ".join(f"{what} ({count})" for what, count in content.dropped.items())
        warn_dropped(f"glTF: {parts}")
    return Mesh(vertices, faces, {}, {}, {"format": format})


def _nothing() -> tuple[npt.NDArray[np.float32], npt.NDArray[np.int32]]:
    return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32)


def _through_open3d(glb: bytes) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.int32]]:
    with _open3d() as open3d, TemporaryDirectory() as folder:
        path = Path(folder, "mesh.glb")
        path.write_bytes(glb)
        found = open3d.io.read_triangle_mesh(str(path))
        vertices = np.asarray(found.vertices).astype(np.float32).reshape(-1, 3)
        return vertices, np.asarray(found.triangles).astype(np.int32).reshape(-1, 3)


def write_gltf(mesh: Mesh) -> bytes:
    """The triangles as a glTF file with an embedded buffer; warns of what is left out."""
    warn_attributes("glTF", vertex=mesh.vertex_attributes, face=mesh.face_attributes)
    with np.errstate(over="ignore", invalid="ignore"):
        single = mesh.vertices.astype(np.float32)
    if not np.array_equal(single, mesh.vertices, equal_nan=True):
        warn_dropped("glTF cannot carry float64: coordinates are rounded to float32")
    if not np.isfinite(single).all():
        bad = int(np.argmin(np.isfinite(single).all(axis=1)))
        raise MeshError(f"vertex {bad}: glTF holds finite coordinates only")
    if not len(mesh.faces):
        raise MeshError("glTF cannot hold a mesh without faces")
    if len(mesh.vertices) > MAX_WRITTEN:
        raise MeshError(f"glTF cannot hold {len(mesh.vertices)} vertices")
    with _open3d() as open3d, TemporaryDirectory() as folder:
        path = Path(folder, "mesh.gltf")
        out = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(single.astype(np.float64)),
            open3d.utility.Vector3iVector(mesh.faces.astype(np.int32)),
        )
        if not open3d.io.write_triangle_mesh(str(path), out):
            raise MeshError("glTF: open3d could not write this mesh")
        return path.read_bytes()


def write_glb(mesh: Mesh) -> bytes:
    """Like write_gltf, as GLB: open3d's own GLB is one that it cannot read."""
    document = parse_json(write_gltf(mesh))
    body = joined_buffers(document, b"")
    document["buffers"] = [{"byteLength": len(body)}]
    return make_glb(document, bytes(body))


@contextmanager
def _open3d() -> Iterator[Any]:
    """open3d, while what it prints on file descriptor 1 goes to 2.

    Raises EbzError that names what to install where it cannot be imported.
    """
    with _stdout_on_stderr():
        _preload_libusb()
        try:
            import open3d
        except ImportError as error:
            raise EbzError(_advice(str(error))) from None
        level = open3d.utility.VerbosityLevel.Error
        with open3d.utility.VerbosityContextManager(level):
            yield open3d


def _advice(error: str) -> str:
    packages = [name for part, name in DEBIAN_PACKAGES.items() if part in error]
    line = f"apt-get install {packages[0]}" if packages else "python -m pip install open3d"
    return f"glTF needs open3d, which cannot be imported ({error}): {line}"


def _preload_libusb() -> None:
    """Loads libusb, which open3d's wheel wants: the system's, else that of libusb-package."""
    if not sys.platform.startswith("linux"):
        return
    with suppress(OSError):
        ctypes.CDLL(LIBUSB, mode=ctypes.RTLD_GLOBAL)
        return
    with suppress(ImportError, OSError):
        import libusb_package

        ctypes.CDLL(str(libusb_package.get_library_path()), mode=ctypes.RTLD_GLOBAL)


@contextmanager
def _stdout_on_stderr() -> Iterator[None]:
    if sys.stdout is not None:
        sys.stdout.flush()
    kept = os.dup(1)
    try:
        os.dup2(2, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
