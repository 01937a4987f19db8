"""Attributes that follow the order of the source, where it is kept; normals of faces."""

from dataclasses import replace

import numpy as np
import pytest

import ebz
from ebz.codec import pipeline
from ebz.codec.attributes.plan import Guess
from ebz.codec.sample import random_triangulation, torus

OWNERS = ["vertex_attributes", "face_attributes", "corner_attributes"]


def shuffled(mesh: ebz.Mesh, **attributes: dict[str, np.ndarray]) -> ebz.Mesh:
    """Vertices and faces in random order."""
    rng = np.random.default_rng(1)
    order = rng.permutation(mesh.n_vertices)
    number = np.argsort(order)
    faces = number[mesh.faces][rng.permutation(mesh.n_faces)]
    return ebz.Mesh(mesh.vertices[order], faces, **attributes)


def counts(mesh: ebz.Mesh) -> list[int]:
    return [mesh.n_vertices, mesh.n_faces, mesh.n_corners]


@pytest.mark.parametrize("level", [1, 6, 9])
def test_what_follows_the_order_of_the_source_costs_little_where_it_is_kept(level):
    mesh = shuffled(random_triangulation(1500, seed=2))
    plain = len(ebz.compress(mesh, level=level, keep_order=True))
    for owner, n in zip(OWNERS, counts(mesh), strict=True):
        for values in (np.arange(n), 7 - 3 * np.arange(n), np.arange(n, dtype=np.uint16) // 100):
            carrying = replace(mesh, **{owner: {"id": values}})
            data = ebz.compress(carrying, level=level, keep_order=True)
            decoded = ebz.decompress(data)
            assert np.array_equal(getattr(decoded, owner)["id"], values)
            assert ebz.compress(decoded, level=level, keep_order=True) == data
            assert len(data) - plain < 200 + n / 16


def test_smooth_values_are_not_told_in_the_order_of_the_source():
    mesh = shuffled(torus(2000))
    values = (mesh.vertices[:, 0] * 1000).astype(np.int32)
    encoded, _ = pipeline.encode(
        replace(mesh, vertex_attributes={"smooth": values, "id": np.arange(len(values))}),
        keep_order=True,
    )
    assert [a.plan.in_source_order for a in encoded.vertex_attributes] == [False, True]


def test_an_order_that_is_not_kept_is_refused():
    mesh = shuffled(torus(400))
    mesh = replace(mesh, vertex_attributes={"id": np.arange(mesh.n_vertices)})
    kept, _ = pipeline.encode(mesh, keep_order=True)
    streams = kept.streams._replace(order=pipeline.OrderStreams())
    with pytest.raises(ebz.CorruptError, match="an order that is not kept"):
        pipeline.decode(kept._replace(streams=streams))


def face_normals(mesh: ebz.Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    return np.cross(b - a, c - a)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_normals_of_faces_cost_little_whatever_their_length(dtype):
    mesh = random_triangulation(2000, seed=1)
    long = face_normals(mesh)
    short = long / np.linalg.norm(long, axis=1, keepdims=True)
    for values, weights in ((long, Guess.AREA), (short, Guess.NONE)):
        carrying = replace(mesh, face_attributes={"normal": values.astype(dtype)})
        encoded, _ = pipeline.encode(carrying)
        (array,) = encoded.face_attributes
        assert array.plan.guess == Guess.NORMALS | weights
        assert len(array.data) < mesh.n_faces / 2
        assert encoded.streams.order.rotations is None
        assert ebz.verify(ebz.compress(carrying), carrying).equal


@pytest.mark.parametrize(
    ("name", "width", "is_kept"),
    [("x", 3, True), ("x", 6, True), ("x", 2, False), ("x", 4, False), ("Colors", 3, False),
     ("rgb", 3, False), ("normal", 3, False)],
)  # fmt: skip
def test_rotations_are_kept_where_values_may_stand_for_corners(name, width, is_kept):
    mesh = shuffled(torus(400))
    turns = np.random.default_rng(3).integers(0, 3, (mesh.n_faces, 1))
    faces = np.take_along_axis(mesh.faces, (np.arange(3) + turns) % 3, axis=1)
    values = np.random.default_rng(4).random((mesh.n_faces, width))
    carrying = ebz.Mesh(mesh.vertices, faces, face_attributes={name: values})
    data = ebz.compress(carrying)
    assert ("rotations" in [s.name for s in ebz.stats(data).streams]) == is_kept
    assert ebz.verify(data, carrying).equal
    assert ebz.compress(ebz.decompress(data)) == data
