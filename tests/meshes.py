"""Hypothesis strategies for meshes of every topological kind, up to about a hundred faces.

Faces come as (m, 3) int64 arrays.  A failing example prints its mesh with `hypothesis.note`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import note
from hypothesis import strategies as st

from ebz.codec.mesh import Mesh
from ebz.codec.sample import glued_grid, random_triangulation
from tests import surgery
from tests.surgery import Faces, Rng, n_used

# Quiet and signalling NaNs with payloads, infinities, zeros, denormals, the largest numbers.
SPECIAL_32 = [0x7FC00000, 0x7FC00001, 0xFFFFFFFF, 0x7F800001, 0x7F800000, 0xFF800000]
SPECIAL_32 += [0x80000000, 0, 1, 0x80000001, 0x007FFFFF, 0x7F7FFFFF, 0xFF7FFFFF]
SPECIAL_64 = [0x7FF8 << 48, (0x7FF8 << 48) + 1, 2**64 - 1, (0x7FF0 << 48) + 1, 0x7FF0 << 48]
SPECIAL_64 += [0xFFF0 << 48, 1 << 63, 0, 1, (1 << 63) + 1, 2**52 - 1, (0x7FF0 << 48) - 1]

DAMAGE: list[Callable[[Faces, int, Rng], Faces]] = [
    surgery.delete_faces,
    surgery.identify_vertices,
    surgery.turn_faces,
    surgery.repeat_faces,
    surgery.add_degenerate_faces,
    surgery.add_faces,
    surgery.flip_edges,
]

rngs = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def triangle_soups(max_vertices: int = 8, max_faces: int = 16) -> st.SearchStrategy[Faces]:
    """Any faces over few vertices: mostly non-manifold, some degenerate, some repeated."""
    vertex = st.integers(0, max_vertices - 1)
    faces = st.lists(st.tuples(vertex, vertex, vertex), max_size=max_faces)
    return faces.map(lambda rows: np.array(rows, np.int64).reshape(-1, 3))


@st.composite
def spheres(draw: st.DrawFn, max_vertices: int = 50) -> Faces:
    """Uniform random simple triangulations of the sphere."""
    n_vertices = draw(st.integers(4, max_vertices))
    return random_triangulation(n_vertices, draw(st.integers(0, 2**32 - 1))).faces.astype(np.int64)


@st.composite
def surfaces(draw: st.DrawFn, max_handles: int = 2, max_holes: int = 4) -> Faces:
    """Connected simple oriented surfaces with handles and boundary loops of three edges."""
    n_handles, n_holes = draw(st.integers(0, max_handles)), draw(st.integers(0, max_holes))
    return surgery.surface(n_handles, n_holes, draw(rngs))


@st.composite
def discs(draw: st.DrawFn) -> Faces:
    """Spheres without the star of a vertex: discs with a boundary of any length."""
    faces = draw(spheres())
    return faces[(faces != draw(st.integers(0, n_used(faces) - 1))).all(axis=1)]


@st.composite
def grids(draw: st.DrawFn) -> Faces:
    """Rectangles, cylinders, tori, Moebius strips and Klein bottles, the small ones not simple."""
    n_rows, n_columns = draw(st.integers(1, 6)), draw(st.integers(1, 7))
    rows, columns = (
        draw(st.sampled_from(["open", "join"])),
        draw(st.sampled_from(["open", "join", "twist"])),
    )
    faces = glued_grid(n_rows, n_columns, rows, columns)[2]
    return surgery.flip_edges(faces, draw(st.integers(0, 40)), draw(rngs))


def simple_surfaces() -> st.SearchStrategy[Faces]:
    """Connected oriented manifolds without double edges."""
    return spheres() | surfaces() | discs()


@st.composite
def damaged(draw: st.DrawFn) -> Faces:
    """Surfaces after random deletions, identifications, turned, repeated and degenerate faces."""
    faces = draw(simple_surfaces() | grids())
    for operation in draw(st.lists(st.sampled_from(DAMAGE), min_size=1, max_size=3)):
        faces = operation(faces, draw(st.integers(1, 12)), draw(rngs))
    return faces


def face_lists() -> st.SearchStrategy[Faces]:
    """Faces of every kind, unions of several kinds included."""
    kinds = triangle_soups() | simple_surfaces() | grids() | damaged()
    return kinds | st.lists(kinds, max_size=3).map(surgery.union)


@st.composite
def coordinates(
    draw: st.DrawFn, n: int, *, distinct: bool = True, finite: bool = False
) -> npt.NDArray[Any]:
    """Vertices, (n, 3) float32 or float64, no two equal bit by bit where `distinct` says so."""
    dtype = draw(st.sampled_from([np.dtype(np.float32), np.dtype(np.float64)]))
    rng = draw(rngs)
    kind = draw(st.sampled_from(["smooth", "decimal", "integer"]))
    values = rng.normal(size=(n, 3)) if kind == "smooth" else rng.integers(-999, 999, (n, 3)) / 1.0
    vertices = (values / 1000 if kind == "decimal" else values).astype(dtype)
    if not finite and draw(st.booleans()):
        words = (SPECIAL_32, np.uint32) if dtype == np.float32 else (SPECIAL_64, np.uint64)
        patterns = np.array(*words).view(dtype)
        odd = rng.random((n, 3)) < draw(st.sampled_from([0.05, 0.5]))
        vertices[odd] = rng.choice(patterns, np.count_nonzero(odd))
    if distinct:
        vertices[:, rng.integers(3)] = rng.permutation(n) / (1000 if kind == "decimal" else 1)
    return vertices


@st.composite
def attributes(draw: st.DrawFn, n: int) -> dict[str, npt.NDArray[Any]]:
    """Up to three arrays of any numeric dtype, scalar or with several components."""
    dtypes = st.sampled_from(["?", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"])
    names = st.sampled_from(["red", "label", "texture uv", "é"])
    arrays = {}
    for name in draw(st.lists(names, unique=True, max_size=3)):
        dtype, shape = np.dtype(draw(dtypes)), (n, *draw(st.sampled_from([(), (2,), (4,)])))
        words = draw(rngs).integers(256, size=(*shape, dtype.itemsize), dtype=np.uint8)
        words = words & 1 if dtype.kind == "b" else words
        arrays[name] = words.view(dtype).reshape(shape)
    return arrays


@st.composite
def meshes(
    draw: st.DrawFn,
    faces: st.SearchStrategy[Faces] | None = None,
    *,
    distinct: bool = True,
    finite: bool = False,
    with_attributes: bool = False,
) -> Mesh:
    """Meshes over the given face lists (every kind), shuffled, some with isolated vertices.

    `distinct`: no two vertices are equal, so that `same_mesh` can compare; `finite`: no infinity
    and no NaN, so that coordinates can be quantised.
    """
    corners = draw(faces if faces is not None else face_lists())
    n_vertices = n_used(corners) + draw(st.sampled_from([0, 0, 0, 1, 5]))
    vertices = draw(coordinates(n_vertices, distinct=distinct, finite=finite))
    carried = [draw(attributes(n)) if with_attributes else {} for n in (n_vertices, len(corners))]
    mesh, _ = surgery.shuffled(Mesh(vertices, corners, *carried), draw(rngs))
    note(f"faces = {mesh.faces.tolist()}\nvertices = {mesh.vertices!r}")
    return mesh
