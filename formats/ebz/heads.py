"""What describes an attribute <-> few bytes: text that is expected to be like its prior."""

from ebz.codec import text
from ebz.codec.errors import CorruptError
from ebz.formats.ebz.head_prior import PRIOR

# Longer heads (of long names) stand as they are: a few bytes must not claim much time.
MAX_CODED = 512


def encode(head: bytes) -> bytes:
    """The head as it is or coded, whichever has fewer bytes."""
    if len(head) > MAX_CODED:
        return head
    return min(head, text.encode(PRIOR, head), key=len)


def decode(coded: bytes, n_head: int) -> bytes:
    """The n_head bytes; raises CorruptError where there cannot be as many."""
    if len(coded) == n_head:
        return coded
    if not len(coded) < n_head <= MAX_CODED:
        raise CorruptError(f"{len(coded)} bytes for a head of {n_head}")
    return text.decode(PRIOR, coded, n_head)
