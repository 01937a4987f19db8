"""How attributes are coded <-> the structure in their chunks."""

import math
from typing import Any

import numpy as np

from ebz.codec.attributes.lattices import Decimals, Fractions, Singles, exact
from ebz.codec.attributes.lossy import MAX_BITS, Box, Shares, Step
from ebz.codec.attributes.octahedral import NORMAL_BITS, Octahedral
from ebz.codec.attributes.plan import Guess, Lattice, Method, Plan, Relation
from ebz.codec.errors import CorruptError, VersionError
from ebz.codec.lattice import MAX_DIGITS, MAX_SINGLE_DIGITS

MAX_DIVISOR = 65535
# Added to the method where entries are in the order of the source.
IN_SOURCE_ORDER = 4


def build(plan: Plan) -> dict[str, Any]:
    """The values of declarations.Plan."""
    return {
        "lattice": {"kind": plan.lattice.kind, "parameters": vars(plan.lattice)},
        "method": plan.method + IN_SOURCE_ORDER * plan.in_source_order,
        "guess": plan.guess,
        "relation": plan.relation,
        "total": plan.total,
        "specials": plan.specials,
        "special_start": plan.special_start,
        "n_labels": plan.n_labels,
        "labels_size": len(plan.labels),
    }


def parse(parsed: Any, dtype: np.dtype[Any], n_components: int, labels: bytes) -> Plan:
    """The plan for entries of n_components; raises CorruptError, VersionError."""
    try:
        in_source_order, number = divmod(parsed.method, IN_SOURCE_ORDER)
        method, guess = Method(number), Guess(parsed.guess)
        relation = Relation(parsed.relation)
        if in_source_order > 1:
            raise ValueError(f"method {parsed.method}")
    except ValueError as error:
        raise VersionError(f"an attribute coded in another way: {error}") from None
    lattice = _lattice(parsed.lattice, dtype, n_components)
    total = parsed.total or 0.0
    if not math.isfinite(total):
        raise CorruptError(f"components whose total is {total}")
    is_guess = Guess.NORMALS in guess and Guess.AREA | Guess.ANGLE not in guess
    if guess and (n_components != 3 or not is_guess):
        raise CorruptError(f"normals of {n_components} components as guess {guess}")
    is_octahedral = isinstance(lattice, Octahedral)
    if relation and (relation == Relation.OCTAHEDRAL) != is_octahedral:
        raise CorruptError(f"relation {relation} on a lattice of kind {lattice.kind}")
    if relation == Relation.UNIT and n_components != 3:
        raise CorruptError(f"unit vectors of {n_components} components")
    if method == Method.SYMBOLS and not parsed.n_labels:
        raise CorruptError("symbols without labels")
    return Plan(
        lattice=lattice,
        method=method,
        relation=relation,
        total=total,
        guess=guess,
        special_start=parsed.special_start or 0,
        specials=parsed.specials,
        n_labels=parsed.n_labels,
        labels=labels,
        in_source_order=bool(in_source_order),
    )


def _lattice(parsed: Any, dtype: np.dtype[Any], n_components: int) -> Lattice:
    kind, parameters = str(parsed.kind), parsed.parameters
    if parameters is None:
        raise VersionError(f"an attribute on an unknown lattice {kind}")
    is_float = dtype.kind == "f"
    if kind == "decimal" and is_float and parameters.digits <= max(MAX_DIGITS.values()):
        return Decimals(parameters.digits)
    if kind == "fraction" and is_float and 1 <= parameters.divisor <= MAX_DIVISOR:
        return Fractions(parameters.divisor)
    if kind == "box" and _is_box(parameters, n_components):
        return Box(parameters.bits, tuple(parameters.origin), parameters.side)
    if kind == "step" and 0 < parameters.max_error < math.inf:
        return Step(parameters.max_error)
    if kind == "shares" and is_float and 1 <= parameters.bits <= MAX_BITS:
        return Shares(parameters.bits)
    is_vector = is_float and n_components == 3
    if kind == "octahedral" and is_vector and parameters.bits in NORMAL_BITS:
        return Octahedral(parameters.bits)
    if kind == "single" and dtype == np.float64 and parameters.digits <= MAX_SINGLE_DIGITS:
        return Singles(parameters.digits)
    if kind == "exact":
        return exact(dtype)
    raise CorruptError(f"{dtype} on a lattice of kind {kind} with {dict(parameters)}")


def _is_box(parameters: Any, n_components: int) -> bool:
    numbers = [*parameters.origin, parameters.side]
    return (
        len(parameters.origin) == n_components
        and 1 <= parameters.bits <= MAX_BITS
        and all(math.isfinite(number) for number in numbers)
    )
