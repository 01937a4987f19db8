"""Entries of attributes <-> streams.

Values -> integers on a lattice -> labels where few occur -> bytes, and back.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels, threads
from ebz.codec.arrays import Attributes
from ebz.codec.attributes import guesses, labels, lattices, relations, specials
from ebz.codec.attributes.bundles import Bundle, bundles
from ebz.codec.attributes.items import Items
from ebz.codec.attributes.lattices import bytes_of_floats
from ebz.codec.attributes.octahedral import Octahedral
from ebz.codec.attributes.plan import Effort, Guess, Method, Plan
from ebz.codec.attributes.precision import AttributePrecision, lattice_of
from ebz.codec.encoded import EncodedArray
from ebz.codec.errors import CorruptError, corrupt_at
from ebz.codec.lattice import Integers

EXACT = AttributePrecision()
SPACES = {4: 1, 8: 2}  # of floats by their bits; halves are coded as the integers they are
# So many labels take little time, and numbers say little about them.
FEW = 64


def encode(
    attributes: Attributes,
    order: npt.NDArray[Any],
    items: Items,
    precision: AttributePrecision = EXACT,
    *,
    effort: Effort = Effort.FULL,
) -> list[EncodedArray]:
    """A stream per bundle; `order` gives the source entry of each output entry."""
    one = partial(encode_bundle, items=items, precision=precision, effort=effort)
    return encode_each(attributes, order, precision, one)


def encode_each(
    attributes: Attributes,
    order: npt.NDArray[Any],
    precision: AttributePrecision,
    encode_one: Callable[[Bundle], EncodedArray],
) -> list[EncodedArray]:
    """What becomes of each bundle of entries in the order of the output."""

    def coded(bundle: Bundle) -> EncodedArray:
        return encode_one(bundle._replace(values=bundle.values[order]))

    return threads.run(coded, bundles(attributes, precision.of))


def decode(arrays: Sequence[EncodedArray], items: Items) -> Attributes:
    """The attributes by name; raises CorruptError."""
    return decode_each(arrays, partial(decode_array, items=items))


def decode_each(
    arrays: Sequence[EncodedArray], decode_one: Callable[[EncodedArray], npt.NDArray[Any]]
) -> Attributes:
    """What becomes of each bundle, by the names of its attributes."""
    named: Attributes = {}
    for array, decoded in zip(arrays, threads.run(decode_one, arrays), strict=True):
        named |= _by_name(array, decoded)
    return named


def _by_name(array: EncodedArray, values: npt.NDArray[Any]) -> Attributes:
    """The attributes of a bundle."""
    if len(array.names) == 1:
        return {array.names[0]: values}
    return {name: np.ascontiguousarray(values[:, i]) for i, name in enumerate(array.names)}


def encode_bundle(
    bundle: Bundle,
    items: Items,
    precision: AttributePrecision = EXACT,
    *,
    effort: Effort = Effort.FULL,
) -> EncodedArray:
    """The shortest of the streams that suit the values and take no more than the effort."""
    values = items.arranged(bundle.values)
    array = EncodedArray(bundle.names, values.dtype.newbyteorder("="), values.shape[1:], b"")
    if not values.size:
        return array
    flat = values.reshape(len(values), -1)
    lattice = lattice_of(flat, precision.of(bundle.names[0])) or lattices.fit(flat)
    plan, integers = specials.integers(flat, lattice)
    plans = list(_plans(plan, integers, flat, items, array))
    best = _shortest(plans, items, array, effort=effort)
    if items.of_source is not None:
        rows = items.rows_of_source
        integers = rows.arranged(items.rearranged(integers))
        if _rough_size(integers) < _size(best):
            plan = plan._replace(in_source_order=True)
            plans = list(_plans(plan, integers, flat, rows, array))
            best = min(best, _shortest(plans, rows, array, effort=effort), key=_size)
    return array._replace(plan=best[0], data=best[1])


def decode_array(array: EncodedArray, items: Items) -> npt.NDArray[Any]:
    """(n, ...) entries; raises CorruptError."""
    if array.plan.in_source_order:
        with corrupt_at(array.place):
            items = items.rows_of_source
    shape = (items.n, *array.shape)
    n_values = array.n_components
    if not items.n or not n_values:
        return np.zeros(shape, array.dtype)
    with corrupt_at(array.place):
        integers = _decode(array, items)
        if array.plan.n_labels:
            integers = labels.decode(integers, array.plan)
        values = specials.values(integers, array.plan, array.dtype)
        if values.size != items.n * n_values:
            raise CorruptError("entries of another number of components")
    return items.rearranged(values.reshape(shape))


def _shortest(
    plans: list[tuple[Plan, Integers]], items: Items, array: EncodedArray, *, effort: Effort
) -> tuple[Plan, bytes]:
    """The plan with the fewest bytes, and its stream."""
    coded = _encode_all(_fast(plans, array, effort), items, array)
    is_done = bool(coded) and effort < Effort.FULL
    slow = [pair for pair in plans if not is_done or _has_few_labels(pair[0])]
    return min(coded + _encode_all(slow, items, array), key=_size)


def _size(coded: tuple[Plan, bytes]) -> int:
    plan, data = coded
    return len(data) + len(plan.labels)


def _rough_size(integers: Integers) -> float:
    """About the bytes of the (n, components) differences from entry to entry, or of theirs."""
    steps = np.diff(integers.astype(np.float64), axis=0)
    sizes = (np.log2(1 + 2 * np.abs(x)).sum() for x in (steps, np.diff(steps, axis=0)))
    return float(min(sizes)) / 8


def _plans(
    plan: Plan, integers: Integers, values: npt.NDArray[Any], items: Items, array: EncodedArray
) -> Iterator[tuple[Plan, Integers]]:
    """Ways to code the integers, and what they make of them."""
    related = relations.find(plan, integers, array.dtype)
    guess = guesses.best(related, values, items)
    yield related._replace(guess=guess), integers
    labelled = labels.encode(integers)
    if labelled is not None:
        n_labels, stream, numbers = labelled
        for method in (Method.SYMBOLS, Method.NUMBERS):
            yield plan._replace(method=method, n_labels=n_labels, labels=stream), numbers


def _fast(
    plans: list[tuple[Plan, Integers]], array: EncodedArray, effort: Effort
) -> list[tuple[Plan, Integers]]:
    """The plan that takes few operations a value, if there is room for it.

    What floats gain by more is worth the time beyond the least effort.
    """
    plain, integers = plans[0]
    if _space(plain, array) > (SPACES[4] if effort == Effort.FAST else 0):
        return []
    return [(plain._replace(method=Method.FAST), integers)]


def _has_few_labels(plan: Plan) -> bool:
    return plan.method == Method.SYMBOLS and plan.n_labels <= FEW


def _encode_all(
    plans: list[tuple[Plan, Integers]], items: Items, array: EncodedArray
) -> list[tuple[Plan, bytes]]:
    """The plans and their streams, but for fast ones where a value has more than 32 bits."""
    coded = threads.run(lambda pair: (pair[0], _encode(*pair, items, array)), plans)
    return [(plan, data) for plan, data in coded if data]


def _encode(plan: Plan, integers: Integers, items: Items, array: EncodedArray) -> bytes:
    values = np.ascontiguousarray(integers).reshape(-1)
    return _kernels.encode_attribute(**_known(plan, items, array, integers.shape[1]), values=values)


def _decode(array: EncodedArray, items: Items) -> Integers:
    width = 2 if isinstance(array.plan.lattice, Octahedral) else array.n_components
    known = _known(array.plan, items, array, width)
    return _kernels.decode_attribute(array.data, **known).reshape(items.n, width)


def _known(plan: Plan, items: Items, array: EncodedArray, width: int) -> dict[str, Any]:
    """What both sides tell the kernel."""
    guess = np.zeros(0)
    if plan.guess != Guess.NONE and not plan.n_labels:
        guess = guesses.positions(plan, items)
    return {
        "opposite": items.opposite,
        "item": items.item,
        "offsets": items.offsets,
        "n": items.n,
        "n_components": width,
        "points": _points(plan, items, guess).reshape(-1),
        "site": items.site,
        "guess": guess.reshape(-1),
        "method": plan.method,
        "space": _space(plan, array),
        "relation": plan.relation,
        "total": plan.total,
        "heights": Guess.HEIGHTS in plan.guess,
        "by_area": Guess.AREA in plan.guess,
    }


def _points(plan: Plan, items: Items, guess: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Where entries are, if that tells anything; of labels only which ones are near."""
    if len(guess):
        tells = Guess.HEIGHTS in plan.guess
    else:
        tells = plan.method == Method.NUMBERS or not items.has_surface
    return items.points if tells and items.has_places else np.zeros(0)


def _space(plan: Plan, array: EncodedArray) -> int:
    """The space of floats in which integers that stand for them are predicted, 0 for others."""
    if plan.n_labels:
        return 0
    return SPACES.get(bytes_of_floats(plan.lattice, array.dtype), 0)
