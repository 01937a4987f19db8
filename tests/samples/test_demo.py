"""The demo shows each command and fails where any command of any pipeline fails."""

import os
import re
import subprocess
from itertools import product
from pathlib import Path

import pytest

DEMO = Path(__file__).parents[2] / "samples" / "demo.sh"

# Stands in for ebz: copies, and fails the n-th time that a command is called.
STAND_IN = """#!/bin/sh
echo "$1" >> "$CALLS"
if [ "$1 $(grep -cx "$1" "$CALLS")" = "$FAILING" ]; then exit 1; fi
case "$*" in
    "compress trefoil.ply") cp trefoil.ply trefoil.ply.ebz ;;
    "decompress -o back.ply "*) cp trefoil.ply back.ply ;;
    compress* | decompress*) cat ;;
    *) cat > /dev/null ;;
esac
"""


def run_demo(tmp_path, failing: str) -> subprocess.CompletedProcess:
    stand_in = tmp_path / "bin" / "ebz"
    stand_in.parent.mkdir()
    stand_in.write_text(STAND_IN)
    stand_in.chmod(0o755)
    (tmp_path / "temporary").mkdir()
    environment = os.environ | {
        "PATH": f"{stand_in.parent}:{os.environ['PATH']}",
        "TMPDIR": str(tmp_path / "temporary"),
        "CALLS": str(tmp_path / "calls"),
        "FAILING": failing,
    }
    done = subprocess.run(
        ["sh", DEMO],
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert not list((tmp_path / "temporary").iterdir())
    return done


def test_every_command_is_shown_and_run(tmp_path):
    done = run_demo(tmp_path, failing="")
    assert (done.returncode, done.stderr) == (0, "")
    shown = [line for line in done.stdout.splitlines() if line.startswith("$ ")]
    assert shown[0] == "$ ebz compress trefoil.ply"
    calls = (tmp_path / "calls").read_text().split()
    assert sum(len(re.findall(r"(?<!\.)ebz ", line)) for line in shown) == len(calls)
    assert set(calls) == {"compress", "stats", "decompress", "verify"}


@pytest.mark.parametrize(
    ("command", "nth"),
    [("stats", 1), *product(["decompress", "verify"], [1, 2]), *product(["compress"], range(1, 5))],
)
def test_a_failure_anywhere_fails_the_demo(tmp_path, command, nth):
    done = run_demo(tmp_path, failing=f"{command} {nth}")
    assert done.returncode == 1
    assert f"demo: failed: ebz {command}" in done.stderr
