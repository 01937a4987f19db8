"""Certified models beside Draco on the costliest connectivity that can be drawn at random.

    python -m tests.bench.models [-n 100000] [--seeds 10]

Uniform random triangulations of n vertices: bits per vertex of connectivity, and CPU seconds to
code the word, for each built-in table; Draco level 10 if DracoPy is installed.  For Draco all
vertices but one are rounded to one point, so that next to nothing of its file is geometry.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ebz.codec import _kernels, connectivity, sample
from ebz.codec.models.guarantee import BUILT_IN
from ebz.codec.models.load import load
from ebz.codec.word import kernel_model

REPEATS = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-n", type=int, default=100_000)
    parser.add_argument("--seeds", type=int, default=10)
    options = parser.parse_args()
    tables = {name: load(name) for name in BUILT_IN}
    print("seed", *tables, "Draco_10", sep="\t")
    speeds: dict[str, list[list[float]]] = {name: [] for name in tables}
    for seed in range(1, options.seeds + 1):
        faces = sample.random_triangulation(options.n, seed).faces
        bits = []
        for name, table in tables.items():
            word = connectivity.encode(faces, options.n, [table])[0]
            bits.append(8 * len(word.word) / options.n)
            times = [_seconds(work) for work in _coders(word, table)]
            speeds[name].append([len(faces) / seconds / 1e6 for seconds in times])
        print(seed, *(f"{x:.4f}" for x in (*bits, _draco(faces, options.n))), sep="\t", flush=True)
    print("bound", *(f"{bound:.5f}" for bound in BUILT_IN.values()), sep="\t")
    for name, values in speeds.items():
        encode, decode = (statistics.median(column) for column in zip(*values, strict=True))
        print(
            f"{name}: {encode:.1f} encoding, {decode:.1f} decoding, million symbols per CPU second"
        )


def _coders(word: connectivity.EncodedWord, table: Any) -> list[Callable[[], Any]]:
    """Symbols to bytes and nothing else; bytes to symbols and to the triangles that they build."""
    model = kernel_model(table)
    sizes = word.counts.n_symbols, word.counts.n_closed, word.counts.n_single
    return [
        lambda: _kernels.encode_symbols(word.symbols, word.specials, model),
        lambda: _kernels.decode_connectivity(word.word, *sizes, word.specials, model),
    ]


def _seconds(work: Callable[[], Any]) -> float:
    """The least of a few runs: what disturbs a run only makes it longer."""
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def _draco(faces: Any, n_vertices: int) -> float:
    """Bits per vertex; Draco would weld vertices at the same point before rounding."""
    try:
        import DracoPy
    except ImportError:
        return float("nan")
    points = np.zeros((n_vertices, 3), np.float32)
    points[:, 0] = 1e-9 * np.arange(n_vertices)
    points[-1] = 1
    data = DracoPy.encode(
        points, faces.astype(np.uint32), quantization_bits=1, compression_level=10
    )
    return 8 * len(data) / n_vertices


if __name__ == "__main__":
    main()
