"""The payloads with structure within, declared with construct; FORMAT.md has them in prose.

construct takes longer to import than a small mesh to code: this module is imported where a file
has attributes, elements or a model of its own.
"""

from typing import Any

import construct
from construct import (
    Array,
    Byte,
    Bytes,
    Check,
    Construct,
    ConstructError,
    Container,
    Enum,
    Float64l,
    GreedyBytes,
    If,
    IfThenElse,
    Int8ul,
    Int16ul,
    Int64sl,
    IntegerError,
    Prefixed,
    PrefixedArray,
    StreamError,
    Switch,
    Terminated,
    this,
)

from ebz.codec.errors import CorruptError
from ebz.codec.models.table import MAX_STATES
from ebz.formats.ebz.layout import MAX_VARINT, read_varint, varint


class _VarInt(Construct):  # type: ignore[misc]
    def _parse(self, stream: Any, context: Any, path: str) -> int:
        start = stream.tell()
        try:
            value, size = read_varint(stream.read(MAX_VARINT))
        except IndexError:
            raise StreamError("the data ends within an integer", path) from None
        except ValueError as error:
            raise IntegerError(str(error), path) from None
        stream.seek(start + size)
        return value

    def _build(self, value: int, stream: Any, context: Any, path: str) -> int:
        stream.write(varint(value))
        return value


VarInt = _VarInt()


class Struct(construct.Struct):  # type: ignore[misc]
    """That of construct without paths and hooks, which take most of its time."""

    def __init__(self, *fields: Any) -> None:
        super().__init__(*fields)
        self._fields = [
            (field.name, field.subcon if isinstance(field, construct.Renamed) else field)
            for field in self.subcons
        ]

    def _parse(self, stream: Any, context: Any, path: str) -> Any:
        inner = self._context(context)
        values = Container()
        for name, field in self._fields:
            value = field._parse(stream, inner, path)
            if name:
                inner[name] = values[name] = value
        inner.clear()  # it refers to itself
        return values

    def _build(self, values: Any, stream: Any, context: Any, path: str) -> Any:
        inner = self._context(context)
        inner.update(values)
        for name, field in self._fields:
            field._build(values.get(name), stream, inner, path)
        inner.clear()
        return values

    @staticmethod
    def _context(outer: Any) -> Any:
        inner = Container(_=outer)
        inner["_root"] = outer.get("_root", inner)
        for name in ("_params", "_parsing", "_building", "_sizing"):
            inner[name] = outer[name]
        return inner


Frequencies = Array(this.n_rows, Array(4, Int16ul))  # of C, L, R, S; E has what is left of 2^16

Automaton = Struct(
    "name" / Prefixed(VarInt, GreedyBytes),
    "n_rows" / VarInt,
    Check(this.n_rows <= MAX_STATES),
    "frequencies" / Frequencies,
    "successors"
    / Array(this.n_rows, Array(5, IfThenElse(this._root.n_rows <= 256, Int8ul, Int16ul))),
    Terminated,
)

Stack = Struct(
    "name" / Prefixed(VarInt, GreedyBytes),
    "n_rows" / VarInt,
    Check(this.n_rows <= MAX_STATES),
    "frequencies" / Frequencies,
    "n_conflicts" / Byte,
    "top" / Prefixed(VarInt, GreedyBytes),
    "n_lengths" / Byte,
    "step" / Prefixed(VarInt, GreedyBytes),
    "bottom" / Byte,
    Terminated,
)

ATTRIBUTE_LATTICES = (
    *("exact", "decimal", "fraction", "box", "step", "shares", "octahedral", "single"),
)

AttributeLattice = Struct(
    "kind" / Enum(Byte, **{name: i for i, name in enumerate(ATTRIBUTE_LATTICES)}),
    "parameters"
    / Switch(
        lambda context: str(context.kind),
        {
            "exact": Struct(),
            "decimal": Struct("digits" / Byte),
            "fraction": Struct("divisor" / VarInt),
            "box": Struct(
                "bits" / Byte, "origin" / PrefixedArray(VarInt, Float64l), "side" / Float64l
            ),
            "step": Struct("max_error" / Float64l),
            "shares": Struct("bits" / Byte),
            "octahedral": Struct("bits" / Byte),
            "single": Struct("digits" / Byte),
        },
    ),
)

Plan = Struct(
    "lattice" / AttributeLattice,
    "method" / Byte,
    "guess" / Byte,
    "relation" / Byte,
    "total" / If(this.relation > 0, Float64l),
    "specials" / Prefixed(VarInt, GreedyBytes),
    "special_start" / If(lambda context: len(context.specials) > 0, Int64sl),
    "n_labels" / VarInt,
    "labels_size" / If(this.n_labels > 0, VarInt),
)

AttributeHead = Struct(
    "names" / PrefixedArray(VarInt, Prefixed(VarInt, GreedyBytes)),
    "kind" / Bytes(1),  # b, i, u, f as in numpy
    "itemsize" / Byte,
    "shape" / PrefixedArray(Byte, VarInt),  # of one entry
    "plan" / Plan,
    "seams_size" / VarInt,
    Terminated,
)

# head: an AttributeHead of n_head bytes, as it is where it has as many, else coded as text.
# streams: labels, seams, data.
Attribute = Struct(
    "n_head" / VarInt, "head" / Prefixed(VarInt, GreedyBytes), "streams" / GreedyBytes
)

Nested = Prefixed(VarInt, Attribute)

Element = Struct(
    "name" / Prefixed(VarInt, GreedyBytes),
    "n_rows" / VarInt,
    "n_corners" / VarInt,
    "lengths" / PrefixedArray(Byte, Nested),  # one or none
    "corners" / PrefixedArray(Byte, Nested),  # one, or none where links are
    "links" / Prefixed(VarInt, GreedyBytes),
    "attributes" / PrefixedArray(VarInt, Nested),
    "corner_attributes" / PrefixedArray(VarInt, Nested),
    Terminated,
)


def build(declaration: Any, values: Any) -> bytes:
    """The bytes of a declared structure."""
    return bytes(declaration.build(values))


def parse(declaration: Any, payload: bytes) -> Any:
    """The values of a declared structure; raises CorruptError where the payload does not fit."""
    try:
        return declaration.parse(payload)
    except ConstructError as error:
        reason = str(error).splitlines()[-1]
        raise CorruptError(reason) from None
