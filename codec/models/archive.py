"""Table files: npz archives of a few small arrays, read without believing what they declare."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import OptionError

if TYPE_CHECKING:
    import zipfile

# No array of a table has more entries: 65535 rows of five.
MAX_ENTRIES = 65535 * 5
MAX_ARRAYS = 16
MAX_ITEM_BYTES = 1024

Arrays = dict[str, npt.NDArray[Any]]


def pack(**arrays: npt.NDArray[Any]) -> bytes:
    """The npz archive of these arrays; the same arrays give the same bytes."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()


def text(arrays: Arrays, name: str) -> str:
    """A string that must be there."""
    return str(_present(arrays, name))


def _present(arrays: Arrays, name: str) -> npt.NDArray[Any]:
    if name not in arrays:
        raise OptionError(f"model table: no array {name!r}")
    return arrays[name]


def integers(arrays: Arrays, name: str, dtype: type) -> npt.NDArray[Any]:
    """An array that must be there, as `dtype`; raises OptionError where it does not fit."""
    values = _present(arrays, name)
    if values.dtype.kind not in "iu":
        raise OptionError(f"model table: array {name!r} is not of integers")
    if values.size and (values.min() < 0 or values.max() > np.iinfo(dtype).max):
        raise OptionError(f"model table: array {name!r} does not fit {np.dtype(dtype).name}")
    return np.ascontiguousarray(values, dtype)


def unpack(data: bytes) -> Arrays:
    """Every array of an npz; the sizes that it declares are checked before any is allocated."""
    import zipfile

    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return {
                member.filename.removesuffix(".npy"): _array(archive, member)
                for member in archive.infolist()[:MAX_ARRAYS]
            }
    except OptionError:
        raise
    except (zipfile.BadZipFile, ValueError, EOFError, NotImplementedError, RuntimeError) as error:
        raise OptionError(f"model table: not an npz file ({error})") from None
    except Exception as error:  # zlib.error, struct.error and what else a damaged archive raises
        raise OptionError(f"model table: damaged npz file ({error})") from None


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> npt.NDArray[Any]:
    with archive.open(member) as stream:
        if np.lib.format.read_magic(stream) != (1, 0):
            raise OptionError(f"model table: {member.filename} is not of npy version 1.0")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
        n = int(np.prod([int(extent) for extent in shape], dtype=object))
        if dtype.kind not in "iuU" or dtype.itemsize > MAX_ITEM_BYTES or not 0 <= n <= MAX_ENTRIES:
            raise OptionError(f"model table: {member.filename} declares {shape} of {dtype}")
        content = stream.read(n * dtype.itemsize)
    array = np.frombuffer(content, dtype, n)
    return array.reshape(shape, order="F" if fortran else "C")
