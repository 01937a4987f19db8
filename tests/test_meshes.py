"""The generated meshes are of the kinds that their names say."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests import surgery
from tests.connectivity_check import same_mesh, same_under
from tests.meshes import discs, face_lists, meshes, rngs, simple_surfaces, spheres
from tests.topology import is_simple_sphere, topology


@given(spheres())
def test_spheres_are_simple_spheres(faces):
    assert is_simple_sphere(faces)


@given(spheres(), st.integers(0, 200), rngs)
def test_flips_keep_a_simple_sphere(faces, n_flips, rng):
    assert is_simple_sphere(surgery.flip_edges(faces, n_flips, rng))


@settings(max_examples=50)
@given(simple_surfaces())
def test_simple_surfaces_are_oriented_manifolds_without_double_edges(faces):
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
    assert np.unique(edges, axis=0, return_counts=True)[1].max() <= 2
    assert topology(faces)[3:] == (0, 0, 0)


@pytest.mark.parametrize(("n_handles", "n_holes"), [(0, 0), (1, 0), (0, 1), (3, 4), (40, 60)])
def test_surfaces_have_the_handles_and_holes_asked_for(n_handles, n_holes):
    faces = surgery.surface(n_handles, n_holes, np.random.default_rng(1))
    euler = 2 - 2 * n_handles - n_holes
    assert topology(faces) == (1, euler, n_holes, 0, 0, 0)
    assert set(np.unique(np.bincount(faces.ravel()))) - {0, 5, 6}, "flips took place"


@given(discs())
def test_discs_have_one_boundary_and_no_handle(faces):
    assert topology(faces) == (1, 1, 1, 0, 0, 0)


@settings(max_examples=50)
@given(meshes(with_attributes=True), rngs)
def test_shuffling_gives_the_same_mesh(mesh, rng):
    other, order = surgery.shuffled(mesh, rng)
    assert same_mesh(mesh, other)
    assert same_under(mesh, other, order)


@settings(max_examples=50)
@given(meshes(finite=True))
def test_finite_meshes_are_finite(mesh):
    assert np.isfinite(mesh.vertices).all()


def test_face_lists_have_every_kind_among_them():
    found: set[str] = set()

    @settings(max_examples=150, database=None, derandomize=True)
    @given(face_lists())
    def collect(faces):
        found.update(kinds(faces))

    collect()
    assert found == {
        *("empty", "degenerate", "handles", "boundary", "closed", "several components"),
        *("singular edges", "singular vertices", "clashing edges"),
    }


def kinds(faces) -> set[str]:
    proper = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    shape = topology(proper)
    manifold = len(proper) > 0 and not any(shape[3:])
    return {
        name
        for name, present in {
            "empty": len(faces) == 0,
            "degenerate": len(proper) < len(faces),
            "handles": manifold and shape.genus > 0,
            "boundary": manifold and shape.boundary_loops > 0,
            "closed": manifold and shape.boundary_loops == 0,
            "several components": shape.components > 1,
            "singular edges": shape.singular_edges > 0,
            "singular vertices": shape.singular_vertices > 0,
            "clashing edges": shape.clashing_edges > 0,
        }.items()
        if present
    }
