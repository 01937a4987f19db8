"""ebz in pipelines, as a shell user has it: exact output, exact exit status."""

import json

from tests.cli.shell import TETRAHEDRON, Result, grid

NOTHING = Result(0, b"", b"")
TERMS = b"Try 'ebz compress --help'.\n"


def test_compress_names_the_file_and_says_nothing(sh, names):
    assert sh("ebz compress a.ply") == NOTHING
    assert names() == {"a.ply", "a.ply.ebz"}


def test_decompress_strips_the_suffix_and_gives_the_mesh_back(sh, names):
    script = """
        ebz compress -o b.ply.ebz a.ply && ebz decompress b.ply.ebz &&
        ebz verify --against a.ply b.ply.ebz > report && ebz compress -c b.ply | cmp - b.ply.ebz
    """
    assert sh(script) == NOTHING
    assert names() == {"a.ply", "b.ply", "b.ply.ebz", "report"}


def test_no_input_and_dash_are_standard_input(sh):
    script = """
        ebz compress < a.ply > 1 && ebz compress - < a.ply > 2 && cat a.ply | ebz compress -c > 3
        ebz compress -o - a.ply > 4 && ebz compress -o 5 < a.ply && ebz compress -o - - < a.ply > 6
        for i in 2 3 4 5 6; do cmp 1 $i; done
        ebz decompress < 1 > out.ply && cat 1 | ebz verify --against out.ply > report
    """
    assert sh(script) == NOTHING


def test_whole_pipeline_leaves_no_file(sh, names):
    result = sh("ebz compress < a.ply | ebz decompress | ebz compress | ebz stats --json")
    assert (result.status, result.stderr) == (0, b"")
    assert json.loads(result.stdout)["file"] == "(stdin)"
    assert names() == {"a.ply"}


def test_the_standard_descriptors_have_names_too(sh, names):
    script = """
        ebz compress -c a.ply > 1
        ebz compress /dev/stdin < a.ply > 2; ebz compress -o /dev/stdout a.ply > 3
        ebz compress -o /dev/fd/3 a.ply 3> 4; ebz compress -o /dev/null a.ply
        for i in 2 3 4; do cmp 1 $i; done
    """
    assert sh(script) == NOTHING
    assert names() == {"a.ply", "1", "2", "3", "4"}


def test_fifos_are_read_and_written(sh):
    script = """
        mkfifo in.ply out; ebz compress -c a.ply > expected
        cat a.ply > in.ply & cat out > got &
        ebz compress -o out in.ply; wait; cmp got expected; test -p out && test -p in.ply
    """
    assert sh(script) == NOTHING


def test_to_changes_the_suffix(sh, names):
    assert sh("ebz compress a.ply; ebz decompress --to off a.ply.ebz; head -n 1 a.off") == Result(
        0, b"OFF\n", b""
    )
    assert names() == {"a.ply", "a.ply.ebz", "a.off"}


def test_a_name_without_a_mesh_suffix_gets_one(sh, names):
    assert sh("ebz compress -o b.ebz a.ply; ebz decompress b.ebz; head -n 1 b.ply").stdout == (
        b"ply\n"
    )
    assert names() == {"a.ply", "b.ebz", "b.ply"}


def test_the_suffix_of_the_output_chooses_the_format(sh):
    script = "ebz compress a.ply; ebz decompress -o b.off a.ply.ebz; head -n 1 b.off"
    assert sh(script).stdout == b"OFF\n"
    assert sh("ebz decompress -o c.off --to ply a.ply.ebz; head -n 1 c.off").stdout == b"ply\n"


def test_an_unknown_suffix_is_refused_but_for_named_outputs(sh, names):
    script = "ebz compress -o b a.ply; ebz decompress b; echo $?; ebz decompress -c b | head -n 1"
    assert sh(script) == Result(
        0, b"1\nply\n", b"ebz: b: unknown suffix (.ebz expected); use -o or -c\n"
    )
    assert names() == {"a.ply", "b"}


def test_what_is_compressed_is_not_compressed_again(sh, names):
    assert sh("ebz compress a.ply; ebz compress a.ply.ebz") == Result(
        1, b"", b"ebz: a.ply.ebz: has the suffix .ebz already; use -o or -c\n"
    )
    assert sh("ebz compress -c a.ply.ebz | cmp - a.ply.ebz") == NOTHING


def test_a_failure_does_not_stop_the_rest(sh, names):
    script = (
        "mkdir d; echo nonsense > bad.ply; cp a.ply b.ply; ebz compress no d bad.ply b.ply a.ply"
    )
    result = sh(script)
    lines = result.stderr.splitlines()
    assert (result.status, result.stdout) == (1, b"")
    assert lines[:2] == [b"ebz: no: No such file or directory", b"ebz: d: is a folder"]
    assert len(lines) == 3 and lines[2].startswith(b"ebz: bad.ply: ")
    assert names() == {"a.ply", "b.ply", "bad.ply", "d", "a.ply.ebz", "b.ply.ebz"}


