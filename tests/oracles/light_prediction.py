"""What the light method expects once more, by section 9.5 of FORMAT.md, an axis at a time."""

from collections.abc import Callable, Sequence

import numpy as np

from tests.oracles.floats import F, pattern, rounded, signed, within
from tests.oracles.gates import Gates, following, previous
from tests.oracles.least_squares import Fit

N_SIDE = 6
N_KEPT = 8
FAR = 2.0**29
PRIOR, PRIOR_OF_HEIGHTS = (-0.1, 0.4, 0.1), (0, 0.5, 0.1)

Vector = list[np.float32]


class Gathered:
    """The neighbours of a tip, and its parallelograms."""

    def __init__(self, gates: Gates, g: int, h: int) -> None:
        self.gates = gates
        self.neighbours = list(gates.ends(g))
        self.parallelograms: list[tuple[int, int, int]] = []
        met = {g}
        self._gate(g)
        if not self._side(g, met, following, end=1):
            self._side(g, met, previous, end=0)
            if h not in met:
                self.neighbours += gates.ends(h)
                self._gate(h)

    def _gate(self, gate: int) -> None:
        beyond = self.gates.beyond(gate)
        if beyond is not None:
            self.parallelograms.append((*self.gates.ends(gate), beyond))

    def _side(self, g: int, met: set[int], turn: Callable[[int], int], end: int) -> bool:
        """Whether it goes all around."""
        gate = g
        for _ in range(N_SIDE):
            e = self.gates.opposite[turn(gate)]
            if e < 0:
                return False
            gate = turn(e)
            if gate == g:
                return True
            new = self.gates.ends(gate)[end]
            if not self.gates.known[new]:
                return False
            met.add(gate)
            self.neighbours.append(new)
            self._gate(gate)
        return False


class Point:
    """Of a site: what is expected of it.  at, residual: of all sites known."""

    def __init__(
        self,
        around: Gathered,
        at: Sequence[Sequence[int]],
        residual: Sequence[Sequence[int]],
        n_bits: int,
    ) -> None:
        self.n_bits = n_bits
        self.g = around.parallelograms[0]
        tips = [
            [self.signed(at[a][d] + at[b][d] - at[o][d]) for d in range(3)]
            for a, b, o in around.parallelograms
        ]
        self.first = tips[0]
        self.n_tips, self.n_neighbours = len(tips), len(around.neighbours)
        self.kept_neighbours = kept([at[u] for u in around.neighbours])
        self.second = tips[min(1, len(tips) - 1)]
        self.near, self.drift, self.size = zeros(), zeros(), zeros()
        self.tips, self.spread, self.ahead, self.normal = zeros(), zeros(), zeros(), zeros()
        for u in around.neighbours:
            self._add_neighbour(at[u], residual[u])
        for i, tip in enumerate(tips):
            self._add_tip(tip, tips[max(i - 1, 0)])
        for a, b, o in around.parallelograms:
            self._add_edges(at[a], at[b], at[o])
        self.n: Vector | None = None
        self.last: int | None = None
        self.plain, self.expected = zeros(), zeros()
        self.refined = self.expected
        self.inputs: list[Vector] = []
        self.slid: np.float32 | None = None

    def signed(self, x: int) -> int:
        return signed(x, self.n_bits)

    def float(self, x: int) -> np.float32:
        limit = 2**42 if self.n_bits == 64 else 2**31
        return F(min(max(self.signed(x), -limit), limit))

    def _add_neighbour(self, at: Sequence[int], residual: Sequence[int]) -> None:
        for d in range(3):
            self.near[d] += self.float(at[d] - self.first[d])
            self.drift[d] += self.float(residual[d])
            self.size[d] += abs(self.float(residual[d]))

    def _add_tip(self, tip: Sequence[int], before: Sequence[int]) -> None:
        for d in range(3):
            self.tips[d] += self.float(tip[d] - self.first[d])
            self.spread[d] += abs(self.float(tip[d] - before[d]))

    def _add_edges(self, a: Sequence[int], b: Sequence[int], o: Sequence[int]) -> None:
        u = [self.float(a[d] - o[d]) * F(2.0**-20) for d in range(3)]
        w = [self.float(b[d] - o[d]) * F(2.0**-20) for d in range(3)]
        for d in range(3):
            self.ahead[d] += self.float(a[d] - o[d] + b[d] - o[d])
            i, j = (d + 1) % 3, (d + 2) % 3
            self.normal[d] += u[i] * w[j] - u[j] * w[i]

    @property
    def few(self) -> int:
        return min(self.n_tips, 4)

    def scale(self, d: int) -> tuple[np.float32, np.float32]:
        """And the spread."""
        size = self.size[d] * (F(1) / F(self.n_neighbours))
        spread = self.spread[d] * (F(1) / F(self.n_tips - 1)) if self.n_tips > 1 else size
        of_size, of_spread = (0.75, 0.1) if d == self.last else (0.6, 0.25)
        return size * F(of_size) + spread * F(of_spread), spread


