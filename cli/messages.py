"""What goes to standard error: one line per message, never a traceback."""

import os
import signal
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from typing import Any

from ebz.codec.errors import DroppedWarning, EbzError

STDIN = "(stdin)"
STDOUT = "(stdout)"
STDERR_FD = 2
UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
CLEAR_LINE = "\r\033[K"
# Control characters from file names and file contents do not reach a terminal.
ESCAPES = {code: f"\\x{code:02x}" for code in (*range(9), *range(11, 32), 127)}


_caught: ContextVar[list[Warning | str]] = ContextVar("caught")


def encode(text: str) -> bytes:
    """The bytes of `text` for a terminal or pipe; file names that are no text come out as is."""
    try:
        return os.fsencode(text)
    except UnicodeEncodeError:
        return text.encode("ascii", "backslashreplace")


def say(text: str) -> None:
    """Writes a line to standard error; a standard error that is closed or full is no error."""
    _write(text.translate(ESCAPES) + "\n")


def _write(text: str) -> None:
    rest = encode(text)
    with suppress(OSError):
        while rest:
            rest = rest[os.write(STDERR_FD, rest) :]


def report(error: BaseException, name: str | None = None) -> None:
    """Says what went wrong, with the file `name` where the error names no other."""
    source, message = _explain(error)
    place = source or name
    say(f"ebz: {place}: {message}" if place else f"ebz: {message}")


def _explain(error: BaseException) -> tuple[str | None, str]:
    match error:
        case EbzError():
            return error.source, error.message
        case OSError(strerror=str(reason)):
            return error.filename and os.fsdecode(error.filename), reason
        case MemoryError():
            return None, "not enough memory"
        case RecursionError():
            return None, "nested too deeply"
    return None, f"internal error: {type(error).__name__}: {error}"


@contextmanager
def warnings_kept() -> Iterator[None]:
    """Hands warnings to the `warnings_of` around them, whatever the thread."""

    def keep(message: Warning | str, *_: Any, **__: Any) -> None:
        _caught.get().append(message)

    with warnings.catch_warnings():
        warnings.simplefilter("always", DroppedWarning)
        warnings.showwarning = keep
        yield


@contextmanager
def warnings_of(name: str, *, quiet: bool) -> Iterator[None]:
    """Shows the warnings kept in this context as lines about the file `name`."""
    caught: list[Warning | str] = []
    token = _caught.set(caught)
    try:
        yield
    finally:
        _caught.reset(token)
        for message in () if quiet else caught:
            say(f"ebz: warning: {name}: {message}")


def stderr_is_terminal() -> bool:
    return os.isatty(STDERR_FD)


def human_size(n_bytes: int) -> str:
    """`n_bytes` in three digits, more below 1 KiB only: 512 B, 1.21 MiB."""
    if n_bytes < 1024:
        return f"{n_bytes} B"
    size, unit = float(n_bytes), 0
    while size >= 999.5 and unit < len(UNITS) - 1:
        size, unit = size / 1024, unit + 1
    decimals = 2 if size < 9.995 else 1 if size < 99.95 else 0
    return f"{size:.{decimals}f} {UNITS[unit]}"


class Progress:
    """The progress of one file as a line on a terminal, once the work takes long enough."""

    DELAY = 1.0
    INTERVAL = 0.1

    def __init__(self, name: str, *, quiet: bool) -> None:
        self._name = name
        self._enabled = not quiet and stderr_is_terminal()
        self._next = time.monotonic() + self.DELAY
        self._shown = False

    def __call__(self, stage: str, done: int, total: int) -> None:
        if not self._enabled or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + self.INTERVAL
        self._shown = True
        percent = 100 * done // total if total else 100
        line = f"{self._name}: {stage} {percent} %".translate(ESCAPES | {9: " ", 10: " "})
        # One column is left free: a line that fills the terminal would wrap and stay.
        _write(CLEAR_LINE + line[: _columns() - 1])

    def clear(self) -> None:
        """Removes the line, so that messages start on an empty one."""
        if self._shown:
            _write(CLEAR_LINE)
        self._shown = False


def _columns() -> int:
    try:
        return os.get_terminal_size(STDERR_FD).columns or 80
    except OSError:
        return 80


def interrupted() -> int:
    """Ends the process as SIGINT does by default; returns its status where that is ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    os.kill(os.getpid(), signal.SIGINT)
    return 128 + signal.SIGINT


def discard_stdout() -> None:
    """Sends what is left in the buffers of standard output nowhere: it has failed already."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
