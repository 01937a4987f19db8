"""Adaptive integers once more, as codec/kernels/entropy/integers.hpp codes them."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Any

from tests.oracles.range_coder import Decoder, Encoder

FLOOR, CEILING = 32, 2**16 - 32


class AdaptiveBit:
    """The mean of a fast and a slow estimate of the probability of a one, in 1 / 2^16."""

    def __init__(self) -> None:
        self.fast = self.slow = 2**15

    def code(self, coder: Any, bit: bool) -> bool:
        bit = coder.bit(bit, (self.fast + self.slow) // 2)
        target = CEILING if bit else FLOOR
        self.fast += (target - self.fast) >> 4
        self.slow += (target - self.slow) >> 7
        return bit


class IntegerModel:
    """The number of bits in unary, two modelled bits after the leading one, and the rest raw."""

    def __init__(self) -> None:
        self.more: defaultdict[int, AdaptiveBit] = defaultdict(AdaptiveBit)
        self.mantissa: defaultdict[tuple[int, int], AdaptiveBit] = defaultdict(AdaptiveBit)

    def code(self, coder: Any, value: int) -> int:
        width, n_bits = value.bit_length(), 0
        while n_bits < 64 and self.more[n_bits].code(coder, n_bits < width):
            n_bits += 1
        if n_bits < 2:
            return n_bits
        decoded, left = 1, n_bits - 1
        while left and decoded < 4:
            left -= 1
            bit = self.mantissa[n_bits, decoded].code(coder, bool(value >> left & 1))
            decoded = 2 * decoded + bit
        while left:
            n = min(left, 16)
            left -= n
            decoded = decoded << n | coder.raw(value >> left & (2**n - 1), n)
        return decoded


def encode(rows: Sequence[Sequence[int]]) -> bytes:
    """Rows of equal length, a model per column."""
    coder = Encoder()
    models: defaultdict[int, IntegerModel] = defaultdict(IntegerModel)
    for row in rows:
        for column, value in enumerate(row):
            models[column].code(coder, value)
    return coder.finish()


def decode(data: bytes, n_rows: int, n_columns: int) -> list[list[int]]:
    coder = Decoder(data)
    models = [IntegerModel() for _ in range(n_columns)]
    return [[model.code(coder, 0) for model in models] for _ in range(n_rows)]
