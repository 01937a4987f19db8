"""The errors of ebz, told apart by what a caller can do about them."""


class EbzError(Exception):
    """Anything that ebz reports about its input; the message names the place.

    `source` is the file's name where one is known, and is put in front of the message.
    """

    def __init__(self, message: str, *, source: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.source = source

    def __str__(self) -> str:
        return f"{self.source}: {self.message}" if self.source else self.message


class MeshError(EbzError):
    """A mesh or a mesh file that is malformed or cannot be represented: mend the mesh."""


class OptionError(EbzError, ValueError):
    """An option, or a combination of options, that makes no sense: call again with others."""


class NotEbzError(EbzError):
    """The data does not start like an .ebz file."""


class TruncatedError(EbzError):
    """The data ends before the file does: fetch it again."""


class CorruptError(EbzError):
    """The data contradicts a checksum or itself; the message names chunk and offset."""


class corrupt_at:  # noqa: N801 (used like a function)
    """Put the place in front of the message of a CorruptError that is raised within."""

    def __init__(self, place: object) -> None:
        self._place = place  # only an error is told in words

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, traceback: object) -> None:
        if isinstance(error, CorruptError):
            raise CorruptError(f"{self._place}: {error.message}") from None


class VersionError(EbzError):
    """The file was written for another version of the format than this one reads."""


class MemoryLimitError(EbzError):
    """Decoding would need more memory than the limit allows: raise the limit."""


class DroppedWarning(UserWarning):
    """Something that the target format cannot carry was left out; the message names it."""
