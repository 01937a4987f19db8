"""stats of the zoo, against values that are known from the surfaces."""

import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import ebz
from ebz.codec import pipeline, statistics
from ebz.codec.statistics import TUTTE_LIMIT, Stats

SAMPLES = Path(__file__).parents[2] / "samples"


@cache
def read(name: str) -> ebz.Mesh:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ebz.DroppedWarning)
        return ebz.read(SAMPLES / name)


@cache
def stats(name: str) -> Stats:
    return ebz.stats(read(name))


@pytest.mark.parametrize(
    ("name", "components", "genus", "loops"),
    [
        ("triangle.ply", 1, 0, 1),
        ("tetrahedron.ply", 1, 0, 0),
        ("icosphere.ply", 1, 0, 0),
        ("torus.ply", 1, 1, 0),
        ("double_torus.ply", 1, 2, 0),
        ("genus_5.ply", 1, 5, 0),
        ("annulus.ply", 1, 0, 2),
        ("cylinder.ply", 1, 0, 2),
        ("empty.ply", 0, 0, 0),
    ],
)
def test_topology_of_the_zoo(name, components, genus, loops):
    found = stats(name)
    assert (found.components, found.genus, found.boundary_loops) == (components, genus, loops)
    assert found.hole_and_handle_integers == 2 * (2 * genus + max(loops - 1, 0))
    assert found.glued_vertices == 0


@pytest.mark.parametrize("path", sorted(SAMPLES.glob("*.ply")), ids=lambda path: path.name)
def test_counts_and_sizes_add_up(path):
    found = stats(path.name)
    mesh = read(path.name)
    data = ebz.compress(mesh)
    assert (found.vertices, found.faces) == (len(mesh.vertices), len(mesh.faces))
    assert found.isolated_vertices == len(mesh.vertices) - len(np.unique(mesh.faces))
    assert found.total_bytes == len(data) == sum(stream.bytes for stream in found.streams)
    parts = found.connectivity_bytes + found.geometry_bytes + found.attribute_bytes
    framing = sum(s.bytes for s in found.streams if s.name in {"start", "header", "digest"})
    assert parts + framing == found.total_bytes
    raw = mesh.vertices.nbytes + 12 * len(mesh.faces)
    owners = [mesh.vertex_attributes, mesh.face_attributes, mesh.corner_attributes]
    for element in mesh.elements.values():
        owners += [element.attributes, element.corner_attributes]
        raw += element.corners.nbytes
    carried = [values for owner in owners for values in owner.values()]
    assert found.raw_bytes == raw + sum(values.nbytes for values in carried)
    assert found.ratio == found.raw_bytes / len(data)


@pytest.mark.parametrize("path", sorted(SAMPLES.glob("*.ply")), ids=lambda path: path.name)
def test_symbols_add_up(path):
    found = stats(path.name)
    symbols = found.symbols
    n_specials = found.hole_and_handle_integers // 2
    assert symbols["E"] == symbols["S"] - n_specials + found.components
    euler = 2 * found.components - 2 * found.genus - found.boundary_loops
    n_sites = found.vertices - found.isolated_vertices - found.welded_vertices
    n_used = n_sites + found.glued_vertices
    assert 3 * found.faces == 2 * (n_used + found.faces - euler) - found.boundary_edges
    n_closed = found.faces - sum(symbols.values())
    assert symbols["C"] == n_used - found.boundary_edges - 3 * n_closed


def test_the_tetrahedron_exactly():
    found = stats("tetrahedron.ply")
    assert found.symbols == {"C": 1, "L": 0, "R": 1, "S": 0, "E": 1}
    assert found.valence_entropy_bits_per_vertex == 0
    assert found.tutte_limit_bits_per_vertex == TUTTE_LIMIT == pytest.approx(3.2451, abs=5e-5)


def test_valence_entropy_is_that_of_the_valences():
    """A wheel of five spokes: one vertex with five edges, five with three."""
    mesh = ebz.Mesh(np.arange(18.0).reshape(-1, 3), [(0, i, i % 5 + 1) for i in range(1, 6)])
    encoded, _ = pipeline.encode(mesh)
    surface = pipeline.decode(encoded).surface
    expected = -(np.log2(1 / 6) / 6 + np.log2(5 / 6) * 5 / 6)
    assert statistics.valence_entropy(surface) == pytest.approx(expected)


def test_a_mesh_and_its_file_have_the_same_statistics():
    mesh = read("annulus.ply")
    found = ebz.stats(mesh)
    assert found == ebz.stats(ebz.compress(mesh))
    assert TUTTE_LIMIT < found.guarantee_bits_per_vertex < 3.3234
    assert found.as_dict()["streams"][0]["name"] == "start"
