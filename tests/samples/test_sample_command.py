"""`ebz sample` as a shell user meets it: meshes on stdout or in files, one line for every error."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ebz.codec.sample import grid, random_triangulation, sphere, torus
from ebz.formats.meshes import read_mesh

EBZ = Path(sys.executable).parent / "ebz"


def run(command: str, folder: Path) -> subprocess.CompletedProcess:
    environment = {"PATH": f"{EBZ.parent}:/usr/bin:/bin"}
    return subprocess.run(
        ["sh", "-c", command], cwd=folder, env=environment, capture_output=True, check=False
    )


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ("random-triangulation -n 200 --seed 3", random_triangulation(200, 3)),
        ("sphere -n 300", sphere(300)),
        ("torus -n 300 --noise 0.01 --seed 5", torus(300, 0.01, 5)),
        ("grid -n 300 -o -", grid(300)),
    ],
)
def test_meshes_come_on_standard_output(arguments, expected, tmp_path):
    done = run(f"ebz sample {arguments}", tmp_path)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(b"ply\nformat binary_little_endian 1.0\n")
    mesh = read_mesh(done.stdout)
    assert np.array_equal(mesh.vertices, expected.vertices)
    assert np.array_equal(mesh.faces, expected.faces)


@pytest.mark.parametrize(
    ("options", "start"),
    [
        *[("-o a.obj", b"v "), ("-o a.off", b"OFF\n"), ("-o a.ply", b"ply\n"), ("-o a", b"ply\n")],
        *[("--to off -o a.ply", b"OFF\n"), ("--to obj -o a", b"v ")],
    ],
)
def test_the_format_is_that_of_to_or_of_the_suffix(options, start, tmp_path):
    done = run(f"ebz sample sphere -n 20 {options}", tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    (written,) = tmp_path.iterdir()
    assert written.read_bytes().startswith(start)


def test_files_are_overwritten_only_by_force(tmp_path):
    (tmp_path / "a.ply").write_text("precious")
    done = run("ebz sample sphere -n 20 -o a.ply", tmp_path)
    assert (done.returncode, done.stdout) == (1, b"")
    assert done.stderr == b"ebz: a.ply: already exists; use -f to overwrite it\n"
    assert (tmp_path / "a.ply").read_text() == "precious"
    assert run("ebz sample sphere -n 20 -f -o a.ply", tmp_path).returncode == 0
    assert len(read_mesh((tmp_path / "a.ply").read_bytes()).faces) == 20


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("random-triangulation -n 2", "'-n': 2 is not in the range 3<=x<=10000000."),
        ("torus -n 0", "'-n': 0 is not in the range 1<=x<=100000000."),
        ("grid -n 9 --seed -1", "'--seed': -1 is not in the range x>=0."),
        ("grid -n 9 --noise -1", "'--noise': -1.0 is not in the range x>=0."),
    ],
)
def test_impossible_options_are_explained(arguments, message, tmp_path):
    done = run(f"ebz sample {arguments}", tmp_path)
    assert (done.returncode, done.stdout) == (1, b"")
    name = arguments.split()[0]
    expected = f"ebz: Invalid value for {message}\nTry 'ebz sample {name} --help'.\n"
    assert done.stderr.decode() == expected


def test_a_closed_pipe_ends_quietly(tmp_path):
    done = run("ebz sample sphere -n 100000 | head -c 3", tmp_path)
    assert (done.stdout, done.stderr) == (b"ply", b"")
