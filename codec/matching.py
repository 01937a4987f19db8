"""Which vertex is which in two meshes whose order differs: by data, refined along the faces.

Reference: colour refinement, B. Weisfeiler and A. Leman, "The reduction of a graph to canonical
form", 1968, on vertices and faces.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ebz.codec import cycles

Colours = npt.NDArray[np.int64]
MAX_ROUNDS = 100


class Labelled(NamedTuple):
    """corners, offsets: of the faces; data: (n, k) bytes of each vertex; face_data: (m, j)."""

    corners: npt.NDArray[Any]
    offsets: npt.NDArray[np.int64]
    data: npt.NDArray[np.uint8]
    face_data: npt.NDArray[np.uint8]


def match(a: Labelled, b: Labelled) -> tuple[Colours, Colours] | str | None:
    """For each vertex and face of `a`, that of `b`; the name of a difference; None if undecided.

    Faces with the same vertices are told apart by their data; other differences of data between
    faces are for the caller to find.
    """
    colours = ranks(np.concatenate([_rows(a.data), _rows(b.data)]))
    ours, theirs = np.split(colours, [len(a.data)])
    if not _same_counts(ours, theirs):
        return "vertex data"
    for _ in range(MAX_ROUNDS):
        n_colours = int(max(ours.max(initial=-1), theirs.max(initial=-1))) + 1
        if n_colours == len(ours):
            return _by_colours(a, b, ours, theirs)
        ours, theirs = np.split(_refine(a, b, ours, theirs), [len(ours)])
        if not _same_counts(ours, theirs):
            return "faces"
        if int(max(ours.max(), theirs.max())) + 1 == n_colours:
            break
    return None


def as_bytes(values: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """(n, k) the bytes of each entry."""
    flat = np.frombuffer(np.ascontiguousarray(values).tobytes(), np.uint8)
    return flat.reshape(len(values), values[:1].nbytes if len(values) else 0)


def same_rows(a: npt.NDArray[np.uint8], b: npt.NDArray[np.uint8]) -> bool:
    """Whether the rows are the same but for their order."""
    if a.shape != b.shape:
        return False
    return not a.size or np.array_equal(np.sort(_rows(a)), np.sort(_rows(b)))


def _by_colours(
    a: Labelled, b: Labelled, ours: Colours, theirs: Colours
) -> tuple[Colours, Colours] | str:
    """The correspondence when every vertex has a colour of its own."""
    vertex_of_colour = np.empty(len(theirs), np.int64)
    vertex_of_colour[theirs] = np.arange(len(theirs))
    sizes = [np.diff(labelled.offsets) for labelled in (a, b)]
    if not _same_counts(*sizes):
        return "faces"
    faces = np.empty(len(sizes[0]), np.int64)
    both = zip(cycles.by_size(a.offsets), cycles.by_size(b.offsets), strict=True)
    for (left_faces, left), (right_faces, right) in both:
        mine, other = cycles.least(ours[a.corners[left]]), cycles.least(theirs[b.corners[right]])
        my_order = _sorting(mine, a.face_data[left_faces])
        other_order = _sorting(other, b.face_data[right_faces])
        if not np.array_equal(mine[my_order], other[other_order]):
            return "faces"
        faces[left_faces[my_order]] = right_faces[other_order]
    return vertex_of_colour[ours], faces


def _sorting(faces: npt.NDArray[np.int64], data: npt.NDArray[np.uint8]) -> Colours:
    """The order of faces by their corners, then by their data."""
    keys = [np.zeros(len(faces)), *data.T, *faces.T]
    return np.lexsort(keys)


def _refine(a: Labelled, b: Labelled, ours: Colours, theirs: Colours) -> Colours:
    """New colours from the old one and the multiset of what is seen along the faces at a vertex."""
    seen = [_views(a, ours, 0), _views(b, theirs, len(ours))]
    owner = np.concatenate([part[0] for part in seen])
    view = ranks(np.concatenate([part[1] for part in seen]))
    colours = np.concatenate([ours, theirs])
    order = np.lexsort([view, owner])
    owner, view = owner[order], view[order]
    # A random-looking sum per vertex stands for the multiset; it is the same on both sides.
    mixed = (view.astype(np.uint64) + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    sums = np.zeros(len(colours), np.uint64)
    np.add.at(sums, owner, mixed ^ (mixed >> np.uint64(32)))
    return ranks(np.column_stack([colours.astype(np.uint64), sums]))


def _views(
    labelled: Labelled, colours: Colours, first: int
) -> tuple[Colours, npt.NDArray[np.int64]]:
    """For each corner, its vertex, the colours of the next two corners, the size of the face."""
    owners, views = [np.zeros(0, np.int64)], [np.zeros((0, 4), np.int64)]
    for _, rows in cycles.by_size(labelled.offsets):
        corners = labelled.corners[rows]
        around = [np.roll(corners, -turn, axis=1).reshape(-1) for turn in range(3)]
        size = np.full(corners.size, rows.shape[1])
        owners.append(around[0].astype(np.int64) + first)
        views.append(np.column_stack([*(colours[corner] for corner in around), size]))
    return np.concatenate(owners), np.concatenate(views)


def ranks(rows: npt.NDArray[Any]) -> Colours:
    """Equal rows get equal numbers from 0 on."""
    if rows.ndim == 2:
        rows = _rows(as_bytes(rows)) if len(rows) else np.zeros(0, np.int64)
    return np.unique(rows, return_inverse=True)[1].reshape(-1).astype(np.int64)


def _rows(data: npt.NDArray[np.uint8]) -> npt.NDArray[Any]:
    """Each row of bytes as one value that can be sorted."""
    return np.ascontiguousarray(data).view(np.dtype((np.void, data.shape[1]))).reshape(-1)


def _same_counts(a: Colours, b: Colours) -> bool:
    n = int(max(a.max(initial=-1), b.max(initial=-1))) + 1
    return np.array_equal(np.bincount(a, minlength=n), np.bincount(b, minlength=n))