def test_usage_errors_exit_with_1(sh, names):
    cases = {
        "-o x a.ply a.ply": b"-o takes one INPUT only.",
        "-c a.ply a.ply": b"-c takes one INPUT only.",
        "-c -o x a.ply": b"-c and -o exclude each other.",
        "--bits 3 --max-error 1 a.ply": b"--bits, --max-error and --grid exclude each other.",
        "--bits 31 a.ply": b"Invalid value for '--bits': 31 is not in the range 1<=x<=30.",
        "--from step a.ply": (
            b"Invalid value for '--from': 'step' is not one of "
            b"'ply', 'obj', 'off', 'stl', 'gltf', 'glb'."
        ),
    }
    for arguments, message in cases.items():
        expected = Result(1, b"", b"ebz: " + message + b"\n" + TERMS)
        assert sh(f"ebz compress {arguments}") == expected
    assert sh("ebz no") == Result(1, b"", b"ebz: No such command 'no'.\nTry 'ebz --help'.\n")
    assert names() == {"a.ply"}


def test_options_reach_the_codec(sh):
    script = """
        ebz compress -c --bits 4 a.ply > 4.ebz; ebz compress -c --max-error 0.3 a.ply > e.ebz
        ebz compress -c -1 -9 --embed-model a.ply > m.ebz
        ebz compress -c --model nowhere a.ply; echo $?
        for i in 4 e m; do ebz verify $i.ebz > /dev/null || echo $i; done
        test $(wc -c < m.ebz) -gt 1000
    """
    result = sh(script)
    assert (result.status, result.stdout) == (0, b"1\n")
    assert result.stderr.startswith(b"ebz: ") and result.stderr.count(b"\n") == 1


def test_polygons_are_cut_up_on_request(sh):
    script = """
        sed -e 's/element face 4/element face 1/' -e '/^3 /d' a.ply > q.ply
        echo 4 0 1 3 2 >> q.ply; ebz compress --triangulate q.ply; ebz decompress -c q.ply.ebz
    """
    result = sh(script)
    assert (result.status, result.stderr) == (0, b"")
    assert b"element face 2\n" in result.stdout


def test_what_is_dropped_is_named_unless_quiet(sh):
    coloured = (
        "sed -e 's/float z/&\\nproperty float heat/' -e 's/^[01] [01] [01]$/& 7/' a.ply > h.ply"
    )
    result = sh(f"{coloured}; ebz compress h.ply; ebz decompress --to stl h.ply.ebz")
    assert result.status == 0
    assert result.stderr.startswith(b"ebz: warning: h.ply.ebz: ") and b"heat" in result.stderr
    assert sh("ebz decompress -qf --to stl h.ply.ebz") == NOTHING


def test_damage_is_an_error_of_one_line(sh, names):
    script = """
        ebz compress a.ply; head -c 50 a.ply.ebz > cut.ebz; : > empty.ebz; cp a.ply mesh.ebz
        for i in cut empty mesh; do ebz decompress $i.ebz; echo $?; done
        ebz verify cut.ebz; echo $?
    """
    result = sh(script)
    assert result.stdout == b"1\n1\n1\n1\n"
    starts = [line.split(b": ")[:2] for line in result.stderr.splitlines()]
    assert starts == [[b"ebz", name + b".ebz"] for name in (b"cut", b"empty", b"mesh", b"cut")]
    assert names() == {"a.ply", "a.ply.ebz", "cut.ebz", "empty.ebz", "mesh.ebz"}


def test_the_memory_limit_holds(sh):
    assert sh("ebz compress a.ply") == NOTHING
    for command in ("decompress -c", "stats", "verify"):
        limited = f"ebz {command} --memory-limit {{}} a.ply.ebz > out"
        result = sh(limited.format(100))
        assert (result.status, result.stderr.count(b"\n")) == (1, 1)
        assert result.stderr.startswith(b"ebz: a.ply.ebz: ") and b"limit" in result.stderr
        assert sh(limited.format("64MiB")) == NOTHING
    assert sh("ebz stats --memory-limit 64QB a.ply") == Result(
        1,
        b"",
        b"ebz: Invalid value for '--memory-limit': '64QB' is not a size such as 64MiB, 1GB or "
        b"500k.\nTry 'ebz stats --help'.\n",
    )


def test_a_closed_pipe_ends_quietly(sh, tmp_path):
    (tmp_path / "big.ply").write_bytes(grid(60))
    script = """
        ebz compress big.ply
        { ebz decompress -c big.ply.ebz; echo $? >&2; } | head -c 10 > /dev/null
    """
    assert sh(script) == Result(0, b"", b"141\n")


