"""The range coder once more, with integers that never overflow: no carry has to be propagated.

G. N. N. Martin, "Range encoding", 1979; codec/kernels/entropy/range_coder.hpp is what ebz uses.
"""

FULL = 2**48 - 1
SMALL = 2**40


class Encoder:
    """The message is the number low / 256^n_bytes, somewhere in [low, low + range)."""

    def __init__(self) -> None:
        self.low, self.range, self.n_bytes = 0, FULL, 6

    def symbol(self, start: int, frequency: int, total_bits: int) -> None:
        unit = self.range >> total_bits
        self.low += unit * start
        self.range = unit * frequency
        self._normalise()

    def bit(self, bit: bool, p1: int) -> bool:
        bound = self.range * p1 >> 16
        if bit:
            self.range = bound
        else:
            self.low += bound
            self.range -= bound
        self._normalise()
        return bit

    def raw(self, value: int, n_bits: int) -> int:
        self.symbol(value, 1, n_bits)
        return value

    def finish(self) -> bytes:
        """The shortest of the numbers in range; the decoder reads zeros past the end."""
        for n_dropped in (5, 4, 3, 2, 1, 0):
            unit = 256**n_dropped
            value = -(-self.low // unit) * unit
            if value - self.low < self.range:
                return (value // unit).to_bytes(self.n_bytes - n_dropped, "big")
        raise AssertionError("the range is never empty")

    def _normalise(self) -> None:
        while self.range < SMALL:
            self.low, self.range, self.n_bytes = self.low << 8, self.range << 8, self.n_bytes + 1


class Decoder:
    def __init__(self, data: bytes) -> None:
        self.data, self.at, self.range, self.code = data, 0, FULL, 0
        for _ in range(6):
            self._next()

    def symbol(self, starts: list[int], total_bits: int) -> int:
        """The symbol that owns [starts[symbol], starts[symbol + 1])."""
        position = self._position(total_bits)
        symbol = max(i for i, start in enumerate(starts[:-1]) if start <= position)
        self._consume(starts[symbol], starts[symbol + 1] - starts[symbol], total_bits)
        return symbol

    def bit(self, _: bool, p1: int) -> bool:
        bound = self.range * p1 >> 16
        bit = self.code < bound
        if bit:
            self.range = bound
        else:
            self.code -= bound
            self.range -= bound
        self._normalise()
        return bit

    def raw(self, _: int, n_bits: int) -> int:
        value = self._position(n_bits)
        self._consume(value, 1, n_bits)
        return value

    def _position(self, total_bits: int) -> int:
        return min(self.code // (self.range >> total_bits), 2**total_bits - 1)

    def _consume(self, start: int, frequency: int, total_bits: int) -> None:
        unit = self.range >> total_bits
        self.code -= unit * start
        self.range = unit * frequency
        self._normalise()

    def _next(self) -> None:
        byte = self.data[self.at] if self.at < len(self.data) else 0
        self.code = (self.code << 8 | byte) & FULL  # damaged streams leave it above the range
        self.at += 1

    def _normalise(self) -> None:
        while self.range < SMALL:
            self.range <<= 8
            self._next()
