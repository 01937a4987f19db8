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


def perron(matrix: Any, start: Perron | None = None, tolerance: float = 1e-12) -> Perron:
    """The Perron root and vectors by power iteration on M + 1 (paper, section 3).

    The shift makes an irreducible matrix primitive, so that the iteration converges.
    `start` gives vectors to start from.
    """
    n = matrix.shape[0]
    right, left = (start.right, start.left) if start else (np.ones(n), np.ones(n))
    right, _ = _power(matrix, right, tolerance)
    left, _ = _power(matrix.T.tocsr(), left, tolerance)
    image = matrix @ right
    ratios = image / right
    root = float(left @ image / (left @ right))
    return Perron(root, right, left, float(ratios.max() - ratios.min()) / root)


def _power(matrix: Any, vector: Floats, tolerance: float) -> tuple[Floats, int]:
    n_steps = 100000
    for step in range(n_steps):
        new = matrix @ vector + vector
        new /= new.sum()
        if step % 8 == 7 and np.abs(new / vector - 1).max() < tolerance:
            return new, step
        vector = new
    return vector, n_steps


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
        method="highs",
    )  # fmt: skip
    return np.asarray(found.x) if found.status == 0 else None


def sparse_rows(entries: tuple[Any, Any, Any], shape: tuple[int, int]) -> Any:
    """The sparse matrix with values, rows and columns `entries`."""
    values, rows, columns = entries
    return coo_matrix((values, (rows, columns)), shape=shape).tocsr()
