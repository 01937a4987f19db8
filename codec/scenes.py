"""A scene <-> streams: its parts one after another, on one lattice where their precision is one."""

from dataclasses import replace
from typing import Any, NamedTuple

from ebz.codec import fitting, metadata, pipeline, threads
from ebz.codec.encoded import EncodedMesh, EncodedText
from ebz.codec.errors import corrupt_at
from ebz.codec.fitting import LOSSLESS, Precision
from ebz.codec.mesh import Mesh
from ebz.codec.pipeline import Progress
from ebz.codec.scene import Scene, in_part, name_of
from ebz.codec.surface import OutputOrder
from ebz.codec.word import WordModel


class EncodedScene(NamedTuple):
    """Everything from which `decode` restores a scene; place: where its chunk is in the file."""

    parts: list[EncodedMesh]
    metadata: EncodedText | None = None
    place: str = "scene"


Encoded = EncodedMesh | EncodedScene


def encode(
    content: Mesh | Scene,
    model: WordModel | None = None,
    *,
    precision: Precision = LOSSLESS,
    progress: Progress | None = None,
    **options: Any,
) -> tuple[Encoded, list[OutputOrder]]:
    """A mesh or every part of a scene as streams, and where the items of the outputs come from.

    options: see pipeline.encode.

    The box of Precision.bits is around all parts: what they share, they still share.
    """
    if isinstance(content, Mesh):
        encoded_mesh, order = pipeline.encode(
            content, model, precision=precision, progress=progress, **options
        )
        return encoded_mesh, [order]
    # Their arrays may have been exchanged since they were checked.
    parts = [replace(part) for part in content.parts]
    for number, part in enumerate(parts):
        with in_part(number, name_of(part)):
            fitting.check(part.vertices, precision)
    points = fitting.fit_together([part.vertices for part in parts], precision)

    def coded(number: int) -> tuple[EncodedMesh, OutputOrder]:
        part, report = parts[number], _within(progress, number, len(parts))
        with in_part(number, name_of(part)):
            return pipeline.encode(
                part,
                model,
                precision=precision,
                points=points[number],
                progress=report,
                **options,
            )

    encoded = threads.run(coded, range(len(parts)))
    carried = metadata.encode(content.metadata)
    return EncodedScene([part for part, _ in encoded], carried), [order for _, order in encoded]


def decode(encoded: Encoded, *, progress: Progress | None = None) -> Mesh | Scene:
    """The mesh or the scene; raises CorruptError."""
    if isinstance(encoded, EncodedMesh):
        return pipeline.decode(encoded, progress=progress).mesh
    with corrupt_at(encoded.place):
        carried = metadata.decode(encoded.metadata)
    parts = encoded.parts

    def decoded(number: int) -> Mesh:
        with in_part(number):
            report = _within(progress, number, len(parts))
            return pipeline.decode(parts[number], progress=report).mesh

    return Scene(threads.run(decoded, range(len(parts))), carried)


def _within(progress: Progress | None, number: int, n: int) -> Progress | None:
    """What is done of a part, as a share of the whole."""
    if progress is None:
        return None
    return lambda stage, done, total: progress(stage, number * total + done, n * total)
