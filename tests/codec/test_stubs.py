"""The committed types of the kernels are those of the kernels."""

import subprocess
import sys
from pathlib import Path

STUBS = Path(__file__).parents[2] / "codec" / "_kernels.pyi"


def test_the_stubs_are_current(tmp_path):
    """Otherwise: make stubs."""
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "ebz.codec._kernels"]
    subprocess.run([*command, "-o", tmp_path / "_kernels.pyi"], check=True)
    assert (tmp_path / "_kernels.pyi").read_text() == STUBS.read_text()
