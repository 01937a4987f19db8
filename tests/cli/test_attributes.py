"""Precision of attributes in the shell."""

import numpy as np

import ebz
from ebz.codec.sample import torus


def write(path) -> ebz.Mesh:
    mesh = torus(400)
    normal = (mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True)).astype("f4")
    carried = {f"n{axis}": normal[:, i].copy() for i, axis in enumerate("xyz")}
    mesh = ebz.Mesh(mesh.vertices, mesh.faces, carried | {"quality": normal[:, 0] * 7})
    ebz.write(path, mesh)
    return mesh


def test_attributes_are_rounded_and_verified(sh, tmp_path):
    mesh = write(tmp_path / "a.ply")
    script = """
        ebz compress --normal-bits 8 --attribute-error quality=0.01 --keep-order a.ply || exit
        ebz verify --against a.ply a.ply.ebz > report || exit
        ebz compress --attribute-bits quality=9 -o b.ebz a.ply
        ebz stats a.ply.ebz | grep -o 'octahedral\\|error 0.01'
        ebz stats b.ebz | grep -o '9 bits'
    """
    result = sh(script)
    assert (result.status, result.stderr) == (0, b"")
    assert result.stdout == b"octahedral\nerror 0.01\n9 bits\n"
    decoded = ebz.decompress((tmp_path / "a.ply.ebz").read_bytes())
    moved = decoded.vertex_attributes["quality"] - mesh.vertex_attributes["quality"]
    assert 0 < np.abs(moved).max() <= 0.01 + 1e-6


def test_precisions_that_make_no_sense_are_errors(sh, tmp_path):
    write(tmp_path / "a.ply")
    for text in ("quality", "quality=x", "=", ""):
        result = sh(f"ebz compress --attribute-bits '{text}' a.ply")
        assert (result.status, result.stdout) == (1, b"")
        assert f"'{text}' is not NAME=VALUE, VALUE being a number.".encode() in result.stderr
    assert sh("ebz compress --attribute-bits colour=3 a.ply").stderr == (
        b"ebz: a.ply: there is no attribute 'colour' whose precision could be less\n"
    )
    assert sh("ebz compress --attribute-error quality=-1 a.ply").status == 1
