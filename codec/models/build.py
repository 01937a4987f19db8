"""Writes the tables that ship: `python -m ebz.codec.models.build [FOLDER]`; needs clarabel."""

from __future__ import annotations

import sys
from pathlib import Path

from ebz.codec.models.fit import fit
from ebz.codec.models.fit_stack import fit_stack
from ebz.codec.models.table import TABLES, Table


def loop_60() -> Table:
    """The table `loop-60`: 3.3171 bits per vertex; its 60 most visited states give 3.3233."""
    return fit(loops=3, max_length=13, max_conflict=11, n_states=60, name="loop-60")


def main(folder: Path) -> None:
    """Write every table that ships into `folder`."""
    for table in (loop_60(), fit_stack()):
        table.save(folder / f"{table.name}.npz")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else TABLES)
