"""OBJ statements that hold for what follows: objects, groups, materials, smoothing groups."""

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.formats.text_floats import Line, text_of

# The attribute of faces that each keyword makes, and where metadata["obj"] has its names.
STATEMENTS = {
    "o": ("object", "objects"),
    "g": ("group", "groups"),
    "usemtl": ("material", "materials"),
    "s": ("smoothing", "smoothing"),
}
LIBRARY, LIBRARIES = "mtllib", "mtllibs"
NONE = -1


def read_statements(
    lines: list[Line], where: dict[str, npt.NDArray[np.int64]]
) -> tuple[dict[str, list[str]], dict[str, Attributes], list[Line]]:
    """Names by key of metadata["obj"], attributes by what they are of, and the lines left over.

    where: the line numbers of all faces, and of other rows, by what they are.
    """
    found: dict[str, list[tuple[int, str]]] = {}
    left = []
    for number, line in lines:
        first, *rest = line.split(None, 1)
        word = first.decode()
        if word in STATEMENTS or word == LIBRARY:
            name = text_of(rest[0].strip()) if rest else ""
            found.setdefault(word, []).append((number, name))
        else:
            left.append((number, line))
    names: dict[str, list[str]] = {}
    attributes: dict[str, Attributes] = {what: {} for what in where}
    if LIBRARY in found:
        names[LIBRARIES] = [name for _, name in found[LIBRARY]]
    for keyword, (attribute, key) in STATEMENTS.items():
        if keyword in found:
            names[key] = list(dict.fromkeys(name for _, name in found[keyword]))
            for what, numbers in where.items():
                if len(numbers) and (what == "face" or attribute != "smoothing"):
                    attributes[what][attribute] = _in_force(found[keyword], names[key], numbers)
    return names, attributes, left


def _in_force(
    statements: list[tuple[int, str]], names: list[str], numbers: npt.NDArray[np.int64]
) -> npt.NDArray[np.int32]:
    """For each line, which name was the last before it; NONE before the first."""
    index = {name: i for i, name in enumerate(names)}
    values = np.array([NONE, *(index[name] for _, name in statements)], np.int32)
    at = np.fromiter((number for number, _ in statements), np.int64, len(statements))
    return values[np.searchsorted(at, numbers)]
