"""Geometric programs as exponential-cone programs, solved by Clarabel.

S. Boyd, S.-J. Kim, L. Vandenberghe, A. Hassibi, A tutorial on geometric programming, 2007.  Only
building the stack table needs this: clarabel is no run-time dependency.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ebz.codec.models.solvers import Floats, sparse_rows

# Variable and coefficient.
Term = tuple[int, float]


@dataclass
class ConeProgram:
    """Linear constraints (sum <= bound) and exponential ones (exp(sum) <= variable)."""

    n_variables: int
    linear: list[list[Term]] = field(default_factory=list)
    bounds: list[float] = field(default_factory=list)
    exponential: list[tuple[list[Term], int]] = field(default_factory=list)

    def variable(self) -> int:
        """A new variable."""
        self.n_variables += 1
        return self.n_variables - 1

    def at_most(self, terms: list[Term], bound: float) -> None:
        """Demand that the sum of the terms is at most `bound`."""
        self.linear.append(terms)
        self.bounds.append(bound)

    def exponential_at_most(self, terms: list[Term], above: int) -> None:
        """Demand that exp(sum of the terms) is at most the variable `above`."""
        self.exponential.append((terms, above))

    def minimum(self, objective: dict[int, float], ridge: Floats) -> Floats:
        """The variables that minimise objective + ridge x^2 / 2."""
        clarabel = _clarabel()
        rows: list[list[Term]] = list(self.linear)
        offsets = list(self.bounds)
        for terms, above in self.exponential:
            rows += [[(v, -a) for v, a in terms], [], [(above, -1.0)]]
            offsets += [0.0, 1.0, 0.0]
        cones = [
            clarabel.NonnegativeConeT(len(self.linear)),
            *[clarabel.ExponentialConeT()] * len(self.exponential),
        ]
        cost = np.zeros(self.n_variables)
        cost[list(objective)] = list(objective.values())
        solver = clarabel.DefaultSolver(
            self._diagonal(ridge), cost, self._matrix(rows), np.array(offsets), cones, _settings()
        )
        return np.array(solver.solve().x)

    def _matrix(self, rows: list[list[Term]]) -> Any:
        entries = [(a, i, v) for i, terms in enumerate(rows) for v, a in terms]
        values, line, column = map(np.array, zip(*entries, strict=True))
        return sparse_rows((values, line, column), (len(rows), self.n_variables)).tocsc()

    def _diagonal(self, ridge: Floats) -> Any:
        place = np.arange(len(ridge))
        return sparse_rows((ridge, place, place), (self.n_variables, self.n_variables)).tocsc()


def summed(terms: Iterable[Term]) -> list[Term]:
    """Terms with equal variables added up."""
    total: dict[int, float] = {}
    for variable, coefficient in terms:
        total[variable] = total.get(variable, 0.0) + coefficient
    return [(v, a) for v, a in total.items() if a]


def _clarabel() -> Any:
    return importlib.import_module("clarabel")


def _settings() -> Any:
    """One thread, so that the same machine gives the same table."""
    chosen = _clarabel().DefaultSettings()
    chosen.verbose, chosen.max_threads, chosen.max_step_fraction = False, 1, 0.95
    chosen.tol_gap_abs = chosen.tol_gap_rel = chosen.tol_feas = 1e-6
    return chosen
