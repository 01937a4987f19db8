"""Values of options, tables, and errors that no file can provoke."""

import json

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.cli import group, jobs, messages, options, table
from ebz.cli.compress import compress


@pytest.mark.parametrize(
    ("text", "n_bytes"),
    [
        ("64MiB", 64 << 20),
        ("64m", 64 << 20),
        ("1GB", 10**9),
        ("500k", 500 << 10),
        ("1.5 KiB", 1536),
        ("2tib", 2 << 40),
        ("12345", 12345),
        ("12 B", 12),
    ],
)
def test_sizes_are_those_of_the_gnu_tools(text, n_bytes):
    assert options.size(text) == n_bytes


@given(st.text(alphabet="0123456789.kMGiB -e", max_size=8))
def test_other_sizes_are_usage_errors(text):
    try:
        assert options.size(text) > 0
    except click.UsageError as error:
        assert repr(text) in error.message


def test_the_formats_are_those_of_the_package():
    from ebz.formats import meshes

    assert set(options.FORMATS) == set(meshes.FORMATS)
    assert all(meshes.suffix_of(name) == f".{name}" for name in options.FORMATS)


def test_commands_are_listed_as_they_describe_themselves():
    for name in ("compress", "decompress", "stats", "verify"):
        command = group.ebz.get_command(click.Context(group.ebz), name)
        assert command is not None and command.name == name
    assert group.ebz.get_command(click.Context(group.ebz), "main") is None


def test_the_last_level_counts():
    for arguments, level in (([], None), (["-1"], 1), (["-19"], 9), (["-9", "a", "-2"], 2)):
        assert compress.make_context("compress", arguments).params["level"] == level


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (MemoryError(), "ebz: a: not enough memory\n"),
        (RecursionError("deep"), "ebz: a: nested too deeply\n"),
        (OSError(28, "No space left on device", "b"), "ebz: b: No space left on device\n"),
        (OSError(28, "No space left on device"), "ebz: a: No space left on device\n"),
        (KeyError("k"), "ebz: a: internal error: KeyError: 'k'\n"),
        (ValueError("\x1b\ud800"), "ebz: a: internal error: ValueError: \\x1b\\ud800\n"),
    ],
)
def test_no_error_becomes_a_traceback(capfd, error, line):
    def work(_name: str) -> int:
        raise error

    assert jobs.for_each(("a",), work) == 1
    assert capfd.readouterr() == ("", line)


def test_errors_outweigh_differences():
    statuses = {"a": 2, "b": 1, "c": 0}
    assert jobs.for_each(("a", "c"), statuses.__getitem__) == 2
    assert jobs.for_each(("a", "b", "c"), statuses.__getitem__) == 1
    assert jobs.for_each(("c",), statuses.__getitem__) == 0


def test_tables_align_names_and_numbers():
    result = {
        "vertices": 12345,
        "closed": True,
        "genus": None,
        "streams": {
            "word": {"bytes": 7, "bits_per_vertex": 1.25},
            "positions": {"bytes": 1234, "bits_per_vertex": 12.0},
        },
        "reference": {"tutte_limit_bits_per_vertex": 3.2451, "largest_error": 1.5e-7},
        "kinds": [{"name": "a", "n": 1}, {"name": "bc", "n": 20}],
        "attributes": {},
    }
    assert table.text_of(result) == (
        "vertices  12345\n"
        "closed    yes\n"
        "genus     -\n"
        "streams\n"
        "             bytes  bits per vertex\n"
        "  word           7            1.250\n"
        "  positions   1234           12.000\n"
        "reference\n"
        "  tutte limit bits per vertex    3.245\n"
        "  largest error                1.5e-07\n"
        "kinds\n"
        "  name   n\n"
        "  a      1\n"
        "  bc    20\n"
        "attributes\n"
        "  -\n"
    )


def test_json_has_no_numbers_that_json_lacks():
    line = table.json_of({"a": float("nan"), "b": [float("inf"), 1.5], "c": {"d": -0.0}})
    assert json.loads(line) == {"a": None, "b": [None, 1.5], "c": {"d": 0.0}}
    assert line.count("\n") == 1


@pytest.mark.parametrize(
    ("n_bytes", "text"),
    [
        (0, "0 B"),
        (1023, "1023 B"),
        (1024, "1.00 KiB"),
        (1024 * 999, "999 KiB"),
        (1024 * 1023, "1.00 MiB"),
        (1024 * 99, "99.0 KiB"),
        (10 << 50, "10240 TiB"),
    ],
)
def test_sizes_are_short(n_bytes, text):
    assert messages.human_size(n_bytes) == text


@pytest.mark.parametrize("group", ["sample", "model"])
def test_a_group_without_a_command_is_an_error_of_two_lines(sh, group):
    result = sh(f"ebz {group}")
    assert result.status == 1
    assert result.stdout == b""
    assert result.stderr.decode() == f"ebz: Missing command.\nTry 'ebz {group} --help'.\n"
