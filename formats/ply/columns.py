"""What a property of a PLY element is in memory: one array, or lists in CSR form."""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.ply.header import Element, Property

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

    def per_corner(self, corners: npt.NDArray[Any]) -> int | None:
        """How many values each corner has, where `corners` (per row) times that is every length.

        One value for each corner of rows that all have as many is taken for a vector of the row:
        None, as where the lengths do not suit.
        """
        n_corners = int(corners.sum(dtype=np.int64))
        if not n_corners or not len(self.values) or len(self.values) % n_corners:
            return None
        width = len(self.values) // n_corners
        if width == 1 and (corners == corners[0]).all():
            return None
        same = self.lengths.astype(np.int64) == width * corners.astype(np.int64)
        return width if same.all() else None


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
