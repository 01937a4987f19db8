"""Text <-> few bytes, where it is like a prior that both sides know."""

from functools import cache

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels


def encode(prior: bytes, text: bytes) -> bytes:
    """The coded text."""
    return _coder(prior).encode(_view(text))


def decode(prior: bytes, data: bytes, n_bytes: int) -> bytes:
    """The text of n_bytes; any data is some text."""
    return _coder(prior).decode(_view(data), n_bytes).tobytes()


@cache
def _coder(prior: bytes) -> _kernels.TextCoder:
    """Priors are parts of the format: there are few."""
    return _kernels.TextCoder(_view(prior))


def _view(data: bytes) -> npt.NDArray[np.uint8]:
    return np.frombuffer(data, np.uint8)
