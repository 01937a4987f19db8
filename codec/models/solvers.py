"""Everything that needs scipy: Perron vectors, convex minimisation, linear programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import linprog, minimize
from scipy.sparse import coo_matrix, csr_matrix

Floats = npt.NDArray[np.float64]

# Relative change per step at which a power iteration has converged.
PRECISION = 1e-12
MAX_STEPS = 100_000


@dataclass(eq=False)
class Perron:
    """The Perron root of a non-negative matrix with its right and left vectors.

    residual: relative width of the Collatz-Wielandt bracket min, max (M x)_i / x_i of the root.
    """

    root: float
    right: Floats
    left: Floats
    residual: float


def sparse(source: Any, target: Any, values: Any, n: int) -> Any:
    """The (n, n) sparse matrix of those entries; entries at the same place add up."""
    return csr_matrix((values, (source, target)), shape=(n, n))


def perron(matrix: Any, start: Perron | None = None) -> Perron:
    """The Perron root and vectors by the shifted power iteration of the paper's section 3.

    The shift (M / root estimate + 1) makes an irreducible matrix primitive, which is when the
    iteration converges.  `start` gives vectors to start from.
    """
    n = matrix.shape[0]
    right = _power(matrix, start.right if start else np.ones(n))
    left = _power(matrix.T.tocsr(), start.left if start else np.ones(n))
    image = matrix @ right
    ratios = image / right
    root = float(left @ image / (left @ right))
    return Perron(root, right, left, float(ratios.max() - ratios.min()) / root)


def _power(matrix: Any, vector: Floats) -> Floats:
    vector = new = vector / vector.sum()
    for step in range(MAX_STEPS):
        image = matrix @ vector
        new = image / image.sum() + vector
        new /= new.sum()
        if step % 8 == 7 and np.abs(new / vector - 1).max() < PRECISION:
            break
        vector = new
    return np.asarray(new)


def minimise(
    function: Callable[[Floats], tuple[float, Floats]], start: Floats, gradient_tolerance: float
) -> tuple[Floats, float]:
    """The minimum of a convex function with gradient (BFGS): where, and the largest gradient."""
    found = minimize(function, start, jac=True, method="BFGS", options={"gtol": gradient_tolerance})
    return found.x, float(np.abs(found.jac).max(initial=0.0))


def linear_program(
    objective: Floats,
    upper: tuple[Any, Floats] | None,
    equal: tuple[Any, Floats] | None,
    bounds: Any,
) -> Floats | None:
    """Minimise objective x under A x <= b, A x = b and bounds (HiGHS); None where infeasible."""
    a_upper, b_upper = upper or (None, None)
    a_equal, b_equal = equal or (None, None)
    found = linprog(
        objective, A_ub=a_upper, b_ub=b_upper, A_eq=a_equal, b_eq=b_equal, bounds=bounds,
        method="highs-ipm",
    )  # fmt: skip
    return np.asarray(found.x) if found.status == 0 else None


def sparse_rows(entries: tuple[Any, Any, Any], shape: tuple[int, int]) -> Any:
    """The sparse matrix with values, rows and columns `entries`."""
    values, rows, columns = entries
    return coo_matrix((values, (rows, columns)), shape=shape).tocsr()
