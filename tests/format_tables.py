"""The long tables of the format, from the headers that have them: `make tables`."""

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
KERNELS = ROOT / "codec" / "kernels"
PAGE = ROOT / "docs" / "format-tables.md"
N_DECISIONS = 4  # C, R, L, S

INTRODUCTION = """\
# Tables of the format

Part of [FORMAT.md](../FORMAT.md), which says how they are used. Made by `make tables`.
"""
DEGREES = """\
## Degree prior (5a)

By decision (0: C, 1: R, 2: L, 3: S) and l0, the values for latest(2) = 0 to 63; all others are 0.
"""
MIXING = """\
## Weights of {method} (5a)

In 2^-10. `weights`: a row per decision. `by_known`: per decision, a row for each number of contexts
known, from 0.
"""
NODES = """\
## Weights of positions (9.4)

`initial_weights`: a row per node, inputs 0 to 23; the nearest floats.
"""
ATTRIBUTES = """\
## Weights of attributes (12.4, 12.5)

Inputs 0 to 24; the nearest floats. `{table}`: a row per node, {beyond}.
"""
BEYOND = {
    "weights_of_numbers": "from 24 on that of 20 + (node & 3)",
    "weights_of_symbols": "the last for all nodes from 8 on",
}


def page() -> str:
    """The page, as it is to be."""
    words = (KERNELS / "word" / "word_priors.hpp").read_text("utf-8")
    nodes = (KERNELS / "positions" / "initial_weights.hpp").read_text("utf-8")
    sections = [INTRODUCTION, DEGREES, _code(_degrees(words))]
    for method in ("fast", "strong"):
        sections += [MIXING.format(method=method), _code(_mixing(words, method))]
    sections += [NODES, _code(_weights(nodes, "initial_weights"))]
    attributes = (KERNELS / "attributes" / "initial_weights.hpp").read_text("utf-8")
    for table, beyond in BEYOND.items():
        title = ATTRIBUTES.format(table=table, beyond=beyond)
        sections += [title, _code(_weights(attributes, table))]
    return "\n".join(sections)


def _code(lines: Iterator[str]) -> str:
    return "\n".join(f"    {line}" for line in lines) + "\n"


def _degrees(text: str) -> Iterator[str]:
    for decision, degree, values in re.findall(r"prior\[(\d+)\]\[(\d+)\] = \{([^}]*)\}", text):
        yield f"{decision} {degree}: {' '.join(_numbers(values))}"


def _mixing(text: str, method: str) -> Iterator[str]:
    rows = list(_rows(text, rf"{method}_prior\{{(.*?)\n\}}\}}\}};"))
    yield "weights"
    yield from (" ".join(row) for row in rows[:N_DECISIONS])
    rows = rows[N_DECISIONS:]
    n_known = len(rows) // N_DECISIONS
    for i, row in enumerate(rows):
        if i % n_known == 0:
            yield f"by_known {i // n_known}"
        yield " ".join(row)


def _weights(text: str, table: str) -> Iterator[str]:
    yield from (" ".join(row) for row in _rows(text, rf"{table} = \{{\{{(.*?)\n\}}\}};"))


def _rows(text: str, pattern: str) -> Iterator[list[str]]:
    found = re.search(pattern, text, re.S)
    assert found, pattern
    for values in re.findall(r"\{([^{}]*)\}", re.sub(r"//.*", "", found[1])):
        yield _numbers(values)


def _numbers(text: str) -> list[str]:
    return re.findall(r"-?\d+(?:\.\d+)?", text)


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
