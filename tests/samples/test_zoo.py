"""The zoo is what samples/make.py makes, is described, and is as difficult as it claims."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ebz
from tests.topology import Topology, topology

SAMPLES = Path(__file__).parents[2] / "samples"
MESH_SUFFIXES = {".ply", ".obj", ".off", ".stl", ".glb"}


def zoo() -> set[str]:
    return {path.name for path in SAMPLES.iterdir() if path.suffix in MESH_SUFFIXES}


def faces_of(name: str) -> np.ndarray:
    """The faces of a little-endian PLY file whose vertices are three floats."""
    header, body = (SAMPLES / name).read_bytes().split(b"end_header\n", 1)
    n_vertices, n_faces = map(int, re.findall(rb"element \w+ (\d+)", header))
    dtype = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    return np.frombuffer(body, dtype, n_faces, 12 * n_vertices)["corners"]


def test_making_the_zoo_again_gives_the_committed_bytes(tmp_path):
    subprocess.run([sys.executable, "-m", "samples.make", tmp_path], cwd=SAMPLES.parent, check=True)
    assert {path.name for path in tmp_path.iterdir()} == zoo()
    for path in tmp_path.iterdir():
        assert path.read_bytes() == (SAMPLES / path.name).read_bytes(), path.name


def test_the_readme_has_one_row_for_each_sample():
    rows = re.findall(r"^\| `(\S+)` \|", (SAMPLES / "README.md").read_text(), re.MULTILINE)
    assert sorted(rows) == sorted(zoo())


def test_samples_are_small():
    sizes = {name: (SAMPLES / name).stat().st_size for name in zoo() - {"trefoil.ply"}}
    assert max(sizes.values()) < 100_000
    assert (SAMPLES / "trefoil.ply").stat().st_size < 300_000


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        # components, Euler characteristic, boundary loops, singular edges and vertices, clashes
        ("triangle.ply", (1, 1, 1, 0, 0, 0)),
        ("icosphere.ply", (1, 2, 0, 0, 0, 0)),
        ("torus.ply", (1, 0, 0, 0, 0, 0)),
        ("double_torus.ply", (1, -2, 0, 0, 0, 0)),
        ("genus_5.ply", (1, -8, 0, 0, 0, 0)),
        ("annulus.ply", (1, 0, 2, 0, 0, 0)),
        ("cylinder.ply", (1, 0, 2, 0, 0, 0)),
        ("moebius_strip.ply", (1, 0, 1, 0, 0, 6)),
        ("klein_bottle.ply", (1, 0, 0, 0, 0, 24)),
        ("projective_plane.ply", (1, 1, 0, 0, 0, 10)),
        ("short_boundary.ply", (1, 1, 1, 0, 0, 0)),
        ("terrain.ply", (1, 1, 1, 0, 0, 0)),
        ("random_triangulation.ply", (1, 2, 0, 0, 0, 0)),
        ("components.ply", (30, 60, 0, 0, 0, 0)),
        ("trefoil.ply", (1, 0, 0, 0, 0, 0)),
        ("bow_tie.ply", (1, 1, 1, 0, 1, 0)),
        ("tetrahedra_vertex.ply", (1, 3, 0, 0, 1, 0)),
        ("tetrahedra_edge.ply", (1, 3, 0, 1, 2, 2)),
        ("tetrahedra_face.ply", (1, 4, 0, 3, 3, 6)),
        ("three_pages.ply", (1, 1, 1, 1, 2, 1)),
        ("five_pages.ply", (1, 1, 1, 1, 2, 1)),
        ("opposite_faces.ply", (1, 3, 0, 1, 2, 2)),
        ("pinched_sphere.ply", (1, 1, 0, 0, 1, 0)),
        ("pinched_cubes.ply", (1, 4, 0, 6, 7, 12)),
        ("touching_hole.ply", (1, -1, 1, 0, 1, 0)),
        ("flipped_face.ply", (1, 2, 0, 0, 0, 3)),
        ("isolated_vertices.ply", (1, 2, 0, 0, 0, 0)),
        ("special_floats.ply", (1, 2, 0, 0, 0, 0)),
    ],
)
def test_the_topology_is_as_described(name, expected):
    assert topology(faces_of(name)) == Topology(*expected)


def test_polygons_have_as_many_corners_as_described():
    for name, n_corners in (("quads.off", {4}), ("mixed.off", {3, 4, 5})):
        mesh = ebz.read(SAMPLES / name)
        assert set(np.diff(mesh.offsets)) == n_corners


def test_holes_and_handles_are_many():
    holed = topology(faces_of("sphere_with_holes.ply"))
    assert (holed.components, holed.genus, holed.boundary_loops) == (1, 0, 40)
    box = topology(faces_of("box_with_holes.ply"))
    assert (box.components, box.genus, box.boundary_loops) == (1, 6, 0)
