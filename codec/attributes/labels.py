"""Integers of which few occur -> which of them, in ascending order."""

import numpy as np

from ebz.codec.attributes.plan import Plan
from ebz.codec.errors import CorruptError
from ebz.codec.integers import decode_columns, encode_columns, unzigzag, zigzag
from ebz.codec.lattice import Integers

MAX_LABELS = 1 << 16
# More labels than these, at least half of the integers in their range, are better coded as numbers.
MAX_DENSE = 256


def encode(integers: Integers) -> tuple[int, bytes, Integers] | None:
    """How many labels there are, their stream, and which is where; None if there are many."""
    found, which = np.unique(integers, return_inverse=True)
    n_labels = len(found)
    if n_labels > min(MAX_LABELS, 8 + integers.size // 3):
        return None
    if n_labels > MAX_DENSE and 2 * n_labels > int(found[-1]) - int(found[0]):
        return None
    stream = encode_columns(zigzag(np.diff(found, prepend=0)))
    return len(found), stream, which.reshape(integers.shape).astype(np.int64)


def decode(which: Integers, plan: Plan) -> Integers:
    """The integers; raises CorruptError where there is no such label."""
    (steps,) = decode_columns(plan.labels, plan.n_labels, 1)
    if which.size and (which.min() < 0 or which.max() >= plan.n_labels):
        raise CorruptError(f"a label beyond the {plan.n_labels} that there are")
    labels: Integers = np.cumsum(unzigzag(steps))
    return labels[which]
