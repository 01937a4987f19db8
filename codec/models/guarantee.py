"""The guaranteed bits per vertex of a table, without deriving them again for built-in tables."""

from __future__ import annotations

from ebz.codec.models.load import load
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import Table

# What `certify` derives, rounded up; a test compares.
BUILT_IN = {"loop-60": 3.31714, "stack": 3.25855}


def guaranteed_bits(table: Table | StackTable) -> float:
    """Bits per vertex that no closed mesh of genus 0 exceeds, up to a constant.

    Raises OptionError for a table of a user's that has no certificate.
    """
    if table.name in BUILT_IN:
        built_in = load(table.name)
        if type(table) is type(built_in) and table.same_as(built_in):
            return BUILT_IN[table.name]
    from ebz.codec.models.certify import certify

    return certify(table).bits_per_vertex
