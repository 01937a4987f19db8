"""Writes the sample zoo: `python -m samples.make [FOLDER]`, into this folder if none is given.

The same bytes on every machine.  README.md lists what each sample is for.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import sample
from samples import polygons, surfaces, texts
from samples.writers import ascii_stl, binary_stl, glb, obj, off, ply

Array = npt.NDArray[Any]

TETRAHEDRON = (
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
)
POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0.25), (0, -1, 0.5), (-1, -1, 0.75)]


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for name, data in (tiny() | smooth() | singular() | carried() | flavours() | scenes()).items():
        (folder / name).write_bytes(data)


def tiny() -> dict[str, bytes]:
    return {
        "empty.ply": ply([], []),
        "points.ply": ply(POINTS, []),
        "triangle.ply": ply(POINTS[:3], [(0, 1, 2)]),
        "tetrahedron.ply": ply(*TETRAHEDRON, flavour="ascii"),
    }


def smooth() -> dict[str, bytes]:
    """Manifold, oriented where possible."""
    sphere = sample.sphere(1280)
    holed = surfaces.compact(sphere.vertices, _with_holes(sphere.faces))
    disc = surfaces.compact(sphere.vertices, sphere.faces[1:])
    box = surfaces.voxels(_box_with_holes())
    terrain, torus = sample.grid(2000), sample.torus(1200)
    triangulation = sample.random_triangulation(1000, seed=1)
    many = [
        (0.2 * sample.icosahedron()[0] + offset) for offset in 8 * sample.uniform(2, (30, 1, 3))
    ]
    return {
        "icosphere.ply": ply(sphere.vertices, sphere.faces),
        "torus.ply": ply(torus.vertices, torus.faces),
        "double_torus.ply": _ply(surfaces.relax(surfaces.slab(2, 3), 8)),
        "genus_5.ply": _ply(surfaces.relax(surfaces.slab(5, 2), 4)),
        "annulus.ply": _ply(surfaces.annulus(6, 48)),
        "cylinder.ply": _ply(surfaces.cylinder(16, 24)),
        "moebius_strip.ply": _ply(surfaces.moebius_strip(6, 60)),
        "klein_bottle.ply": _ply(surfaces.klein_bottle(24, 48)),
        "projective_plane.ply": ply(sample.spiral(6).astype(np.float32), PROJECTIVE_PLANE),
        "sphere_with_holes.ply": ply(*holed),
        "short_boundary.ply": ply(*disc),
        "box_with_holes.ply": _ply(box),
        "terrain.ply": ply(terrain.vertices, terrain.faces),
        "random_triangulation.ply": ply(triangulation.vertices, triangulation.faces),
        "components.ply": _ply(_union([(points, sample.icosahedron()[1]) for points in many])),
        "trefoil.ply": _ply(surfaces.trefoil(36, 218, seed=7)),
    }


# Six vertices, every two of them adjacent: the smallest triangulation.
PROJECTIVE_PLANE = [
    *[(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)],
    *[(1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)],
]


def singular() -> dict[str, bytes]:
    """Non-manifold, inconsistently oriented or degenerate."""
    a, b = TETRAHEDRON[1], np.array(TETRAHEDRON[1])
    corners = [*POINTS, (1, 1, 1)]
    sphere = sample.sphere(320)
    flipped = sphere.faces.copy()
    flipped[100] = flipped[100, ::-1]
    pinched = np.where(sphere.faces == 11, 0, sphere.faces)
    cubes = np.zeros((2, 2, 2))
    cubes[0, 0, 0] = cubes[1, 1, 0] = cubes[0, 1, 1] = 1
    hole = surfaces.annulus(3, 16)
    touching = np.where(hole[1] == len(hole[0]) - 16, 0, hole[1])
    return {
        "bow_tie.ply": ply(POINTS[:5], [(0, 1, 2), (0, 3, 4)]),
        "tetrahedra_vertex.ply": ply(corners[:7], [*a, *np.array([0, 4, 5, 6])[b]]),
        "tetrahedra_edge.ply": ply(corners[:6], [*a, *np.array([0, 1, 4, 5])[b]]),
        "tetrahedra_face.ply": ply([*corners[:4], corners[-1]], [*a, *np.array([4, 1, 3, 2])[b]]),
        "three_pages.ply": ply(POINTS[:5], [(0, 1, 2), (0, 1, 3), (0, 1, 4)]),
        "five_pages.ply": ply(POINTS, [(0, 1, page) for page in range(2, 7)]),
        "repeated_faces.ply": ply(TETRAHEDRON[0], [*a, a[0], a[1], a[1][1:] + a[1][:1]]),
        "opposite_faces.ply": ply(POINTS[:4], [(0, 1, 2), (2, 1, 0), (0, 1, 3), (0, 3, 1)]),
        "degenerate_faces.ply": ply(
            TETRAHEDRON[0], [*a, (0, 0, 1), (2, 3, 2), (1, 1, 1), (3, 2, 2)]
        ),
        "pinched_sphere.ply": ply(*surfaces.compact(sphere.vertices, pinched)),
        "pinched_cubes.ply": _ply(surfaces.voxels(np.kron(cubes, np.ones((2, 2, 2))))),
        "touching_hole.ply": _ply(surfaces.compact(hole[0], touching)),
        "flipped_face.ply": ply(sphere.vertices, flipped),
        "isolated_vertices.ply": ply(
            np.concatenate(
                [[[3, 0, 0]], sphere.vertices[:50], [[4, 0, 0]] * 3, sphere.vertices[50:]]
            ).astype(np.float32),
            sphere.faces + np.where(sphere.faces < 50, 1, 4),
        ),
    }


def carried() -> dict[str, bytes]:
    """What comes with a mesh: odd coordinates, attributes, comments."""
    sphere = sample.sphere(320)
    vertices = sphere.vertices.copy()
    odd = np.array([0x7FC00001, 0xFFC00000, 0x7F800001, 0x7F800000, 0xFF800000, 0x80000000, 1])
    vertices.ravel()[5 : 5 + 20 * len(odd) : 20] = odd.astype(np.uint32).view(np.float32)
    precise, faces = sample.subdivide(*sample.icosahedron(), 3)
    labels = {"label": np.arange(len(sphere.faces), dtype=np.int32) // 64}
    colours = ((sphere.vertices + 1) * 127).astype(np.uint8)
    channels = {name: colours[:, i] for i, name in enumerate(("red", "green", "blue"))}
    quality = {"quality": sphere.vertices[:, 2].astype(np.float64) / 3}
    return {
        "special_floats.ply": ply(vertices, sphere.faces),
        "float64.ply": ply(precise / 3, faces),
        "colours.ply": ply(
            sphere.vertices,
            sphere.faces,
            vertex_properties=channels | quality,
            face_properties=labels,
            comments=("vertex colours, a scalar field and face labels",),
        ),
        "big_endian.ply": ply(
            sphere.vertices, sphere.faces, flavour="binary_big_endian", face_properties=labels
        ),
        "ascii_colours.ply": ply(
            sphere.vertices,
            sphere.faces,
            flavour="ascii",
            vertex_properties=channels | quality,
            face_properties=labels,
        ),
        "property_order.ply": texts.PROPERTY_ORDER,
        "texcoord.ply": texts.TEXCOORD,
    }


def flavours() -> dict[str, bytes]:
    sphere = sample.sphere(180)
    lines = ply(*TETRAHEDRON, flavour="ascii")
    return {
        "crlf.ply": lines.replace(b"\n", b"\r\n"),
        "ascii.stl": ascii_stl(*TETRAHEDRON, "tetrahedron"),
        "binary.stl": binary_stl(
            sphere.vertices, sphere.faces, "solid by name, binary all the same"
        ),
        "plain.obj": obj(sphere.vertices, sphere.faces),
        "corners.obj": texts.CORNERS,
        "polygons.obj": texts.POLYGONS,
        "materials.obj": texts.MATERIALS,
        "plain.off": off(sphere.vertices, sphere.faces),
        "quads.off": _off(polygons.quad_torus(12, 24)),
        "mixed.off": _off(polygons.mixed_sphere(720)),
        "colours.off": texts.COLOURS,
    }


def _ply(surface: surfaces.Surface) -> bytes:
    return ply(surface[0].astype(np.float32), surface[1])


def _off(surface: tuple[Array, list[list[int]]]) -> bytes:
    return off(surface[0].astype(np.float32), surface[1])


def _union(parts: list[surfaces.Surface]) -> surfaces.Surface:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    faces = [corners + start for (_, corners), start in zip(parts, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def _with_holes(faces: Array) -> Array:
    """Without the stars of the first twelve vertices, and without faces far apart."""
    star = (faces < 12).any(axis=1)
    lone = np.zeros_like(star)
    lone[20::37] = True
    touched = np.zeros(faces.max() + 1, bool)
    touched[faces[star]] = True
    for face in np.flatnonzero(lone):
        lone[face] = not touched[faces[face]].any()
        touched[faces[face]] |= lone[face]
    return faces[~(star | lone)]


def _box_with_holes() -> Array:
    box = np.ones((9, 7, 4), bool)
    box[1:3, 1:3, :] = box[4:8, 2:5, :] = False
    box[1:3, 4:6, 2:] = box[:, 3, 1:3] = False
    return box


def scenes() -> dict[str, bytes]:
    """Several meshes in one file."""
    ball, box = sample.sphere(320), surfaces.voxels(_box_with_holes())
    box_vertices, box_faces = np.asarray(box[0], np.float32), np.asarray(box[1], np.uint16)
    half = len(box_faces) // 2
    outline = np.array([0, 1, 1, 2, 2, 0], np.uint16)
    position, normal, index = "POSITION", "NORMAL", "indices"
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"name": "root", "children": [1, 2, 3], "scale": [2, 2, 2]},
            {"mesh": 0, "translation": [0, 3, 0]},
            {"mesh": 0, "translation": [0, -3, 0], "extras": {"copy": True}},
            {"mesh": 1},
        ],
        "materials": [{"name": "red"}, {"name": "blue"}],
        "meshes": [
            {"name": "ball", "primitives": [{"attributes": {position: 0, normal: 1}, index: 2}]},
            {
                "name": "box",
                "extras": {"holes": 2},
                "primitives": [
                    {"attributes": {position: 3}, index: 4, "material": 0},
                    {"attributes": {position: 3}, index: 5, "material": 1},
                    {"attributes": {position: 6, "COLOR_0": 7}, "mode": 0},
                    {"attributes": {position: 6}, index: 8, "mode": 1},
                ],
            },
        ],
    }
    arrays = [
        *[ball.vertices, ball.vertices, ball.faces.astype(np.uint16).ravel()],
        *[box_vertices, box_faces[:half].ravel(), box_faces[half:].ravel()],
        *[box_vertices[:3] + 1, np.eye(3, 4, dtype=np.float32), outline],
    ]
    return {"scene.glb": glb(document, arrays)}


if __name__ == "__main__":
    main()
