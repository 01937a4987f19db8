"""The entry point of the shell tool: nothing heavy is imported before signals are in order."""

import gc
import os
import signal
import sys

# Signals that end the process quietly, by their own means, so that a shell sees 128 + signal.
QUIET = (signal.SIGINT, signal.SIGPIPE)

LONG_LIVED = 100_000


def main() -> None:
    """Runs the command line and ends the process: 0 fine, 1 an error, 2 a difference."""
    for number in QUIET:
        # Python itself ignores SIGPIPE; an inherited "ignore" of SIGINT (nohup, `&`) is kept.
        if number == signal.SIGPIPE or signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, signal.SIG_DFL)
    _occupy_standard_descriptors()
    # No command multiplies large matrices; starting a thread per core takes tens of milliseconds.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Importing makes this many objects, all of which stay: there is no garbage to look for.
    gc.set_threshold(LONG_LIVED)
    from ebz.cli import group

    status = group.run(sys.argv[1:])
    # All output is flushed; taking the interpreter apart would cost a tenth of the run time.
    os._exit(status)


def _occupy_standard_descriptors() -> None:
    """A descriptor closed by the caller (`>&-`) must not become that of the first file opened.

    It is opened the wrong way round, so that using it fails as if it were still closed.
    """
    for descriptor, flags in ((0, os.O_WRONLY), (1, os.O_RDONLY), (2, os.O_RDONLY)):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, flags)
