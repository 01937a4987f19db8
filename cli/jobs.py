"""Several inputs in turn: a failure does not stop the rest, and shows in the exit status."""

import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import NamedTuple, TypeVar

from ebz.cli import messages
from ebz.cli.atomic import sync_folder
from ebz.cli.files import Input, Output
from ebz.cli.messages import STDIN
from ebz.codec import threads

Result = TypeVar("Result")


class Manner(NamedTuple):
    """How files are treated and how much is said about it; alone: not several at a time."""

    force: bool = False
    remove: bool = False
    quiet: bool = False
    verbose: bool = False
    alone: bool = True


def is_alone(inputs: tuple[str, ...], n_threads: int) -> bool:
    """Whether one input is worked on at a time."""
    return n_threads == 1 or len(inputs) <= 1


def for_each(inputs: tuple[str, ...], work: Callable[[str], int], *, quiet: bool = False) -> int:
    """Calls `work` on every input, standard input if there is none, and returns the worst status.

    An error (1) outweighs a difference (2).
    """
    with messages.warnings_kept():
        names = inputs or ("-",)
        return _worst(_attempt(name, partial(work, name), quiet=quiet) for name in names)


def deliver_each(
    inputs: tuple[str, ...],
    prepare: Callable[[str], Callable[[], int]],
    *,
    quiet: bool,
    n_threads: int,
) -> int:
    """As for_each, in two steps: `prepare` on several threads; what it returns in turn, on this.

    Only the main thread may write whole files: it alone can catch signals.
    """

    def prepared(name: str) -> Callable[[], int] | None:
        return _attempt(name, partial(prepare, name), quiet=quiet)

    names = inputs or ("-",)
    with threads.using(n_threads), messages.warnings_kept():
        pairs = zip(names, threads.each(prepared, names), strict=True)
        return _worst(finish and _attempt(name, finish, quiet=quiet) for name, finish in pairs)


def _worst(statuses: Iterable[int | None]) -> int:
    """None stands for an error."""
    found = {1 if status is None else status for status in statuses}
    return 1 if 1 in found else max(found)


def _attempt(name: str, work: Callable[[], Result], *, quiet: bool = False) -> Result | None:
    """None where it failed, which has been said."""
    shown = STDIN if name == "-" else name
    try:
        with messages.warnings_of(shown, quiet=quiet):
            return work()
    except Exception as error:
        messages.report(error, shown)
        return None


def deliver(source: Input, output: Output, data: bytes | memoryview, manner: Manner) -> None:
    """Writes `data` to `output`, and removes the input if that is wanted and nothing is lost."""
    output.write([data])
    if manner.remove and source.is_file and output.is_file:
        sync_folder(output.path)
        source.remove()


class Summary:
    """The line about sizes that ends the work on one file."""

    def __init__(self, manner: Manner) -> None:
        self._start = time.monotonic()
        self._manner = manner

    def show(self, source: Input, output: Output, *, n_plain: int | None, n_packed: int) -> None:
        """Says how `n_plain` bytes of mesh relate to `n_packed` bytes of .ebz."""
        if not self._wanted(output) or n_plain is None:
            return
        share = f"{100 * n_packed / n_plain:.2f} %" if n_plain else "no bytes"
        plain, packed = messages.human_size(n_plain), messages.human_size(n_packed)
        line = f"{source.name}: {share} ({plain}, {packed} compressed), {output.name}"
        if self._manner.verbose:
            line += f", {n_plain / n_packed:.2f}:1, {time.monotonic() - self._start:.2f} s"
        messages.say(line)

    def _wanted(self, output: Output) -> bool:
        if self._manner.quiet:
            return False
        return self._manner.verbose or (output.is_file and messages.stderr_is_terminal())
