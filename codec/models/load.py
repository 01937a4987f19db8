"""Loads a table of any kind."""

from __future__ import annotations

from os import PathLike

from ebz.codec.errors import OptionError
from ebz.codec.models.archive import text, unpack
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import Table, read

AnyTable = Table | StackTable


def load(name_or_path: str | PathLike[str]) -> AnyTable:
    """The built-in table of that name, or the table in that file, of whatever kind.

    Raises OptionError where there is neither, or where the table is malformed.
    """
    return read(name_or_path, from_bytes)


def from_bytes(data: bytes) -> AnyTable:
    """The checked table of a file's content; raises OptionError where it is malformed."""
    kind = text(unpack(data), "kind")
    if kind == Table.kind:
        return Table.from_bytes(data)
    if kind == StackTable.kind:
        return StackTable.from_bytes(data)
    raise OptionError(f"model table: unknown kind {kind!r}")
