"""The wheel that is built from the sdist holds what it must, and works on its own.

Compiles all kernels once more, unoptimised: by far the slowest test.
"""

import os
import shutil
import subprocess
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = {"": "api", "codec": "codec", "formats": "formats", "cli": "cli"}
DATA = {".py", ".pyi", ".npz", ".typed"}
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv", "build", "dist", "*.egg-info", "__pycache__", ".*_cache", ".hypothesis"
)
BUILD_SDIST = "import setuptools.build_meta as backend; backend.build_sdist('dist')"
USE = """
import io, sys, ebz
mesh = ebz.read(sys.argv[1])
assert ebz.verify(ebz.compress(mesh), mesh).equal
print(ebz.__file__)
"""


def expected() -> set[str]:
    """The files of the package, named as in the wheel."""
    names = set()
    for package, folder in PACKAGES.items():
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in DATA or path.name == "py.typed":
                names.add(Path("ebz", package, path.relative_to(ROOT / folder)).as_posix())
    return names


def run(*command, cwd: Path) -> str:
    environment = os.environ | {"CC": str(cwd / "quick"), "CXX": str(cwd / "quick")}
    done = subprocess.run(
        command, cwd=cwd, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_the_wheel_of_the_sdist_is_complete_and_works(tmp_path):
    source, fresh = tmp_path / "source", tmp_path / "venv"
    shutil.copytree(ROOT, source, ignore=LEFT_OUT)
    venv.create(fresh, with_pip=True)
    python = fresh / "bin" / "python"
    pip = (python, "-m", "pip", "-q", "--disable-pip-version-check")
    run(*pip, "install", "setuptools>=77", "nanobind>=2.4", cwd=tmp_path)
    run(python, "-c", BUILD_SDIST, cwd=source)
    (sdist,) = (source / "dist").iterdir()
    with tarfile.open(sdist) as archive:
        packed = {name.partition("/")[2] for name in archive.getnames()}
    needed = {"FORMAT.md", "tests/surgery.py", "tests/data/golden-v2/meshes.json"}
    headers = {path.relative_to(ROOT).as_posix() for path in ROOT.glob("codec/kernels/**/*.hpp")}
    assert needed | headers <= packed

    quick = tmp_path / "quick"
    quick.write_text('#!/bin/sh\nexec c++ "$@" -O0\n')
    quick.chmod(0o755)
    run(*pip, "wheel", "--no-deps", "--no-build-isolation", "-w", "wheels", sdist, cwd=tmp_path)
    (wheel,) = (tmp_path / "wheels").iterdir()
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    kernels = "ebz/codec/_kernels" + sysconfig.get_config_var("EXT_SUFFIX")
    assert names == expected() | {kernels}

    run(*pip, "install", "--no-deps", wheel, cwd=tmp_path)
    # The dependencies are those of this environment; the link to its own ebz is not followed.
    site = run(python, "-c", "import site; print(site.getsitepackages()[0])", cwd=tmp_path)
    Path(site.strip(), "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    sample = ROOT / "samples" / "annulus.ply"
    assert run(python, "-c", USE, sample, cwd=tmp_path).startswith(str(fresh))
    script = f"cat {sample} | {fresh}/bin/ebz compress | {fresh}/bin/ebz decompress | wc -c"
    assert int(run("sh", "-c", script, cwd=tmp_path)) == sample.stat().st_size
    assert run(fresh / "bin" / "ebz", "--version", cwd=tmp_path).startswith("ebz")
