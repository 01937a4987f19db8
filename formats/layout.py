"""The bytes of an .ebz file, declared with construct; FORMAT.md is the specification in prose.

The header, which every file has, is in header.py.
"""

from typing import Any

import construct
from construct import (
    Array,
    Byte,
    Bytes,
    Check,
    Computed,
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
from ebz.codec.models.adaptive import Effort
from ebz.codec.models.table import MAX_STATES

Malformed = ConstructError

MAGIC = b"\x89EBZ\r\n\x1a\n"
VERSION = 2

# Chunk types: upper case is required to decode, a reader skips what it does not know in lower case.
HEADER, MODEL, WORD, SPECIALS, GLUING = b"H", b"M", b"W", b"S", b"G"
SPLITS, POSITIONS, POINTS, EXCEPTIONS = b"I", b"P", b"Q", b"X"
VERTEX_ORDER, FACE_ORDER, ROTATIONS = b"N", b"O", b"R"
VERTEX_ATTRIBUTE, FACE_ATTRIBUTE, CORNER_ATTRIBUTE, ELEMENT = b"V", b"F", b"C", b"E"
METADATA, END = b"D", b"Z"
# Before the parts of a scene, each of which is what a file of one mesh holds.
SCENE = b"L"

NAMES = {
    HEADER: "header",
    MODEL: "model",
    WORD: "word",
    SPECIALS: "special S",
    GLUING: "gluing",
    SPLITS: "splits",
    POSITIONS: "positions",
    POINTS: "points",
    EXCEPTIONS: "exceptions",
    VERTEX_ORDER: "vertex order",
    FACE_ORDER: "face order",
    ROTATIONS: "rotations",
    VERTEX_ATTRIBUTE: "vertex attributes",
    FACE_ATTRIBUTE: "face attributes",
    CORNER_ATTRIBUTE: "corner attributes",
    ELEMENT: "elements",
    METADATA: "metadata",
    END: "digest",
}

# Seven bits a byte, the lowest first, all bytes but the last with the highest bit set.  The limit
# keeps the time of reading one constant.
MAX_VARINT = 10


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


def read_varint(data: bytes | memoryview, at: int = 0) -> tuple[int, int]:
    """The integer there, and its size in bytes.

    Raises IndexError where the data ends within it and ValueError where it is too long.
    """
    value = 0
    for i in range(MAX_VARINT):
        byte = data[at + i]
        value |= (byte & 0x7F) << 7 * i
        if byte < 0x80:
            return value, i + 1
    raise ValueError(f"an integer of more than {MAX_VARINT} bytes")


def varint(value: int) -> bytes:
    """The bytes of an integer."""
    n = max(1, -(-value.bit_length() // 7))
    return bytes(value >> 7 * i & 0x7F | (0x80 if i < n - 1 else 0) for i in range(n))


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


# Model 0 is the table of the file's model chunk; the other models are built in and never change.
INLINE_MODEL = 0
MODELS = {1: "loop-60", 2: "stack"}
ADAPTIVE_MODELS = {129: Effort.DIRECT, 130: Effort.FAST, 131: Effort.STRONG}

AUTOMATON, STACK = range(2)
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

Exceptions = Struct("rows" / Prefixed(VarInt, GreedyBytes), "exact" / GreedyBytes)

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


# size: 2 n_bytes, or one more where raw bytes stand beside the text.
Text = Struct(
    "size" / VarInt,
    "n_raw" / IfThenElse(this.size & 1 == 1, VarInt, Computed(0)),
    "raw" / IfThenElse(this.size & 1 == 1, Prefixed(VarInt, GreedyBytes), Computed(b"")),
    "data" / GreedyBytes,
)
Scene = Struct("n_parts" / VarInt, "text" / Text)


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
