"""verify tells names and comments that differ, where they can be compared."""

from typing import Any

import numpy as np
import pytest

import ebz

VERTICES = np.eye(3)
FACES = np.array([[0, 1, 2]])
OBJ = {"format": "obj", "obj": {"groups": ["a", "b"], "comments": ["c"]}}


def mesh(metadata: dict[str, Any]) -> ebz.Mesh:
    return ebz.Mesh(VERTICES, FACES, metadata=metadata)


@pytest.mark.parametrize(
    ("other", "difference"),
    [
        (OBJ, None),
        (OBJ | {"runs": 3}, None),
        ({"format": "ply"}, None),
        (OBJ | {"obj": {"groups": ["a", "x"], "comments": ["c"]}},
         "metadata 'obj' 'groups' 1: 'b', not 'x'"),
        (OBJ | {"obj": {"groups": ["a"], "comments": ["c"]}},
         "metadata 'obj' 'groups': 2 entries, not 1"),
        (OBJ | {"obj": {"groups": ["a", "b"]}}, "metadata 'obj' 'comments': not in MESH"),
        (OBJ | {"name": "n"}, "metadata 'name': missing"),
    ],
)  # fmt: skip
def test_metadata_is_compared_where_the_format_is_one(
    other: dict[str, Any], difference: str | None
) -> None:
    verdict = ebz.verify(ebz.compress(mesh(OBJ)), against=mesh(other))
    assert verdict.first_difference == difference
    assert verdict.equal == (difference is None)
    assert ("metadata" in verdict.checked) == (other["format"] == "obj")


def test_other_arrays_are_told_first() -> None:
    moved = ebz.Mesh(VERTICES + 1, FACES, metadata={"format": "obj"})
    verdict = ebz.verify(ebz.compress(mesh(OBJ)), against=moved)
    assert verdict.first_difference is not None
    assert "metadata" not in verdict.first_difference


def test_nan_is_equal_to_itself_and_parts_of_a_scene_are_told() -> None:
    parts = [mesh({"name": "p", "extras": {"a": 1, "b": float("nan")}})]
    data = ebz.compress(ebz.Scene(parts, {}))
    assert ebz.verify(data, against=ebz.Scene(parts, {})).equal
    other = [mesh({"name": "p", "extras": {"a": 2, "b": float("nan")}})]
    verdict = ebz.verify(data, against=ebz.Scene(other, {}))
    assert verdict.first_difference == "part 0 'p': metadata 'extras' 'a': 1, not 2"
