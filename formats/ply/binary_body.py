"""The body of a binary PLY file: rows of packed numbers <-> columns."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ebz.codec.errors import MeshError
from ebz.formats.ply.columns import Column, Lists, early_end, place
from ebz.formats.ply.header import ByteOrder, Element, Property


def read_rows(
    data: bytes, offset: int, element: Element, byte_order: ByteOrder
) -> tuple[list[Column], int]:
    """One column per property of `element`, and the offset behind its last row.

    Lists that all have the lengths of the first row are read as one structured array. Otherwise
    the rows are walked one by one, since each says where the next one begins, and then gathered by
    their lengths.
    """
    if not element.properties or not element.count:
        return [_empty(prop) for prop in element.properties], offset
    lengths = _lengths_of_row(data, offset, element, byte_order, 0)
    dtype = _row_dtype(element, lengths, byte_order)
    if element.count * dtype.itemsize <= len(data) - offset:
        table = np.frombuffer(data, dtype, element.count, offset)
        if all((table[f"n{i}"] == n).all() for i, n in lengths.items()):
            columns = _columns(table, element)
            return columns, offset + table.nbytes
    if not lengths:
        raise _early_end_in_row(
            element, (len(data) - offset) // dtype.itemsize, dtype, data, offset
        )
    return _read_uneven(data, offset, element, byte_order)


def _empty(prop: Property) -> Column:
    values = np.zeros(0, prop.dtype)
    return Lists(np.zeros(0, prop.count_dtype), values) if prop.count_type else values


def _row_dtype(element: Element, lengths: dict[int, int], byte_order: ByteOrder) -> np.dtype[Any]:
    fields: list[Any] = []
    for i, prop in enumerate(element.properties):
        dtype = prop.dtype.newbyteorder(byte_order)
        if prop.count_type:
            fields.append((f"n{i}", prop.count_dtype.newbyteorder(byte_order)))
            fields.append((f"v{i}", dtype, (lengths[i],)))
        else:
            fields.append((f"v{i}", dtype))
    return np.dtype(fields)


def _columns(table: npt.NDArray[Any], element: Element) -> list[Column]:
    columns: list[Column] = []
    for i, prop in enumerate(element.properties):
        values = table[f"v{i}"].astype(prop.dtype).ravel()
        if prop.count_type:
            columns.append(Lists(table[f"n{i}"].astype(prop.count_dtype), values))
        else:
            columns.append(values)
    return columns


def _early_end_in_row(
    element: Element, row: int, dtype: np.dtype[Any], data: bytes, offset: int
) -> MeshError:
    """The error for scalars that end in `row`: names the first property that is not whole."""
    left = len(data) - offset - row * dtype.itemsize
    ends = np.cumsum([prop.dtype.itemsize for prop in element.properties])
    return early_end(element, row, element.properties[int(np.searchsorted(ends, left, "right"))])


def _lengths_of_row(
    data: bytes, offset: int, element: Element, byte_order: ByteOrder, row: int
) -> dict[int, int]:
    """The length of each list of the row at `offset`, by property; the row must be whole."""
    order = "big" if byte_order == ">" else "little"
    lengths = {}
    for i, prop in enumerate(element.properties):
        n = 1
        if prop.count_type:
            end = offset + prop.count_dtype.itemsize
            if end > len(data):
                raise early_end(element, row, prop)
            signed = prop.count_dtype.kind == "i"
            n = int.from_bytes(data[offset:end], order, signed=signed)  # type: ignore[arg-type]
            if n < 0:
                raise MeshError(f"{place(element, row, prop)}: a list of {n} entries")
            lengths[i] = n
            offset = end
        offset += n * prop.dtype.itemsize
        if offset > len(data):
            raise early_end(element, row, prop)
    return lengths


def _read_uneven(
    data: bytes, offset: int, element: Element, byte_order: ByteOrder
) -> tuple[list[Column], int]:
    starts, kinds, kind_of_row = _walk(data, offset, element, byte_order)
    columns = [_prepared(prop, i, kinds, kind_of_row) for i, prop in enumerate(element.properties)]
    firsts = [
        np.cumsum(column.lengths, dtype=np.int64) - column.lengths
        if isinstance(column, Lists)
        else None
        for column in columns
    ]
    body = np.frombuffer(data, np.uint8)
    for kind, lengths in enumerate(kinds):
        rows = np.flatnonzero(kind_of_row == kind)
        dtype = _row_dtype(element, dict(lengths), byte_order)
        table = body[starts[rows][:, None] + np.arange(dtype.itemsize)].view(dtype)[:, 0]
        for i, (column, first) in enumerate(zip(columns, firsts, strict=True)):
            if isinstance(column, Lists) and first is not None:
                values = table[f"v{i}"]
                column.values[first[rows][:, None] + np.arange(values.shape[1])] = values
            elif not isinstance(column, Lists):
                column[rows] = table[f"v{i}"]
    return columns, int(starts[-1])


def _prepared(
    prop: Property,
    index: int,
    kinds: list[tuple[tuple[int, int], ...]],
    kind_of_row: npt.NDArray[Any],
) -> Column:
    if not prop.count_type:
        return np.empty(len(kind_of_row), prop.dtype)
    of_kind = np.array([dict(lengths)[index] for lengths in kinds], prop.count_dtype)
    lengths = of_kind[kind_of_row]
    return Lists(lengths, np.empty(int(lengths.sum(dtype=np.int64)), prop.dtype))


def _walk(
    data: bytes, offset: int, element: Element, byte_order: ByteOrder
) -> tuple[npt.NDArray[np.int64], list[tuple[tuple[int, int], ...]], npt.NDArray[np.int64]]:
    """Where each row starts (and the last ends), the lengths of each kind of row, and row kinds.

    A row takes at least one byte, so the walk is bounded by the data, not by the count.
    """

    kinds: list[tuple[tuple[int, int], ...]] = []
    starts, kind_of_row = [offset], []
    lists = [prop for prop in element.properties if prop.count_type]
    simple = len(lists) == 1 and lists[0].count_dtype.itemsize == 1
    before = _bytes_before_first_list(element)
    known: dict[Any, tuple[int, int]] = {}
    for row in range(element.count):
        key: Any = data[offset + before : offset + before + 1] if simple else None
        found = known.get(key) if simple else None
        if found is None:
            lengths = tuple(_lengths_of_row(data, offset, element, byte_order, row).items())
            found = known.get(lengths)
            if found is None:
                kinds.append(lengths)
                size = _row_dtype(element, dict(lengths), byte_order).itemsize
                found = known[lengths] = (len(kinds) - 1, size)
            if simple:
                known[key] = found
        kind, size = found
        if offset + size > len(data):
            _lengths_of_row(data, offset, element, byte_order, row)
        offset += size
        starts.append(offset)
        kind_of_row.append(kind)
    return np.array(starts), kinds, np.array(kind_of_row)


def _bytes_before_first_list(element: Element) -> int:
    total = 0
    for prop in element.properties:
        if prop.count_type:
            break
        total += prop.dtype.itemsize
    return total


def write_rows(element: Element, columns: list[Column], byte_order: ByteOrder) -> bytes:
    """The rows of `element`; every column has the dtype of its property already."""
    lists = {i: column for i, column in enumerate(columns) if isinstance(column, Lists)}
    constant = {i: column.constant_length() for i, column in lists.items()}
    if None not in constant.values():
        lengths = {i: n for i, n in constant.items() if n is not None}
        return _table(element, columns, lengths, None, byte_order).tobytes()
    return _write_uneven(element, columns, lists, byte_order)


def _table(
    element: Element,
    columns: list[Column],
    lengths: dict[int, int],
    rows: npt.NDArray[Any] | None,
    byte_order: ByteOrder,
) -> npt.NDArray[Any]:
    """The given rows (None: all), which have lists of `lengths`, as a structured array."""
    n = element.count if rows is None else len(rows)
    table = np.empty(n, _row_dtype(element, lengths, byte_order))
    for i, column in enumerate(columns):
        if not isinstance(column, Lists):
            table[f"v{i}"] = column if rows is None else column[rows]
            continue
        table[f"n{i}"] = lengths[i]
        if rows is None:
            table[f"v{i}"] = column.values.reshape(n, lengths[i])
        else:
            first = np.cumsum(column.lengths, dtype=np.int64) - column.lengths
            table[f"v{i}"] = column.values[first[rows][:, None] + np.arange(lengths[i])]
    return table


def _write_uneven(
    element: Element, columns: list[Column], lists: dict[int, Lists], byte_order: ByteOrder
) -> bytes:
    keys = np.stack([column.lengths.astype(np.int64) for column in lists.values()], axis=1)
    kinds, kind_of_row = np.unique(keys, axis=0, return_inverse=True)
    kind_of_row = kind_of_row.ravel()
    dtypes = [
        _row_dtype(element, dict(zip(lists, lengths, strict=True)), byte_order)
        for lengths in kinds.tolist()
    ]
    starts = np.concatenate([[0], np.cumsum(np.array([d.itemsize for d in dtypes])[kind_of_row])])
    body = np.empty(starts[-1], np.uint8)
    for kind, (lengths, dtype) in enumerate(zip(kinds.tolist(), dtypes, strict=True)):
        rows = np.flatnonzero(kind_of_row == kind)
        table = _table(element, columns, dict(zip(lists, lengths, strict=True)), rows, byte_order)
        if dtype.itemsize:
            packed = table.view(np.uint8).reshape(len(rows), dtype.itemsize)
            body[starts[rows][:, None] + np.arange(dtype.itemsize)] = packed
    return body.tobytes()