class Predictor:
    def __init__(self, *, slides: bool) -> None:
        self.slides = slides
        self.fits = [Fit(PRIOR) for _ in range(5)]
        self.heights = [Fit(PRIOR_OF_HEIGHTS) for _ in range(5)]
        self.lead = [[F(0)] * 3, [F(0)] * 3]
        self.with_slide, self.without = F(1), F(1)
        self.toward, self.mean = F(4), F(1)

    def predict(self, point: Point) -> None:
        share, each = F(1) / F(point.n_tips), F(1) / F(point.n_neighbours)
        point.plain = [limited(x * share) for x in point.tips]
        point.inputs = [
            [x * (F(0.5) * share) for x in point.ahead],
            [x * each - plain for x, plain in zip(point.near, point.plain, strict=True)],
            [x * each for x in point.drift],
        ]
        fit = self.fits[point.few]
        moved = [fit.output([x[d] for x in point.inputs]) for d in range(3)]
        square = dot(point.normal, point.normal)
        if self.slides and square > 0:
            n = point.n = [x * (F(1) / np.sqrt(square)) for x in point.normal]
            height = self.heights[point.few].output([dot(x, n) for x in point.inputs])
            lift = height - dot(moved, n)
            moved = [x + of_n * lift for x, of_n in zip(moved, n, strict=True)]
            point.last = max(range(3), key=lambda d: (abs(n[d]), d))
        point.refined = [
            limited(plain + limited(x)) for plain, x in zip(point.plain, moved, strict=True)
        ]
        point.expected = list(point.refined)

    def slide(self, point: Point, at: Sequence[int]) -> None:
        """The last axis' expectation, by positions on the others."""
        d = point.last
        assert d is not None and point.n is not None
        r = [point.float(x - y) - z for x, y, z in zip(at, point.first, point.refined, strict=True)]
        r[d] = F(0)
        c = point.n[d]
        w = c * c * max(F(3) * self.toward / self.mean - F(1), F(0))
        point.slid = -w / (F(1) + w) * (dot(r, point.n) / c)
        if self.with_slide < self.without:
            point.expected[d] = limited(point.refined[d] + point.slid)

    def is_plain(self, point: Point, d: int) -> bool:
        return bool(self.lead[d == point.last][d] <= 0)

    def base(self, point: Point, d: int) -> tuple[int, int]:
        """Its offset from the first tip, too."""
        offset = rounded((point.plain if self.is_plain(point, d) else point.expected)[d])
        return point.signed(point.first[d] + offset), offset

    def learn(self, point: Point, at: Sequence[int]) -> None:
        x = [point.float(p - q) for p, q in zip(at, point.first, strict=True)]
        for d in range(3):
            lead = error(x[d] - point.plain[d]) - error(x[d] - point.expected[d])
            of = self.lead[d == point.last]
            of[d] += (lead - of[d]) * F(0.01)
        if point.n is not None:
            self._learn_slide(point, x)
        y = [p - q for p, q in zip(x, point.plain, strict=True)]
        weight = F(9) / (F(1) + dot(point.inputs[0], point.inputs[0]))
        for d in range(3):
            self.fits[point.few].add(d, [z[d] for z in point.inputs], y[d], weight)
        self.fits[point.few].tick()
        if point.n is not None:
            inputs = [dot(z, point.n) for z in point.inputs]
            self.heights[point.few].add(0, inputs, dot(y, point.n), weight)
            self.heights[point.few].tick()

    def _learn_slide(self, point: Point, x: Vector) -> None:
        assert point.n is not None and point.last is not None and point.slid is not None
        r = [p - q for p, q in zip(x, point.refined, strict=True)]
        u, v = abs(r[point.last]), abs(r[point.last] - point.slid)
        k = F(0.005) / ((F(1) + v) + u)
        self.with_slide += v * k - self.with_slide * F(0.005)
        self.without += u * k - self.without * F(0.005)
        d = dot(r, point.n)
        s = d * d / (dot(r, r) + F(0.1))
        self.mean += (s + F(0.001) - self.mean) * F(0.02)
        self.toward += ((F(1) - s) * F(0.5) + F(0.01) - self.toward) * F(0.02)


def kept(points: Sequence[Sequence[int]]) -> list[Sequence[int]]:
    found: list[Sequence[int]] = []
    for i, point in enumerate(points):
        if i < N_KEPT:
            found.append(point)
        else:
            found[i % N_KEPT] = point
    return found


def error(x: np.float32) -> np.float32:
    return F(pattern(abs(x) + F(1)))


def limited(x: np.float32) -> np.float32:
    return within(x, -FAR, FAR)


def zeros() -> Vector:
    return [F(0), F(0), F(0)]


def dot(x: Sequence[np.float32], y: Sequence[np.float32]) -> np.float32:
    return (x[0] * y[0] + x[1] * y[1]) + x[2] * y[2]
