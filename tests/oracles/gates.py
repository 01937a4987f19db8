"""The order of gates once more, by section 9.8 of FORMAT.md."""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """To a site from the latest one, None at first."""

    site: int
    latest: int | None
    kind: int


@dataclass(frozen=True)
class Tip:
    """A site between two gates, the first of them g."""

    site: int
    g: int
    h: int


class Gates:
    """opposite, vertex: of the corners of the surface."""

    def __init__(self, opposite: Sequence[int], vertex: Sequence[int], n_sites: int) -> None:
        self.opposite, self.vertex = opposite, vertex
        self.known = [False] * n_sites
        self.first_gate: dict[int, int] = {}
        self.visited: set[int] = set()
        self.queues: tuple[deque[int], deque[int]] = deque(), deque()
        self.stack: list[int] = []
        self.latest: int | None = None

    def sites(self) -> Iterator[Step | Tip]:
        """All of them; each is known once the next one is asked for."""
        for face in range(len(self.vertex) // 3):
            if face not in self.visited:
                yield from self._component(3 * face)
        for v, known in enumerate(self.known):
            if not known:
                yield from self._step(v, 0)

    def ends(self, gate: int) -> tuple[int, int]:
        return self.vertex[gate], self.vertex[following(gate)]

    def beyond(self, gate: int) -> int | None:
        """The site across, if it is known."""
        g = self.opposite[gate]
        return self.vertex[previous(g)] if g >= 0 and self.known[self.vertex[previous(g)]] else None

    def _component(self, gate: int) -> Iterator[Step | Tip]:
        for i in range(3):
            v = self.vertex[gate + i]
            if self.known[v]:
                self.latest = v
            else:
                yield from self._step(v, min(i, 1))
        self._cross(gate)
        self._visit_from(gate)
        while self.queues[0] or self.queues[1]:
            h = (self.queues[1] or self.queues[0]).popleft()
            tip = self.vertex[previous(h)]
            if h // 3 in self.visited:
                continue
            if self.known[tip]:
                self._visit_from(h)
                continue
            g = self.first_gate[tip]
            yield Tip(tip, g, h)
            self.known[tip] = True
            self._visit_from(h)
            self._visit_from(g)

    def _step(self, v: int, kind: int) -> Iterator[Step]:
        yield Step(v, self.latest, kind)
        self.latest, self.known[v] = v, True

    def _cross(self, h: int) -> None:
        g = self.opposite[h]
        if g < 0 or g // 3 in self.visited:
            return
        tip = self.vertex[previous(g)]
        if self.known[tip]:
            self.stack.append(g)
        else:
            self.queues[tip in self.first_gate].append(g)
            self.first_gate.setdefault(tip, g)

    def _visit_from(self, h: int) -> None:
        self.stack.append(h)
        while self.stack:
            h = self.stack.pop()
            if h // 3 not in self.visited:
                self.visited.add(h // 3)
                self._cross(following(h))
                self._cross(previous(h))


def following(c: int) -> int:
    return c - 2 if c % 3 == 2 else c + 1


def previous(c: int) -> int:
    return c + 2 if c % 3 == 0 else c - 1
