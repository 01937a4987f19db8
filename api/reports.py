"""What a file holds and whether it is whole."""

import math

from ebz.codec import pipeline, scene_statistics, scenes, statistics
from ebz.codec.attributes.comparison import lattices_of
from ebz.codec.compare import Verification
from ebz.codec.compare_metadata import with_metadata
from ebz.codec.compare_scenes import compare_parts, summary
from ebz.codec.encoded import EncodedMesh
from ebz.codec.errors import OptionError
from ebz.codec.levels import guaranteed_by
from ebz.codec.mesh import Mesh
from ebz.codec.models.guarantee import guaranteed_bits
from ebz.codec.scene import Scene, in_part
from ebz.codec.scene_statistics import SceneStats
from ebz.codec.statistics import Stats
from ebz.codec.word import WordModel
from ebz.coding import BytesLike, compress, parse
from ebz.formats.ebz import file
from ebz.formats.ebz.limits import DEFAULT_MEMORY_LIMIT
from ebz.options import as_bytes, content


def stats(
    data: BytesLike | Mesh | Scene, *, memory_limit: int = DEFAULT_MEMORY_LIMIT
) -> Stats | SceneStats:
    """Counts, sizes and reference values of an .ebz file, or of what `compress` makes of a mesh.

    Of a scene, those of every part and their sums.  Raises what decompress raises.
    """
    view = as_bytes(compress(data) if isinstance(data, Mesh | Scene) else data)
    encoded = parse(view, memory_limit)
    frame, sizes = file.sizes(view)
    if isinstance(encoded, EncodedMesh):
        return _describe(encoded, frame | sizes[0])[0]
    parts = []
    for number, part in enumerate(encoded.parts):
        with in_part(number):
            parts.append(_describe(part, sizes[number]))
    scene = Scene([mesh for _, mesh in parts])
    return scene_statistics.describe(scene, [described for described, _ in parts], frame)


def _describe(encoded: EncodedMesh, sizes: dict[str, int]) -> tuple[Stats, Mesh]:
    decoded = pipeline.decode(encoded)
    guarantee = _guarantee(encoded.model)
    described = statistics.describe(
        encoded, decoded.word, decoded.surface, decoded.mesh, sizes, guarantee
    )
    return described, decoded.mesh


def _guarantee(model: WordModel) -> float:
    """Bits per vertex; infinite where a table in the file has no certificate."""
    try:
        return guaranteed_bits(guaranteed_by(model))
    except OptionError:
        return math.inf


def verify(
    data: BytesLike,
    against: Mesh | Scene | None = None,
    *,
    memory_limit: int = DEFAULT_MEMORY_LIMIT,
) -> Verification:
    """Check an .ebz file by decoding all of it, and compare it with the original if that is given.

    The order of vertices and faces is compared where the file keeps it.

    Raises what decompress raises, and EbzError where vertices cannot be told apart.
    """
    original = None if against is None else content(against)
    encoded = parse(data, memory_limit)
    decoded = scenes.decode(encoded)
    checked = ["checksums", "every stream", "digest"]
    if original is None:
        return summary(decoded, checked)
    parts = [encoded] if isinstance(encoded, EncodedMesh) else encoded.parts
    keeps_order = any(part.streams.order.vertices is not None for part in parts)
    lattices = [part.lattice for part in parts]
    verdict = compare_parts(
        decoded,
        original,
        lattices,
        checked,
        attributes=[lattices_of(part) for part in parts],
        keeps_order=keeps_order,
    )
    return with_metadata(verdict, decoded, original)
