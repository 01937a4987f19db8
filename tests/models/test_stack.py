"""The stack table forbids just what the language forbids, and no word costs more than certified."""

import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.models.certificate import Certificate
from ebz.codec.models.certify_stack import certify_stack
from ebz.codec.models.fit_stack import fit_stack
from ebz.codec.models.language import Stack, successors
from ebz.codec.models.stack import UNKNOWN, Loop, StackTable
from ebz.codec.models.table import FREQUENCY_BITS, SYMBOLS, TOTAL, C, E, S
from tests.models.words import random_word

TABLE = StackTable.load("stack")
CERTIFICATE = certify_stack(TABLE)
BITS = FREQUENCY_BITS - np.log2(np.maximum(TABLE.frequencies, 1))


def cost(table: StackTable, word: str, special: list[int]) -> float:
    """The bits of a word, its first E included; special S are not coded."""
    stack, total = table.start(), 0.0
    for position, letter in enumerate(word):
        symbol = SYMBOLS.index(letter)
        if position not in special:
            frequency = int(table.frequencies[table.row(stack[-1]), symbol])
            assert frequency, f"symbol {position} ({letter}) is forbidden"
            total += FREQUENCY_BITS - np.log2(frequency)
        table.apply(stack, symbol, special=position in special)
    return total


def limit(found: Certificate, n_c: int, n_other: int, n_loops: int, n_special: int) -> float:
    """What the certificate grants a word that leaves that many loops."""
    return (
        found.bits_per_word
        + found.bits_per_c * n_c
        + found.bits_per_other * n_other
        + found.bits_per_component * n_loops
        + found.bits_per_special * n_special
    )


def perturbed(seed: int) -> StackTable:
    """A valid table of the shipped shape, with random shares."""
    rng = np.random.default_rng(seed)
    allowed = TABLE.frequencies > 0
    frequencies = np.where(allowed, rng.integers(1, 8000, allowed.shape), 0)
    frequencies[:, E] += TOTAL - frequencies.sum(axis=1)
    return StackTable("x", frequencies.astype(np.uint32), TABLE.top, TABLE.step, TABLE.bottom)


def test_the_bound_of_the_stack_table() -> None:
    assert CERTIFICATE.bits_per_vertex < 3.2586
    assert CERTIFICATE.bits_per_word + CERTIFICATE.bits_per_component < 64


def test_no_word_of_13_triangles_is_forbidden_or_costs_more() -> None:
    """All stacks, each with the costliest of the words that lead to it by as many C."""
    level: dict[tuple[Stack, tuple[Loop, ...], int], float] = {((), tuple(TABLE.start()), 0): 0.0}
    for n_triangles in range(1, 14):
        following: dict[tuple[Stack, tuple[Loop, ...], int], float] = {}
        for (exact, stack, n_c), bits in level.items():
            row = TABLE.row(stack[-1])
            for symbol, after in successors(exact):
                assert TABLE.frequencies[row, symbol] > 0
                loops = list(stack)
                TABLE.apply(loops, symbol)
                key = after, tuple(loops), n_c + (symbol == C)
                following[key] = max(following.get(key, 0.0), bits + float(BITS[row, symbol]))
        level = following
        for (exact, _, n_c), bits in level.items():
            assert bits <= limit(CERTIFICATE, n_c, n_triangles - n_c, len(exact), 0)


@settings(deadline=None)
@given(
    st.integers(0, 2**32).map(random.Random),
    st.lists(st.floats(0.01, 1), min_size=5, max_size=5),
    st.sampled_from([0.0, 0.05, 0.5]),
)
def test_no_word_costs_more_than_certified(
    rng: random.Random, weights: list[float], special_share: float
) -> None:
    word, special = random_word(rng, 400, weights, special_share)
    n_loops = word.count("E") - word.count("S") + len(special)
    n_c = word.count("C")
    most = limit(CERTIFICATE, n_c, len(word) - n_c - len(special), n_loops, len(special))
    assert cost(TABLE, word, special) <= most


def test_certificates_hold_for_any_table() -> None:
    table = perturbed(1)
    found = certify_stack(table)
    for word_seed in range(5):
        word, special = random_word(random.Random(word_seed), 400, [1.0] * 5, 0.02)
        n_loops = word.count("E") - word.count("S") + len(special)
        n_c = word.count("C")
        most = limit(found, n_c, len(word) - n_c - len(special), n_loops, len(special))
        assert cost(table, word, special) <= most


def test_after_a_special_s_the_length_stays_unknown() -> None:
    stack = TABLE.start()
    for letter in "ERR":
        TABLE.apply(stack, SYMBOLS.index(letter))
    TABLE.apply(stack, S, special=True)
    for letter in "RCLECS":
        TABLE.apply(stack, SYMBOLS.index(letter))
    assert [length for length, _, _ in stack] == [UNKNOWN, UNKNOWN]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.frequencies.__setitem__((7, S), t.frequencies[7, S] + 1), "row 7 sums to"),
        (lambda t: t.step.__setitem__((2, 5), 200), r"step\[2\]\[5\] is not a class"),
        (lambda t: t.step.__setitem__((t.bottom, -1), t.bottom - 1), "virtual loop"),
        (lambda t: t.top.__setitem__((9, 3), 200), r"top\[9\]\[3\] is not a column"),
        (lambda t: setattr(t, "bottom", 200), "bottom 200 is not a class"),
        (lambda t: setattr(t, "step", t.step[:, :4]), "clipped length"),
        (lambda t: setattr(t, "frequencies", t.frequencies[:-1]), "frequencies of shape"),
        (lambda t: setattr(t, "top", np.zeros((100, 9), np.uint8)), "of shape"),
    ],
)
def test_malformed_tables_are_refused(change, message: str) -> None:  # type: ignore[no-untyped-def]
    table = StackTable(
        "x", TABLE.frequencies.copy(), TABLE.top.copy(), TABLE.step.copy(), TABLE.bottom
    )
    change(table)
    with pytest.raises(OptionError, match=message):
        certify_stack(table)


def test_a_forbidden_c_is_unsound() -> None:
    table = StackTable("x", TABLE.frequencies.copy(), TABLE.top, TABLE.step, TABLE.bottom)
    row = TABLE.row((6, 2, 3))
    table.frequencies[row, E] += table.frequencies[row, C]
    table.frequencies[row, C] = 0
    with pytest.raises(OptionError, match=r"unsound: row .* forbids C"):
        table.check()


def test_a_table_survives_its_file() -> None:
    again = StackTable.from_bytes(TABLE.to_bytes())
    assert (again.frequencies == TABLE.frequencies).all()
    assert again.to_bytes() == TABLE.to_bytes()


def test_fitting_keeps_what_it_promises() -> None:
    """Fewer lengths told apart than in the table that ships: 3.2857."""
    table = fit_stack(length_max=8, conflict_max=4)
    assert certify_stack(table).bits_per_vertex < 3.286
