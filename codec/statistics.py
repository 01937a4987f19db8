"""What a compressed mesh is made of and what each part of it costs."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels
from ebz.codec.attributes.summary import summary
from ebz.codec.encoded import EncodedArray, EncodedMesh
from ebz.codec.mesh import Mesh
from ebz.codec.models.adaptive import Effort
from ebz.codec.surface import Surface
from ebz.codec.word import EncodedWord, WordModel

# W. T. Tutte, "A census of planar triangulations", 1962: log2(256 / 27) bits per vertex.
TUTTE_LIMIT = math.log2(256 / 27)
SYMBOLS = "CLRSE"


@dataclass(frozen=True)
class Stream:
    """Bytes of one kind of chunk, and the same as bits per vertex."""

    name: str
    bytes: int
    bits_per_vertex: float


@dataclass(frozen=True)
class Stats:
    """Counts, sizes and reference values of a compressed mesh; as_dict() is what --json prints.

    Components, boundary loops and genus are those of the manifold pieces that the word codes; the
    genus is the sum over all of them.  Sizes are in bytes; bits per vertex count every vertex.
    """

    vertices: int
    faces: int
    faces_by_corners: dict[int, int]
    vertex_dtype: str
    isolated_vertices: int
    components: int
    genus: int
    boundary_loops: int
    boundary_edges: int
    glued_vertices: int
    welded_vertices: int
    symbols: dict[str, int]
    hole_and_handle_integers: int
    model: str
    lattice: dict[str, Any]
    exceptions: int
    attributes: dict[str, dict[str, Any]]
    streams: list[Stream]
    connectivity_bytes: int
    geometry_bytes: int
    order_bytes: int
    attribute_bytes: int
    total_bytes: int
    raw_bytes: int
    ratio: float
    bits_per_vertex: float
    connectivity_bits_per_vertex: float
    geometry_bits_per_vertex: float
    order_bits_per_vertex: float
    guarantee_bits_per_vertex: float
    tutte_limit_bits_per_vertex: float
    valence_entropy_bits_per_vertex: float

    def as_dict(self) -> dict[str, Any]:
        """The fields by name, nested as they are."""
        return asdict(self)


def describe(
    encoded: EncodedMesh,
    word: EncodedWord,
    surface: Surface,
    mesh: Mesh,
    chunk_sizes: dict[str, int],
    guarantee: float,
) -> Stats:
    """The statistics of an encoded mesh.

    chunk_sizes: bytes of the file by kind of chunk, framing included.
    guarantee: worst case of the model, bits per vertex of a closed mesh of genus 0.
    """
    n_vertices, n_faces = encoded.n_vertices, mesh.n_faces
    n_used = len(np.unique(mesh.faces))
    components, loops, boundary_edges, n_edges = _kernels.describe(surface.opposite)
    n_piece_vertices = len(surface.vertex_of_piece)
    euler = n_piece_vertices - n_edges + encoded.counts.n_triangles
    connectivity = _total(chunk_sizes, "word", "model", "special S", "gluing", "splits")
    geometry = _total(chunk_sizes, "positions", "points", "exceptions")
    order = _total(chunk_sizes, "vertex order", "face order", "rotations")
    attributes = _total(
        chunk_sizes,
        *("vertex attributes", "face attributes", "corner attributes", "elements", "metadata"),
    )
    total, raw = sum(chunk_sizes.values()), _raw_size(encoded)
    return Stats(
        vertices=n_vertices,
        faces=n_faces,
        faces_by_corners=_faces_by_corners(mesh),
        vertex_dtype=encoded.dtype.name,
        isolated_vertices=n_vertices - n_used,
        components=components,
        genus=components - (euler + loops) // 2,
        boundary_loops=loops,
        boundary_edges=boundary_edges,
        glued_vertices=encoded.counts.n_copies,
        welded_vertices=len(np.unique(mesh.faces))
        - int(surface.vertex_of_piece.max(initial=-1))
        - 1,
        symbols=_count_symbols(word.symbols),
        hole_and_handle_integers=2 * encoded.counts.n_specials,
        model=_model_name(encoded.model),
        lattice={"kind": encoded.lattice.kind, **_parameters(encoded.lattice)},
        exceptions=encoded.n_exceptions,
        attributes=_attributes(encoded),
        streams=[Stream(k, size, _per_vertex(size, n_vertices)) for k, size in chunk_sizes.items()],
        connectivity_bytes=connectivity,
        geometry_bytes=geometry,
        order_bytes=order,
        attribute_bytes=attributes,
        total_bytes=total,
        raw_bytes=raw,
        ratio=raw / total,
        bits_per_vertex=_per_vertex(total, n_vertices),
        connectivity_bits_per_vertex=_per_vertex(connectivity, n_vertices),
        geometry_bits_per_vertex=_per_vertex(geometry, n_vertices),
        order_bits_per_vertex=_per_vertex(order, n_vertices),
        guarantee_bits_per_vertex=guarantee,
        tutte_limit_bits_per_vertex=TUTTE_LIMIT,
        valence_entropy_bits_per_vertex=valence_entropy(surface),
    )


def _faces_by_corners(mesh: Mesh) -> dict[int, int]:
    counts = np.bincount(np.diff(mesh.offsets))
    return {n: int(counts[n]) for n in np.flatnonzero(counts).tolist()}


def valence_entropy(surface: Surface) -> float:
    """Order-0 entropy of the numbers of edges at each vertex of the pieces, in bits per vertex."""
    n = len(surface.vertex_of_piece)
    if not n:
        return 0.0
    # A fan on a boundary has one more edge than it has corners.
    on_boundary = surface.piece_vertex[surface.opposite < 0]
    valence = np.bincount(surface.piece_vertex, minlength=n)
    valence += np.bincount(on_boundary, minlength=n)
    counts = np.bincount(valence)
    share = counts[counts > 0] / n
    return abs(float((share * np.log2(share)).sum()))


def _model_name(model: WordModel) -> str:
    return model.model_name if isinstance(model, Effort) else model.name


def _count_symbols(symbols: npt.NDArray[np.uint8]) -> dict[str, int]:
    return dict(zip(SYMBOLS, np.bincount(symbols, minlength=5).tolist(), strict=True))


def _parameters(lattice: Any) -> dict[str, Any]:
    parameters = dict(vars(lattice))
    if hasattr(lattice, "step"):
        parameters["step"] = lattice.step
    return parameters


def _attributes(encoded: EncodedMesh) -> dict[str, dict[str, Any]]:
    return {
        f"{owner} {', '.join(array.names)}": summary(array)
        for owner, _, arrays in _owners(encoded)
        for array in arrays
    }


def _owners(encoded: EncodedMesh) -> Iterator[tuple[str, int, Sequence[EncodedArray]]]:
    """What has attributes, and how many entries each of them has."""
    n_faces = encoded.counts.n_faces
    yield "vertex", encoded.n_vertices, encoded.vertex_attributes
    yield "face", n_faces, encoded.face_attributes
    yield "corner", encoded.counts.n_corners, encoded.corner_attributes
    for element in encoded.elements:
        yield element.name, element.n_rows, element.attributes
        yield f"{element.name} corner", element.n_corners, element.corner_attributes


def _raw_size(encoded: EncodedMesh) -> int:
    """Bytes of the arrays: coordinates, face indices of 4 bytes, attributes."""
    size = 3 * encoded.dtype.itemsize * encoded.n_vertices + 4 * encoded.counts.n_corners
    size += sum(4 * element.n_corners for element in encoded.elements)
    for _, n, arrays in _owners(encoded):
        size += sum(n * array.entry_size for array in arrays)
    return size


def _total(sizes: dict[str, int], *kinds: str) -> int:
    return sum(sizes.get(kind, 0) for kind in kinds)


def _per_vertex(n_bytes: int, n_vertices: int) -> float:
    return 8 * n_bytes / n_vertices if n_vertices else 0.0
