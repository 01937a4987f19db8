"""The order in which rows of an OBJ file are written, and the statements between them.

Faces that compressing has shuffled would need a statement at nearly every face.  So rows are sorted
by what is in force for them, stably, unless the file that they are from was not sorted and their
order is still that of the file: metadata["runs"] then says how many runs it had.  What stands
before the first statement of a keyword can only be written there, so rows with less in force come
first.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.formats.obj.statements import NONE, STATEMENTS
from ebz.formats.text_floats import one_line

RUNS = "runs"
ANY = -2  # a statement that does not matter to a row
SMOOTHING = list(STATEMENTS).index("s")

Matrix = npt.NDArray[np.int64]


def take_in_force(attributes: Attributes, n: int, *, smooth: bool) -> Matrix:
    """(n, 4) what is in force for each row, by keyword; takes what it uses out of `attributes`."""
    matrix = np.full((n, len(STATEMENTS)), ANY, np.int64)
    for i, (attribute, _) in enumerate(STATEMENTS.values()):
        values = attributes.get(attribute)
        if values is None or values.ndim != 1 or values.dtype.kind not in "iu":
            continue
        if attribute == "smoothing" and not smooth:
            continue
        matrix[:, i] = np.maximum(values, NONE)
        del attributes[attribute]
    return matrix


def count_runs(face_attributes: Attributes, n: int) -> int:
    """How many runs of faces have the same in force; 0 where they are sorted."""
    matrix = take_in_force(dict(face_attributes), n, smooth=True)
    order = _sorted(matrix, np.zeros(n, np.int8))
    return 0 if np.array_equal(order, np.arange(n)) else _runs(matrix)


def order_of_rows(matrix: Matrix, kinds: npt.NDArray[np.int8], runs: Any) -> npt.NDArray[np.intp]:
    """The rows in the order to write them; faces are of kind 0, which `runs` is about.

    Other rows, and faces in no more runs than in their file, are only moved by what is missing for
    them; of one kind, what comes from a file has rows before a statement first.
    """
    faces = kinds == 0
    if isinstance(runs, int) and _runs(matrix[faces]) <= runs:
        faces = np.zeros_like(faces)
    return _sorted(np.where(faces[:, None] | (matrix == NONE), matrix, 0), kinds)


def _sorted(matrix: Matrix, kinds: npt.NDArray[np.int8]) -> npt.NDArray[np.intp]:
    missing = matrix == NONE
    smoothing = missing[:, SMOOTHING]
    others = np.delete(missing, SMOOTHING, axis=1).sum(axis=1)
    return np.lexsort([*matrix.T[::-1], ~smoothing, kinds, -others])


def _runs(matrix: Matrix) -> int:
    return int(np.count_nonzero((matrix[1:] != matrix[:-1]).any(axis=1))) + 1


def statements_between(matrix: Matrix, names: Mapping[str, Any]) -> list[tuple[int, list[str]]]:
    """Lines to write before the row of each number; those behind the last row come last.

    names: metadata["obj"].  Names that would come in another order, or are not used, are all
    written once where the first of them stands.
    """
    found: dict[int, list[str]] = {}
    for i, (keyword, (_, key)) in enumerate(STATEMENTS.items()):
        column = matrix[:, i]
        rows = np.flatnonzero(column != ANY)
        values = column[rows]
        before = np.concatenate([[NONE], values[:-1]])
        changes = np.flatnonzero(values != before)
        known = _names(names.get(key))
        wanted = values[changes].tolist()
        told = list(dict.fromkeys(wanted))
        first = int(rows[changes[0]]) if len(changes) else len(matrix)
        if told != list(range(len(known))):
            found.setdefault(first, []).extend(_line(keyword, name) for name in known)
        for row, value in zip(rows[changes].tolist(), wanted, strict=True):
            name = known[value] if value < len(known) else str(value)
            found.setdefault(row, []).append(_line(keyword, "" if value == NONE else name))
    return sorted(found.items())


def _names(value: Any) -> list[str]:
    return [one_line(name) for name in value] if isinstance(value, list) else []


def _line(keyword: str, name: str) -> str:
    return f"{keyword} {name}".rstrip(" ")
