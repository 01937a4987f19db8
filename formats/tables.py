"""Model tables <-> the model chunk; built-in tables are known by number.

declarations is imported where a file has a table of its own: see there.
"""

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import CorruptError, OptionError, VersionError, corrupt_at
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.load import AnyTable, load
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import TOTAL, Table
from ebz.codec.word import WordModel
from ebz.formats.ebz import layout
from ebz.formats.ebz.chunks import Chunk

# What a header's model may be.
NUMBERS = {layout.INLINE_MODEL, *layout.MODELS, *layout.ADAPTIVE_MODELS}


def number_of(model: WordModel) -> int:
    """The number of a built-in model, INLINE_MODEL where it is a table that is none of them."""
    if isinstance(model, Effort):
        return {effort: number for number, effort in layout.ADAPTIVE_MODELS.items()}[model]
    for number, name in layout.MODELS.items():
        if model.name == name and model.same_as(_built_in(name)):
            return number
    return layout.INLINE_MODEL


@cache
def _built_in(name: str) -> AnyTable:
    """A table that ships, read once."""
    return load(name)


def write(table: AnyTable) -> bytes:
    """The payload of a model chunk."""
    common = {
        "name": table.name.encode("utf-8", "surrogatepass"),
        "n_rows": len(table.frequencies),
        "frequencies": table.frequencies[:, :-1].tolist(),
    }
    from ebz.formats.ebz import declarations

    if isinstance(table, Table):
        successors = {"successors": table.successors.tolist()}
        return bytes([layout.AUTOMATON]) + declarations.build(
            declarations.Automaton, common | successors
        )
    classes = {
        "n_conflicts": table.top.shape[1],
        "top": table.top.tobytes(),
        "n_lengths": table.step.shape[1],
        "step": table.step.tobytes(),
        "bottom": table.bottom,
    }
    return bytes([layout.STACK]) + declarations.build(declarations.Stack, common | classes)


def read(number: int, chunk: Chunk | None) -> WordModel:
    """The model that a header's number means; raises CorruptError where the chunk is malformed."""
    if number in layout.ADAPTIVE_MODELS:
        return layout.ADAPTIVE_MODELS[number]
    if number != layout.INLINE_MODEL:
        return _built_in(layout.MODELS[number])
    assert chunk is not None, "the container checks that it is there"
    with corrupt_at(chunk):
        try:
            table = _parse(chunk)
            table.check()
        except (OptionError, ValueError) as error:
            raise CorruptError(str(error)) from None
    return table


def _parse(chunk: Chunk) -> AnyTable:
    from ebz.formats.ebz import declarations

    kind, body = chunk.payload[:1], chunk.payload[1:]
    if kind == bytes([layout.AUTOMATON]):
        parsed = declarations.parse(declarations.Automaton, body)
        successors = np.array(parsed.successors, np.uint16).reshape(-1, 5)
        return Table(_name(parsed), _frequencies(parsed), successors)
    if kind == bytes([layout.STACK]):
        parsed = declarations.parse(declarations.Stack, body)
        top = np.frombuffer(parsed.top, np.uint8).reshape(-1, parsed.n_conflicts)
        step = np.frombuffer(parsed.step, np.uint8).reshape(-1, parsed.n_lengths)
        return StackTable(_name(parsed), _frequencies(parsed), top, step, parsed.bottom)
    raise VersionError(f"{chunk}: unknown kind of model")


def _name(parsed: Any) -> str:
    return bytes(parsed.name).decode("utf-8", "backslashreplace")


def _frequencies(parsed: Any) -> npt.NDArray[np.uint32]:
    """All five columns; a sum past 2^16 wraps, which checking the table finds."""
    stored = np.array(parsed.frequencies, np.uint32).reshape(-1, 4)
    return np.column_stack([stored, np.uint32(TOTAL) - stored.sum(axis=1, dtype=np.uint32)])
