"""What `ebz model show` says of a table."""

from __future__ import annotations

from typing import Any

import numpy as np

from ebz.codec.models.certificate import Certificate
from ebz.codec.models.certify import certify
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import FREQUENCY_BITS, SYMBOLS, Table


def summary(table: Table | StackTable) -> dict[str, Any]:
    """Contexts, bound, size in bytes, and for each symbol its price and least and largest cost.

    The price is what the certificate charges for a symbol, in bits; the costs are 16 - log2 f of
    the frequencies f.  Raises OptionError for a table without a certificate.
    """
    found = certify(table)
    return {
        "model": table.name,
        "kind": table.kind,
        "contexts": len(table.frequencies),
        "bits_per_vertex": found.bits_per_vertex,
        "bytes": len(table.to_bytes()),
        "symbols": {symbol: _costs(table, column, found) for column, symbol in enumerate(SYMBOLS)},
    }


def _costs(table: Table | StackTable, column: int, found: Certificate) -> dict[str, float]:
    frequencies = table.frequencies[:, column]
    costs = FREQUENCY_BITS - np.log2(frequencies[frequencies > 0])
    return {
        "price": found.prices[SYMBOLS[column]],
        "least": float(costs.min()),
        "largest": float(costs.max()),
        "forbidden_in_contexts": int((frequencies == 0).sum()),
    }
