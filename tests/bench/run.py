"""`make bench`: size and speed of every level beside its peers, in one run.

    python -m tests.bench.run [FOLDER] [--bits 11,14,16,0] [--levels 1,3,6,9] [--json FILE]

FOLDER holds mesh files; without it, generated meshes and the project's samples are used.  Vertices
that no face uses are dropped first, for every codec.  Sizes are exact.  Times are medians of CPU
seconds on one thread; machines differ: what counts is the ratio to Draco level 10 in the same run.
"""

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import ebz
from ebz.codec import sample
from tests.bench import peers, report

SAMPLES = Path(__file__).parents[2] / "samples"
# Below this many faces, start-up of a call weighs more than its work.
MIN_FACES = 200
LOSSLESS = 0


def main() -> int:
    options = _parse()
    rows = []
    for name, mesh in _meshes(options.folder):
        print(name, len(mesh.vertices), len(mesh.faces), file=sys.stderr, flush=True)
        for bits in options.bits:
            for codec in peers.codecs(bits or None, options.levels):
                rows.append({"mesh": name, **_measure(codec, mesh, options)})
    for line in peers.missing():
        print(f"left out: {line}", file=sys.stderr)
    print(report.table(rows))
    if options.json:
        Path(options.json).write_text(
            json.dumps({"about": _about(), "rows": rows}, indent=1) + "\n"
        )
    return 0


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--bits", type=_numbers, default=[11, 14, 16, LOSSLESS], help="0: lossless")
    parser.add_argument("--levels", type=_numbers, default=[1, 3, 6, 9])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", help="also write every measurement here")
    return parser.parse_args()


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


def _about() -> dict[str, Any]:
    return {
        "command": " ".join(["python -m tests.bench.run", *sys.argv[1:]]),
        "python": platform.python_version(),
        "machine": platform.machine(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "versions": peers.versions(),
    }


def _processor() -> str:
    """The model of the processor, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor()
    models = (line.partition(": ")[2] for line in lines if line.startswith("model name"))
    return next(models, platform.processor())


def _meshes(folder: Path | None) -> Iterator[tuple[str, ebz.Mesh]]:
    if folder is None:
        yield "noisy sphere", sample.sphere(50_000, noise=0.02, seed=1)
        yield "large torus", sample.torus(20_000)
        yield "noisy grid", sample.grid(20_000, noise=0.01, seed=1)
        yield "random triangulation, 10000", sample.random_triangulation(10_000, 1)
    for path in sorted((folder or SAMPLES).iterdir()):
        mesh = _read(path)
        if mesh is not None and len(mesh.faces) >= MIN_FACES:
            yield path.stem, mesh


def _read(path: Path) -> ebz.Mesh | None:
    try:
        mesh = ebz.read(path, triangulate=True)
    except (ebz.EbzError, OSError):
        return None
    if isinstance(mesh, ebz.Scene) or not np.isfinite(mesh.vertices).all():
        return None
    used, faces = np.unique(mesh.faces, return_inverse=True)
    vertices = mesh.vertices[used].astype(np.float32)
    return ebz.Mesh(vertices, faces.reshape(-1, 3).astype(np.int32))


def _measure(codec: peers.Codec, mesh: ebz.Mesh, options: argparse.Namespace) -> dict[str, Any]:
    data, encode_s = _timed(lambda: codec.encode(mesh), options.repeats)
    _, decode_s = _timed(lambda: codec.decode(data), options.repeats)
    row = {
        "codec": codec.name,
        "bits": codec.bits or LOSSLESS,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "bytes": len(data),
        "encode_s": encode_s,
        "decode_s": decode_s,
    }
    if codec.name.startswith("ebz"):
        row["connectivity_bytes"] = ebz.stats(data).connectivity_bytes
    return row


def _timed(work: Callable[[], Any], repeats: int) -> tuple[Any, float]:
    result, seconds = work(), []
    for _ in range(repeats):
        start = time.process_time()
        work()
        seconds.append(max(time.process_time() - start, 1e-9))
    return result, statistics.median(seconds)


if __name__ == "__main__":
    sys.exit(main())
