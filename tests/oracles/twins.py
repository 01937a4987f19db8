"""Twins once more, by section 9.10 of FORMAT.md."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tests.oracles.floats import signed
from tests.oracles.gates import Gates, following, previous
from tests.oracles.recall import WORD, Table, table_bits
from tests.oracles.streams import Streams

MAX_CORNERS = 12
STRONG, LEAST_SAME = 3, 8192


@dataclass(frozen=True)
class Twin:
    site: int
    strength: int
    at: list[int]


class Twins:
    """by: the axis of the order; at: positions, of the sites known."""

    def __init__(self, gates: Gates, at: list[list[int]], by: int) -> None:
        self.gates, self.at, self.by = gates, at, by
        self.of: dict[int, int] = {}
        self.corner: dict[int, int] = {}
        self.run = 0
        self.same, self.recent = [16384] * 4, 0
        b, n_key_bits = table_bits(len(at), 1, 18), 32 - len(at).bit_length()
        self.shapes, self.places = Table(b, n_key_bits), Table(b, n_key_bits)
        self.pending: tuple[int, int, int] | None = None

    def find(self, gates: Sequence[int]) -> Twin | None:
        for gate in gates:
            found = self._beside(gate)
            if found is not None:
                return found
        return None

    def tells(self, streams: Streams, twin: Twin) -> bool | None:
        """Whether all coordinates are the twin's, None where that is not asked."""
        p = self.same[self.recent]
        return streams.tells(0, p) if twin.strength == STRONG and p >= LEAST_SAME else None

    def learn(self, v: int, g: int, twin: Twin | None, n_equal: int) -> None:
        """After v, coded from gate g; n_equal: of its coordinates, the twin's."""
        right = n_equal >= 2
        if twin is not None:
            self.run = self.run + 1 if right else 0
            if twin.strength == STRONG:
                self._learn_same(n_equal == 3)
        self._recall()
        if twin is not None and right:
            self.of[v] = twin.site
        self.corner[v] = previous(g)
        self.pending = v, self._shape(v, g), self._place(v)

    def _learn_same(self, same: bool) -> None:
        p = self.same[self.recent]
        self.same[self.recent] = p + (((32753 if same else 15) - p) >> 4)
        self.recent = (2 * self.recent + same) % 4

    def _recall(self) -> None:
        if self.pending is None:
            return
        v, shape, place = self.pending
        found = self.shapes.find(shape) or self.places.find(place)
        self.of.setdefault(v, v if found is None else found[0])
        self.shapes.learn(shape, v)
        self.places.learn(place, v)

    def _shape(self, v: int, g: int) -> int:
        a, b = self.gates.ends(g)
        of_v, of_a, of_b = self.at[v], self.at[a], self.at[b]
        key = []
        for d in range(3):
            key += [abs(signed(of_v[d] - of_a[d], 64)), abs(signed(of_b[d] - of_a[d], 64))]
        return mixed(key)

    def _place(self, v: int) -> int:
        return mixed([self.at[v][d] for d in range(3) if d != self.by])

    def _beside(self, gate: int) -> Twin | None:
        a, b = self.gates.ends(gate)
        beyond = self.gates.beyond(gate)
        of_a, of_b = self.of.get(a), self.of.get(b)
        if of_a is None or of_b is None:
            return None
        of_beyond = None if beyond is None else self.of.get(beyond)
        if (of_a, of_b) == (a, b):
            same, flipped = of_beyond, beyond
        else:
            same, flipped = self._third(of_a, of_b)
        is_flipped = flipped is not None and flipped != of_beyond
        twin = flipped if is_flipped else same if same != of_beyond else None
        if twin is None or not self.gates.known[twin]:
            return None
        strength = 0 if (of_a, of_b) == (a, b) else 1 + min(2, self.run)
        at = [self._coordinate(d, (a, b), (of_a, of_b), twin, is_flipped) for d in range(3)]
        return Twin(twin, strength, at)

    def _third(self, a: int, b: int) -> tuple[int | None, int | None]:
        """The third corners of the faces from a to b and from b to a."""
        same = flipped = None
        for c in self._corners(self.corner[a]) if a in self.corner else ():
            after, before = self.gates.vertex[following(c)], self.gates.vertex[previous(c)]
            if after == b:
                same = before
            if before == b:
                flipped = after
        return same, flipped

    def _corners(self, first: int) -> Iterator[int]:
        opposite = self.gates.opposite
        c = first
        for _ in range(MAX_CORNERS):
            yield c
            c = opposite[previous(c)]
            if c < 0 or c == first:
                break
        if c >= 0:
            return
        c = opposite[first]
        for _ in range(MAX_CORNERS):
            if c < 0:
                return
            yield following(c)
            c = opposite[following(c)]

    def _coordinate(
        self, d: int, ends: tuple[int, int], twins: tuple[int, int], twin: int, is_flipped: bool
    ) -> int:
        (a, b), (of_a, of_b) = ([self.at[v][d] for v in pair] for pair in (ends, twins))
        u, v = signed(b - a, 64), signed(of_b - of_a, 64)
        turned, straight = abs(signed(u + v, 64)), abs(signed(u - v, 64))
        step = signed(self.at[twin][d] - of_a, 64)
        mirrored = turned < straight or (turned == straight and is_flipped and d == self.by)
        return signed(a - step if mirrored else a + step, 64)


def equal(one: Sequence[int], other: Sequence[int]) -> int:
    return sum(x == y for x, y in zip(one, other, strict=True))


def mixed(key: Sequence[int]) -> int:
    h = 0
    for z in key:
        h = (h ^ z % WORD) * 0x85EBCA6B % WORD
        h = (h ^ h >> 15) * 0xC2B2AE35 % WORD
    return h
