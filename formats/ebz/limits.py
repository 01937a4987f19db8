"""What a file may declare: no more than its bytes can hold, no more than memory allows."""

import math
from collections.abc import Sequence

from ebz.codec.encoded import EncodedArray, EncodedElement, EncodedMesh, EncodedText
from ebz.codec.errors import CorruptError, MemoryLimitError, corrupt_at
from ebz.codec.listing import Listing
from ebz.codec.models.adaptive import CHEAPEST_SYMBOL, state_bytes
from ebz.codec.models.load import AnyTable
from ebz.codec.models.table import TOTAL
from ebz.codec.order import Method as OrderMethod
from ebz.codec.polygons import Cut
from ebz.codec.scene import in_part
from ebz.codec.scenes import EncodedScene

# The cheapest adaptive bit: AdaptiveBit in codec/kernels/entropy/adaptive_bit.hpp.
CHEAPEST_BIT = math.log2(65536 / (65536 - 32))
# The cheapest decision about a position or an order: its probability is at most 65535 / 2^16.
CHEAPEST_DECISION = math.log2(65536 / 65535)
# The cheapest decision of learnt log-odds: squash in codec/kernels/entropy/logistic.hpp.
CHEAPEST_LEARNT = math.log2(65536 / 65528)
# What a range coder's stream of b bytes holds is at most 8 b bits and these.
SLACK_BITS = 8
DEFAULT_MEMORY_LIMIT = 4 << 30
# Memory that decoding takes at its peak, measured and rounded up.
BYTES_PER_FACE = 160
BYTES_PER_VERTEX = 160
BYTES_PER_INTEGER = 128
BYTES_PER_PART = 16 << 10
BYTES_PER_CHARACTER = 32
BYTES_PER_CORNER = 48  # the wedges of an attribute of corners
BYTES_PER_ROW = 32
BYTES_PER_COMPONENT = 64  # of an attribute: integers, the model's sizes, masks


def check_memory(n_bytes: int, memory_limit: int) -> None:
    """Raise MemoryLimitError where decoding takes more than the limit."""
    if n_bytes > memory_limit:
        raise MemoryLimitError(
            f"decoding takes up to {n_bytes:,} bytes of memory, past the limit of {memory_limit:,}"
        )


def check_text(text: EncodedText | None) -> int:
    """The memory that a text takes; raises CorruptError where it exceeds its stream."""
    if text is None:
        return 0
    _check("characters", text.n_bytes, 8 * CHEAPEST_LEARNT, len(text.data))
    if text.n_raw > len(text.raw):
        _check("bytes of byte strings", text.n_raw, 8 * CHEAPEST_LEARNT, len(text.raw))
    return BYTES_PER_CHARACTER * text.n_bytes + 4 * text.n_raw


def scene_size(scene: EncodedScene) -> int:
    """The memory that decoding takes; raises CorruptError where a count exceeds its stream."""
    size = check_text(scene.metadata)
    for number, part in enumerate(scene.parts):
        with in_part(number):
            size += BYTES_PER_PART + declared_size(part)
    return size


def declared_size(encoded: EncodedMesh) -> int:
    """The memory that decoding takes; raises CorruptError where a count exceeds its stream."""
    counts, streams = encoded.counts, encoded.streams
    with corrupt_at(encoded.place("header")):
        _check_symbols(encoded)
        _check("copies", counts.n_copies, 2 * CHEAPEST_BIT, len(streams.gluing))
        n_split = 3 * counts.n_triangles if streams.splits is not None else 0
        n_coded = max(0, encoded.n_vertices - n_split)
        n_bytes = len(streams.positions) + len(streams.points or b"")
        _check("vertices", n_coded, 3 * CHEAPEST_DECISION, n_bytes)
        listing = streams.listing or Listing(0, b"")
        _check("listed coordinates", listing.n, CHEAPEST_BIT, listing.size)
        _check("exceptions", encoded.n_exceptions, CHEAPEST_BIT, len(streams.exception_rows))
    if streams.order.any:
        n_coded = counts.n_faces - (counts.polygons.n_empty if counts.polygons else 0)
        _check_order("face order", n_coded - 1, streams.order.faces, encoded)
        _check_order("rotations", n_coded, streams.order.rotations, encoded)
    n_integers = counts.n_specials + counts.n_copies + encoded.n_exceptions + listing.n
    size = 0 if isinstance(encoded.model, AnyTable) else state_bytes(counts.n_symbols)
    n_faces = max(counts.n_faces, counts.n_triangles)
    if counts.polygons:
        n_faces += counts.n_triangles * (2 if encoded.coding.cut == Cut.TWICE else 1)
    size += BYTES_PER_FACE * n_faces + BYTES_PER_VERTEX * encoded.n_vertices
    size += BYTES_PER_INTEGER * n_integers
    return size + _carried_size(encoded) if encoded.carries_more else size


