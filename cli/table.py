"""Nested results as text: sections, aligned columns, one object per line."""

import math
from collections.abc import Iterator
from typing import Any

from ebz.cli.atomic import write_all
from ebz.cli.messages import STDIN, STDOUT, encode
from ebz.codec.errors import EbzError

STDOUT_FD = 1
THREE_DECIMALS = ("bits_per_vertex", "ratio")


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

    Dicts or a list of dicts with the same keys become a table with a column per key.
    """
    lines = list(_section(result, 0))
    return "".join(line.rstrip() + "\n" for line in lines)


def json_of(result: dict[str, Any]) -> str:
    """`result` as one line of JSON; values that JSON has no number for are null."""
    import json

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
    plain = {key: value for key, value in section.items() if not _is_nested(value)}
    width = max((len(_title(key)) for key in plain), default=0)
    numbers = [_cell(key, value) for key, value in plain.items() if _is_number(value)]
    number_width = max(map(len, numbers), default=0)
    for key, value in section.items():
        if _is_nested(value):
            yield pad + _title(key)
            yield from _nested(value, indent + 1)
        else:
            cell = _cell(key, value).rjust(number_width if _is_number(value) else 0)
            yield f"{pad}{_title(key):<{width}}  {cell}"


def _is_nested(value: Any) -> bool:
    return isinstance(value, dict) or _is_table(value)


def _nested(value: Any, indent: int) -> Iterator[str]:
    if not isinstance(value, dict):
        return _rows(value, indent)
    rows = [{"": _title(key)} | row for key, row in value.items() if isinstance(row, dict)]
    if len(rows) == len(value) > 1 and _is_table(rows):
        return _rows(rows, indent)
    return _section(value, indent) if value else iter(["  " * indent + "-"])


def _is_table(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) > 0
        and all(isinstance(row, dict) and list(row) == list(value[0]) for row in value)
    )


def _rows(table: list[dict[str, Any]], indent: int) -> Iterator[str]:
    columns = [_column(key, [row[key] for row in table]) for key in table[0]]
    for cells in zip(*columns, strict=True):
        yield "  " * indent + "  ".join(cells)


def _column(key: str, values: list[Any]) -> list[str]:
    """The cells of a column and its title, all of one width; text to the left, numbers right."""
    cells = [_title(key), *(_cell(key, value) for value in values)]
    width = max(map(len, cells))
    is_text = any(isinstance(value, str) for value in values)
    return [cell.ljust(width) if is_text else cell.rjust(width) for cell in cells]


def _title(key: str) -> str:
    return str(key).replace("_", " ")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _cell(key: str, value: Any) -> str:
    match value:
        case None:
            return "-"
        case bool():
            return "yes" if value else "no"
        case float():
            return f"{value:.3f}" if key.endswith(THREE_DECIMALS) else f"{value:.6g}"
        case list() | tuple():
            return ", ".join(_cell(key, item) for item in value) or "-"
    return str(value)
