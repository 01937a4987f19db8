"""What a mesh accepts, and what it says of what it does not."""

import numpy as np
import pytest

import ebz

POINTS = np.arange(15, dtype=np.float32).reshape(5, 3)


def test_triangles_have_no_offsets():
    mesh = ebz.Mesh(POINTS, [[0, 1, 2], [2, 3, 4]])
    assert mesh.is_triangles and mesh.face_offsets is None and mesh.faces.shape == (2, 3)
    assert mesh.offsets.tolist() == [0, 3, 6] and mesh.corners.tolist() == [0, 1, 2, 2, 3, 4]


def test_offsets_of_triangles_are_dropped():
    mesh = ebz.Mesh(POINTS, [0, 1, 2, 2, 3, 4], face_offsets=[0, 3, 6])
    assert mesh.is_triangles and mesh.faces.tolist() == [[0, 1, 2], [2, 3, 4]]


def test_rows_of_four_are_quads():
    mesh = ebz.Mesh(POINTS, [[0, 1, 2, 3], [3, 2, 1, 4]])
    assert not mesh.is_triangles and mesh.n_faces == 2 and mesh.n_corners == 8
    assert mesh.face_offsets.tolist() == [0, 4, 8] and mesh.faces.shape == (8,)


def test_polygons_of_any_size():
    mesh = ebz.Mesh(POINTS, [0, 1, 2, 0, 1, 2, 3, 4], face_offsets=[0, 3, 8, 8])
    assert mesh.n_faces == 3 and mesh.offsets.dtype == np.int64


def test_corner_attributes_have_an_entry_per_corner():
    values = {"uv": np.zeros((7, 2), np.float32)}
    faces, offsets = [0, 1, 2, 0, 1, 2, 3], [0, 3, 7]
    assert ebz.Mesh(POINTS, faces, face_offsets=offsets, corner_attributes=values).n_corners == 7
    with pytest.raises(ebz.MeshError, match=r"corner attribute 'uv': shape \(7, 2\) is not \(3"):
        ebz.Mesh(POINTS, [[0, 1, 2]], corner_attributes=values)


@pytest.mark.parametrize(
    ("faces", "offsets", "message"),
    [
        ([0, 1, 2], None, r"faces: shape \(3,\) is not \(m, 3\)"),
        ([[0, 1, 2]], [0, 3], r"faces: shape \(1, 3\) is not \(k,\) beside face_offsets"),
        ([0, 1, 2, 3], [0, 3], "face offsets do not ascend from 0 to the 4 corners"),
        ([0, 1, 2, 3], [0, 5, 4], "face offsets do not ascend from 0 to the 4 corners"),
        ([0, 1, 2, 3], [0.0, 4.0], r"face offsets: shape \(2,\) of float64 is no \(m \+ 1,\)"),
        ([0, 1, 2, 3, 0, 9], [0, 2, 6], r"face 1: vertex 9 is out of range \(there are 5\)"),
        ([[0, 1, 2], [0, -1, 2]], None, "face 1: vertex -1 is out of range"),
        ([[0.0, 1.0, 2.0]], None, "faces: dtype float64 is not an integer"),
    ],
)
def test_faces_that_do_not_fit(faces, offsets, message):
    with pytest.raises(ebz.MeshError, match=message):
        ebz.Mesh(POINTS, faces, face_offsets=offsets)


def test_elements_refer_to_vertices():
    line = ebz.Element([0, 2, 5], [0, 1, 2, 3, 4], {"id": np.array([7, 8])})
    mesh = ebz.Mesh(POINTS, [], elements={"line": line})
    assert len(mesh.elements["line"]) == 2
    with pytest.raises(ebz.MeshError, match="line 1: vertex 4 is out of range"):
        ebz.Mesh(POINTS[:4], [], elements={"line": line})
    with pytest.raises(ebz.MeshError, match=r"line attribute 'id': shape \(2,\) is not \(1"):
        short = ebz.Element([0, 2], [0, 1], {"id": np.array([7, 8])})
        ebz.Mesh(POINTS, [], elements={"line": short})
