"""OpenCTM's lossless method, through its C library."""

import ctypes
from typing import Any

import numpy as np

import ebz

IMPORT, EXPORT, MG1, LEVEL = 0x0101, 0x0102, 0x0202, 9
VERTEX_COUNT, TRIANGLE_COUNT, INDICES, VERTICES = 0x0301, 0x0302, 0x0601, 0x0602
CALLBACK = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p)
# OpenCTM does not call back where the user's pointer is NULL.
USER = ctypes.c_void_p(1)


class Mg1:
    """Encoder and decoder around a loaded libopenctm."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self._library = library
        pointer, unsigned = ctypes.c_void_p, ctypes.c_uint
        library.ctmNewContext.restype = pointer
        for name, arguments in {
            "ctmNewContext": [unsigned],
            "ctmFreeContext": [pointer],
            "ctmDefineMesh": [pointer, pointer, unsigned, pointer, unsigned, pointer],
            "ctmCompressionMethod": [pointer, unsigned],
            "ctmCompressionLevel": [pointer, unsigned],
            "ctmSaveCustom": [pointer, CALLBACK, pointer],
            "ctmLoadCustom": [pointer, CALLBACK, pointer],
            "ctmGetInteger": [pointer, unsigned],
            "ctmGetError": [pointer],
        }.items():
            getattr(library, name).argtypes = arguments

    def encode(self, mesh: ebz.Mesh) -> bytes:
        vertices, faces = mesh.vertices, mesh.faces.astype(np.uint32)
        written = bytearray()

        def write(data: Any, size: int, _user: Any) -> int:
            written.extend(ctypes.string_at(data, size))
            return size

        ctm, context = self._library, self._library.ctmNewContext(EXPORT)
        try:
            ctm.ctmDefineMesh(
                context, vertices.ctypes.data, len(vertices), faces.ctypes.data, len(faces), None
            )
            ctm.ctmCompressionMethod(context, MG1)
            ctm.ctmCompressionLevel(context, LEVEL)
            ctm.ctmSaveCustom(context, CALLBACK(write), USER)
            self._check(context)
        finally:
            ctm.ctmFreeContext(context)
        return bytes(written)

    def decode(self, data: bytes) -> tuple[int, int]:
        at = 0

        def read(target: Any, size: int, _user: Any) -> int:
            nonlocal at
            part = data[at : at + size]
            ctypes.memmove(target, part, len(part))
            at += len(part)
            return len(part)

        ctm, context = self._library, self._library.ctmNewContext(IMPORT)
        try:
            ctm.ctmLoadCustom(context, CALLBACK(read), USER)
            self._check(context)
            counts = (VERTEX_COUNT, TRIANGLE_COUNT)
            n_vertices, n_faces = (ctm.ctmGetInteger(context, count) for count in counts)
        finally:
            ctm.ctmFreeContext(context)
        return n_vertices, n_faces

    def _check(self, context: int) -> None:
        error = self._library.ctmGetError(context)
        if error:
            raise RuntimeError(f"OpenCTM error {error:#x}")
