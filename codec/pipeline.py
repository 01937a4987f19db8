"""All stages in order: mesh -> word and order -> lattice -> residuals -> streams, and back."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import assembly, connectivity, fitting, lattice, metadata, positions, welding
from ebz.codec import order as source_order
from ebz.codec import points as free_points
from ebz.codec.arrays import Attributes
from ebz.codec.attributes import coding, corners, rows
from ebz.codec.attributes.coding import EXACT
from ebz.codec.attributes.items import Sites
from ebz.codec.attributes.plan import Effort
from ebz.codec.attributes.precision import (
    AttributePrecision,
    is_name_of_colour,
    is_name_of_normal,
)
from ebz.codec.attributes.rounding import rounded
from ebz.codec.digest import digest
from ebz.codec.encoded import EncodedArray, EncodedMesh, Streams
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.codec.fitting import LOSSLESS, Precision
from ebz.codec.integers import encode_columns, gaps
from ebz.codec.lattice import Points
from ebz.codec.levels import DEFAULT_LEVEL, attribute_effort, position_method, word_models
from ebz.codec.mesh import Mesh
from ebz.codec.order import OrderStreams, SourceOrder
from ebz.codec.surface import OutputOrder, Surface
from ebz.codec.welding import Split
from ebz.codec.word import EncodedWord, WordModel

Progress = Callable[[str, int, int], None]
N_STAGES = 4


class Decoded(NamedTuple):
    """A decoded mesh and, for statistics, what its connectivity was made of."""

    mesh: Mesh
    word: EncodedWord
    surface: Surface


def keeps_rotation(mesh: Mesh) -> bool:
    """Whether the first corner of a face matters: several values may stand for its corners.

    They are not as many where all faces have as many; normals and colours are of the whole face.
    """
    sizes = np.unique(np.diff(mesh.offsets)) if mesh.face_attributes else np.zeros(0)
    n_corners = int(sizes[0]) if len(sizes) == 1 else 1
    return any(
        values.ndim > 1
        and values.shape[1] % max(n_corners, 1) == 0
        and not (is_name_of_normal(name) or is_name_of_colour(name))
        for name, values in mesh.face_attributes.items()
    )


def encode(
    mesh: Mesh,
    model: WordModel | None = None,
    *,
    level: int = DEFAULT_LEVEL,
    precision: Precision = LOSSLESS,
    points: Points | None = None,
    keep_order: bool = False,
    attribute_precision: AttributePrecision = EXACT,
    progress: Progress | None = None,
) -> tuple[EncodedMesh, OutputOrder]:
    """Every part of a mesh as streams, and where the items of the output come from.

    Nothing is lost but what precision allows, and the order without keep_order.
    model: of the word; None: the best of those of the level.
    points: the coordinates where they are fitted already, together with others.
    """
    report = progress or _silent
    mesh = replace(mesh)  # its arrays may have been exchanged since they were checked
    fitting.check(mesh.vertices, precision)
    mesh = rounded(mesh, attribute_precision)
    report("lattice", 0, N_STAGES)
    points = points or fitting.fit(mesh.vertices, precision)
    exact = mesh.vertices.reshape(-1)[points.exceptions]
    stored = lattice.restore(points, mesh.vertices.dtype, exact)
    report("connectivity", 1, N_STAGES)
    models = word_models(level) if model is None else [model]
    welded = welding.weld(mesh.faces, stored, mesh.face_offsets)
    word, surface, order = connectivity.encode(welded, len(stored), models, mesh.face_offsets)
    arrangement = welding.arrange(mesh.faces, welded, surface, order)
    report("positions", 2, N_STAGES)
    free = None
    if not keep_order:
        arrangement, free = free_points.encode(arrangement, points.integers)
    order = order._replace(vertices=arrangement.vertices)
    points = points.take(arrangement.sites)
    n_along = len(arrangement.sites) if free is None else surface.n_vertices
    coded = positions.encode(surface, points, n_along, stored.dtype, position_method(level))
    exact = mesh.vertices[arrangement.sites[points.exceptions // 3], points.exceptions % 3]
    report("attributes", 3, N_STAGES)
    keep_rotation = keeps_rotation(mesh)
    split = arrangement.split
    kept = source_order.kept(
        order, surface.polygons, keep_order=keep_order, keep_rotation=keep_rotation
    )
    placed = lattice.taken(stored, order.vertices)
    sites = Sites(surface, split, placed, kept)
    of_vertices, of_faces, of_corners = _encode_attributes(
        mesh, order, sites, attribute_precision, effort=attribute_effort(level)
    )
    encoded = EncodedMesh(
        dtype=stored.dtype,
        counts=word.counts,
        n_vertices=len(stored),
        n_exceptions=len(points.exceptions),
        lattice=points.lattice,
        coding=coded.coding,
        model=word.model,
        streams=Streams(
            word=word.word,
            special_integers=word.special_integers,
            gluing=word.gluing,
            splits=arrangement.splits,
            positions=coded.data if n_along else b"",
            listing=coded.listing,
            points=free,
            exception_rows=_encode_rows(points.exceptions),
            exception_values=_encode_values(exact),
            order=_encode_order(kept, surface, split, points.integers),
        ),
        vertex_attributes=of_vertices,
        face_attributes=of_faces,
        corner_attributes=of_corners,
        elements=rows.encode(mesh.elements, order.number_of, attribute_precision, sites),
        metadata=metadata.encode(mesh.metadata),
    )
    decoded = _restored(mesh, order, kept, sites)
    report("done", N_STAGES, N_STAGES)
    return encoded._replace(digest=digest(decoded)), order


def decode(encoded: EncodedMesh, *, progress: Progress | None = None) -> Decoded:
    """The mesh; raises CorruptError where the streams contradict each other or the digest."""
    report = progress or _silent
    streams, counts = encoded.streams, encoded.counts
    report("connectivity", 0, N_STAGES)
    word, surface = connectivity.decode(
        streams.word,
        streams.special_integers,
        streams.gluing,
        counts,
        encoded.model,
        place=encoded.place,
    )
    n_vertices = encoded.n_vertices
    with corrupt_at(encoded.place("word" if streams.splits is None else "splits")):
        split = welding.split(surface, streams.splits, n_vertices)
    report("positions", 1, N_STAGES)
    integers = assembly.decode_integers(encoded, surface, split.n_sites)
    report("lattice", 2, N_STAGES)
    vertices = split.at_sites(assembly.decode_coordinates(encoded, integers))
    report("attributes", 3, N_STAGES)
    kept = assembly.decode_order(encoded, surface, split, integers)
    sites = Sites(surface, split, vertices, kept)
    mesh = assembly.arranged(sites, kept, assembly.decode_carried(encoded, sites))
    report("done", N_STAGES, N_STAGES)
    if digest(mesh) != encoded.digest:
        raise CorruptError(
            f"{encoded.place('digest')}: the digest of the decoded mesh is not the one stored"
        )
    return Decoded(mesh, word, surface)


def _encode_attributes(
    mesh: Mesh, order: OutputOrder, sites: Sites, precision: AttributePrecision, *, effort: Effort
) -> tuple[list[EncodedArray], list[EncodedArray], list[EncodedArray]]:
    """Those of vertices, faces and corners; nothing is worked out for those there are none of."""
    of_vertices, of_faces, of_corners = [], [], []
    if values := mesh.vertex_attributes:
        of_vertices = coding.encode(
            values, order.vertices, sites.by_vertex, precision, effort=effort
        )
    if values := mesh.face_attributes:
        of_faces = coding.encode(values, order.faces, sites.by_face, precision, effort=effort)
    if values := mesh.corner_attributes:
        of_corners = corners.encode(values, order.all_corners, sites, precision, effort=effort)
    return of_vertices, of_faces, of_corners


def _encode_order(
    kept: SourceOrder, surface: Surface, split: Split, integers: lattice.Integers
) -> OrderStreams:
    if not kept.any:
        return OrderStreams()
    at = split.at_sites(integers)
    known = source_order.Known(surface.opposite, split.vertex, at, surface.polygons)
    return source_order.encode(kept, known)


def _silent(stage: str, done: int, total: int) -> None:
    pass


def _encode_rows(rows: npt.NDArray[np.int64]) -> bytes:
    return encode_columns(gaps(rows)) if len(rows) else b""


def _encode_values(exact: lattice.Floats) -> bytes:
    return exact.astype(exact.dtype.newbyteorder("<")).tobytes()


def _restored(mesh: Mesh, order: OutputOrder, kept: SourceOrder, sites: Sites) -> Mesh:
    """The mesh as decoding will yield it."""
    carried = assembly.Carried(
        _taken(mesh.vertex_attributes, order.vertices),
        _taken(mesh.face_attributes, order.faces) if mesh.face_attributes else {},
        _taken(mesh.corner_attributes, order.all_corners) if mesh.corner_attributes else {},
        rows.renumbered(mesh.elements, order.number_of),
        mesh.metadata,
    )
    return assembly.arranged(sites, kept, carried)


def _taken(attributes: Attributes, order: npt.NDArray[Any]) -> Attributes:
    return {name: values[order] for name, values in attributes.items()}