def test_a_full_disk_is_an_error(sh, names):
    expected = Result(1, b"", b"ebz: (stdout): No space left on device\n")
    for command in (
        "compress -c a.ply",
        "stats a.ply",
        "stats --json a.ply",
        "--help",
        "model list",
    ):
        assert sh(f"ebz {command} > /dev/full") == expected
    assert sh("ebz compress -o /dev/full a.ply") == Result(
        1, b"", b"ebz: /dev/full: No space left on device\n"
    )
    # The limit on the size of files stands for a disk that fills while the file is written.
    assert sh("ulimit -f 0; ebz compress a.ply") == Result(
        1, b"", b"ebz: a.ply.ebz: File too large\n"
    )
    assert names() == {"a.ply"}


def test_closed_descriptors_are_errors(sh, names):
    assert sh("ebz compress -c a.ply >&-") == Result(
        1, b"", b"ebz: (stdout): Bad file descriptor\n"
    )
    assert sh("ebz compress <&-") == Result(1, b"", b"ebz: (stdin): Bad file descriptor\n")
    assert sh("ebz compress no 2>&-") == Result(1, b"", b"")
    assert names() == {"a.ply"}


def test_stats_prints_one_structure_in_two_ways(sh):
    script = "ebz compress a.ply; ebz stats a.ply.ebz; ebz stats --json a.ply.ebz a.ply"
    result = sh(script)
    assert (result.status, result.stderr) == (0, b"")
    *table, packed, plain = result.stdout.decode().splitlines()
    packed, plain = json.loads(packed), json.loads(plain)
    assert (packed.pop("file"), plain.pop("file")) == ("a.ply.ebz", "a.ply")
    assert packed == plain and packed["connectivity_bytes"] > 0
    assert _words(packed) <= set(" ".join(table).split())


def _words(value: object) -> set[str]:
    """The words of all keys in what JSON holds."""
    if isinstance(value, list):
        return set().union(*map(_words, value))
    if isinstance(value, dict):
        keys = {word for key in value for word in key.replace("_", " ").split()}
        return keys.union(*map(_words, value.values()))
    return set()


def test_verify_is_silent_if_told_to(sh):
    result = sh("""
        sed 's/^3 0 3 2/3 0 2 3/' a.ply > other.ply; ebz compress a.ply
        ebz verify -q --against a.ply a.ply.ebz; echo $?
        ebz verify -q --against other.ply a.ply.ebz; echo $?
        ebz verify -q no.ebz; echo $?
    """)
    assert result.stdout == b"0\n2\n1\n"
    assert result.stderr.startswith(b"ebz: no.ebz: ") and result.stderr.count(b"\n") == 1


def test_verify_tells_a_difference_by_its_status(sh):
    script = """
        sed 's/^3 0 3 2/3 0 2 3/' a.ply > other.ply; ebz compress a.ply
        ebz verify --against a.ply a.ply.ebz > same; echo $?
        ebz verify --against other.ply a.ply.ebz > different; echo $?
        ebz verify --against no.ply a.ply.ebz; echo $?
        ebz verify --json --against other.ply a.ply.ebz no.ebz; echo $?
    """
    result = sh(script)
    first, second, third, last, fourth = result.stdout.splitlines()
    assert (first, second, third, fourth) == (b"0", b"2", b"1", b"1")
    assert json.loads(last)["equal"] is False
    assert result.stderr == (
        b"ebz: no.ply: No such file or directory\nebz: no.ebz: No such file or directory\n"
    )


def test_verbose_tells_sizes_ratio_and_time(sh):
    result = sh("ebz compress -v a.ply; ebz decompress -vf a.ply.ebz; ebz compress -vqf a.ply")
    lines = result.stderr.decode().splitlines()
    assert (result.status, result.stdout, len(lines)) == (0, b"", 2)
    assert lines[0].startswith("a.ply: ") and "(210 B, " in lines[0] and ":1, " in lines[0]
    assert lines[1].startswith("a.ply.ebz: ") and lines[1].endswith(" s")


def test_help_and_version(sh):
    assert sh("ebz").stdout == sh("ebz --help").stdout
    assert sh("ebz --version").stdout.startswith(b"ebz 0.")
    for command in ("compress", "decompress", "stats", "verify"):
        result = sh(f"ebz {command} --help")
        assert (result.status, result.stderr) == (0, b"")
        assert b"Examples:" in result.stdout
        assert max(map(len, result.stdout.splitlines())) <= 80


def test_completion_comes_from_click(sh):
    result = sh("COMP_WORDS='ebz comp' COMP_CWORD=1 _EBZ_COMPLETE=bash_complete ebz")
    assert (result.stdout, result.stderr) == (b"plain,compress\n", b"")


def test_the_tetrahedron_is_as_these_tests_presume():
    assert len(TETRAHEDRON) == 210


def test_kept_order_gives_the_same_file_back(sh):
    script = """
        ebz sample torus -n 300 > s.ply
        ebz compress --keep-order < s.ply | ebz decompress | cmp - s.ply
        ebz compress --keep-order < s.ply | ebz verify --against s.ply > report
    """
    assert sh(script) == NOTHING
