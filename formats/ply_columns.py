"""What a property of a PLY element is in memory: one array, or lists in CSR form."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.ply_header import Element, Property

# Ragged lists become one padded array, which may take this many times the room of the lists.
MAX_PADDING = 64
SMALL_PADDED = 1 << 24


@dataclass
class Lists:
    """Row i holds `lengths[i]` of `values`, in order."""

    lengths: npt.NDArray[Any]
    values: npt.NDArray[Any]

    def constant_length(self) -> int | None:
        """The length of all lists where it is one and the same; 0 where there is no list."""
        if not self.lengths.size:
            return 0
        first = int(self.lengths[0])
        return first if (self.lengths == first).all() else None


Column: TypeAlias = npt.NDArray[Any] | Lists


def early_end(element: Element, row: int, prop: Property) -> MeshError:
    return MeshError(f"{place(element, row, prop)}: early end of file")


def place(element: Element, row: int, prop: Property) -> str:
    return f"element {element.name!r}: row {row}: property {prop.name!r}"


def padded(lists: Lists, where: str) -> npt.NDArray[Any]:
    """(n, longest) with zeros behind the end of the shorter lists."""
    n, longest = len(lists.lengths), int(lists.lengths.max(initial=0))
    size = n * longest * lists.values.itemsize
    if size > SMALL_PADDED + MAX_PADDING * lists.values.nbytes:
        raise MeshError(f"{where}: lists of up to {longest} entries are too uneven to be kept")
    table = np.zeros((n, longest), lists.values.dtype)
    table[np.arange(longest) < lists.lengths[:, None]] = lists.values
    return table


def unpadded(table: npt.NDArray[Any], lengths: npt.NDArray[Any]) -> Lists:
    """The inverse of `padded`."""
    return Lists(lengths, table[np.arange(table.shape[1]) < lengths[:, None]])
