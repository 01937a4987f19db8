"""The oracle accepts what may change, and notices everything else."""

import numpy as np
import pytest

from ebz.codec.mesh import Mesh
from tests.connectivity_check import same_mesh, same_under


def mesh(vertices, faces, **attributes) -> Mesh:
    return Mesh(np.array(vertices, np.float32).reshape(-1, 3), np.array(faces, int), **attributes)


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, np.nan)]
FACES = [(0, 1, 2), (0, 2, 3)]
TAG = {"face_attributes": {"tag": np.array([4, 5])}}


def test_order_and_rotation_do_not_matter():
    other = mesh([SQUARE[i] for i in (2, 0, 3, 1)], [(0, 2, 1), (3, 0, 1)])
    assert same_mesh(mesh(SQUARE, FACES), other)
    assert same_under(mesh(SQUARE, FACES), other, [2, 0, 3, 1])
    assert not same_under(mesh(SQUARE, FACES), other, [2, 0, 1, 3])
    assert not same_under(mesh(SQUARE, FACES), other, [2, 0, 0, 1])


@pytest.mark.parametrize(
    "other",
    [
        mesh(SQUARE, [(0, 1, 2), (2, 0, 3)]),
        mesh(SQUARE, [(0, 1, 2), (0, 1, 2)]),
        mesh(SQUARE, FACES[:1]),
        mesh([*SQUARE[:3], (0, 1, 0)], FACES),
        mesh([(-0.0, 0, 0), *SQUARE[1:]], FACES),
        mesh([*SQUARE, (9, 9, 9)], FACES),
        mesh(SQUARE, FACES, **TAG),
        Mesh(np.array(SQUARE), np.array(FACES)),
    ],
    ids=["flipped", "repeated", "fewer", "value", "sign of zero", "more", "attribute", "dtype"],
)
def test_differences_are_noticed(other):
    assert not same_mesh(mesh(SQUARE, FACES), other)
    assert not same_under(mesh(SQUARE, FACES), other, [0, 1, 2, 3])


def test_face_attributes_go_with_their_faces():
    swapped = {"face_attributes": {"tag": np.array([5, 4])}}
    assert same_mesh(mesh(SQUARE, FACES, **TAG), mesh(SQUARE, FACES[::-1], **swapped))
    assert not same_mesh(mesh(SQUARE, FACES, **TAG), mesh(SQUARE, FACES, **swapped))


def test_vertex_attributes_tell_equal_positions_apart():
    tag = {"vertex_attributes": {"tag": np.arange(4)}}
    at_one_place = mesh([(0, 0, 0)] * 4, FACES, **tag)
    assert same_mesh(at_one_place, at_one_place)
    assert not same_mesh(at_one_place, mesh([(0, 0, 0)] * 4, [(0, 1, 2), (0, 1, 3)], **tag))


def test_equal_vertices_are_refused_only_where_faces_use_them():
    with pytest.raises(ValueError, match="told apart"):
        same_mesh(mesh([(0, 0, 0)] * 4, FACES), mesh([(0, 0, 0)] * 4, FACES))
    one_used = mesh([*SQUARE, SQUARE[0]], FACES)
    assert same_mesh(one_used, mesh([*SQUARE, SQUARE[0]], [(4, 1, 2), (4, 2, 3)]))
    assert not same_mesh(one_used, mesh([*SQUARE, SQUARE[0]], [(0, 1, 2), (4, 2, 3)]))
    assert same_under(mesh([(0, 0, 0)] * 4, FACES), mesh([(0, 0, 0)] * 4, FACES), range(4))
