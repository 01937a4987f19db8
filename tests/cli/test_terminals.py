"""On a terminal: what is refused, what is shown, and that pipes get none of it."""

import os
import pty
import subprocess

import pytest

from ebz.cli import messages
from tests.cli.shell import BIN, environment


@pytest.fixture
def terminal(sh, tmp_path):
    """Runs ebz with some of its descriptors on a terminal; gives status and what was shown."""

    def run(*arguments: str, on: tuple[str, ...]) -> tuple[int, bytes]:
        master, slave = pty.openpty()
        streams = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        streams |= dict.fromkeys(on, slave)
        done = subprocess.run(
            [BIN / "ebz", *arguments],
            cwd=tmp_path,
            env=environment(),
            check=False,
            timeout=60,
            **streams,
        )
        os.close(slave)
        try:
            shown = os.read(master, 1 << 16)
        except OSError:  # Linux says EIO where others say end of file
            shown = b""
        os.close(master)
        return done.returncode, shown.replace(b"\r\n", b"\n")

    return run


BOTH = ("stdout", "stderr")


def test_compressed_data_is_not_written_to_a_terminal(terminal):
    refusal = (
        b"ebz: (stdout): binary data is not written to a terminal; use -o FILE, or -f to force it\n"
    )
    assert terminal("compress", "-c", "a.ply", on=BOTH) == (1, refusal)
    assert terminal("compress", "-o", "/dev/stdout", "a.ply", on=BOTH) == (
        1,
        refusal.replace(b"(stdout)", b"/dev/stdout"),
    )
    status, shown = terminal("compress", "-fc", "a.ply", on=BOTH)
    assert status == 0 and b"ebz:" not in shown and len(shown) > 20


def test_text_goes_to_a_terminal_and_binary_does_not(sh, terminal):
    assert sh("ebz compress a.ply").status == 0
    status, shown = terminal("decompress", "-c", "a.ply.ebz", on=BOTH)
    assert status == 0 and shown.startswith(b"ply\nformat ascii 1.0\n")
    status, shown = terminal("decompress", "-c", "--to", "stl", "a.ply.ebz", on=BOTH)
    assert (status, shown.count(b"\n")) == (1, 1)
    assert shown.startswith(b"ebz: (stdout): binary data is not written to a terminal; ")


@pytest.mark.parametrize("command", ["compress", "decompress", "stats", "verify"])
def test_nothing_is_read_from_a_terminal(terminal, command):
    expected = (1, b"ebz: (stdin): is a terminal: name a file, or use a pipe\n")
    assert terminal(command, on=("stdin", "stderr")) == expected


def test_a_summary_is_shown_on_a_terminal_unless_quiet(terminal, names):
    status, shown = terminal("compress", "a.ply", on=BOTH)
    assert status == 0 and shown.startswith(b"a.ply: ") and shown.endswith(b", a.ply.ebz\n")
    assert terminal("compress", "-fq", "a.ply", on=BOTH) == (0, b"")
    assert terminal("compress", "-f", "a.ply", on=("stdout",)) == (0, b"")
    assert terminal("compress", "-c", "a.ply", on=("stderr",)) == (0, b"")


def test_progress_is_one_line_that_is_cleared(monkeypatch, capfd):
    monkeypatch.setattr(messages, "stderr_is_terminal", lambda: True)
    monkeypatch.setattr(messages.Progress, "DELAY", 0.0)
    monkeypatch.setattr(messages.Progress, "INTERVAL", 0.0)
    progress = messages.Progress("a\x1b\nb.ply", quiet=False)
    progress("connectivity", 1, 4)
    progress("x" * 200, 4, 4)
    progress.clear()
    shown = capfd.readouterr().err
    first, second, last = shown.split("\r\x1b[K")[1:]
    assert first == "a\\x1b b.ply: connectivity 25 %"
    assert len(second) == 79 and last == ""


@pytest.mark.parametrize(("is_terminal", "quiet", "delay"), [(0, 0, 0), (1, 1, 0), (1, 0, 1e9)])
def test_progress_is_silent_otherwise(monkeypatch, capfd, is_terminal, quiet, delay):
    monkeypatch.setattr(messages, "stderr_is_terminal", lambda: bool(is_terminal))
    monkeypatch.setattr(messages.Progress, "DELAY", delay)
    progress = messages.Progress("a.ply", quiet=bool(quiet))
    progress("connectivity", 1, 4)
    progress.clear()
    assert capfd.readouterr().err == ""
