"""The sites of piece vertices once more, as FORMAT.md section 7 words them."""

from collections import defaultdict
from itertools import chain, islice

from tests.oracles.integers import AdaptiveBit, IntegerModel
from tests.oracles.range_coder import Decoder

MAX_CANDIDATES, MAX_PIECES = 4, 8


class Gluing:
    def __init__(self, data: bytes, opposite: list[int], vertex: list[int]) -> None:
        self.coder = Decoder(data)
        boundary = [h for h, across in enumerate(opposite) if across < 0]
        follower = [(vertex[h], vertex[h - h % 3 + (h + 1) % 3]) for h in boundary]
        self.after, self.before = dict(follower), {b: a for a, b in follower}
        self.starts = {
            vertex[t]
            for t in range(0, len(vertex), 3)
            if not any(0 <= h < t for h in opposite[t : t + 3])
        }
        self.sites: list[int] = []
        self.pieces: list[list[int]] = []  # at each site, the latest first
        self.base = {True: 0, False: 0}
        self.latest_start = False
        self.bits: defaultdict[tuple, AdaptiveBit] = defaultdict(AdaptiveBit)
        self.steps: defaultdict[bool, IntegerModel] = defaultdict(IntegerModel)

    def bit(self, *context: object) -> bool:
        return self.bits[context].code(self.coder, False)

    def decode(self, n_copies: int, n_pieces: int) -> list[int]:
        not_inside = self.starts | self.after.keys()
        inside = iter([v for v in range(n_pieces) if v not in not_inside])
        n_inside, gap = IntegerModel().code(self.coder, 0) if n_copies else 0, IntegerModel()
        gaps = [gap.code(self.coder, 0) for _ in range(n_inside)]
        copies_inside = {next(islice(inside, gap, None)) for gap in gaps}
        for v in range(n_pieces):
            is_asked = v > 0 and n_copies > 0 and v in not_inside
            if v in copies_inside or (is_asked and self.is_copy(v)):
                n_copies -= 1
                site = self.copied(v)
            else:
                site = len(self.pieces)
                self.pieces.append([])
            self.sites.append(site)
            self.pieces[site].insert(0, v)
        assert n_copies == 0
        return self.sites

    def is_copy(self, v: int) -> bool:
        if v in self.starts:
            self.latest_start = self.bit("start", self.latest_start)
            return self.latest_start
        return self.bit("copy", self.state(self.before.get(v)), self.state(self.after.get(v)))

    def state(self, u: int | None) -> int:
        if u is None or u >= len(self.sites):
            return 0
        return min(len(self.pieces[self.sites[u]]), 2)

    def copied(self, v: int) -> int:
        for i, site in enumerate(self.candidates(v)):
            if self.bit("candidate", i):
                return site
        starts = v in self.starts
        zigzag = self.steps[starts].code(self.coder, 0)
        self.base[starts] += -(zigzag // 2) - 1 if zigzag % 2 else zigzag // 2
        return self.base[starts]

    def candidates(self, v: int) -> list[int]:
        known = [u for u in (self.before.get(v), self.after.get(v)) if u is not None and u < v]
        others = chain.from_iterable(
            [w for w in self.pieces[self.sites[u]][:MAX_PIECES] if w != u] for u in known
        )
        beside = chain.from_iterable((self.after.get(w), self.before.get(w)) for w in others)
        sites = dict.fromkeys(self.sites[x] for x in beside if x is not None and x < v)
        return list(sites)[:MAX_CANDIDATES]
