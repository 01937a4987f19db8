"""What was met before under a key, once more, by section 9.3 of FORMAT.md."""

from tests.oracles.floats import signed

WORD = 2**32


class Table:
    """Of 2^b entries: coordinates modulo 2^32, or numbers of vertices."""

    def __init__(self, b: int, n_key_bits: int = 28) -> None:
        self.b, self.n_keys = b, 2**n_key_bits
        self.entries: dict[int, tuple[int, int, int]] = {}

    def find(self, key: int) -> tuple[int, int] | None:
        """A coordinate and its hits."""
        same, coordinate, hits = self.entries.get(key >> (32 - self.b), (-1, 0, 0))
        return (coordinate, hits) if same == key % self.n_keys else None

    def learn(self, key: int, coordinate: int) -> None:
        coordinate %= WORD
        found = self.find(key)
        hits = min(found[1] + 1, 15) if found and found[0] == coordinate else 1
        self.entries[key >> (32 - self.b)] = key % self.n_keys, coordinate, hits


class Mirror:
    """Of an axis: the sum of a coordinate and the one that was recalled instead."""

    def __init__(self) -> None:
        self.sum, self.hits = 0, 0

    def learn(self, coordinate: int, recalled: int) -> None:
        if (coordinate - recalled) % WORD == 0:
            return
        sum_ = (coordinate + recalled) % WORD
        self.hits = min(self.hits + 1, 15) if self.hits and sum_ == self.sum else 1
        self.sum = sum_


def from_base(coordinate: int, base: int) -> int:
    return signed(coordinate - base)


def table_bits(n_sites: int, more: int, greatest: int) -> int:
    return min(max(n_sites.bit_length() + more, 8), greatest)
