"""Size against speed, drawn from the JSON of `make bench`: `make picture`.

    python -m tests.bench.picture bench.json docs/size-speed.svg [--bits 14]

A point is a codec: geometric means over the meshes of its size and of its speed, as ratios to Draco
level 10 in the same run.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.bench.report import REFERENCE, Row, mean

DIRECTIONS = {"encode_s": "encoding", "decode_s": "decoding"}
OURS = "ebz"


def main() -> None:
    options = _parse()
    rows = json.loads(options.json.read_text("utf-8"))["rows"]
    figure = draw([row for row in rows if row["bits"] == options.bits], options.bits)
    # The same measurements give the same bytes.
    with mpl.rc_context({"svg.hashsalt": "ebz", "svg.fonttype": "none"}):
        figure.savefig(options.picture, metadata={"Date": None, "Creator": None})


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("json", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--bits", type=int, default=14)
    return parser.parse_args()


def draw(rows: list[Row], bits: int) -> Figure:
    """Encoding on the left, decoding on the right."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    for axes, (key, title) in zip(
        figure.subplots(1, 2, sharey=True), DIRECTIONS.items(), strict=True
    ):
        points = ratios(rows, key)
        for ours in (True, False):
            _series(axes, {k: v for k, v in points.items() if k.startswith(OURS) == ours}, ours)
        axes.set_xscale("log")
        axes.set_title(title)
        axes.set_xlabel("speed / Draco level 10 (log)")
        axes.grid(alpha=0.3)
    figure.axes[0].set_ylabel(f"size / Draco level 10, at {bits} bits")
    return figure


def _series(axes: Axes, points: dict[str, tuple[float, float]], ours: bool) -> None:
    if not points:
        return
    speeds, sizes = zip(*points.values(), strict=True)
    axes.plot(speeds, sizes, "o-" if ours else "s", color="tab:blue" if ours else "tab:gray")
    for name, point in points.items():
        axes.annotate(name, point, xytext=(5, 5), textcoords="offset points", fontsize=8)


def ratios(rows: list[Row], key: str) -> dict[str, tuple[float, float]]:
    """By codec: its speed and its size, where the reference was measured on the same mesh."""
    reference = {row["mesh"]: row for row in rows if row["codec"] == REFERENCE}
    points: dict[str, Any] = {}
    for codec in dict.fromkeys(row["codec"] for row in rows):
        mine = [row for row in rows if row["codec"] == codec and row["mesh"] in reference]
        pairs = [(row, reference[row["mesh"]]) for row in mine]
        if pairs:
            speed = mean(ref[key] / row[key] for row, ref in pairs)
            points[codec] = speed, mean(row["bytes"] / ref["bytes"] for row, ref in pairs)
    return points


if __name__ == "__main__":
    main()
