"""OBJ files <-> meshes.

What the format leaves open, and what is chosen here:

- `v x y z w`: w becomes the vertex attribute `w`; `v x y z r g b`: the attribute `rgb` (n, 3).
  Where only some vertices have them, NaN stands for those that have none.
- Coordinates are float32 where every shortest decimal survives that, else float64. A float64 mesh
  whose text would be taken for float32 is marked by a comment, `# ebz: float64`.
- Comments are kept, though not where they were: they are written at the head.
- Texture coordinates, normals, groups, objects, materials, lines, points and free-form geometry
  are left out with one warning that counts them; so are keywords that are not known.
- Indices are 1-based, negative ones count back from the last vertex before the face.
- A backslash at the end of a line continues it.

Source: Wavefront, Object Files (.obj), appendix B1 of the Advanced Visualizer manual.
"""

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_attributes, warn_dropped
from ebz.formats.numbers import format_numbers, narrowed, shown
from ebz.formats.polygons import triangles
from ebz.formats.text_floats import (
    DOUBLE_MARK,
    EMPTY_MARK,
    Line,
    floats_at,
    integers_at,
    one_line,
    reads_as_float32,
    text_of,
    wide_if,
)
from ebz.formats.text_lines import words_per_line

WHAT = {
    "vt": "texture coordinates",
    "vn": "normals",
    "vp": "parameter space vertices",
    "l": "lines",
    "p": "points",
    "g": "groups",
    "o": "objects",
    "s": "smoothing groups",
    "usemtl": "materials in use",
    "mtllib": "material libraries",
}
MAX_NAMED = 12
# The vertex of a corner stays; its texture and normal indices go.
CORNER_REST = re.compile(rb"/-?[0-9]*(?:/-?[0-9]*)?(?=\s|$)")


def read_obj(data: bytes, *, triangulate: bool = False) -> Mesh:
    """The mesh of an OBJ file; metadata["obj"]["comments"] holds its comments.

    Raises MeshError that names the line.
    """
    lines = _logical_lines(data)
    kinds, comments = _sorted_lines(lines)
    mesh_metadata: dict[str, Any] = {"format": "obj"}
    double = DOUBLE_MARK in comments
    empty = EMPTY_MARK in comments
    comments = [comment for comment in comments if comment not in (DOUBLE_MARK, EMPTY_MARK)]
    if comments:
        mesh_metadata["obj"] = {"comments": comments}
    vertex_lines, face_lines = kinds.pop("v", []), kinds.pop("f", [])
    if not vertex_lines and not face_lines and not empty:
        raise MeshError("there is no vertex")
    vertices, attributes = _vertices(vertex_lines, double=double)
    lengths, corners, rests = _corners(face_lines, vertex_lines)
    _warn_of_rest(kinds, rests)
    faces, _ = triangles(
        lengths,
        corners,
        triangulate=triangulate,
        place=lambda row: f"line {face_lines[row][0]}: face {row}",
    )
    return Mesh(vertices, faces, attributes, {}, mesh_metadata)


def _logical_lines(data: bytes) -> list[Line]:
    """Lines with their numbers, continued ones joined."""
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = list(enumerate(text.split(b"\n"), 1))
    if b"\\\n" not in text:
        return lines
    joined: list[Line] = []
    parts: list[bytes] = []
    for number, line in lines:
        if line.endswith(b"\\") and not line.lstrip().startswith(b"#"):
            parts.append(line[:-1])
            continue
        joined.append((number - len(parts), b" ".join([*parts, line])))
        parts = []
    return joined


def _sorted_lines(lines: list[Line]) -> tuple[dict[str, list[Line]], list[str]]:
    """Lines by keyword, and comments."""
    kinds: dict[str, list[Line]] = {"v": [], "f": []}
    vertices, faces = kinds["v"], kinds["f"]
    comments = []
    for item in lines:
        head = item[1][:2]
        if head == b"v ":
            vertices.append(item)
        elif head == b"f ":
            faces.append(item)
        else:
            words = item[1].split(None, 1)
            if not words:
                continue
            if words[0].startswith(b"#"):
                comments.append(text_of(item[1].strip()[1:].strip()))
                continue
            if not re.fullmatch(rb"[A-Za-z_]\w{0,31}", words[0]):
                raise MeshError(f"line {item[0]}: {shown(words[0])} is no keyword")
            kinds.setdefault(words[0].decode(), []).append(item)
    return kinds, comments