def _carried_size(encoded: EncodedMesh) -> int:
    """The memory of what is there besides the surface."""
    with corrupt_at(encoded.place("metadata")):
        size = check_text(encoded.metadata)
    size += _arrays_size(encoded.vertex_attributes, encoded.n_vertices)
    size += _arrays_size(encoded.face_attributes, encoded.counts.n_faces)
    size += sum(_elements_size(element) for element in encoded.elements)
    # What is at a vertex may be one value: only decoding tells.
    n_corners = 3 * encoded.counts.n_triangles
    return size + sum(
        n_corners
        * (3 * array.entry_size + BYTES_PER_COMPONENT * array.n_components + BYTES_PER_CORNER)
        for array in encoded.corner_attributes
    )


def _check_order(part: str, count: int, stream: bytes | None, encoded: EncodedMesh) -> None:
    if stream and stream[0] != OrderMethod.IDENTITY:
        with corrupt_at(encoded.place(part)):
            _check("faces", count, CHEAPEST_DECISION, len(stream) - 1)


def _check_symbols(encoded: EncodedMesh) -> None:
    counts, model, streams = encoded.counts, encoded.model, encoded.streams
    if isinstance(model, AnyTable):
        cheapest = math.log2(TOTAL / int(model.frequencies.max()))
        n_coded = max(0, counts.n_symbols - counts.n_specials)
        _check("symbols", n_coded, cheapest, len(streams.word))
        _check("special S", counts.n_specials, 2 * CHEAPEST_BIT, len(streams.special_integers))
        return
    if 3 * counts.n_single > encoded.n_vertices + counts.n_copies:
        raise CorruptError(f"header: {counts.n_single} single triangles have too few vertices")
    # The symbols of single triangles and the first are determined; marks of polygons are not.
    n_determined = 1 if counts.polygons else counts.n_single + 1
    n_coded = max(counts.n_symbols - n_determined, counts.n_specials)
    _check("symbols", n_coded, CHEAPEST_SYMBOL, len(streams.word))


def _check(what: str, count: int, bits_each: float, n_bytes: int) -> None:
    available = 8 * n_bytes + SLACK_BITS if n_bytes else 0
    if count * bits_each > available * (1 + 1e-9):
        raise CorruptError(f"{count} {what} do not fit in {n_bytes} bytes")


def _elements_size(element: EncodedElement) -> int:
    lengths = [element.lengths] if element.lengths else []
    size = _arrays_size([*lengths, *element.attributes], element.n_rows)
    if element.corners:
        width = element.corners.shape[0]
        size += _arrays_size([element.corners], -(-element.n_corners // width))
    else:
        with corrupt_at(element.place):
            _check("corners", element.n_corners, CHEAPEST_BIT, len(element.links))
    size += _arrays_size(element.corner_attributes, element.n_corners)
    return size + BYTES_PER_ROW * (element.n_rows + element.n_corners)


def _arrays_size(arrays: Sequence[EncodedArray], n: int) -> int:
    size = 0
    for array in arrays:
        entry = array.entry_size
        with corrupt_at(array.place):
            name = ", ".join(array.names)
            _check(
                f"values of {name!r}", n * array.n_components, CHEAPEST_DECISION, len(array.data)
            )
            _check("labels", array.plan.n_labels, CHEAPEST_BIT, len(array.plan.labels))
        size += n * (3 * entry + BYTES_PER_COMPONENT * array.n_components)
        size += BYTES_PER_INTEGER * array.plan.n_labels
    return size
