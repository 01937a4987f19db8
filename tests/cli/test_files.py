"""Which files are read, written and removed, and what the new ones are like."""

import os
import stat
import tempfile
from pathlib import Path

from tests.cli.shell import TETRAHEDRON, Result

NOTHING = Result(0, b"", b"")
MTIME = 1234567890


def test_nothing_is_overwritten_without_force(sh, tmp_path):
    (tmp_path / "a.ply.ebz").write_bytes(b"precious")
    expected = Result(1, b"", b"ebz: a.ply.ebz: already exists; use -f to overwrite it\n")
    assert sh("ebz compress a.ply") == expected
    assert sh("ebz compress -o a.ply.ebz - < a.ply") == expected
    assert (tmp_path / "a.ply.ebz").read_bytes() == b"precious"
    assert sh("ebz compress -f a.ply; ebz verify a.ply.ebz > /dev/null") == NOTHING
    assert sh("ebz decompress a.ply.ebz") == Result(
        1, b"", b"ebz: a.ply: already exists; use -f to overwrite it\n"
    )


def test_the_input_is_never_its_own_output(sh, tmp_path):
    os.link(tmp_path / "a.ply", tmp_path / "b.ply")
    for output in ("a.ply", "./a.ply", "b.ply"):
        assert sh(f"ebz compress -f -o {output} a.ply") == Result(
            1, b"", f"ebz: {output}: is the input, which would be overwritten\n".encode()
        )
    assert (tmp_path / "a.ply").read_bytes() == TETRAHEDRON


def test_outputs_that_cannot_be_are_refused(sh, names):
    cases = {
        "nowhere/x": "No such file or directory",
        "d": "is a folder",
        "a.ply/x": "Not a directory",
        "n" * 300: "File name too long",
    }
    for output, reason in cases.items():
        assert sh(f"mkdir -p d; ebz compress -f -o {output} a.ply") == Result(
            1, b"", f"ebz: {output}: {reason}\n".encode()
        )
    assert names() == {"a.ply", "d"}


def test_a_folder_without_write_permission_is_an_error(sh, tmp_path):
    # The superuser may write to every folder but those of the kernel.
    folder = tmp_path / "locked" if os.geteuid() else Path("/proc")
    if os.geteuid():
        folder.mkdir(mode=0o555)
    result = sh(f"ebz compress -o {folder}/x.ebz a.ply")
    assert (result.status, result.stdout) == (1, b"")
    assert result.stderr.startswith(f"ebz: {folder}/x.ebz: ".encode())
    assert result.stderr.count(b"\n") == 1
    assert not list(folder.glob(".ebz*"))


def test_the_longest_name_that_fits_is_written(sh, names):
    name = "n" * 247 + ".ply"
    assert sh(f"cp a.ply {name}; ebz compress {name}") == NOTHING
    assert names() == {"a.ply", name, name + ".ebz"}


def test_mode_and_time_of_the_input_are_kept(sh, tmp_path):
    source = tmp_path / "a.ply"
    for mode in (0o440, 0o755):
        source.chmod(mode)
        os.utime(source, ns=(MTIME * 10**9, MTIME * 10**9 + 123456789))
        assert sh("umask 022; ebz compress a.ply && ebz decompress -o b.ply a.ply.ebz") == NOTHING
        for name in ("a.ply.ebz", "b.ply"):
            status = (tmp_path / name).stat()
            assert stat.S_IMODE(status.st_mode) == mode
            assert status.st_mtime_ns == source.stat().st_mtime_ns
            (tmp_path / name).unlink()


def test_the_umask_holds_for_standard_input(sh, tmp_path):
    assert sh("umask 027; ebz compress -o b.ebz < a.ply") == NOTHING
    assert stat.S_IMODE((tmp_path / "b.ebz").stat().st_mode) == 0o640


def test_rm_removes_inputs_that_were_written_to_files(sh, names):
    assert sh("ebz compress --rm a.ply") == NOTHING
    assert names() == {"a.ply.ebz"}
    assert sh("ebz decompress --rm a.ply.ebz") == NOTHING
    assert names() == {"a.ply"}


