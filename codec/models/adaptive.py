"""Adaptive models of the word: the alternatives to a table, by effort."""

import enum
import math


class Effort(enum.IntEnum):
    """How much work goes into each symbol; the numbers are those of Effort in the kernels."""

    DIRECT = 1
    FAST = 2
    STRONG = 3

    @property
    def model_name(self) -> str:
        """What statistics call it."""
        return f"adaptive-{self.name.lower()}"


# A decision is at most this likely (least_share in codec/kernels/entropy/context_mixing.hpp), and
# every symbol that is not determined takes one decision at least: more than 2^-12 bits.
CHEAPEST_SYMBOL = math.log2(65536 / (65536 - 12))


def state_bytes(n_symbols: int) -> int:
    """Memory of the largest model, at most: 14 tables of 2^18 slots of 16 bytes, or fewer slots."""
    return (4 << 20) + min(224 << 18, 112 * n_symbols)
