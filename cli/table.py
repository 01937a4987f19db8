"""Nested results as text: sections, aligned columns, one object per line."""

import math
from collections.abc import Iterator
from typing import Any

from ebz.cli.atomic import write_all
from ebz.cli.messages import STDIN, STDOUT, encode
from ebz.codec.errors import EbzError

STDOUT_FD = 1
BITS_DECIMALS = 3


def show(result: dict[str, Any], name: str, *, as_json: bool, titled: bool) -> None:
    """Prints `result` about the file `name`, as a line of JSON or as a table under its name."""
    shown = STDIN if name == "-" else name
    if as_json:
        text = json_of({"file": shown} | result)
    else:
        text = (f"{shown}\n" if titled else "") + text_of(result)
    try:
        write_all(STDOUT_FD, encode(text))
    except OSError as error:
        raise EbzError(error.strerror or str(error), source=STDOUT) from error


def text_of(result: dict[str, Any]) -> str:
    """The lines of `result`: a column of names and one of values, nested dicts as sections.

    A dict of dicts with the same keys becomes a table with a column per key.
    """
    lines = list(_section(result, 0))
    return "".join(line.rstrip() + "\n" for line in lines)


def json_of(result: dict[str, Any]) -> str:
    """`result` as one line of JSON; values that JSON has no number for are null."""
    import json  # noqa: PLC0415

    return json.dumps(_finite(result), allow_nan=False) + "\n"


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _section(section: dict[str, Any], indent: int) -> Iterator[str]:
    pad = "  " * indent
    plain = {key: value for key, value in section.items() if not isinstance(value, dict)}
    width = max((len(_title(key)) for key in plain), default=0)
    cells = {key: _cell(value) for key, value in plain.items()}
    number_width = max((len(cells[key]) for key in plain if _is_number(plain[key])), default=0)
    for key, value in section.items():
        if isinstance(value, dict):
            yield pad + _title(key)
            yield from _rows(value, indent + 1) if _is_table(value) else _section(value, indent + 1)
        else:
            cell = cells[key].rjust(number_width) if _is_number(value) else cells[key]
            yield f"{pad}{_title(key):<{width}}  {cell}"


def _is_table(section: dict[str, Any]) -> bool:
    rows = list(section.values())
    return len(rows) > 1 and all(
        isinstance(row, dict) and row and list(row) == list(rows[0]) for row in rows
    )


def _rows(table: dict[str, dict[str, Any]], indent: int) -> Iterator[str]:
    columns = list(next(iter(table.values())))
    cells = [["", *map(_title, columns)]]
    cells += [
        [_title(name), *(_cell(row[column]) for column in columns)] for name, row in table.items()
    ]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for name, *values in cells:
        aligned = [value.rjust(width) for value, width in zip(values, widths[1:], strict=True)]
        yield "  " * indent + "  ".join([name.ljust(widths[0]), *aligned])


def _title(key: str) -> str:
    return str(key).replace("_", " ")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _cell(value: Any) -> str:
    match value:
        case None:
            return "-"
        case bool():
            return "yes" if value else "no"
        case float():
            return _float(value)
        case list() | tuple():
            return ", ".join(map(_cell, value)) or "-"
    return str(value)


def _float(value: float) -> str:
    """Three decimals as in bits per vertex, but no small error rounded to nothing."""
    if (value and abs(value) < 0.1) or abs(value) >= 1e9:
        return f"{value:.4g}"
    return f"{value:.{BITS_DECIMALS}f}"
