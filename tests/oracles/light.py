"""The light method once more, by sections 9.3, 9.5, 9.6, 9.8 and 9.10 of FORMAT.md."""

from collections.abc import Sequence

import numpy as np

from tests.oracles.floats import F, octaves, signed, within
from tests.oracles.gates import Gates, Step, Tip
from tests.oracles.light_prediction import Gathered, Point, Predictor
from tests.oracles.light_values import Axis, Values
from tests.oracles.streams import Row, Streams
from tests.oracles.twins import Twin, Twins, equal

SLIDING = 3
FIRST_CELL = [-15, -11, -7, -5, -3, -2, -1, 0, 1, 2, 3, 4, 6, 8, 12]
CELL_DIGITS = [2, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 2]
FIRST_DIGITS = [8184 * i for i in range(4)] + [2**15 - 8 * (8 - i) for i in range(4, 9)]


class Decoder:
    """opposite, vertex: of the corners of the surface."""

    def __init__(
        self, data: bytes, opposite: Sequence[int], vertex: Sequence[int], n_sites: int
    ) -> None:
        self.is_empty, first = not data, data[0] if data else 0
        self.order, self.n_bits = first & 3, 64 if first & 4 else 32
        self.streams = Streams(data[1:])
        self.gates = Gates(opposite, vertex, n_sites)
        self.at: list[list[int]] = [[0, 0, 0] for _ in range(n_sites)]
        self.residual = [[0, 0, 0] for _ in range(n_sites)]
        self.predictor = Predictor(slides=self.order == SLIDING)
        self.steps = Steps(self.streams, self.n_bits)
        self.symbols = Symbols(self.streams)
        self.values = Values(self.streams, n_sites)
        self.twins = Twins(self.gates, self.at, self.order)

    def decode(self) -> list[list[int]]:
        if self.is_empty:
            return self.at
        for to in self.gates.sites():
            if isinstance(to, Step):
                self._step(to)
            else:
                self._predict(to)
        return self.at

    def _step(self, to: Step) -> None:
        latest = [0, 0, 0] if to.latest is None else self.at[to.latest]
        for d in range(3):
            e = self.steps.decode(d, to.kind)
            self.at[to.site][d] = signed(latest[d] + e, self.n_bits)

    def _predict(self, to: Tip) -> None:
        if self.order == SLIDING:
            self._along(to, None)
            return
        twin = self.twins.find([to.g] if to.g == to.h else [to.g, to.h])
        told = None if twin is None else self.twins.tells(self.streams, twin)
        if twin is not None and told:
            self.at[to.site] = [signed(x, self.n_bits) for x in twin.at]
            self.residual[to.site] = self.residual[twin.site]
        else:
            self._along(to, twin, denied=told is False)
        n_equal = 3 if told else 0 if twin is None else equal(self.at[to.site], twin.at)
        self.twins.learn(to.site, to.g, twin, n_equal)

    def _along(self, to: Tip, twin: Twin | None, *, denied: bool = False) -> None:
        """An axis at a time; denied: not all are the twin's."""
        around = Gathered(self.gates, to.g, to.h)
        point = Point(around, self.at, self.residual, self.n_bits)
        self.predictor.predict(point)
        recalls, at = self.order != SLIDING, self.at[to.site]
        last = self.order if recalls else point.last
        axes = [d for d in range(3) if d != last] + ([] if last is None else [last])
        for turn, d in enumerate(axes):
            if turn == 2 and point.last is not None:
                self.predictor.slide(point, at)
            if turn == 2 and denied and twin and all(at[i] == twin.at[i] for i in axes[:2]):
                twin = None
            axis = self._axis(point, d, turn)
            e = None
            if recalls:
                self.values.gather(point, axis, twin, at, axes[:turn])
                e = self.values.decode(axis)
            if e is None:
                e = point.signed(self.symbols.decode(point, axis))
            self.residual[to.site][d] = e
            at[d] = point.signed(axis.base + e)
            if recalls:
                self.values.learn(axis, e, at[d])
        self.predictor.learn(point, at)

    def _axis(self, point: Point, d: int, turn: int) -> Axis:
        scale, spread = point.scale(d)
        shift = max(0, octaves(scale) - 12) >> 1
        wide = min(max(octaves(spread) - 2 * shift, 0), 17)
        base, offset = self.predictor.base(point, d)
        is_plain = self.predictor.is_plain(point, d)
        return Axis(d, turn, base, offset, is_plain, octaves(scale) - 2 * shift, wide, shift)


