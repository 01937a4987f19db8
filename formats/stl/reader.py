"""STL files <-> meshes, ascii and binary.

STL has no connectivity: corners at bit-identical positions become one vertex, numbered in the
order of first use; -0.0 and 0.0 stay apart. What else is chosen here:

- A file is binary where its size is the one that its count of facets asks for, even if it begins
  with "solid"; else ascii where it begins with "solid"; else binary.
- Normals that follow from the corners (or are zero) are dropped and computed again when writing;
  where any other is among them, all are kept as the face attribute `normal`.
- The attribute byte count is kept as the face attribute `attribute_byte_count` where it is not 0
  everywhere, the header of 80 bytes and the name of the solid where there is one.
- Several solids in one ascii file: their names are kept, and the face attribute `solid` counts
  from 0.
- Ascii coordinates are float32 where every shortest decimal survives that, else float64. Binary
  is float32.

Source: StereoLithography Interface Specification, 3D Systems, 1989.
"""

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import face_dtype
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.detect import is_binary_stl
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import narrowed, parse_floats, shown
from ebz.formats.stl.normals import follow_from
from ebz.formats.text_floats import text_of
from ebz.formats.weld import weld

HEADER_SIZE = 80
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
SOLID_LINE = re.compile(rb"^[ \t]*(end)?solid\b([^\n]*)$", re.MULTILINE | re.IGNORECASE)
# The words of an ascii facet; None stands for a number.
WORDS: tuple[bytes | None, ...] = (
    *(b"facet", b"normal", None, None, None, b"outer", b"loop"),
    *(b"vertex", None, None, None) * 3,
    *(b"endloop", b"endfacet"),
)
NUMBERS_AT = [at for at, word in enumerate(WORDS) if word is None]
LAST_WORD = b"endfacet"
BLOCK_SIZE = 1 << 20


def read_stl(data: bytes) -> Mesh:
    """The welded mesh of an STL file; metadata["stl"] holds its flavour.

    Raises MeshError that names the facet, and the line in ascii.
    """
    if data[:HEADER_SIZE].lstrip()[:5].lower() == b"solid" and not is_binary_stl(data):
        return _read_ascii(data)
    return _read_binary(data)


def _read_binary(data: bytes) -> Mesh:
    start = HEADER_SIZE + 4
    if len(data) < start:
        raise MeshError("early end of file: a binary STL has a header of 84 bytes")
    n = int.from_bytes(data[HEADER_SIZE:start], "little")
    n_whole, left = divmod(len(data) - start, FACET.itemsize)
    if n_whole < n:
        raise MeshError(f"facet {n_whole}: early end of file, {n} facets were declared")
    if n_whole > n or left:
        extra = len(data) - start - n * FACET.itemsize
        warn_dropped(f"{extra} bytes behind the last facet")
    table = np.frombuffer(data, FACET, n, start)
    flavour: dict[str, Any] = {"format": "binary"}
    header = data[:HEADER_SIZE]
    if header.strip(b"\0 "):
        flavour["header"] = header
    attributes = {}
    if table["attribute"].any():
        attributes["attribute_byte_count"] = table["attribute"].astype(np.uint16)
    corners = table["corners"].astype(np.float32)
    return _mesh(corners, table["normal"].astype(np.float32), attributes, flavour)


def _mesh(
    corners: npt.NDArray[Any],
    normals: npt.NDArray[Any],
    attributes: dict[str, npt.NDArray[Any]],
    flavour: dict[str, Any],
) -> Mesh:
    if not follow_from(normals, corners):
        attributes["normal"] = normals
    vertices, index = weld(corners.reshape(-1, 3))
    faces = index.reshape(-1, 3).astype(face_dtype(len(vertices)))
    return Mesh(vertices, faces, {}, attributes, {"format": "stl", "stl": flavour})


def _read_ascii(data: bytes) -> Mesh:
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    names, parts = _solids(text)
    facets = [_facets(text[start:end], text, start) for start, end in parts]
    n_per_solid = [len(normals) for normals, _ in facets]
    normals = np.concatenate([normals for normals, _ in facets])
    corners = narrowed(np.concatenate([corners for _, corners in facets]))
    flavour: dict[str, Any] = {"format": "ascii"}
    if any(names):
        flavour["names"] = names
    attributes = {}
    if len(parts) > 1:
        attributes["solid"] = np.repeat(np.arange(len(parts), dtype=np.int32), n_per_solid)
        flavour["names"] = names
    return _mesh(corners, narrowed(normals), attributes, flavour)


def _solids(text: bytes) -> tuple[list[str], list[tuple[int, int]]]:
    """The name of each solid, and where its facets begin and end."""
    names, parts = [], []
    begin = -1
    for match in SOLID_LINE.finditer(text):
        ends = match[1] is not None
        if ends != (begin >= 0):
            found = "'endsolid' outside" if ends else "'solid' inside"
            raise MeshError(f"{_line(text, match.start())}: {found} a solid")
        if ends:
            parts.append((begin, match.start()))
            begin = -1
        else:
            names.append(text_of(match[2].strip()))
            begin = match.end()
    if begin >= 0:
        raise MeshError(f"{_line(text, len(text))}: early end of file, expected 'endsolid'")
    if not parts:
        raise MeshError("line 1: expected 'solid'")
    return names, parts


def _line(text: bytes, offset: int) -> str:
    return f"line {text.count(bytes([10]), 0, offset) + 1}"


def _facets(part: bytes, text: bytes, start: int) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Normals (m, 3) and corners (m, 3, 3) in float64, read in blocks of whole facets."""
    part = part.lower()
    blocks = [np.zeros((0, len(NUMBERS_AT)))]
    begin = 0
    while begin < len(part):
        cut = part.rfind(LAST_WORD, begin, begin + BLOCK_SIZE)
        end = cut + len(LAST_WORD) if cut >= 0 and begin + BLOCK_SIZE < len(part) else len(part)
        words = part[begin:end].split()
        values = _numbers(words)
        if values is None:
            raise _error(words, part[begin:end], text, start + begin, sum(map(len, blocks)))
        blocks.append(values)
        begin = end
    values = np.concatenate(blocks)
    return values[:, :3], values[:, 3:].reshape(-1, 3, 3)


def _numbers(words: list[bytes]) -> npt.NDArray[np.float64] | None:
    """(m, 12) numbers of whole facets, None where something is wrong."""
    width = len(WORDS)
    for at, expected in enumerate(WORDS):
        found = words[at::width]
        if len(found) * width != len(words):
            return None
        if expected is not None and found.count(expected) != len(found):
            return None
    try:
        return np.stack([parse_floats(words[at::width]) for at in NUMBERS_AT], axis=1)
    except ValueError:
        return None


def _error(words: list[bytes], part: bytes, text: bytes, start: int, n_before: int) -> MeshError:
    """What is wrong with the first word that is not as it should be; `part` begins at `start`."""
    width = len(WORDS)
    for at, match in enumerate(re.finditer(rb"\S+", part)):
        problem = _problem(match[0], WORDS[at % width])
        if problem:
            line = _line(text, start + match.start())
            return MeshError(f"{line}: facet {n_before + at // width}: {problem}")
    facet = n_before + len(words) // width
    return MeshError(f"{_line(text, start + len(part))}: facet {facet}: early end of solid")


def _problem(word: bytes, expected: bytes | None) -> str | None:
    if expected is not None:
        return None if word == expected else f"expected {expected.decode()!r}, found {shown(word)}"
    try:
        parse_floats([word])
    except ValueError:
        return f"{shown(word)} is no number"
    return None
