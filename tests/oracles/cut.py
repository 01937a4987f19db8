"""Triangles that predict positions of polygons once more, by section 9.9 of FORMAT.md."""

from collections import deque
from dataclasses import dataclass, field
from itertools import pairwise


@dataclass
class Cutter:
    """vertex, across: of each half-edge of the polygons, which begin at `offsets`."""

    vertex: list[int]
    offsets: list[int]
    across: list[int]
    cut: int
    known: set[int] = field(default_factory=set)
    visited: dict[int, int] = field(default_factory=dict)  # polygons, to the gate of each
    diagonal: dict[int, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        ends = list(pairwise(self.offsets))
        self.face = [f for f, (a, b) in enumerate(ends) for _ in range(a, b)]
        self.corners = [list(range(a, b)) for a, b in ends]
        self.degree = [self.vertex.count(v) for v in range(max(self.vertex, default=-1) + 1)]

    def turned(self, gate: int) -> list[int]:
        corners = self.corners[self.face[gate]]
        at = corners.index(gate)
        return corners[at:] + corners[:at]

    def place(self, h: int) -> int:
        return h - self.offsets[self.face[h]]

    def order(self) -> None:
        stack: list[int] = []
        near: deque[int] = deque()
        far: deque[int] = deque()
        met = set()
        for corners in self.corners:
            if len(corners) >= 3:
                far.append(corners[0])
            while stack or near or far:
                gate = stack.pop() if stack else (near or far).popleft()
                if self.face[gate] in self.visited:
                    continue
                self.visit(gate)
                for side in self.turned(gate):
                    h = self.across[side]
                    if h < 0 or self.face[h] in self.visited:
                        continue
                    around = self.corners[self.face[h]]
                    n_unknown = sum(self.vertex[c] not in self.known for c in around)
                    if n_unknown == 0:
                        stack.append(h)
                    elif n_unknown < len(around) - 2 or self.face[h] in met:
                        near.append(h)
                    else:
                        met.add(self.face[h])
                        far.append(h)

    def visit(self, gate: int) -> None:
        face = self.face[gate]
        if len(self.corners[face]) == 4:
            d = self.diagonal[face] = self.choose(gate)
            for end in self.corners[face][d::2]:
                self.degree[self.vertex[end]] += 1
        self.visited[face] = gate
        self.known |= {self.vertex[c] for c in self.corners[face]}

    def choose(self, gate: int) -> int:
        sizes = [len(corners) for corners in self.corners]
        corners = self.corners[self.face[gate]]
        if sizes.count(3) > sizes.count(4):
            degrees = [self.degree[self.vertex[c]] for c in corners]
            return int(degrees[0] + degrees[2] > degrees[1] + degrees[3])
        unknown = [c for c in corners if self.vertex[c] not in self.known]
        if self.cut == 0 and len(unknown) == 1:
            return (self.place(unknown[0]) + 1) % 2
        votes = []
        for side in self.turned(gate):
            h = self.across[side]
            if h >= 0 and self.face[h] in self.diagonal:
                wanted = self.place(side) + self.place(h) + self.diagonal[self.face[h]]
                votes.append(wanted % 2)
        if not votes:
            return self.place(gate) % 2
        return votes[0] if 2 * sum(votes) == len(votes) else int(2 * sum(votes) > len(votes))

    def triangles(self) -> list[tuple[int, int, int]]:
        self.order()
        made = []
        for sheet in range(2 if self.cut == 2 else 1):
            for face, gate in self.visited.items():
                left = self.diagonal.get(face) != self.place(gate) % 2
                a, b, *rest = self.turned(gate)
                left ^= sheet == 1
                while rest:
                    tip = rest.pop() if left else rest.pop(0)
                    made.append((a, b, tip))
                    a, b = (tip, b) if left else (a, tip)
                    left = not left
        return made


def opposites(triangles: list[tuple[int, int, int]], across: list[int], n_sheets: int) -> list[int]:
    """The half-edge across each of the triangles: of a diagonal, or as the polygons are joined."""
    edges = [(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)]
    size, found = len(edges) // n_sheets, []
    for first in range(0, len(edges), size or 1):
        sheet = {edge: first + i for i, edge in enumerate(edges[first : first + size])}
        sides = {a: h for (a, b), h in sheet.items() if (b, a) not in sheet}
        found += [sheet.get((b, a), sides.get(across[a], -1)) for a, b in sheet]
    return found