def _joined(lines: list[Line]) -> tuple[list[bytes], npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """All words, the number of words of each line, and each line's number."""
    text = b"\n".join([line for _, line in lines])
    if b"#" in text:
        text = re.sub(rb"#[^\n]*", b"", text)
    numbers = np.fromiter((number for number, _ in lines), np.intp, len(lines))
    return text.split(), words_per_line(text), numbers


def _vertices(
    lines: list[Line], *, double: bool
) -> tuple[npt.NDArray[Any], dict[str, npt.NDArray[Any]]]:
    words, counts, numbers = _joined(lines)
    if not lines:
        return np.zeros((0, 3), np.float64 if double else np.float32), {}
    counts = counts - 1
    bad = ~np.isin(counts, (3, 4, 6))
    if bad.any():
        row = int(np.argmax(bad))
        raise MeshError(f"line {numbers[row]}: a vertex has 3, 4 or 6 numbers, not {counts[row]}")
    starts = np.cumsum(counts + 1) - counts - 1
    del_at = np.ones(len(words), bool)
    del_at[starts] = False
    values = floats_at(
        [word for word, keep in zip(words, del_at.tolist(), strict=True) if keep],
        np.repeat(numbers, counts),
    )
    first = np.cumsum(counts) - counts
    attributes = {}
    for name, count, width in (("w", 4, 1), ("rgb", 6, 3)):
        rows = np.flatnonzero(counts == count)
        if rows.size:
            table = np.full((len(lines), width), np.nan)
            table[rows] = values[first[rows][:, None] + np.arange(3, count)]
            attributes[name] = narrowed(table[:, 0] if width == 1 else table)
    return wide_if(values[first[:, None] + np.arange(3)], double=double), attributes


def _corners(
    lines: list[Line], vertex_lines: list[Line]
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.int64], int]:
    """Corners per face, their vertices from 0, and how many corners carried further indices."""
    if not lines:
        return np.zeros(0, np.intp), np.zeros(0, np.int64), 0
    text = b"\n".join([line for _, line in lines])
    n_rest = 0
    if b"/" in text:
        text, n_rest = CORNER_REST.subn(b"", text)
    stripped = list(zip([number for number, _ in lines], text.split(b"\n"), strict=True))
    words, counts, numbers = _joined(stripped)
    counts = counts - 1
    keep = np.ones(len(words), bool)
    keep[np.cumsum(counts + 1) - counts - 1] = False
    words = [word for word, kept in zip(words, keep.tolist(), strict=True) if kept]
    numbers = np.repeat(numbers, counts)
    index = integers_at(words, numbers)
    before = len(vertex_lines)
    if (index < 0).any():
        vertex_numbers = np.fromiter((number for number, _ in vertex_lines), np.intp)
        so_far = np.searchsorted(vertex_numbers, numbers)
        resolved = np.where(index < 0, so_far + index, index - 1)
    else:
        resolved = index - 1
    bad = (resolved < 0) | (resolved >= before)
    if bad.any():
        at = int(np.argmax(bad))
        raise MeshError(_bad_index(int(numbers[at]), int(index[at]), before))
    return counts, resolved, n_rest


def _bad_index(line: int, index: int, n_vertices: int) -> str:
    if index == 0:
        return f"line {line}: face refers to vertex 0, but OBJ counts from 1"
    there = "there is 1" if n_vertices == 1 else f"there are {n_vertices}"
    return f"line {line}: face refers to vertex {index}, but {there}"


def _warn_of_rest(kinds: dict[str, list[Line]], n_rest: int) -> None:
    parts = [
        f"{len(lines)} {WHAT.get(keyword, 'lines of unknown or free-form kind')} ({keyword})"
        for keyword, lines in kinds.items()
        if lines
    ]
    if n_rest:
        parts.append(f"texture and normal indices of {n_rest} corners")
    if len(parts) > MAX_NAMED:
        parts[MAX_NAMED:] = [f"{len(parts) - MAX_NAMED} more kinds"]
    if parts:
        warn_dropped("OBJ: " + ", ".join(parts))


def write_obj(mesh: Mesh) -> bytes:
    """The mesh as an OBJ file, numbers as shortest decimals; warns of attributes but `w`, `rgb`."""
    left = dict(mesh.vertex_attributes)
    extra = _extra_words(mesh, left)
    warn_attributes("OBJ", vertex=left, face=mesh.face_attributes)
    comments = _comments(mesh)
    if not len(mesh.vertices):
        comments.insert(0, EMPTY_MARK)
    if mesh.vertices.dtype == np.float64 and reads_as_float32(mesh.vertices):
        comments.insert(0, DOUBLE_MARK)
    lines = [f"# {comment}".rstrip(" ") for comment in comments]
    columns = [format_numbers(np.ascontiguousarray(mesh.vertices[:, i])) for i in range(3)]
    lines += [f"v {x} {y} {z}{more}" for x, y, z, more in zip(*columns, extra, strict=True)]
    corners = (mesh.faces.astype(np.int64) + 1).T.tolist()
    lines += [f"f {a} {b} {c}" for a, b, c in zip(*corners, strict=True)]
    return "\n".join([*lines, ""]).encode()


def _comments(mesh: Mesh) -> list[str]:
    flavour = mesh.metadata.get("obj")
    comments = flavour.get("comments") if isinstance(flavour, dict) else None
    known = comments if isinstance(comments, list) else []
    return [one_line(comment) for comment in known]


def _extra_words(mesh: Mesh, left: dict[str, npt.NDArray[Any]]) -> list[str]:
    """What stands behind x, y and z of each vertex; takes what it writes out of `left`."""
    words = [""] * len(mesh.vertices)
    for name, width in (("rgb", 3), ("w", 1)):
        values = left.get(name)
        if values is None or values.dtype.kind != "f" or values.size != width * len(words):
            continue
        table = values.reshape(-1, width)
        given = np.flatnonzero(~np.isnan(table).all(axis=1)).tolist()
        if any(words[row] for row in given):
            continue
        columns = [format_numbers(np.ascontiguousarray(table[given, i])) for i in range(width)]
        for row, *texts in zip(given, *columns, strict=True):
            words[row] = " " + " ".join(texts)
        del left[name]
    return words
