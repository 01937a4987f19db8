"""The guarantee of any table, derived from the integers that ship and from nothing else."""

from __future__ import annotations

from ebz.codec.models.certificate import Certificate
from ebz.codec.models.certify_automaton import certify_automaton
from ebz.codec.models.certify_stack import certify_stack
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import Table


def certify(table: Table | StackTable) -> Certificate:
    """The guarantee of a table; raises OptionError, with the reason, where there is none.

    For an automaton the potentials of Theorem 3.1 telescope along a word; for a stack table they
    do by inequality (*) of docs/models.md.  Both are found anew from the integers.
    """
    return certify_stack(table) if isinstance(table, StackTable) else certify_automaton(table)
