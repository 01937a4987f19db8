"""Inputs and outputs by name: what may be read, what may be written, and what it is called."""

import os
import re
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ebz.cli import atomic
from ebz.cli.messages import STDIN, STDOUT
from ebz.codec.errors import EbzError, MemoryLimitError

SUFFIX = ".ebz"
PIECE_BYTES = 1 << 20
STANDARD = {"/dev/stdin": 0, "/dev/stdout": 1, "/dev/stderr": 2}


def descriptor_of(name: str) -> int | None:
    """The open descriptor that `name` stands for: /dev/stdout, /dev/fd/3."""
    numbered = re.fullmatch(r"/dev/fd/(\d{1,9})", name)
    return int(numbered[1]) if numbered else STANDARD.get(name)


class Input:
    """An input that may be read: a regular file, a pipe, or standard input for "-".

    As in zstd, a symbolic link has to be forced, and folders and devices are refused.
    """

    def __init__(self, name: str, *, force: bool = False, follow: bool = False) -> None:
        self.descriptor = 0 if name == "-" else descriptor_of(name)
        self.name = STDIN if name == "-" else name
        self.path = name
        self.n_bytes: int | None = None
        self._force = force
        with _named(self.name):
            self.status = self._status() if self.descriptor is None else os.fstat(self.descriptor)
        self._check(follow or force)
        self.is_file = self.descriptor is None and stat.S_ISREG(self.status.st_mode)

    def _status(self) -> os.stat_result:
        return Path(self.path).stat()

    def _check(self, follow: bool) -> None:
        mode = self.status.st_mode
        if stat.S_ISDIR(mode):
            raise EbzError("is a folder", source=self.name)
        if self.descriptor is not None:
            if os.isatty(self.descriptor) and not self._force:
                raise EbzError("is a terminal: name a file, or use a pipe", source=self.name)
        elif not (stat.S_ISREG(mode) or stat.S_ISFIFO(mode)):
            raise EbzError("is neither a file nor a pipe", source=self.name)
        elif stat.S_ISREG(mode) and not follow and Path(self.path).is_symlink():
            raise EbzError("is a symbolic link; use -f to follow it", source=self.name)

    def read(self, limit: int | None = None) -> bytes:
        """All bytes; MemoryLimitError where there are more than `limit`."""
        with _named(self.name):
            if self.descriptor is not None:
                return self._read_all(self.descriptor, limit)
            opened = os.open(self.path, os.O_RDONLY)
            try:
                return self._read_all(opened, limit)
            finally:
                os.close(opened)

    def _read_all(self, descriptor: int, limit: int | None) -> bytes:
        pieces, n_bytes = [], 0
        expected = self.status.st_size if stat.S_ISREG(self.status.st_mode) else 0
        _check_limit(expected, limit)
        while piece := os.read(descriptor, max(PIECE_BYTES, expected - n_bytes)):
            pieces.append(piece)
            n_bytes += len(piece)
            _check_limit(n_bytes, limit)
        self.n_bytes = n_bytes
        return pieces[0] if len(pieces) == 1 else b"".join(pieces)

    def mesh_source(self, data: bytes | None = None) -> Any:
        """What `ebz.read` is to read: the path, which some formats need, or a file object.

        `data` is what has been read already, if anything.
        """
        if self.is_file:
            self.n_bytes = self.status.st_size
            return self.path
        from io import BytesIO

        return BytesIO(self.read() if data is None else data)

    def remove(self) -> None:
        with _named(self.name):
            Path(self.path).unlink()


class Output:
    """An output that may be written; whether it may be is known before the work starts.

    `source` is the input that it must not overwrite and whose mode and time it gets.
    """

    def __init__(self, name: str, source: Input | None, *, force: bool) -> None:
        self.descriptor = 1 if name == "-" else descriptor_of(name)
        self.name = STDOUT if name == "-" else name
        self.path = name
        self.is_file = False
        self._source = source
        self._force = force
        if self.descriptor is None:
            self._check()

    def _check(self) -> None:
        if self.path.endswith("/"):
            raise EbzError("is a folder", source=self.name)
        try:
            status = Path(self.path).stat()
        except OSError:
            self.is_file = True
            if os.path.lexists(self.path) and not self._force:
                raise atomic.already_exists(self.name) from None
            self._check_folder()
            return
        mode = status.st_mode
        self.is_file = stat.S_ISREG(mode)
        if stat.S_ISDIR(mode):
            raise EbzError("is a folder", source=self.name)
        if self.is_file and self._source and os.path.samestat(status, self._source.status):
            raise EbzError("is the input, which would be overwritten", source=self.name)
        if (self.is_file or stat.S_ISBLK(mode)) and not self._force:
            raise atomic.already_exists(self.name)

    def _check_folder(self) -> None:
        with _named(self.name):
            Path(self.path).parent.stat()

    def is_terminal(self) -> bool:
        return self.descriptor is not None and os.isatty(self.descriptor)

    def refuse_terminal(self) -> None:
        """Raises where binary data would go to a terminal unasked."""
        if self.is_terminal() and not self._force:
            raise EbzError(
                "binary data is not written to a terminal; use -o FILE, or -f to force it",
                source=self.name,
            )

    def write(self, chunks: Iterable[bytes | memoryview]) -> None:
        """Writes all of `chunks`: whole or not at all, where the output is a file."""
        with _named(self.name):
            if self.descriptor is not None:
                _write_chunks(self.descriptor, chunks)
            elif self.is_file:
                like = self._source.status if self._source and self._source.is_file else None
                atomic.write_whole(self.path, chunks, like=like, replace=self._force)
            else:
                self._write_special(chunks)

    def _write_special(self, chunks: Iterable[bytes | memoryview]) -> None:
        self.descriptor = os.open(self.path, os.O_WRONLY | os.O_NOCTTY)
        try:
            _write_chunks(self.descriptor, chunks)
        finally:
            os.close(self.descriptor)


def _check_limit(n_bytes: int, limit: int | None) -> None:
    if limit is not None and n_bytes > limit:
        raise MemoryLimitError(f"has more bytes than the memory limit of {limit}")


def _write_chunks(descriptor: int, chunks: Iterable[bytes | memoryview]) -> None:
    for chunk in chunks:
        atomic.write_all(descriptor, chunk)


@contextmanager
def _named(name: str) -> Iterator[None]:
    """Gives errors the name that the user knows the file by."""
    try:
        yield
    except OSError as error:
        raise EbzError(error.strerror or str(error), source=name) from error
    except EbzError as error:
        error.source = error.source or name
        raise


def compressed_name(source: Input) -> str:
    """The output of compressing `source`: a.ply.ebz for a.ply, standard output for a pipe."""
    if source.descriptor is not None:
        return "-"
    if source.path.endswith(SUFFIX):
        raise EbzError(f"has the suffix {SUFFIX} already; use -o or -c", source=source.name)
    return source.path + SUFFIX


def stripped_name(source: Input) -> str:
    """The name of `source` without .ebz, "-" for a pipe."""
    if source.descriptor is not None:
        return "-"
    stem = source.path.removesuffix(SUFFIX)
    if stem == source.path or not Path(stem).name or stem.endswith("/"):
        raise EbzError(f"unknown suffix ({SUFFIX} expected); use -o or -c", source=source.name)
    return stem
