"""--grid in the shell: two tiles, compressed apart, meet."""

import ebz
from tests.codec.test_grid import shared, tiles


def test_tiles_of_the_shell_meet_without_cracks(sh, tmp_path):
    left, right = tiles()
    for name, tile in (("left", left), ("right", right)):
        ebz.write(tmp_path / f"{name}.ply", tile)
    script = """
        for t in left right; do
            ebz compress --grid 0.5,0,0,1e-5 $t.ply
            ebz verify --against $t.ply $t.ply.ebz > report || exit
            ebz decompress -c $t.ply.ebz > $t.decoded.ply
        done
        ebz stats left.ply.ebz | grep -A 3 ^lattice
    """
    result = sh(script)
    assert (result.status, result.stderr) == (0, b"")
    assert result.stdout == (b"lattice\n  kind    grid\n  origin  0.5, 0, 0\n  step    1e-05\n")
    a, b = (ebz.read(tmp_path / f"{name}.decoded.ply") for name in ("left", "right"))
    assert shared(a.vertices, b.vertices) == shared(left.vertices, right.vertices)


def test_other_grids_are_usage_errors(sh):
    result = sh("ebz compress --grid 0,1 --bits 3 a.ply")
    assert (result.status, result.stdout) == (1, b"")
    assert b"--bits, --max-error and --grid exclude each other." in result.stderr
    for text in ("1", "0,1,2", "0,x", ""):
        result = sh(f"ebz compress --grid '{text}' a.ply")
        assert f"'{text}' is not ORIGIN,STEP or X,Y,Z,STEP.".encode() in result.stderr
    assert sh("ebz compress --grid 0,-1 a.ply").stderr == (
        b"ebz: a.ply: the step of the grid is -1.0, not a finite number above 0\n"
    )
