"""The numbers of an .ebz file: magic, chunk types, models; and integers of any size."""

from ebz.codec.models.adaptive import Effort

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

# Model 0 is the table of the file's model chunk; the other models are built in and never change.
INLINE_MODEL = 0
MODELS = {1: "loop-60", 2: "stack"}
ADAPTIVE_MODELS = {129: Effort.DIRECT, 130: Effort.FAST, 131: Effort.STRONG}
AUTOMATON, STACK = range(2)

# Seven bits a byte, the lowest first, all bytes but the last with the highest bit set.  The limit
# keeps the time of reading one constant.
MAX_VARINT = 10


def read_varint(data: bytes | memoryview, at: int = 0) -> tuple[int, int]:
    """The integer there, and its size in bytes.

    Raises IndexError where the data ends within it and ValueError where it is too long.
    """
    value = data[at]
    if value < 0x80:
        return value, 1
    value &= 0x7F
    for i in range(1, MAX_VARINT):
        byte = data[at + i]
        value |= (byte & 0x7F) << 7 * i
        if byte < 0x80:
            return value, i + 1
    raise ValueError(f"an integer of more than {MAX_VARINT} bytes")


def varint(value: int) -> bytes:
    """The bytes of an integer."""
    n = max(1, -(-value.bit_length() // 7))
    return bytes(value >> 7 * i & 0x7F | (0x80 if i < n - 1 else 0) for i in range(n))
