"""Measurements as one table: sizes and speeds relative to Draco level 10, geometric means."""

import math
from collections.abc import Iterable
from typing import Any

REFERENCE = "Draco level 10"
Row = dict[str, Any]


def table(rows: list[Row]) -> str:
    """A Markdown table per precision: a line per codec."""
    parts = []
    for bits in dict.fromkeys(row["bits"] for row in rows):
        chosen = [row for row in rows if row["bits"] == bits]
        title = f"{bits} bits" if bits else "lossless"
        parts.append(
            f"### {title}, {len({row['mesh'] for row in chosen})} meshes\n\n{_grid(chosen)}"
        )
    return "\n\n".join(parts)


def _grid(rows: list[Row]) -> str:
    reference = {row["mesh"]: row for row in rows if row["codec"] == REFERENCE}
    lines = [
        "| codec | bits per vertex | size / Draco 10 | encode, Mtri/s | decode, Mtri/s "
        "| encode / Draco 10 | decode / Draco 10 |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for codec in dict.fromkeys(row["codec"] for row in rows):
        mine = [row for row in rows if row["codec"] == codec]
        cells = [codec, f"{mean(8 * r['bytes'] / r['vertices'] for r in mine):.2f}"]
        pairs = [(row, reference[row["mesh"]]) for row in mine if row["mesh"] in reference]
        cells.append(_ratio(r["bytes"] / ref["bytes"] for r, ref in pairs))
        for key in ("encode_s", "decode_s"):
            cells.append(f"{mean(r['faces'] / r[key] / 1e6 for r in mine):.2f}")
        for key in ("encode_s", "decode_s"):
            cells.append(_ratio(ref[key] / r[key] for r, ref in pairs))
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _ratio(values: Iterable[float]) -> str:
    values = list(values)
    return f"{mean(values):.2f}" if values else ""


def mean(values: Iterable[float]) -> float:
    """The geometric mean."""
    logs = [math.log(value) for value in values]
    return math.exp(sum(logs) / len(logs))
