"""Kernels that exist for several instruction sets write the same bytes and read each other's."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings

import ebz
from ebz.codec import _kernels
from ebz.codec.sample import random_triangulation
from tests.meshes import meshes


@pytest.fixture(autouse=True)
def allowed() -> Iterator[None]:
    yield
    _kernels.forbid_extensions(False)


def both(mesh: ebz.Mesh, level: int) -> tuple[bytes, bytes]:
    """The file with the machine's instructions, and with those of the baseline."""
    files = []
    for forbidden in (False, True):
        _kernels.forbid_extensions(forbidden)
        files.append(ebz.compress(mesh, level=level))
    return files[0], files[1]


@settings(deadline=None)
@given(meshes())
def test_small_meshes(mesh: ebz.Mesh) -> None:
    for level in (1, 3, 6, 9):
        extended, baseline = both(mesh, level)
        assert extended == baseline


def test_attributes() -> None:
    rng = np.random.default_rng(6)
    faces = random_triangulation(500).faces
    n, m = int(faces.max()) + 1, len(faces)
    mesh = ebz.Mesh(
        rng.random((n, 3)),
        faces,
        {
            "a": rng.integers(0, 200, (n, 4)),
            "normal": rng.normal(size=(n, 3)),
            "f": rng.normal(size=(n, 4)).astype(np.float32) ** 9,
        },
        {"b": rng.integers(-9, 9, m) ** 9},
        corner_attributes={"c": rng.integers(0, 2, (3 * m, 2))},
    )
    for options in ({}, {"normal_bits": 9}):
        files, decoded = [], []
        for forbidden in (False, True):
            _kernels.forbid_extensions(forbidden)
            files.append(ebz.compress(mesh, level=1, **options))
            decoded.append(ebz.compress(ebz.decompress(files[0]), level=9))
        assert files[0] == files[1]
        assert decoded[0] == decoded[1]


def test_long_streams() -> None:
    rng = np.random.default_rng(5)
    faces = random_triangulation(3000).faces
    for spread in (3, 300, 100000):
        vertices = np.cumsum(rng.integers(-spread, spread, (faces.max() + 1, 3)), axis=0)
        mesh = ebz.Mesh(vertices.astype(np.float32) / 1024, faces)
        for level in (1, 3, 6, 9):
            extended, baseline = both(mesh, level)
            assert extended == baseline
            _kernels.forbid_extensions(True)
            decoded = ebz.decompress(extended)
            _kernels.forbid_extensions(False)
            again = ebz.decompress(extended)
            assert np.array_equal(decoded.vertices, again.vertices)
