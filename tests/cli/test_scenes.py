"""Files of several meshes in the shell."""

import json
import shutil
from pathlib import Path

import ebz
from tests.cli.shell import Result
from tests.codec.test_scene import scene


def test_scenes_in_pipelines(sh, tmp_path):
    (tmp_path / "s.ebz").write_bytes(ebz.compress(scene()))
    other = scene()
    other.parts[0].vertices[0] += 1
    (tmp_path / "other.ebz").write_bytes(ebz.compress(other))
    assert (
        sh("ebz verify --against s.ebz s.ebz --json | grep -c '\"equal\": true'").stdout == b"1\n"
    )
    result = sh("ebz verify --against other.ebz s.ebz; echo $?")
    assert b"part 0 'ball': " in result.stdout
    assert result.stdout.endswith(b"\n2\n")
    assert sh("ebz compress -c s.ebz | cmp - s.ebz") == Result(0, b"", b"")


def test_glb_comes_back(sh, tmp_path):
    shutil.copy(Path(__file__).parents[2] / "samples" / "scene.glb", tmp_path / "a.glb")
    script = """
        ebz compress --keep-order a.glb && ebz decompress -o b.glb a.glb.ebz &&
        ebz verify --against a.glb a.glb.ebz > 1 && ebz verify --against b.glb a.glb.ebz > 2 &&
        ebz compress --keep-order -c b.glb | cmp - a.glb.ebz && ebz compress -o c.ebz a.glb &&
        ebz decompress c.ebz && ebz verify --against c.glb c.ebz > 3
    """
    assert sh(script) == Result(0, b"", b"")
    result = sh("ebz decompress --to obj -c a.glb.ebz | grep ^o")
    names = dict.fromkeys(result.stdout.decode().splitlines())
    assert list(names) == ["o ball", "o ball.1", "o box", "o box.3", "o box.4", "o box.5"]
    assert b"OBJ holds one mesh: the 6 parts are joined" in result.stderr


def test_statistics_of_scenes(sh, tmp_path):
    (tmp_path / "s.ebz").write_bytes(ebz.compress(scene()))
    lines = sh("ebz stats s.ebz").stdout.decode().splitlines()
    assert lines[0].split() == ["parts", "3"]
    assert {"part 0 'ball'", "part 1 'nothing'", "part 2"} < set(lines)
    stats = json.loads(sh("ebz stats --json s.ebz").stdout)
    assert stats["part 0 'ball'"]["vertices"] == scene().parts[0].n_vertices


def test_scenes_as_one_mesh(sh, tmp_path):
    (tmp_path / "s.ebz").write_bytes(ebz.compress(scene()))
    result = sh("ebz decompress --to ply -c s.ebz | grep -a ^element")
    n = sum(part.n_vertices for part in scene().parts)
    assert result.stdout.split()[2] == str(n).encode()
    assert b"ebz: warning: s.ebz: PLY holds one mesh: the 3 parts are joined\n" in result.stderr


def test_scenes_without_a_format_become_glb(sh, tmp_path):
    whole = scene()
    del whole.parts[1]
    (tmp_path / "s.ebz").write_bytes(ebz.compress(whole))
    assert sh("ebz decompress s.ebz && ebz verify --against s.glb s.ebz | grep ^equal").stdout == (
        b"equal             yes\n"
    )
    assert ebz.read(tmp_path / "s.glb").names == ["ball", None]
