"""Attributes that are components of one thing (red, green, blue) are coded together."""

import re
from collections.abc import Callable, Hashable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes

SEQUENCES = (
    ("x", "y", "z", "w"),
    ("red", "green", "blue", "alpha"),
    ("r", "g", "b", "a"),
    ("u", "v", "w"),
    ("s", "t"),
)
MAX_NAMES = 64
_NUMBERED = re.compile(r"(.*?)(\d{1,9})", re.S)


class Bundle(NamedTuple):
    """Names, and the values of all of them: a component each, or any shape if there is one name."""

    names: tuple[str, ...]
    values: npt.NDArray[Any]


def bundles(attributes: Attributes, key: Callable[[str], Hashable]) -> list[Bundle]:
    """The attributes in their order; those with different keys are not coded together."""
    groups: list[list[str]] = []
    for name in attributes:
        last = groups[-1] if groups else []
        if last and _belongs(name, last, attributes) and key(name) == key(last[0]):
            last.append(name)
        else:
            groups.append([name])
    return [_bundle(group, attributes) for group in groups]


def _bundle(names: list[str], attributes: Attributes) -> Bundle:
    if len(names) == 1:
        return Bundle((names[0],), attributes[names[0]])
    return Bundle(tuple(names), np.stack([attributes[name] for name in names], axis=1))


def _belongs(name: str, group: list[str], attributes: Attributes) -> bool:
    """Whether a name is the next component after those of a group."""
    this, first = attributes[name], attributes[group[0]]
    if this.ndim != 1 or first.ndim != 1 or this.dtype != first.dtype or len(group) >= MAX_NAMES:
        return False
    return _is_next(group[-1], name)


def _is_next(before: str, name: str) -> bool:
    a, b = _NUMBERED.fullmatch(before), _NUMBERED.fullmatch(name)
    if a and b:
        return a[1] == b[1] and int(b[2]) == int(a[2]) + 1
    return any(
        before.endswith(one) and name.endswith(two) and before[: -len(one)] == name[: -len(two)]
        for sequence in SEQUENCES
        for one, two in pairwise(sequence)
    )
