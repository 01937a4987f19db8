"""FORMAT.md quotes the constants of the code."""

import math
import re
from collections import Counter
from pathlib import Path

import pytest

from ebz.codec.lattice import MAX_BITS, MAX_DIGITS
from ebz.codec.mesh import MAX_FACES
from ebz.codec.models.adaptive import CHEAPEST_SYMBOL
from ebz.codec.models.stack import MAX_EXTENT
from ebz.codec.models.table import MAX_STATES
from ebz.codec.positions import FLOAT_METHODS, Method
from ebz.formats.ebz import layout
from ebz.formats.ebz.header import Header
from ebz.formats.ebz.limits import CHEAPEST_BIT, CHEAPEST_DECISION
from tests import format_tables

TEXT = (Path(__file__).parents[1] / "FORMAT.md").read_text("utf-8")
ONE_LINE = re.sub(r"\s+", " ", TEXT)


def test_chunks_are_listed_in_the_order_of_the_code() -> None:
    table = TEXT[TEXT.index("| type | holds |") : TEXT.index("## 2. Header")]
    assert "".join(re.findall(r"^\| `(\w)` \|", table, re.M)) == b"".join(layout.NAMES).decode()


def test_the_file_starts_as_quoted() -> None:
    assert layout.MAGIC.hex(" ").upper() in TEXT
    assert f"    {layout.VERSION:02}  " in TEXT


def test_header_fields_are_in_the_order_of_the_code() -> None:
    section = TEXT[TEXT.index("## 2. Header") : TEXT.index("All counts are below")]
    fields = re.findall(r"^    (\w+) +(?:1 byte|varint) ", section, re.M)
    fields.remove("face_size")
    fields[fields.index("method")] = "coding"
    assert fields == list(Header._fields)


def test_positions_are_listed_by_number() -> None:
    for method in Method:
        if method not in FLOAT_METHODS.values():
            assert f"| {method} {method.name.lower()} |" in TEXT
    assert f"| {', '.join(str(int(m)) for m in FLOAT_METHODS.values())} | floats" in TEXT


@pytest.mark.parametrize(
    ("cost", "formula"),
    [
        (CHEAPEST_BIT, (65536, 65536 - 32)),
        (CHEAPEST_DECISION, (65536, 65535)),
        (CHEAPEST_SYMBOL, (65536, 65536 - 12)),
    ],
)
def test_cheapest_costs_are_those_that_readers_use(cost: float, formula: tuple[int, int]) -> None:
    assert cost == math.log2(formula[0] / formula[1])
    assert f"= {cost:.6f}" in TEXT


def test_limits_are_those_of_the_code() -> None:
    assert f"at most {MAX_FACES:,};" in ONE_LINE
    assert f"n_rows varint 1 to {MAX_STATES}" in ONE_LINE
    assert f"have 1 to {MAX_EXTENT} rows and columns" in ONE_LINE
    assert f"at most {MAX_DIGITS[4]} for float32, {MAX_DIGITS[8]} for float64" in ONE_LINE
    assert f"bits (1 byte, 1 to {MAX_BITS})" in ONE_LINE


def test_long_tables_are_those_of_the_code() -> None:
    page = format_tables.PAGE.read_text("utf-8")
    assert page == format_tables.page()
    rows = [line.split() for line in page.splitlines() if line.startswith("    ")]
    # Of 64 after two numbers; two kinds of weights of 6 and of 14 inputs; of 24, of 25.
    sizes = Counter(map(len, rows))
    assert sizes == {66: 55, 1: 2, 2: 8, 6: 4 * (1 + 7), 14: 4 * (1 + 15), 24: 25, 25: 24 + 9}
