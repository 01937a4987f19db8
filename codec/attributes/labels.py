"""Integers of which few occur -> which of them, in ascending order."""

import numpy as np

from ebz.codec.attributes.plan import Plan
from ebz.codec.lattice import Integers
from ebz.codec.listing import Listing, listing_of

MAX_LABELS = 1 << 16
# Of integers this far apart, as of bits of floats, two thirds may be labels; else a third.
FAR_APART = 1 << 24
# More labels than these, at least half of the integers in their range, are better coded as numbers.
MAX_DENSE = 256


def encode(integers: Integers) -> tuple[int, bytes, Integers] | None:
    """How many labels there are, their stream, and which is where; None if there are many."""
    found, which = np.unique(integers, return_inverse=True)
    n_labels = len(found)
    extent = int(found[-1]) - int(found[0])
    share = 2 * integers.size // 3 if extent > FAR_APART else integers.size // 3
    if n_labels > min(MAX_LABELS, 8 + share):
        return None
    if n_labels > MAX_DENSE and 2 * n_labels > extent:
        return None
    return len(found), listing_of(found).data, which.reshape(integers.shape).astype(np.int64)


def decode(which: Integers, plan: Plan) -> Integers:
    """The integers; raises CorruptError where there is no such label, or no such list."""
    return Listing(plan.n_labels, plan.labels).at(which)
