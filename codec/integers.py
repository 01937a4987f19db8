"""Columns of unsigned integers <-> bytes, small values being cheap."""

import numpy as np
import numpy.typing as npt

from ebz.codec import _kernels

Columns = npt.NDArray[np.uint64]


def encode_columns(*columns: npt.ArrayLike) -> bytes:
    """The bytes of equally long columns of integers in [0, 2^64), a model for each."""
    table = np.column_stack([np.asarray(column).astype(np.uint64) for column in columns])
    return _kernels.encode_integers(table.reshape(-1), len(columns)) if len(table) else b""


def decode_columns(data: bytes, n_rows: int, n_columns: int) -> list[Columns]:
    """The columns; whatever the bytes are, n_rows values come back for each."""
    flat = _kernels.decode_integers(data, n_rows, n_columns)
    return list(flat.reshape(n_rows, n_columns).T)


def gaps(ascending: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """What lies between neighbours of a strictly ascending sequence, and before its first."""
    return np.diff(ascending, prepend=-1) - 1


def from_gaps(values: Columns) -> npt.NDArray[np.int64]:
    """The ascending sequence with those gaps; overflow wraps, for the caller to refuse."""
    return np.cumsum(values.astype(np.int64) + 1) - 1


def zigzag(values: npt.NDArray[np.int64]) -> Columns:
    """0, -1, 1, -2, ... as 0, 1, 2, 3, ..."""
    return ((values << 1) ^ (values >> 63)).astype(np.uint64)


def unzigzag(values: Columns) -> npt.NDArray[np.int64]:
    """The inverse of zigzag."""
    return (values >> np.uint64(1)).astype(np.int64) ^ -(values & np.uint64(1)).astype(np.int64)
