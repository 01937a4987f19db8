"""OBJ files -> meshes; writer.py is the way back.

What the format leaves open, and what is chosen here:

- `v x y z w`: w becomes the vertex attribute `w`; `v x y z r g b`: the attribute `rgb` (n, 3);
  with a seventh number `rgba` (n, 4).
  Where only some vertices have them, NaN stands for those that have none.
- Texture coordinates and normals of corners become the corner attributes `uv` and `normal`; NaN
  stands for corners that have none. Those that no corner has are rows of the elements `vt` and
  `vn`, but where none is referred to and there are as many as vertices, they are the vertices'.
- Numbers are float32 where every shortest decimal survives that, else float64. A float64 array
  whose text would be taken for float32 is marked by a comment, `# ebz: float64`.
- Objects, groups, materials and smoothing groups become attributes of faces (and of lines and
  points): indices into the names in metadata["obj"], -1 before the first statement.
- Lines and points become the elements `line` and `point`.
- Comments are kept, though not where they were: they are written at the head.
- Free-form geometry and keywords that are not known are left out with one warning that counts them.
- Indices are 1-based, negative ones count back from the last vertex before the face.
- A backslash at the end of a line continues it.

Source: Wavefront, Object Files (.obj), appendix B1 of the Advanced Visualizer manual.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes, face_dtype
from ebz.codec.elements import Element, rows
from ebz.codec.errors import MeshError
from ebz.codec.mesh import Mesh
from ebz.formats.dropped import warn_dropped
from ebz.formats.obj.corners import Corners, read_corners
from ebz.formats.obj.lines import Lines, Rows, read_lines
from ebz.formats.obj.order import RUNS, count_runs
from ebz.formats.obj.statements import read_statements
from ebz.formats.obj.tables import read_table, read_vertices
from ebz.formats.polygons import offsets_of
from ebz.formats.text_floats import DOUBLE_MARK, EMPTY_MARK, Line

# What has corners, by keyword, and what corners have besides vertices, by keyword and index.
KINDS = {b"f": "face", b"l": "line", b"p": "point"}
CORNER_TABLES = ((b"vt", "uv", "texture coordinate", 1), (b"vn", "normal", "normal", 3))
MAX_NAMED = 12


def read_obj(data: bytes) -> Mesh:
    """The mesh of an OBJ file; metadata["obj"] holds comments, names and material libraries.

    Raises MeshError that names the line.
    """
    lines = read_lines(data)
    doubles, empty, flavour = _marks(lines)
    tables = lines.tables
    if not len(tables[b"v"]) and not any(len(tables[kind]) for kind in KINDS) and not empty:
        raise MeshError("there is no vertex")
    vertices, by_vertex = read_vertices(tables[b"v"], doubles)
    where = {KINDS[kind]: tables[kind].numbers for kind in KINDS}
    names, attributes, unknown = read_statements(lines.others, where)
    _warn_of(unknown)
    referred = (tables[b"v"], tables[b"vt"], tables[b"vn"])
    corners = {what: read_corners(tables[kind], referred, what) for kind, what in KINDS.items()}
    by_corner, unused = _corner_attributes(tables, corners, doubles, by_vertex)
    elements = {
        what: Element(
            offsets_of(corners[what].lengths),
            corners[what].indices[:, 0].astype(face_dtype(len(vertices))),
            attributes[what],
            by_corner[what],
        )
        for what in KINDS.values()
    }
    face = elements.pop("face")
    flavour |= names
    runs = count_runs(face.attributes, len(face))
    metadata = {"format": "obj", "obj": flavour, RUNS: runs}
    return Mesh(
        vertices,
        face.corners,
        by_vertex,
        face.attributes,
        {name: value for name, value in metadata.items() if value},
        face.offsets,
        face.corner_attributes,
        {name: element for name, element in elements.items() if len(element)} | unused,
    )


def _marks(lines: Lines) -> tuple[set[str], bool, dict[str, Any]]:
    """What is float64 in any case, whether the file is empty on purpose, the other comments."""
    doubles, comments, empty = set(), [], False
    for comment in lines.comments:
        if comment.startswith(DOUBLE_MARK):
            doubles.add(comment.removeprefix(DOUBLE_MARK).strip())
        elif comment == EMPTY_MARK:
            empty = True
        else:
            comments.append(comment)
    return doubles, empty, {"comments": comments} if comments else {}


def _corner_attributes(
    tables: dict[bytes, Rows],
    corners: dict[str, Corners],
    doubles: set[str],
    by_vertex: Attributes,
) -> tuple[dict[str, Attributes], dict[str, Element]]:
    """Attributes of corners, by what has them, and elements of what no corner has.

    What is the vertices' is added to `by_vertex`.
    """
    by_corner: dict[str, Attributes] = {what: {} for what in corners}
    unused = {}
    for slot, (keyword, name, what, least) in enumerate(CORNER_TABLES, 1):
        if not len(tables[keyword]):
            continue
        values = read_table(tables[keyword], what, least, 3, double=name in doubles)
        used = np.zeros(len(values), bool)
        for kind, of_kind in corners.items():
            index = of_kind.indices[:, slot]
            if (index >= 0).any():
                by_corner[kind][name] = _chosen(values, index)
                used[index[index >= 0]] = True
        if not used.any() and len(values) == len(tables[b"v"]):
            by_vertex[name] = values
        elif not used.all():
            unused[keyword.decode()] = rows(int(np.count_nonzero(~used)), {name: values[~used]})
    return by_corner, unused


def _chosen(values: npt.NDArray[Any], index: npt.NDArray[np.int64]) -> npt.NDArray[Any]:
    """The row of each index, NaN where it is negative."""
    chosen = values[index]
    chosen[index < 0] = np.nan
    return chosen


def _warn_of(lines: list[Line]) -> None:
    counts: dict[str, int] = {}
    for _, line in lines:
        keyword = line.split(None, 1)[0].decode()
        counts[keyword] = counts.get(keyword, 0) + 1
    parts = [f"{n} lines of {keyword!r}" for keyword, n in counts.items()]
    if len(parts) > MAX_NAMED:
        parts[MAX_NAMED:] = [f"{len(parts) - MAX_NAMED} more kinds"]
    if parts:
        warn_dropped("OBJ: " + ", ".join(parts))
