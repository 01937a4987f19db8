"""What a run imports: start-up is half of the time that a small mesh takes."""

import re

HEAVY = {
    "open3d",
    "scipy",
    "construct",
    "hashlib",
    "pdb",
    "json",
    "logging",
    "importlib.metadata",
    "asyncio",
    "subprocess",
    "tempfile",
    "urllib.request",
    "multiprocessing",
}


def _imported(stderr: bytes) -> set[str]:
    return set(re.findall(r"^import time:.*\| +(\S+)$", stderr.decode(), re.M))


def test_compress_imports_what_it_needs_only(sh):
    result = sh("PYTHONPROFILEIMPORTTIME=1 ebz compress a.ply")
    assert result.status == 0
    imported = _imported(result.stderr)
    assert {"ebz.cli.jobs", "numpy"} <= imported
    assert imported & (HEAVY - {"json"} | {"ebz.cli.table"}) == set()


def test_help_and_version_do_not_import_numpy(sh):
    for arguments in ("--help", "--version", "compress --help", "stats --help"):
        result = sh(f"PYTHONPROFILEIMPORTTIME=1 ebz {arguments}")
        assert _imported(result.stderr) & (HEAVY | {"numpy", "ebz.codec.mesh"}) == set()
