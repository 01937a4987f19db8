"""Files that appear whole or not at all.

The bytes are complete before the temporary file is created, so that signals need no care while
the codec works: they have their default action and end the process at once, even in the middle
of a long call into a kernel. Only while the temporary file exists, INT, TERM and HUP are caught
by handlers that take a note. The loop below looks at the note between two pieces, removes the
file and then lets the signal do what it does by default. Blocking the signals instead would not
do: another thread, of a BLAS for instance, may take them and end the process.
"""

import errno
import os
import signal
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

from ebz.codec.errors import EbzError

ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PIECE_BYTES = 1 << 20


def write_whole(
    target: str, chunks: Iterable[bytes | memoryview], *, like: os.stat_result | None, replace: bool
) -> None:
    """Writes `chunks` to a new file at `target`, with mode, owner and times of `like` where given.

    Without `replace`, a file that is there already is an error, even if it has just appeared.
    A symbolic link at `target` is replaced itself, not followed, as zstd and mv do.
    """
    path = Path(target)
    temporary = path.with_name(f".ebz-{os.urandom(8).hex()}.tmp")
    with _noted_signals() as noted:
        # Nobody may read the copy of a private file, not even before it has its final mode.
        mode = 0o600 if like else 0o666
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode)
        try:
            try:
                for piece in _pieces(chunks):
                    write_all(descriptor, piece)
                    _stop_if(noted)
                if like:
                    _copy_status(descriptor, like)
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
            _stop_if(noted)
            _publish(temporary, path, replace=replace)
        finally:
            with suppress(FileNotFoundError):
                temporary.unlink()


def write_all(descriptor: int, data: bytes | memoryview) -> None:
    """Writes all of `data`, however many calls that takes."""
    rest = memoryview(data).cast("B")
    while rest:
        rest = rest[os.write(descriptor, rest) :]


def sync_folder(path: str) -> None:
    """Makes the new name of the file at `path` durable, where the file system can."""
    with suppress(OSError):
        descriptor = os.open(Path(path).parent, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@contextmanager
def _noted_signals() -> Iterator[list[int]]:
    noted: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        noted.append(number)

    previous = {
        number: signal.signal(number, note)
        for number in ENDING_SIGNALS
        if signal.getsignal(number) != signal.SIG_IGN
    }
    try:
        yield noted
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
        if noted:
            os.kill(os.getpid(), noted[0])


def _stop_if(noted: list[int]) -> None:
    if noted:
        raise KeyboardInterrupt


def _pieces(chunks: Iterable[bytes | memoryview]) -> Iterator[memoryview]:
    for chunk in chunks:
        view = memoryview(chunk).cast("B")
        for start in range(0, len(view), PIECE_BYTES):
            yield view[start : start + PIECE_BYTES]


def _copy_status(descriptor: int, like: os.stat_result) -> None:
    mode = like.st_mode & 0o777
    with suppress(OSError):
        os.fchown(descriptor, like.st_uid, -1)
    try:
        os.fchown(descriptor, -1, like.st_gid)
    except OSError:
        # Our own group may do no more than others may.
        mode &= 0o707 | (mode & 0o007) << 3
    os.fchmod(descriptor, mode)
    os.utime(descriptor, ns=(like.st_atime_ns, like.st_mtime_ns))


def _publish(temporary: Path, path: Path, *, replace: bool) -> None:
    if not replace:
        try:
            path.hardlink_to(temporary)
            return
        except FileExistsError:
            raise already_exists(str(path)) from None
        except OSError as error:
            # File systems without hard links: the check that was made before has to do.
            if error.errno not in (errno.EPERM, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK):
                raise
    temporary.replace(path)


def already_exists(path: str) -> EbzError:
    """The error about an output that would be overwritten."""
    return EbzError("already exists; use -f to overwrite it", source=path)
