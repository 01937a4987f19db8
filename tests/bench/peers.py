"""The codecs that are measured, all in memory; what is not installed is left out and named.

Every peer gets the same arrays: float32 vertices that are all used, triangles, and the same grid
(step = longest side of the bounding box / (2^bits - 1)).  bits None means lossless float32.
"""

import ctypes
import importlib.metadata
import lzma
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import ebz


@dataclass(frozen=True)
class Codec:
    """A codec in one setting: encode(mesh) -> bytes, decode(bytes) -> anything."""

    name: str
    bits: int | None
    encode: Callable[[ebz.Mesh], bytes]
    decode: Callable[[bytes], Any]


class MissingError(Exception):
    """A peer is not installed; the message says how to get it."""


def codecs(bits: int | None, levels: list[int]) -> Iterator[Codec]:
    """Every codec that can do `bits`; the names of missing ones are raised by `missing`."""
    for level in levels:
        yield _ebz(level, bits)
    for peer in PEERS:
        try:
            yield from peer(bits)
        except MissingError:
            continue


def missing() -> list[str]:
    """What is not installed, and how to get it."""
    lines = []
    for peer in PEERS:
        try:
            list(peer(14))
        except MissingError as error:
            lines.append(str(error))
    return lines


def versions() -> dict[str, str]:
    """The versions of ebz, numpy and the peers that are installed."""
    found = {}
    for name in ("ebz", "numpy", "DracoPy", "meshoptimizer", "zstandard"):
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return found


def _ebz(level: int, bits: int | None) -> Codec:
    def encode(mesh: ebz.Mesh) -> bytes:
        return ebz.compress(mesh, bits=bits, level=level)

    return Codec(f"ebz -{level}", bits, encode, ebz.decompress)


def _draco(bits: int | None) -> Iterator[Codec]:
    try:
        import DracoPy
    except ImportError:
        raise MissingError("Draco: pip install DracoPy") from None
    if bits is None:  # Draco stores the floats as they are
        return
    for level in (10, 7, 5):

        def encode(mesh: ebz.Mesh, level: int = level) -> bytes:
            faces = mesh.faces.astype(np.uint32)
            return bytes(
                DracoPy.encode(
                    mesh.vertices, faces, quantization_bits=bits, compression_level=level
                )
            )

        yield Codec(f"Draco level {level}", bits, encode, DracoPy.decode)


def _meshopt(bits: int | None) -> Iterator[Codec]:
    try:
        import meshoptimizer
        import zstandard
    except ImportError:
        raise MissingError("meshoptimizer: pip install meshoptimizer zstandard") from None
    if bits is not None and bits > 16:
        return

    def encode(mesh: ebz.Mesh) -> bytes:
        faces, n = mesh.faces.astype(np.uint32).reshape(-1), len(mesh.vertices)
        vertices = _on_grid(mesh.vertices, bits)
        ordered = np.empty_like(faces)
        meshoptimizer.optimize_vertex_cache(ordered, faces, len(faces), n)
        fetched = np.zeros_like(vertices)
        stride = vertices.strides[0]
        n = meshoptimizer.optimize_vertex_fetch(fetched, ordered, vertices, len(faces), n, stride)
        indices = bytes(meshoptimizer.encode_index_buffer(ordered, len(ordered), n))
        body = bytes(meshoptimizer.encode_vertex_buffer(fetched[:n], n, stride))
        sizes = struct.pack("<IIII", n, len(ordered), len(indices), stride)
        return zstandard.ZstdCompressor(level=19).compress(sizes + indices + body)

    def decode(data: bytes) -> Any:
        plain = zstandard.ZstdDecompressor().decompress(data)
        n, n_indices, size, stride = struct.unpack_from("<IIII", plain)
        return (
            meshoptimizer.decode_index_buffer(n_indices, 4, plain[16 : 16 + size]),
            meshoptimizer.decode_vertex_buffer(n, stride, plain[16 + size :]),
        )

    yield Codec("meshoptimizer + zstd -19", bits, encode, decode)


def _on_grid(vertices: np.ndarray, bits: int | None) -> np.ndarray:
    """(n, 4) uint16 on the grid, padded as vertex buffers are; the floats where bits is None."""
    if bits is None:
        return vertices
    low = vertices.min(axis=0).astype(np.float64)
    step = float((vertices.max(axis=0) - low).max()) / (2**bits - 1) or 1.0
    grid = np.zeros((len(vertices), 4), np.uint16)
    grid[:, :3] = np.rint((vertices - low) / step)
    return grid


def _openctm(bits: int | None) -> Iterator[Codec]:
    try:
        library = ctypes.CDLL("libopenctm.so.1")
    except OSError:
        raise MissingError("OpenCTM: apt-get install libopenctm1") from None
    from tests.bench import openctm

    if bits is None:
        yield Codec("OpenCTM MG1", bits, openctm.Mg1(library).encode, openctm.Mg1(library).decode)


def _xz(bits: int | None) -> Iterator[Codec]:
    if bits is not None:
        return

    def encode(mesh: ebz.Mesh) -> bytes:
        plain = mesh.vertices.tobytes() + mesh.faces.tobytes()
        return lzma.compress(plain, preset=9 | lzma.PRESET_EXTREME)

    yield Codec("xz -9e", bits, encode, lzma.decompress)


PEERS: list[Callable[[int | None], Iterator[Codec]]] = [_draco, _meshopt, _openctm, _xz]
