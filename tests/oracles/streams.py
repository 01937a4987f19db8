"""ANS over adaptive rows, and plain bits, once more, by section 9.6 of FORMAT.md."""


class Row:
    """One of section 9.6, or one that starts from the mix its first symbol was coded with (9.5)."""

    def __init__(self, starts: list[int] | None = None, *, from_mix: bool = False) -> None:
        self.starts = starts or [2048 * i for i in range(17)]
        self.n, self.from_mix = 0, from_mix

    def learn(self, symbol: int, mix: list[int]) -> None:
        size = len(self.starts) - 1
        first, bounds = 3, [6, 20, 63]
        if self.from_mix:
            first, bounds = 2, [2, 6, 20, 63, 255]
            if self.n == 0:
                self.starts[1:16] = [m + ((2048 * i - m) >> 5) for i, m in enumerate(mix)][1:16]
        rate = first + sum(self.n >= bound for bound in bounds)
        for i in range(1, size):
            aim = 8 * i + (2**15 - 8 * size if i > symbol else 0)
            self.starts[i] += (aim - self.starts[i]) >> rate
        self.n += 1


class Streams:
    """Three states and their words, and plain bits."""

    def __init__(self, data: bytes) -> None:
        size = min(int.from_bytes(data[:4], "little"), max(len(data) - 4, 0))
        self.words = data[4 : 4 + size]
        self.states = [int.from_bytes(self.words[7 * i : 7 * i + 7], "little") for i in range(3)]
        self.at = 21
        self.plain, self.bit = int.from_bytes(data[4 + size :], "little"), 0

    def mixed(self, axis: int, starts: list[int]) -> int:
        """The symbol that owns [starts[symbol], starts[symbol + 1])."""
        state = self.states[axis]
        slot = state % 2**15
        symbol = next(s for s, end in enumerate(starts[1:]) if slot < end)
        self._become(
            axis, (starts[symbol + 1] - starts[symbol]) * (state >> 15) + slot - starts[symbol]
        )
        return symbol

    def symbol(self, axis: int, row: Row) -> int:
        found = self.mixed(axis, row.starts)
        row.learn(found, row.starts)
        return found

    def tells(self, axis: int, probability: int) -> bool:
        """A bit; probability: 2^15 times that of a 1."""
        return self.mixed(axis, [0, 2**15 - probability, 2**15]) == 1

    def raw(self, axis: int, n: int) -> int:
        found = 0
        while n > 0:
            m = min(n, 16)
            found = found << m | self.states[axis] % 2**m
            self._become(axis, self.states[axis] >> m)
            n -= m
        return found

    def bits(self, n: int) -> int:
        self.bit += n
        return self.plain >> (self.bit - n) & (2**n - 1)

    def _become(self, axis: int, state: int) -> None:
        if state < 2**24:
            state = state << 32 | int.from_bytes(self.words[self.at : self.at + 4], "little")
            self.at += 4
        self.states[axis] = state
