"""Rows of labels once more, by section 12.5 of FORMAT.md: encoder and decoder in one."""

from tests.oracles.decisions import Coder, Decisions, key

Rows = list[list[int]]
N = 8


def code_symbols(coder: Coder, rows: Rows) -> None:
    """The rows are written as they are read."""
    n, width = len(rows), len(rows[0])
    most = max(max(row) for row in rows)
    n_bits = min(max(coder.raw(most.bit_length(), 5), 1), 16)
    decisions = Decisions(coder, n * width, "weights_of_symbols", lambda _: 8)
    history = [[0] * N for _ in range(min(width, 64))]
    for r in range(n):
        hits: set[int] = set()
        for c in range(width):
            label = {k: rows[r - 1 - k][c] for k in range(min(r, 3))}
            label |= {4 + k: rows[r - 1 - k][c] for k in range(min(r, 2))}
            label |= {6 + k: rows[r][c - 1 - k] for k in range(min(c, 2))}
            past = history[min(c, 63)]
            told = [8 * (0 if c == 0 else 1 + (k in hits)) + past[k] for k in range(N)]
            decisions.consider(label, told)
            contexts = _contexts_of_label(label, min(r, 3), c)
            value = _code_label(decisions, contexts, label, n_bits, rows[r][c], c)
            rows[r][c] = value
            hits = {k for k, x in label.items() if x == value}
            decisions.settle(hits)
            for k in label:
                past[k] = (2 * past[k] + (k in hits)) % 8


def _contexts_of_label(label: dict[int, int], n: int, c: int) -> list[int]:
    of = [label.get(k, 0xFFFFF) for k in range(N)]
    x = [0, 0, 0, of[2], 0, 0, of[7], n]
    y = [0, 0, of[1], of[1], of[5], of[6], of[6], of[4]]
    z = [0, of[0], of[0], of[0], of[4], of[0], 0 if c > 0 else of[4], of[0]]
    packed = (a << 40 | b << 20 | d for a, b, d in zip(x, y, z, strict=True))
    return [key(i << 8 | min(c, 255), value) for i, value in enumerate(packed)]


def _code_label(
    decisions: Decisions,
    contexts: list[int],
    label: dict[int, int],
    n_bits: int,
    value: int,
    turn: int,
) -> int:
    known = slot = 1
    for node in range(n_bits):
        left = n_bits - 1 - node
        if node % 4 == 0:
            decisions.enter([key(context, known) for context in contexts])
            slot = 0
        upper = {k for k in decisions.alive if label[k] >> left & 1}
        level = min(len(decisions.alive), 11)
        bit = decisions.code(bool(value >> left & 1), node, slot, turn, level, upper)
        known, slot = 2 * known + bit, 2 * slot + 1 + bit
    return known - (1 << n_bits)