class Steps:
    def __init__(self, streams: Streams, n_bits: int) -> None:
        self.streams, self.n_bits = streams, n_bits
        self.rows: dict[tuple[int, int, int], Row] = {}
        self.low_rows: dict[tuple[int, int, int], Row] = {}
        self.before: dict[tuple[int, int], int] = {}

    def decode(self, d: int, kind: int) -> int:
        before = self.before.get((d, kind), 0)
        high = self.streams.symbol(d, self.rows.setdefault((d, kind, before), Row()))
        self.before[d, kind] = high
        low_row = self.low_rows.setdefault((d, kind, high), Row(list(FIRST_DIGITS)))
        n = 4 * high + self.streams.symbol(d, low_row) % 4
        if n == 0:
            return 0
        a = 2 ** (n - 1) + self.streams.raw(d, n - 1)
        return signed(-a if self.streams.bits(1) else a, self.n_bits)


class Symbols:
    def __init__(self, streams: Streams) -> None:
        self.streams = streams
        self.rows: dict[tuple[int, ...], Row] = {}
        self.far: dict[int, Row] = {}
        self.weights: dict[tuple[int, int], list[np.float32]] = {}

    def decode(self, point: Point, axis: Axis) -> int:
        rows = [self.rows.setdefault(key, Row(from_mix=True)) for key in keys(point, axis)]
        weights = self.weights.setdefault((axis.turn, point.few), [F(0.25)] * 4)
        shares = [int(w * F(65530)) for w in weights]
        mix = [
            sum(row.starts[k] * w >> 16 for row, w in zip(rows, shares, strict=True))
            for k in range(16)
        ] + [2**15]
        symbol = self.streams.mixed(axis.d, mix)
        self.weights[axis.turn, point.few] = learnt(
            weights, [F(row.starts[symbol + 1] - row.starts[symbol]) for row in rows]
        )
        for row in rows:
            row.learn(symbol, mix)
        return signed(self._rest(symbol, axis), 64)

    def _rest(self, symbol: int, axis: Axis) -> int:
        by, half = axis.shift, 2**axis.shift >> 1
        if symbol < 15:
            low = self.streams.bits(by + CELL_DIGITS[symbol])
            return low + (FIRST_CELL[symbol] << by) - half
        token = self.streams.symbol(axis.d, self.far.setdefault(by, Row()))
        if token == 15:
            n = self.streams.raw(axis.d, 6)
            zigzag = (2**n | self.streams.raw(axis.d, n)) - 1
            return (zigzag >> 1) ^ -(zigzag & 1)
        negative = self.streams.bits(1)
        n = max(token // 2 - 1, 0)
        low = self.streams.bits(n + by)
        above = ((token if token < 4 else 2 + token % 2) << n | low >> by) + 16
        return ((-above if negative else above) << by) + low % 2**by - half


def keys(point: Point, axis: Axis) -> list[tuple[int, ...]]:
    d, cell = axis.d, F(2.0**-axis.shift)
    apart = (point.float(u[d] - axis.base) for u in point.kept_neighbours)
    near = int(within(min(apart, key=abs) * cell, -7, 7) + F(7.5))
    fraction = (point.expected[d] - F(axis.offset)) * (cell * F(2 if axis.is_plain else 4))
    return [
        (1, d, near, fifteenths(fraction)),
        (2, axis.turn, axis.wide, point.few),
        (3, d, axis.level, axis.wide),
        (4, axis.turn, axis.level, fifteenths(point.float(point.second[d] - axis.base) * cell)),
    ]


def learnt(weights: Sequence[np.float32], frequencies: Sequence[np.float32]) -> list[np.float32]:
    shares = [w * f for w, f in zip(weights, frequencies, strict=True)]
    gain, least = F(0.02) / total(shares), F(0.0001)
    kept = F(1) - (F(0.02) + F(4) * least)
    return [(w * kept + s * gain) + least for w, s in zip(weights, shares, strict=True)]


def total(x: Sequence[np.float32]) -> np.float32:
    return (x[0] + x[1]) + (x[2] + x[3])


def fifteenths(x: np.float32) -> int:
    return int(within(x, -7.5, 6.5) + F(7.5))
