"""Sound loop automata: what a finite memory of the decoder's stack of loops forbids.

S. Gumhold, Optimizing Markov Models with Applications to Triangular Connectivity Coding, 2005,
section 6.  The decoder (Isenburg and Snoeyink 2000, reverse) holds a stack of loops; a loop has a
length l and a conflict k: the k-th C from now is the first that the loop does not allow.  Unlike
in the paper, a state here is a tuple of *upper bounds*

    (l1, k1, l2, l3, ...)       UNBOUNDED where nothing is known

of the top loop's length and conflict and of the lengths of the loops below.  Bounds are enough:
C is forbidden exactly when k1 = 1, every rule below is monotone in every bound, and so replacing
a state by any other with larger bounds never forbids what the stack allows (soundness).  That is
also where the paper's redirect of long loops to [(3, .)] fails: it replaces bounds by smaller ones.

The length forbids too: a loop of three edges allows no C, so k <= l - 2 always.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ebz.codec.errors import OptionError
from ebz.codec.models.automaton import Automaton, build
from ebz.codec.models.table import SYMBOLS, C, E, L, R, S

State = tuple[int, ...]

UNBOUNDED = 255
UNKNOWN: State = (UNBOUNDED, UNBOUNDED)
# #C = #L + #R + #S + #E and #S = #E, up to a constant: each C closes a vertex that one other
# symbol opened, S joins two of the loops that E made.
CONSTRAINTS = ((1, -1, -1, -1, -1), (0, 0, 0, 1, -1))
SYMBOLS_PER_VERTEX = 2


def conflict(length: int, k: int) -> int:
    """The first C that is not allowed: the k-th, or the one that would leave two edges."""
    return min(k, length - 2) if length != UNBOUNDED else k


def successors(state: State) -> Iterator[tuple[int, State]]:
    """Each symbol that the bounds allow, with the bounds after it."""
    length, k, *below = state
    if k != 1:
        yield C, canonical((_add(length, -1), _add(k, -1), *below))
    yield L, canonical((_add(length, 1), 1, *below))
    yield R, canonical((_add(length, 1), UNBOUNDED, *below))
    yield E, canonical((3, 1, length, *below))
    if below:
        joined = min(length + below[0] - 1, UNBOUNDED)
        yield S, canonical((joined, _add(below[0], -1), *below[1:]))
    else:
        yield S, UNKNOWN


def canonical(state: State) -> State:
    """The same bounds with k no looser than l implies, and without trailing unknown loops."""
    length, k, *below = state
    while below and below[-1] == UNBOUNDED:
        below.pop()
    return (length, conflict(length, k), *below)


def clipped(state: State, loops: int, max_length: int, max_conflict: int) -> State:
    """The bounds that are within the limits; the others become unknown."""
    length, k, *below = state
    lengths = [x if x <= max_length else UNBOUNDED for x in (length, *below[: loops - 1])]
    return canonical((lengths[0], k if k <= max_conflict else UNBOUNDED, *lengths[1:]))


def loop_automaton(
    loops: int, max_length: int, max_conflict: int, max_states: int = 1 << 20
) -> Automaton:
    """The sound automaton that knows `loops` loops, lengths and conflicts up to the limits.

    The paper's section 6, with bounds in place of its redirect.

    State 0 is the unknown stack.  Raises OptionError where a limit is out of range or there are
    more than max_states states.
    """
    if not (1 <= loops <= 8 and 3 <= max_length < UNBOUNDED and 1 <= max_conflict < UNBOUNDED):
        raise OptionError(
            f"loop automaton: {loops} loops, length {max_length}, conflict {max_conflict}: "
            "need 1 to 8 loops, lengths of 3 to 254 and conflicts of 1 to 254"
        )

    def step(state: State) -> Iterable[tuple[int, State]]:
        for symbol, target in successors(state):
            yield symbol, clipped(target, loops, max_length, max_conflict)

    return build(SYMBOLS, UNKNOWN, step, max_states)


def redirected_automaton(loops: int, max_length: int) -> Automaton:
    """The paper's automaton, which sends a stack with a loop above the limit to [(3, .)].

    It is *not* sound: it forbids C after any longer loop.  Only for comparison.
    """
    start: State = (3, 1)

    def step(state: State) -> Iterable[tuple[int, State]]:
        for symbol, target in successors(state):
            known = canonical(target[: loops + 1])
            long = any(max_length < x < UNBOUNDED for x in (known[0], *known[2:]))
            yield symbol, start if long else known

    return build(SYMBOLS, start, step).minimised()


def accepts(automaton: Automaton, word: str) -> bool:
    """Whether the automaton allows the reverse CLRSE word."""
    state = 0
    for symbol in word:
        state = int(automaton.targets[state, SYMBOLS.index(symbol)])
        if state < 0:
            return False
    return True


def _add(bound: int, step: int) -> int:
    """The bound after a step; Invariant: no bound is above UNBOUNDED, which absorbs."""
    return bound if bound == UNBOUNDED else min(bound + step, UNBOUNDED)
