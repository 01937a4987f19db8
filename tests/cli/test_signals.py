"""Signals: no output is ever partial, and INT, TERM and HUP leave nothing behind."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.shell import BIN, Result, environment, grid

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
MESH = grid(40)
DELAYS_S = (0.0, 0.05, 0.15)

# Writes three pieces; `act` is called before the second, when the temporary file has a part.
WRITER = """
import os, signal, sys, threading
from ebz.cli import atomic, main
main.signal.signal(signal.SIGINT, signal.SIG_DFL)

def from_thread(number):
    thread = threading.Thread(target=lambda: signal.pthread_kill(threading.get_ident(), number))
    thread.start()
    thread.join()

def pieces():
    yield b"one"
    assert len(os.listdir(".")) == 1 + os.path.exists("out")
    {act}
    yield b"two"
    yield b"three"

atomic.write_whole("out", pieces(), like=None, replace={replace})
"""


def _write(
    folder: Path, act: str, *, replace: bool = False
) -> "subprocess.CompletedProcess[bytes]":
    code = WRITER.format(act=act, replace=replace)
    command = [sys.executable, "-c", code]
    return subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=60)


@pytest.mark.parametrize("number", ENDING)
@pytest.mark.parametrize("act", ["os.kill(os.getpid(), {})", "from_thread({})"])
def test_a_signal_while_writing_leaves_nothing(tmp_path, names, number, act):
    done = _write(tmp_path, act.format(int(number)))
    assert (done.returncode, done.stdout, done.stderr) == (-number, b"", b"")
    assert names() == set()


def test_a_signal_while_overwriting_leaves_the_old_file(tmp_path):
    (tmp_path / "out").write_bytes(b"old")
    done = _write(tmp_path, f"os.kill(os.getpid(), {int(signal.SIGTERM)})", replace=True)
    assert done.returncode == -signal.SIGTERM
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("out", b"old")]


def test_a_kill_while_writing_leaves_no_partial_output(tmp_path):
    done = _write(tmp_path, f"os.kill(os.getpid(), {int(signal.SIGKILL)})")
    assert done.returncode == -signal.SIGKILL
    assert not (tmp_path / "out").exists()


def test_an_error_while_writing_leaves_nothing(tmp_path, names):
    done = _write(tmp_path, "raise MemoryError")
    assert (done.returncode, names()) == (1, set())


def test_a_file_that_appears_meanwhile_is_not_overwritten(tmp_path):
    done = _write(tmp_path, "open('out', 'wb').write(b'theirs')")
    assert done.returncode == 1 and b"already exists" in done.stderr
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("out", b"theirs")]


def test_an_undisturbed_write_is_whole(tmp_path):
    assert _write(tmp_path, "pass").returncode == 0
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [
        ("out", b"onetwothree")
    ]


def _started(folder: Path) -> tuple["subprocess.Popen[bytes]", int]:
    """ebz, and the end of the pipe from which it is reading: signals are in order by then."""
    os.mkfifo(folder / "in.ply")
    process = subprocess.Popen(
        [BIN / "ebz", "compress", "in.ply"],
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    return process, os.open(folder / "in.ply", os.O_WRONLY)


@pytest.mark.parametrize("number", [*ENDING, signal.SIGKILL])
def test_a_signal_while_reading_leaves_nothing(tmp_path, names, number):
    process, pipe = _started(tmp_path)
    os.write(pipe, b"ply\n")
    process.send_signal(number)
    assert process.communicate(timeout=60) == (b"", b"")
    os.close(pipe)
    assert process.returncode == -number
    assert names() == {"in.ply"}


@pytest.fixture(scope="module")
def whole() -> bytes:
    """What an undisturbed run makes of MESH."""
    command = [BIN / "ebz", "compress"]
    return subprocess.run(command, input=MESH, stdout=subprocess.PIPE, check=True).stdout


@pytest.mark.parametrize("number", [*ENDING, signal.SIGKILL])
def test_a_signal_at_any_moment_leaves_all_or_nothing(tmp_path, whole, number):
    for delay in DELAYS_S:
        folder = tmp_path / str(delay)
        folder.mkdir()
        process, pipe = _started(folder)
        with os.fdopen(pipe, "wb") as stream:
            stream.write(MESH)
        time.sleep(delay)
        process.send_signal(number)
        assert process.communicate(timeout=60) == (b"", b"")
        assert process.returncode in (0, -number)
        left = {path.name for path in folder.iterdir()} - {"in.ply"}
        if "in.ply.ebz" in left:
            assert (folder / "in.ply.ebz").read_bytes() == whole
        if number != signal.SIGKILL:
            assert left <= {"in.ply.ebz"}
        if process.returncode == 0:
            assert left == {"in.ply.ebz"}


def test_a_shell_sees_128_and_the_signal(sh):
    script = """
        mkfifo in.ply
        for signal in TERM HUP KILL; do
            ebz compress in.ply & pid=$!
            { kill -$signal $pid; sleep 0.1; } > in.ply
            wait $pid; echo $?
        done
    """
    assert sh(script).stdout == b"143\n129\n137\n"


def test_ignored_signals_stay_ignored(sh, names):
    script = """
        trap '' HUP INT TERM; mkfifo in.ply
        ebz compress in.ply & pid=$!
        { for signal in HUP INT TERM; do kill -$signal $pid; done; cat a.ply; } > in.ply
        wait $pid
    """
    assert sh(script) == Result(0, b"", b"")
    assert names() == {"a.ply", "in.ply", "in.ply.ebz"}
