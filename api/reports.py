"""What a file holds and whether it is whole."""

import math

from ebz.codec import pipeline, statistics
from ebz.codec.compare import Verification, compare
from ebz.codec.connectivity import WordModel
from ebz.codec.errors import OptionError
from ebz.codec.levels import guaranteed_by
from ebz.codec.mesh import Mesh
from ebz.codec.models.guarantee import guaranteed_bits
from ebz.codec.statistics import Stats
from ebz.coding import BytesLike, as_bytes, compress, parse
from ebz.formats import container
from ebz.formats.limits import DEFAULT_MEMORY_LIMIT


def stats(data: BytesLike | Mesh, *, memory_limit: int = DEFAULT_MEMORY_LIMIT) -> Stats:
    """Counts, sizes and reference values of an .ebz file, or of what `compress` makes of a mesh.

    Raises what decompress raises.
    """
    content = compress(data) if isinstance(data, Mesh) else data
    view = as_bytes(content)
    encoded = parse(view, memory_limit)
    decoded = pipeline.decode(encoded)
    guarantee = _guarantee(encoded.model)
    return statistics.describe(
        encoded, decoded.word, decoded.surface, decoded.mesh, container.sizes(view), guarantee
    )


def _guarantee(model: WordModel) -> float:
    """Bits per vertex; infinite where a table in the file has no certificate."""
    try:
        return guaranteed_bits(guaranteed_by(model))
    except OptionError:
        return math.inf


def verify(
    data: BytesLike, against: Mesh | None = None, *, memory_limit: int = DEFAULT_MEMORY_LIMIT
) -> Verification:
    """Check an .ebz file by decoding all of it, and compare it with the original if that is given.

    The order of vertices and faces is compared where the file keeps it.

    Raises what decompress raises, and EbzError where vertices cannot be told apart.
    """
    encoded = parse(data, memory_limit)
    mesh = pipeline.decode(encoded).mesh
    checked = ["checksums", "every stream", "digest"]
    if against is None:
        return Verification(True, checked, len(mesh.vertices), len(mesh.faces))
    keeps_order = encoded.streams.order.vertices is not None
    return compare(mesh, against, encoded.lattice, checked, keeps_order=keeps_order)
