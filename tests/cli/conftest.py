"""A shell in an empty folder, with ebz on its PATH and a mesh in reach."""

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.cli.shell import TETRAHEDRON, Result, Shell, environment


@pytest.fixture
def sh(tmp_path: Path) -> Shell:
    """Runs a script with /bin/sh in a fresh folder that holds the tetrahedron a.ply."""
    (tmp_path / "a.ply").write_bytes(TETRAHEDRON)

    def run(script: str | bytes, **options: Any) -> Result:
        done = subprocess.run(
            ["/bin/sh", "-c", script],
            cwd=tmp_path,
            env=environment(),
            capture_output=True,
            check=False,
            timeout=120,
            **{"stdin": subprocess.DEVNULL} | options,
        )
        return Result(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture
def names(tmp_path: Path) -> Callable[[], set[str]]:
    """The names in the folder of the shell."""
    return lambda: {entry.name for entry in tmp_path.iterdir()}
