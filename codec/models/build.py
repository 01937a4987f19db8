"""Writes the tables that ship: `python -m ebz.codec.models.build [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

from ebz.codec.models.chosen import LOOP_60
from ebz.codec.models.integers import table_of
from ebz.codec.models.loops import CONSTRAINTS
from ebz.codec.models.markov import optimal_model
from ebz.codec.models.search import best_automaton
from ebz.codec.models.table import TABLES, Table


def loop_60() -> Table:
    """The table `loop-60`."""
    return table_of(optimal_model(best_automaton(LOOP_60), CONSTRAINTS), "loop-60")


def main(folder: Path) -> None:
    """Write every table that ships into `folder`."""
    for table in (loop_60(),):
        table.save(folder / f"{table.name}.npz")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else TABLES)
