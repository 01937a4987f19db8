"""Text <-> few bytes, where it is like a prior that both sides know."""

from functools import cache

from ebz.codec import _kernels


def encode(prior: bytes, text: bytes) -> bytes:
    """The coded text."""
    return _coder(prior).encode(text)


def decode(prior: bytes, data: bytes, n_bytes: int) -> bytes:
    """The text of n_bytes; any data is some text."""
    return _coder(prior).decode(data, n_bytes).tobytes()


@cache
def _coder(prior: bytes) -> _kernels.TextCoder:
    """Priors are parts of the format: there are few."""
    return _kernels.TextCoder(prior)
