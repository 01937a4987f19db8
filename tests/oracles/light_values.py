"""Values that repeat once more, by section 9.5 of FORMAT.md."""

from collections.abc import Sequence
from dataclasses import dataclass

from tests.oracles.light_prediction import Point
from tests.oracles.recall import WORD, Mirror, Table, from_base, table_bits
from tests.oracles.streams import Streams
from tests.oracles.twins import Twin


@dataclass
class Axis:
    """Of a point, at its turn; offset: of the base from the first tip."""

    d: int
    turn: int
    base: int
    offset: int
    is_plain: bool
    level: int
    wide: int
    shift: int


@dataclass
class Value:
    """What e may be, and the context of whether it is."""

    e: int
    context: tuple[int, int, int, int]


class Values:
    """What repeats."""

    def __init__(self, streams: Streams, n_sites: int) -> None:
        self.streams = streams
        b = table_bits(n_sites, 1, 15)
        self.by_axes, self.by_place = Table(b), Table(b)
        self.mirrors = [Mirror(), Mirror(), Mirror()]
        self.odds: dict[tuple[int, int, int, int], int] = {}
        self.values: list[Value] = []
        self.keys: tuple[int, int] | None = None

    def decode(self, axis: Axis) -> int | None:
        """e, if it is one of the values."""
        octave = (axis.level + 2 * axis.shift - 6) // 2
        least = max(600, 2**15 >> min(max(octave, 0), 15))
        for value in self.values:
            p = self.odds.get(value.context, 8192)
            if p >= least and self.streams.tells(axis.d, p):
                return value.e
        return None

    def learn(self, axis: Axis, e: int, coordinate: int) -> None:
        for value in self.values:
            p = self.odds.get(value.context, 8192)
            self.odds[value.context] = p + (((32753 if value.e == e else 15) - p) >> 4)
        if self.keys is None:
            return
        recalled = self.by_axes.find(self.keys[0])
        if recalled is not None:
            self.mirrors[axis.d].learn(coordinate, recalled[0])
        self.by_axes.learn(self.keys[0], coordinate)
        self.by_place.learn(self.keys[1], coordinate)

    def gather(
        self, point: Point, axis: Axis, twin: Twin | None, at: Sequence[int], known: Sequence[int]
    ) -> None:
        """known: the axes of the turns before, on which `at` is."""
        d = axis.d

        def agreement(other: Sequence[int]) -> int:
            return sum(other[i] == at[i] for i in known)

        def level(other: Sequence[int]) -> int:
            n = agreement(other)
            return 0 if not known else 1 if n == 0 else 3 if n == len(known) else 2

        self.values, self.keys = [], None
        if twin is not None:
            self._add(point.signed(twin.at[d] - axis.base), 0, axis, level(twin.at), twin.strength)
            if twin.strength == 3 and agreement(twin.at) == len(known):
                return
        near = min(
            point.kept_neighbours[:2],
            key=lambda u: (-agreement(u), abs(point.signed(u[d] - axis.base))),
        )
        self._add(point.signed(near[d] - axis.base), 1, axis, level(near))
        if point.n_tips > 1:
            self._add(point.signed(point.second[d] - axis.base), 2, axis, level(point.second))
        self._recall(point, axis, [at[i] for i in known])

    def _recall(self, point: Point, axis: Axis, before: Sequence[int]) -> None:
        d, kept = axis.d, [u[axis.d] for u in point.kept_neighbours[:2]]
        x = [*(before or kept[:1]), 0][:2]
        self.keys = hashed(d, *x), hashed(4 + d, *kept)
        recalled, mirror = self.by_axes.find(self.keys[0]), self.mirrors[d]
        if recalled is not None:
            coordinate, hits = recalled
            self._add(from_base(coordinate, axis.base), 3, axis, min(hits - 1, 3))
            if mirror.hits:
                e = from_base(mirror.sum - coordinate, axis.base)
                self._add(e, 5, axis, min(mirror.hits - 1, 3))
        beside = self.by_place.find(self.keys[1])
        if beside is not None:
            self._add(from_base(beside[0], axis.base), 4, axis, min(beside[1] - 1, 3))

    def _add(self, e: int, kind: int, axis: Axis, agreement: int, strength: int = 0) -> None:
        if all(value.e != e for value in self.values):
            self.values.append(Value(e, (kind, axis.turn, agreement, strength)))


def hashed(k: int, x: int, y: int) -> int:
    h = k * 0x9E3779B1 % WORD
    for z in (x, y):
        h = (h ^ z % WORD) * 0x85EBCA6B % WORD
        h ^= h >> 15
    return h * 0xC2B2AE35 % WORD