def test_rm_keeps_the_input_otherwise(sh, names):
    script = """
        ebz compress --rm -c a.ply > out; ebz compress --rm -o /dev/null a.ply
        : > a.ply.ebz; ebz compress --rm a.ply; echo $?; ulimit -f 0; ebz compress --rm -f a.ply
    """
    result = sh(script)
    assert (result.status, result.stdout) == (1, b"1\n")
    assert sh("rm a.ply.ebz; ebz compress --rm -k a.ply") == NOTHING
    assert names() == {"a.ply", "a.ply.ebz", "out"}


def test_names_may_hold_any_bytes(sh, tmp_path):
    names = (b"two words.ply", b"\xff\xfe.ply", "ä".encode() + b".ply", b"-dash.ply", b"$(id).ply")
    for name in names:
        (tmp_path / os.fsdecode(name)).write_bytes(TETRAHEDRON)
    script = b"ebz compress -- " + b" ".join(b"'" + name + b"'" for name in names)
    assert sh(script) == NOTHING
    assert all((tmp_path / os.fsdecode(name + b".ebz")).exists() for name in names)
    lines = [b"ebz: " + name + b".ebz: already exists; use -f to overwrite it\n" for name in names]
    assert sh(script) == Result(1, b"", b"".join(lines))


def test_control_characters_in_names_are_not_sent_to_a_terminal(sh):
    assert sh(b"ebz compress '\x1b[31mred.ply'") == Result(
        1, b"", b"ebz: \\x1b[31mred.ply: No such file or directory\n"
    )


def test_symbolic_links_are_followed_by_force_only(sh, tmp_path, names):
    assert sh("ln -s a.ply l.ply; ebz compress l.ply") == Result(
        1, b"", b"ebz: l.ply: is a symbolic link; use -f to follow it\n"
    )
    assert sh("ebz stats l.ply > /dev/null; ebz compress -f --rm l.ply") == NOTHING
    assert names() == {"a.ply", "l.ply.ebz"}


def test_a_link_at_the_output_is_replaced_not_followed(sh, tmp_path):
    (tmp_path / "victim").write_bytes(b"precious")
    for target in ("victim", "nowhere"):
        (tmp_path / "a.ply.ebz").symlink_to(target)
        assert sh("ebz compress a.ply") == Result(
            1, b"", b"ebz: a.ply.ebz: already exists; use -f to overwrite it\n"
        )
        assert sh("ebz compress -f a.ply") == NOTHING
        assert not (tmp_path / "a.ply.ebz").is_symlink()
        (tmp_path / "a.ply.ebz").unlink()
    assert (tmp_path / "victim").read_bytes() == b"precious"
    assert not (tmp_path / "nowhere").exists()


def test_folders_and_devices_are_no_inputs(sh):
    for command in ("compress -f", "stats"):
        result = sh(f"ebz {command} . /dev/null")
        assert result == Result(
            1, b"", b"ebz: .: is a folder\nebz: /dev/null: is neither a file nor a pipe\n"
        )


def test_an_input_without_read_permission_is_an_error(sh, tmp_path):
    # The superuser may read everything; /proc/self/mem cannot be read at offset 0 by anyone.
    name = "a.ply" if os.geteuid() else "/proc/self/mem"
    (tmp_path / "a.ply").chmod(0)
    result = sh(f"ebz decompress -c {name}")
    assert (result.status, result.stdout) == (1, b"")
    assert result.stderr.startswith(f"ebz: {name}: ".encode())


def test_outputs_go_next_to_inputs_in_other_folders(sh, tmp_path):
    with tempfile.TemporaryDirectory() as other:
        (Path(other) / "a.ply").write_bytes(TETRAHEDRON)
        assert sh(f"ebz compress {other}/a.ply") == NOTHING
        assert {path.name for path in Path(other).iterdir()} == {"a.ply", "a.ply.ebz"}
