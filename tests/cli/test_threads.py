"""-T in the shell: several files at once, the same bytes, and messages that name their files."""

from tests.cli.shell import grid


def test_any_number_of_threads_writes_the_same_files(sh, tmp_path):
    for name in "abc":
        (tmp_path / f"{name}.ply").write_bytes(grid(20 + ord(name) % 7))
    script = """
        ebz compress -9 *.ply && mkdir alone && mv *.ebz alone
        for n in 0 2 8; do
            ebz compress -9 -T $n *.ply || exit
            for f in *.ebz; do cmp $f alone/$f || exit; done
            ebz decompress -f -T $n *.ebz || exit
            rm *.ebz
        done
        ebz compress -9 --threads 3 < a.ply | cmp - alone/a.ply.ebz
    """
    result = sh(script)
    assert (result.status, result.stdout, result.stderr) == (0, b"", b"")


def test_failures_and_warnings_name_their_files(sh, tmp_path):
    (tmp_path / "good.ply").write_bytes(grid(9))
    (tmp_path / "bad.ply").write_bytes(b"ply\n")
    result = sh("ebz compress -T 2 bad.ply good.ply; echo $?; ls *.ebz")
    assert result.stdout == b"1\ngood.ply.ebz\n"
    assert result.stderr.startswith(b"ebz: bad.ply: ")
    assert result.stderr.count(b"\n") == 1
    result = sh("ebz decompress -T 2 --to stl good.ply.ebz && ebz compress -T -1 good.ply")
    assert b"-1 is not in the range" in result.stderr
