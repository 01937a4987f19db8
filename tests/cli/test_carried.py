"""What a file carries comes back through compress and decompress, and verify says so."""

from pathlib import Path

import pytest

from ebz.formats.meshes import read_mesh
from tests.cli.shell import Shell
from tests.formats.carried import contents

SAMPLES = Path(__file__).parents[2] / "samples"
NAMES = ["texcoord.ply", "property_order.ply", "colours.ply", "colours.off"]
NAMES += ["corners.obj", "materials.obj", "polygons.obj", "quads.off", "mixed.off"]


@pytest.mark.parametrize("name", NAMES)
def test_verify_finds_all_that_the_file_carries(sh: Shell, name: str) -> None:
    script = f"""
        ebz compress -o m.ebz {SAMPLES / name}; ebz decompress -o back-{name} m.ebz
        ebz verify --against {SAMPLES / name} m.ebz; ebz verify --against back-{name} m.ebz
    """
    result = sh(f"set -e; {script}")
    assert (result.status, result.stderr) == (0, b"")
    assert result.stdout.count(b"equal             yes") == 2
    assert result.stdout.count(b"metadata") == 2


@pytest.mark.parametrize("name", NAMES)
def test_in_its_order_every_array_comes_back(sh: Shell, name: str, tmp_path: Path) -> None:
    script = (
        f"ebz compress --keep-order -o m.ebz {SAMPLES / name} && ebz decompress -o {name} m.ebz"
    )
    result = sh(script)
    assert (result.status, result.stderr) == (0, b"")
    back, original = (read_mesh((folder / name).read_bytes()) for folder in (tmp_path, SAMPLES))
    assert contents(back) == contents(original)
    assert back.metadata == original.metadata
    if name in ("texcoord.ply", "property_order.ply"):
        assert (tmp_path / name).read_bytes() == (SAMPLES / name).read_bytes()


def test_another_name_is_a_difference(sh: Shell) -> None:
    script = f"""
        ebz compress -c {SAMPLES / "corners.obj"} > c.ebz
        sed 's/g upper/g other/' {SAMPLES / "corners.obj"} > o.obj; ebz verify --against o.obj c.ebz
    """
    result = sh(script)
    assert result.status == 2
    assert b"first difference  metadata 'obj' 'groups' 1: 'upper', not 'other'" in result.stdout
