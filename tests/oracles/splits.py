"""The vertices at sites once more, as FORMAT.md section 7a words them."""

from collections import defaultdict
from collections.abc import Sequence

from tests.oracles.integers import AdaptiveBit, IntegerModel
from tests.oracles.range_coder import Decoder


class Splits:
    def __init__(self, data: bytes, opposite: Sequence[int], site: Sequence[int]) -> None:
        self.coder, self.opposite, self.site = Decoder(data), opposite, site
        self.n_sites = max(site, default=-1) + 1
        self.fans: list[list[int]] = []
        self.fan: dict[int, int] = {}
        self.told: defaultdict[int, list[int]] = defaultdict(list)  # vertices of each site
        self.vertex = [-1] * len(site)
        self.more: list[int] = []
        self.cut_spokes: set[int] = set()
        self.reached: defaultdict[int, list[int]] = defaultdict(list)  # spokes of each fan
        self.bits: defaultdict[tuple, AdaptiveBit] = defaultdict(AdaptiveBit)
        self.gap, self.back = IntegerModel(), IntegerModel()
        self.latest_reached = self.latest_whole = self.is_latest_apart = False

    def bit(self, *context: object) -> bool:
        return self.bits[context].code(self.coder, False)

    def decode(self) -> list[int]:
        if self.coder.raw(0, 1):
            self.vertex = [self.new(s) for s in self.site]
            return self.vertex
        for c in range(len(self.site)):
            if c not in self.fan:
                corners, _ = self.turned(c)
                self.fan.update(dict.fromkeys(corners, len(self.fans)))
                self.fans.append(corners)
        n_left = self.gap.code(self.coder, 0)
        for f, corners in enumerate(self.fans):
            if k := len(self.reached[f]):
                self.latest_reached = self.bit("reached", min(k, 3), self.latest_reached)
                is_cut = self.latest_reached
            elif n_left:
                n_left, is_cut = n_left - 1, False
            else:
                n_left, is_cut = self.gap.code(self.coder, 0), True
            if is_cut:
                self.cut(f, (self.reached[f] or [min(corners)])[0])
            else:
                self.take(corners, self.run(corners[0], None, is_whole=True))
        return self.vertex

    def is_spoke(self, h: int) -> bool:
        across = self.opposite[h]
        return across >= 0 and self.site[after(across)] == self.site[h]

    def turned(self, c: int) -> tuple[list[int], bool]:
        first = c
        while is_closed := self.is_spoke(first):
            first = after(self.opposite[first])
            if first == c:
                break
        corners = [first]
        while True:
            across = self.opposite[before(corners[-1])]
            if across < 0 or across == first or self.site[across] != self.site[first]:
                return corners, is_closed
            corners.append(across)

    def cut(self, f: int, start: int) -> None:
        corners, is_closed = self.turned(start)
        first = 0 if is_closed else 1
        ends = [self.other_end(f, c) for c in corners]
        cuts: list[int] = []
        for i in range(first, len(corners)):
            needed = (2 if is_closed else 1) - len(cuts)
            if needed == len(corners) - i or self.is_cut(i - first, cuts, ends[i:], is_closed):
                cuts.append(i)
                self.cut_spokes.add(corners[i])
                across = self.opposite[corners[i]]
                if self.is_spoke(across) and self.fan[across] > f:
                    self.reached[self.fan[across]].append(across)
        self.is_latest_apart = 1 < len(cuts) == len(corners) - first
        starts = cuts if is_closed else [0, *cuts]
        vertex = None
        around = [*corners, *corners[: starts[0]]]
        for i, end in zip(starts, [*starts[1:], len(around)], strict=True):
            vertex = self.run(around[i], vertex, is_whole=False)
            self.take(around[i:end], vertex)

    def other_end(self, f: int, spoke: int) -> int:
        """3 and 2: cut and not, 0: not known."""
        across = self.opposite[spoke]
        if across < 0 or (self.is_spoke(across) and self.fan[across] >= f):
            return 0
        return 3 if across in self.cut_spokes else 2

    def is_cut(self, n_before: int, cuts: list[int], ends: list[int], is_closed: bool) -> bool:
        a = ends[0] or int(3 in ends[1:])
        b = 3 if self.is_latest_apart and len(cuts) == n_before else min(len(cuts), 2)
        d = 0
        if is_closed and cuts and b < 3:
            n, twice = n_before + len(ends), 2 * (n_before - cuts[0])
            d = 1 if twice + 1 < n else 3 if twice > n + 1 else 2
        return self.bit("cut", a, b, d)

    def run(self, corner: int, latest: int | None, *, is_whole: bool) -> int:
        others = [v for v in self.told[self.site[corner]] if v != latest]
        if others:
            k = min(len(others), 3)
            is_known = self.bit("again", self.latest_whole, is_whole, k)
            if is_whole:
                self.latest_whole = is_known
            if is_known:
                back = self.back.code(self.coder, 0) if len(others) > 1 else 0
                return others[-1 - min(back, len(others) - 1)]
        return self.new(self.site[corner])

    def new(self, site: int) -> int:
        vertex = self.n_sites + len(self.more) if self.told[site] else site
        self.told[site].append(vertex)
        if vertex != site:
            self.more.append(site)
        return vertex

    def take(self, corners: list[int], vertex: int) -> None:
        for c in corners:
            self.vertex[c] = vertex


def after(c: int) -> int:
    return c - c % 3 + (c + 1) % 3


def before(c: int) -> int:
    return c - c % 3 + (c + 2) % 3
