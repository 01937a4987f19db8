"""What an attribute costs, how precise it is, and by which model: for statistics."""

from typing import Any

from ebz.codec.attributes.lattices import Decimals, Fractions, Singles
from ebz.codec.attributes.lossy import Box, Shares, Step
from ebz.codec.attributes.octahedral import Octahedral
from ebz.codec.attributes.plan import Guess, Lattice, Method, Plan, Relation
from ebz.codec.encoded import EncodedArray

RELATIONS = {Relation.UNIT: "unit vectors", Relation.SUM: "one sum"}


def summary(array: EncodedArray) -> dict[str, Any]:
    """Type, bytes without framing, precision and model of attributes that are coded together."""
    plan = array.plan
    shape = "".join(f" x {extent}" for extent in array.shape)
    return {
        "type": f"{array.dtype.name}{shape}",
        "bytes": len(array.data) + len(array.seams) + len(plan.specials) + len(plan.labels),
        "precision": precision(plan.lattice),
        "model": model(plan),
    }


def precision(lattice: Lattice) -> str:
    """What is lost, if anything, and on which lattice the values are."""
    if isinstance(lattice, Decimals):
        return f"exact, {lattice.digits} decimals"
    if isinstance(lattice, Fractions):
        return f"exact, steps of 1/{lattice.divisor}"
    if isinstance(lattice, Singles):
        return f"exact, float32 in {lattice.digits} digits" if lattice.digits else "exact, float32"
    if isinstance(lattice, Box | Shares):
        return f"{lattice.bits} bits, step {lattice.step:.6g}"
    if isinstance(lattice, Step):
        return f"error {lattice.max_error:.6g}"
    if isinstance(lattice, Octahedral):
        return f"{lattice.bits} bits, octahedral"
    return "exact"


def model(plan: Plan) -> str:
    """How the values are expected to be."""
    if plan.method == Method.SYMBOLS:
        return f"{plan.n_labels} labels"
    parts = [f"numbers of {plan.n_labels} labels" if plan.n_labels else "numbers"]
    parts += ["fast"] if plan.method == Method.FAST else []
    parts += [RELATIONS[plan.relation]] if plan.relation in RELATIONS else []
    parts += ["normals of the surface"] if Guess.NORMALS in plan.guess else []
    return ", ".join(parts)
