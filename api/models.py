"""Probability models of connectivity, their theory and their guarantees: `ebz.models`.

    >>> import ebz
    >>> ebz.models.certify(ebz.models.load("stack")).bits_per_vertex
    3.25855
    >>> table = ebz.models.fit(loops=2, max_length=8, max_conflict=8)
    >>> table.save("mine.npz")
    >>> data = ebz.compress(ebz.read("bunny.ply"), model="mine.npz")

It follows S. Gumhold, *Optimizing Markov Models with Applications to Triangular Connectivity
Coding* (SODA 2005); docs/models.md has the derivations.

Tables: load, names, Table, StackTable.  Guarantees: certify, Certificate, Band, costly_word,
CostlyWord.  Making tables: fit, fit_stack, round_to_table.  Theory: Automaton,
automaton_from_edges, loop_automaton, redirected_automaton, optimal_model, MarkovModel.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ebz.codec.models.adversary import CostlyWord, costly_word
    from ebz.codec.models.automaton import Automaton
    from ebz.codec.models.automaton import from_edges as automaton_from_edges
    from ebz.codec.models.certificate import Band, Certificate
    from ebz.codec.models.certify import certify
    from ebz.codec.models.fit import fit
    from ebz.codec.models.fit_stack import fit_stack
    from ebz.codec.models.integers import table_of as round_to_table
    from ebz.codec.models.load import load
    from ebz.codec.models.loops import loop_automaton, redirected_automaton
    from ebz.codec.models.markov import MarkovModel, optimal_model
    from ebz.codec.models.stack import StackTable
    from ebz.codec.models.table import Table
    from ebz.codec.models.table import table_names as names

# name: module of ebz.codec.models, name there.
_HOMES = {
    "Automaton": ("automaton", "Automaton"),
    "Band": ("certificate", "Band"),
    "Certificate": ("certificate", "Certificate"),
    "CostlyWord": ("adversary", "CostlyWord"),
    "MarkovModel": ("markov", "MarkovModel"),
    "StackTable": ("stack", "StackTable"),
    "Table": ("table", "Table"),
    "automaton_from_edges": ("automaton", "from_edges"),
    "certify": ("certify", "certify"),
    "costly_word": ("adversary", "costly_word"),
    "fit": ("fit", "fit"),
    "fit_stack": ("fit_stack", "fit_stack"),
    "load": ("load", "load"),
    "loop_automaton": ("loops", "loop_automaton"),
    "names": ("table", "table_names"),
    "optimal_model": ("markov", "optimal_model"),
    "redirected_automaton": ("loops", "redirected_automaton"),
    "round_to_table": ("integers", "table_of"),
}

__all__ = [
    "Automaton",
    "Band",
    "Certificate",
    "CostlyWord",
    "MarkovModel",
    "StackTable",
    "Table",
    "automaton_from_edges",
    "certify",
    "costly_word",
    "fit",
    "fit_stack",
    "load",
    "loop_automaton",
    "names",
    "optimal_model",
    "redirected_automaton",
    "round_to_table",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ebz.models' has no attribute {name!r}")
    module, attribute = _HOMES[name]
    value = getattr(import_module(f"ebz.codec.models.{module}"), attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
