"""The medium method once more, by sections 9.6 and 9.8 of FORMAT.md, an axis at a time."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tests.oracles.floats import F, octaves, pattern, rounded, signed, within
from tests.oracles.gates import Gates, Step
from tests.oracles.streams import Row, Streams

FIRST_CELL = [0, -11, -7, -5, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8]
CELL_DIGITS = [0, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2]


def fifteenths(x: np.float32) -> int:
    return int(within(x, -7.5, 7) + F(7.5))


@dataclass
class Known:
    """What is known about one axis of a residual; kind: None where it is predicted."""

    scale: np.float32
    near: int = 0
    spread: np.float32 = field(default_factory=F)
    drift: np.float32 = field(default_factory=F)
    fraction: np.float32 = field(default_factory=F)
    two: int = 0
    kind: int | None = None


class Residuals:
    def __init__(self, streams: Streams) -> None:
        self.streams = streams
        self.rows: dict[tuple[object, ...], Row] = {}
        self.far: dict[tuple[int, int], Row] = {}
        self.best, self.merit, self.n_sites = 2, [F(0)] * 3, 0

    def decode(self, known: Sequence[Known]) -> list[int]:
        """Of all axes."""
        shifts = [max(0, octaves(axis.scale) - 10) >> 1 for axis in known]
        rows = [self._rows(d, known[d], shifts[d]) for d in range(3)]
        mixes = [self._mix(of_axis) for of_axis in rows]
        symbols = [self.streams.mixed(d, mixes[d]) for d in range(3)]
        if known[0].kind is None:
            self.n_sites += 1
            if self.n_sites % 4 == 0:
                self._judge(rows, symbols)
        for of_axis, symbol, mix in zip(rows, symbols, mixes, strict=True):
            for row in of_axis:
                row.learn(symbol, mix)
        return [self._rest(d, symbols[d], known[d], shifts[d]) for d in range(3)]

    def _rows(self, d: int, x: Known, by: int) -> list[Row]:
        level, cell = octaves(x.scale) - 2 * by, F(2.0**-by)
        if x.kind is not None:
            keys: list[tuple[object, ...]] = [("step", d, x.kind, level)]
        else:
            wide = min(max(octaves(x.spread) - 2 * by, 0), 15)
            near = int(within(F(x.near) * cell, -7, 7) + F(7.5))
            pull = fifteenths(x.drift * F(3) / (x.scale + F(0.125)))
            keys = [
                ("level", d, level, wide),
                ("value", d, near, fifteenths(x.fraction * cell)),
                ("drift", d, x.two, level, pull),
            ]
        return [self.rows.setdefault(key, Row(from_mix=True)) for key in keys]

    def _mix(self, rows: list[Row]) -> list[int]:
        if len(rows) == 1:
            return list(rows[0].starts)
        best = rows[self.best]
        one, other = (row for row in rows if row is not best)
        sides = [(a + b + 1) >> 1 for a, b in zip(one.starts, other.starts, strict=True)]
        return [(s + b + 1) >> 1 for s, b in zip(sides, best.starts, strict=True)]

    def _judge(self, rows: list[list[Row]], symbols: list[int]) -> None:
        for of_axis, symbol in zip(rows, symbols, strict=True):
            for k, row in enumerate(of_axis):
                frequency = F(row.starts[symbol + 1] - row.starts[symbol])
                self.merit[k] += (F(pattern(frequency)) - self.merit[k]) * F(0.003)
        self.best = max(range(3), key=lambda k: (self.merit[k], k))

    def _rest(self, d: int, symbol: int, x: Known, by: int) -> int:
        half = 2**by >> 1
        if symbol == 0:
            return x.near
        if symbol < 14:
            return (FIRST_CELL[symbol] << by) - half + self.streams.bits(by + CELL_DIGITS[symbol])
        if symbol == 14:
            return 0
        level = octaves(x.scale) - 2 * by
        row = self.far.setdefault((d, level), Row())
        token = self.streams.symbol(d, row)
        if token == 15:
            return signed(self.streams.bits(min(self.streams.bits(6), 32)))
        negative = self.streams.bits(1)
        n = max(token // 2 - 1, 0)
        low = self.streams.bits(n + by)
        above = ((token if token < 4 else 2 + token % 2) << n | low >> by) + 12
        return signed(((-above if negative else above) << by) + low % 2**by - half)


class Decoder:
    """opposite, vertex: of the corners of the surface."""

    def __init__(
        self, data: bytes, opposite: Sequence[int], vertex: Sequence[int], n_sites: int
    ) -> None:
        self.residuals = Residuals(Streams(data))
        self.gates = Gates(opposite, vertex, n_sites)
        self.at: list[list[int]] = [[0, 0, 0]] * n_sites
        self.residual = [[0, 0, 0]] * n_sites
        self.steps = [[0, 0, 0], [0, 0, 0]]
        self.lead = [F(0)] * 3

    def decode(self) -> list[list[int]]:
        for to in self.gates.sites():
            if isinstance(to, Step):
                self._step(to)
            else:
                self._predict(to.site, to.g, to.h)
        return self.at

    def _step(self, to: Step) -> None:
        e = self.residuals.decode([Known(F(size), kind=to.kind) for size in self.steps[to.kind]])
        self.steps[to.kind] = [abs(x) for x in e]
        latest = [0, 0, 0] if to.latest is None else self.at[to.latest]
        self.at[to.site] = [signed(x + y) for x, y in zip(latest, e, strict=True)]

    def _predict(self, v: int, g: int, h: int) -> None:
        gates = [self._sites(g), self._sites(h)]
        plain, smooth, first, base, known = [], [], [], [], []
        for d in range(3):
            (a, b, o), (c, e, p) = [[self.at[site][d] for site in gate] for gate in gates]
            origin = signed(a + b - o)
            apart = signed(c + e - p - origin)
            first.append(origin)
            plain.append(signed(origin + (apart >> 1)))
            smooth.append(F(apart) * F(0.3) + F(signed(a + b + c + e - 4 * origin)) * F(0.1))
            is_plain = self.lead[d] <= 0
            base.append(plain[d] if is_plain else signed(origin + rounded(smooth[d])))
            near = min((signed(x - base[d]) for x in (a, b, c, e)), key=lambda x: abs(F(x)))
            ra, rb, rc, re = (F(self.residual[s][d]) for s in (*gates[0][:2], *gates[1][:2]))
            size = ((abs(ra) + abs(rb)) + (abs(rc) + abs(re))) * F(0.25)
            spread = size if g == h else abs(F(apart))
            known.append(
                Known(
                    size * F(0.6) + spread * F(0.25),
                    near,
                    spread,
                    ((ra + rb) + (rc + re)) * F(0.25),
                    (smooth[d] - F(signed(base[d] - origin))) * F(2 if is_plain else 4),
                    int(g != h),
                )
            )
        self.residual[v] = self.residuals.decode(known)
        self.at[v] = [signed(x + y) for x, y in zip(base, self.residual[v], strict=True)]
        for d, x in enumerate(self.at[v]):
            from_plain = abs(F(signed(x - plain[d])))
            from_smooth = abs(F(signed(x - first[d])) - smooth[d])
            lead = F(pattern(from_plain + F(1))) - F(pattern(from_smooth + F(1)))
            self.lead[d] += (lead - self.lead[d]) * F(0.01)

    def _sites(self, gate: int) -> list[int]:
        beyond = self.gates.beyond(gate)
        assert beyond is not None
        return [*self.gates.ends(gate), beyond]
