"""What the components of an entry have to do with each other."""

import numpy as np
import numpy.typing as npt

from ebz.codec.attributes.lattices import bytes_of_floats
from ebz.codec.attributes.octahedral import Octahedral
from ebz.codec.attributes.plan import Plan, Relation
from ebz.codec.lattice import Integers

# Of the entries, how many must obey, and how closely.
SHARE = 0.9
UNIT_TOLERANCE, SUM_TOLERANCE = 0.02, 1e-5
# Shorter vectors of integers have no direction to speak of.
LEAST_LENGTH = 60


@np.errstate(all="ignore")
def find(plan: Plan, integers: Integers, dtype: np.dtype[np.generic]) -> Plan:
    """The plan with the relation that most entries obey."""
    n_components = integers.shape[1]
    if isinstance(plan.lattice, Octahedral):
        return plan._replace(relation=Relation.OCTAHEDRAL, total=plan.lattice.last / 2)
    if n_components < 2:
        return plan
    in_floats = bytes_of_floats(plan.lattice, dtype) > 0
    wide = (plan.lattice.values(integers, dtype) if in_floats else integers).astype(np.float64)
    if n_components == 3:
        lengths = np.sqrt((wide * wide).sum(axis=1))
        total = _common(lengths, getattr(plan.lattice, "one", 1.0))
        close = np.abs(lengths - total) <= UNIT_TOLERANCE * total
        if close.mean() >= SHARE and (in_floats or total >= LEAST_LENGTH):
            return plan._replace(relation=Relation.UNIT, total=total)
    sums = wide.sum(axis=1)
    total = _common(sums, getattr(plan.lattice, "one", 1.0))
    allowed = SUM_TOLERANCE * abs(total) if in_floats else float(n_components)
    few = not in_floats and abs(total) < 4 * n_components
    if total and not few and (np.abs(sums - total) <= allowed).mean() >= SHARE:
        return plan._replace(relation=Relation.SUM, total=total)
    return plan


def _common(sizes: npt.NDArray[np.float64], one: float) -> float:
    """The middle one, or one itself where that is near."""
    middle = float(np.median(sizes))
    if not np.isfinite(middle):
        return 0.0
    return one if abs(middle - one) <= UNIT_TOLERANCE * one else middle
