"""Attributes -> the properties of a PLY element and their columns, in declared types that fit."""

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.arrays import Attributes
from ebz.formats.dropped import warn_dropped
from ebz.formats.numbers import rendered
from ebz.formats.ply.columns import Column, Lists, unpadded
from ebz.formats.ply.header import TYPES, Property
from ebz.formats.ply.tables import COUNT_SUFFIX

Fields: TypeAlias = list[tuple[Property, Column]]

TYPE_NAMES = {np.dtype(code): name for name, code in reversed(TYPES.items())}
# In the order of preference, for what has none of these types.
HOLDERS = ("u1", "i4", "u4", "f4", "f8")
COUNT_TYPES = ("uchar", "int", "uint")


@dataclass
class Wanted:
    """Of an element: its name, the properties that were declared, and whether text is written."""

    name: str
    in_text: bool
    declared: dict[str, Property] = field(default_factory=dict)

    def ordered(self, fields: Fields) -> Fields:
        """Declared properties in their order, then the others in theirs."""
        rank = {name: i for i, name in enumerate(self.declared)}
        return sorted(fields, key=lambda field: rank.get(field[0].name, len(rank)))


def attribute_fields(wanted: Wanted, attributes: Attributes, taken: set[str]) -> Fields:
    """A property for each attribute of rows; warns of those without a name or type in PLY.

    taken: names that are in use; those of the fields are added.
    """
    fields: Fields = []
    counts = {name for name in attributes if _is_count(name, attributes)}
    for name, values in attributes.items():
        plain = None if name in counts else _nameable(wanted, "attribute", name, values, taken)
        if plain is not None:
            lengths = attributes[name + COUNT_SUFFIX] if name + COUNT_SUFFIX in counts else None
            fields.append(_attribute_field(wanted, name, plain, lengths))
    return fields


def corner_fields(
    wanted: Wanted, attributes: Attributes, corners: npt.NDArray[Any], taken: set[str]
) -> Fields:
    """A list property for each attribute of corners, of which each row has as many as given."""
    fields: Fields = []
    for name, values in attributes.items():
        plain = _nameable(wanted, "corner attribute", name, values, taken)
        if plain is None:
            continue
        lengths = corners * int(np.prod(plain.shape[1:], dtype=np.int64))
        prop = _typed(wanted, name, plain)
        prop.count_type = count_type(int(lengths.max(initial=0)), wanted.declared.get(name))
        flat = converted(plain.reshape(-1), prop, in_text=wanted.in_text)
        fields.append((prop, Lists(lengths.astype(prop.count_dtype), flat)))
    return fields


def _nameable(
    wanted: Wanted, kind: str, name: str, values: npt.NDArray[Any], taken: set[str]
) -> npt.NDArray[Any] | None:
    """The values in a type that PLY has; None, with a warning, where it has no name or type."""
    if name in taken or not is_name(name):
        warn_dropped(f"PLY cannot carry {wanted.name} {kind} {name!r} under this name")
        return None
    plain = _plain(values)
    if plain is None:
        warn_dropped(f"PLY has no type for {wanted.name} {kind} {name!r} of {values.dtype}")
        return None
    taken.add(name)
    return plain


def is_name(name: str) -> bool:
    """Whether `name` is one word of a header."""
    word = name.encode(errors="replace")
    return word.split() == [word] and word.decode() == name


def fits(values: npt.NDArray[Any], dtype: np.dtype[Any]) -> bool:
    """Whether `values` come back bit for bit from `dtype`."""
    with np.errstate(over="ignore", invalid="ignore"):
        back = values.astype(dtype).astype(values.dtype)
    return np.ascontiguousarray(values).tobytes() == back.tobytes()


def count_type(longest: int, declared: Property | None) -> str:
    """A type that can count lists of up to `longest` entries, the declared one if it can."""
    names = [declared.count_type] if declared and declared.count_type else []
    return next(n for n in [*names, *COUNT_TYPES] if longest <= np.iinfo(TYPES[n]).max)


def converted(values: npt.NDArray[Any], prop: Property, *, in_text: bool) -> npt.NDArray[Any]:
    """Values in the declared type; in text float64 stays what it is and says more than float."""
    if in_text and values.dtype == np.float64 and prop.dtype == np.float32:
        return values
    return values.astype(prop.dtype)


def _is_count(name: str, attributes: Attributes) -> bool:
    """Whether attribute `name` says how long the lists of another one are."""
    table = attributes.get(name.removesuffix(COUNT_SUFFIX))
    lengths = attributes[name]
    if not name.endswith(COUNT_SUFFIX) or table is None or table.ndim != 2 or lengths.ndim != 1:
        return False
    if lengths.dtype not in TYPE_NAMES or lengths.dtype.kind == "f":
        return False
    if lengths.min(initial=0) < 0 or lengths.max(initial=0) > table.shape[1]:
        return False
    return not table[np.arange(table.shape[1]) >= lengths[:, None]].any()


def _plain(values: npt.NDArray[Any]) -> npt.NDArray[Any] | None:
    """The values in a type that PLY has, None where there is none that holds them."""
    if values.dtype in TYPE_NAMES:
        return values
    for code in HOLDERS:
        suits = code[0] == "f" or values.dtype.kind != "f"
        if suits and fits(values, np.dtype(code)):
            return values.astype(code)
    return None


def _attribute_field(
    wanted: Wanted, name: str, values: npt.NDArray[Any], lengths: npt.NDArray[Any] | None
) -> tuple[Property, Column]:
    prop = _typed(wanted, name, values)
    if values.ndim == 1:
        return prop, converted(values, prop, in_text=wanted.in_text)
    table = values.reshape(len(values), -1) if values.size else values.reshape(len(values), 0)
    declared = wanted.declared.get(name)
    if lengths is None:
        prop.count_type = count_type(table.shape[1], declared)
        lengths = np.full(len(table), table.shape[1], prop.count_dtype)
    else:
        prop.count_type = _type_of_counts(lengths, declared)
    lists = unpadded(table, lengths)
    flat = converted(lists.values, prop, in_text=wanted.in_text)
    return prop, Lists(lengths.astype(prop.count_dtype), flat)


def _type_of_counts(lengths: npt.NDArray[Any], declared: Property | None) -> str:
    if declared and declared.count_type and declared.count_dtype == lengths.dtype:
        return declared.count_type
    return TYPE_NAMES[lengths.dtype]


def _typed(wanted: Wanted, name: str, values: npt.NDArray[Any]) -> Property:
    """A property of the declared type where the values are read from it as they are."""
    declared = wanted.declared.get(name)
    if declared and _keeps_dtype(values, declared, in_text=wanted.in_text):
        return Property(name, declared.type)
    return Property(name, TYPE_NAMES[values.dtype])


def _keeps_dtype(values: npt.NDArray[Any], declared: Property, *, in_text: bool) -> bool:
    if declared.dtype == values.dtype:
        return True
    text_says_more = in_text and declared.dtype == np.float32 and values.dtype == np.float64
    return text_says_more and rendered(values).dtype == np.float64
