"""The exact language of reverse CLRSE words: the rules of the decoder's stack, without bounds.

M. Isenburg and J. Snoeyink, Spirale Reversi, 2000; conflicts as in S. Gumhold's paper.  Counting
the words that end in one loop of three edges gives Tutte's numbers 1, 1, 3, 13, 68, 399, 2530, so
the rules are complete: a model that forbids more is wrong.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ebz.codec.errors import OptionError
from ebz.codec.models.table import FREQUENCY_BITS, SYMBOLS, C, E, L, R, S, Table

# Loops from the top down: (length, conflict), conflict 0 where no C is forbidden.
Stack = tuple[tuple[int, int], ...]

N_CHECKED_TRIANGLES = 13


def successors(stack: Stack) -> Iterator[tuple[int, Stack]]:
    """Each symbol that the stack allows, with the stack after it; no loop allows only E."""
    if stack:
        (length, k), rest = stack[0], stack[1:]
        if length > 3 and k != 1:
            yield C, ((length - 1, max(k - 1, 0)), *rest)
        yield L, ((length + 1, 1), *rest)
        yield R, ((length + 1, 0), *rest)
        if rest:
            below = rest[0][0]
            yield S, ((length + below - 1, below - 1), *rest[1:])
    yield E, ((3, 0), *stack)


def check_stacks(table: Table, n_triangles: int = N_CHECKED_TRIANGLES) -> int:
    """Drive the table through every stack of at most n_triangles; returns how many pairs it met.

    Raises OptionError, with the word, where a state forbids what the stack allows.
    """
    allowed = (table.frequencies > 0).tolist()
    to = table.successors.tolist()
    level: dict[tuple[int, Stack], str] = {(0, ()): ""}
    n_met = 0
    for _ in range(n_triangles):
        following: dict[tuple[int, Stack], str] = {}
        for (state, stack), word in level.items():
            for symbol, after in successors(stack):
                if not allowed[state][symbol]:
                    raise OptionError(
                        f"model {table.name!r}: unsound: state {state} forbids "
                        f"{SYMBOLS[symbol]} after the word {word}"
                    )
                following[to[state][symbol], after] = word + SYMBOLS[symbol]
        level = following
        n_met += len(level)
    return n_met


def word_bits(table: Table, word: str, special: Iterable[int] = ()) -> float:
    """The cost in bits of a reverse CLRSE word; `special` are the positions of its special S.

    A special S is not coded.

    Raises OptionError, with the position, where the table forbids a symbol.
    """
    bits = (FREQUENCY_BITS - np.log2(np.maximum(table.frequencies, 1))).tolist()
    forbidden = (table.frequencies == 0).tolist()
    to = table.successors.tolist()
    resets = frozenset(special)
    state, total = 0, 0.0
    for position, letter in enumerate(word):
        symbol = SYMBOLS.index(letter)
        if position in resets:
            state = 0
            continue
        if forbidden[state][symbol]:
            raise OptionError(f"model {table.name!r}: symbol {position} ({letter}) is forbidden")
        total += bits[state][symbol]
        state = to[state][symbol]
    return total
