"""Draws the paper's figures 1, 2 and 4 (theory.py); only this needs matplotlib."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from ebz.codec.errors import OptionError
from ebz.codec.models import theory

FORMATS = ("svg", "png")


def draw(number: int, format: str) -> bytes:
    """Figure 1, 2 or 4 as a file of the format "svg" or "png"; the same bytes each time.

    Raises OptionError for another figure or format, or where matplotlib is not installed.
    """
    if number not in FIGURES:
        raise OptionError(f"figure {number}: there are 1, 2 and 4")
    if format not in FORMATS:
        raise OptionError(f"figure: format {format!r} is not svg or png")
    try:
        from matplotlib import rc_context
        from matplotlib.figure import Figure
    except ImportError:
        raise OptionError("figures need matplotlib: pip install 'ebz[figures]'") from None
    buffer = io.BytesIO()
    with rc_context({"svg.hashsalt": "ebz", "svg.fonttype": "none"}):
        figure = Figure(figsize=(8, 4.5), layout="constrained")
        FIGURES[number](figure)
        metadata = {"Date": None} if format == "svg" else {"Software": None}
        figure.savefig(buffer, format=format, metadata=metadata)
    return buffer.getvalue()


def _figure_1(figure: Any) -> None:
    found = theory.figure_1()
    axes = figure.add_subplot()
    axes.set_axis_off()
    names = list(found["rows"][0])
    cells = [[_number(row[name]) for name in names] for row in found["rows"]]
    limit = ["limit", "", "", *(_number(found[n]) for n in ("p(a|0)", "p(b|0)", "bits_per_symbol"))]
    axes.table([*cells, limit], colLabels=names, loc="center")
    axes.set_title("Words in which no b follows a b: g_m(i) words of length m from state i")


def _figure_2(figure: Any) -> None:
    rows = theory.figure_2()["rows"]
    axes = figure.add_subplot()
    share = [row["p_b"] for row in rows]
    axes.plot([0, *share, 0.5], [0, *(row["closed_form"] for row in rows), 0], label="closed form")
    axes.plot(share, [row["bits_per_symbol"] for row in rows], ".", label="minimum of the dual")
    axes.set(xlabel="P(b)", ylabel="bits per symbol", xlim=(0, 0.5), ylim=(0, None))
    axes.legend()


def _figure_4(figure: Any) -> None:
    points = [theory.Point(**row) for row in theory.figure_4()["rows"]]
    bound, growth = figure.subplots(1, 2)
    for curve in dict.fromkeys(point.curve for point in points):
        on = sorted((p for p in points if p.curve == curve), key=lambda p: p.states)
        style = "o-" if on[0].sound else "x:"
        label = curve if on[0].sound else f"{curve} (rejects valid words)"
        states = [p.states for p in on]
        bound.plot(states, [p.bits_per_vertex for p in on], style, markersize=3, label=label)
        growth.plot(states, [p.log2_alpha for p in on], style, markersize=3, label=label)
    for name, value in (("Tutte", theory.TUTTE), ("King, Rossignac", theory.KING_ROSSIGNAC),
                        ("Gumhold 2000", theory.GUMHOLD_2000)):  # fmt: skip
        bound.axhline(value, color="gray", linewidth=0.8)
        bound.annotate(f"{name} {value:.4g}", (3, value), fontsize=7, va="bottom")
    bound.set(xscale="log", xlabel="states", ylabel="bits per vertex", title="(a) bound")
    growth.set(xscale="log", xlabel="states", ylabel="log2 alpha, bits per symbol",
               title="(b) growth of the language")  # fmt: skip
    growth.legend(fontsize=7)


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else f"{value:.3f}"


FIGURES: dict[int, Callable[[Any], None]] = {1: _figure_1, 2: _figure_2, 4: _figure_4}
