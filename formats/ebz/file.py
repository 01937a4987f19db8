"""The .ebz file: one mesh, or a scene of several, from its first byte to its last."""

from ebz.codec.encoded import EncodedMesh
from ebz.codec.errors import corrupt_at
from ebz.codec.scene import in_part
from ebz.codec.scenes import Encoded, EncodedScene
from ebz.formats.ebz import chunks, container, layout, payloads
from ebz.formats.ebz.chunks import Chunk
from ebz.formats.ebz.limits import check_memory, check_text, declared_size, scene_size


def write(encoded: Encoded, *, embed_model: bool = False) -> bytes:
    """The file; embed_model: store the tables of models that are built in, too."""
    if isinstance(encoded, EncodedMesh):
        return b"".join([chunks.start(), *container.write(encoded, embed_model=embed_model)])
    payload = payloads.scene(len(encoded.parts), encoded.metadata)
    parts = [chunks.start(), chunks.write(layout.SCENE, payload)]
    for part in encoded.parts:
        parts += container.write(part, embed_model=embed_model)
    return b"".join(parts)


def read(data: memoryview, *, memory_limit: int) -> Encoded:
    """The encoded mesh or scene; counts are checked against the bytes there are and the limit.

    Raises NotEbzError, VersionError, TruncatedError, CorruptError or MemoryLimitError.
    """
    begin = chunks.begin(data)
    scene = _scene_chunk(data, begin)
    if scene is None:
        mesh, end = container.read(data, begin)
        chunks.check_end(data, end)
        check_memory(declared_size(mesh) + 2 * len(data), memory_limit)
        return mesh
    return _read_scene(data, scene, memory_limit)


def _read_scene(data: memoryview, chunk: Chunk, memory_limit: int) -> EncodedScene:
    n_parts, text = payloads.parse_scene(chunk)
    with corrupt_at(chunk):
        check_text(text)
    parts: list[EncodedMesh] = []
    end = chunk.offset + chunk.size
    while len(parts) < n_parts:
        with in_part(len(parts)):
            part, end = container.read(data, end)
        parts.append(part)
    chunks.check_end(data, end)
    scene = EncodedScene(parts, text, str(chunk))
    check_memory(scene_size(scene) + 2 * len(data), memory_limit)
    return scene


def sizes(data: memoryview) -> tuple[dict[str, int], list[dict[str, int]]]:
    """Bytes of what frames a file, and of each part by what it holds, in the order of the file."""
    begin = chunks.begin(data)
    scene = _scene_chunk(data, begin)
    frame = {"start": begin}
    if scene:
        frame |= {"scene": scene.size}
        begin += scene.size
    parts: list[dict[str, int]] = []
    while begin < len(data):
        parts.append({})
        for chunk in chunks.sequence(data, begin):
            name = layout.NAMES.get(chunk.type, "unknown")
            parts[-1][name] = parts[-1].get(name, 0) + chunk.size
            begin = chunk.offset + chunk.size
    return frame, parts


def _scene_chunk(data: memoryview, offset: int) -> Chunk | None:
    """The first chunk where it is that of a scene."""
    if data[offset : offset + 1] != layout.SCENE:
        return None
    return next(chunks.sequence(data, offset))
