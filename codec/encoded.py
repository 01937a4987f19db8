"""The encoded mesh as a structure: what a container stores, before any byte is laid out."""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ebz.codec.attributes.plan import Plan
from ebz.codec.lattice import Lattice
from ebz.codec.listing import Listing
from ebz.codec.order import OrderStreams
from ebz.codec.positions import Coding
from ebz.codec.word import WordCounts, WordModel

NOWHERE: Mapping[str, object] = MappingProxyType({})


class EncodedArray(NamedTuple):
    """Attributes that are coded together: `data` codes all entries in output order.

    names: of one attribute whose entries have `shape`, or of the components of the entries.
    plan: how they are coded.
    seams: of attributes of corners, where those at a vertex differ; b"": nowhere.
    """

    names: tuple[str, ...]
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    data: bytes
    plan: Plan = Plan()
    seams: bytes = b""
    place: str = "attribute"

    @property
    def n_components(self) -> int:
        """Values of one entry."""
        return math.prod(self.shape)

    @property
    def entry_size(self) -> int:
        """Bytes of one entry."""
        return math.prod(self.shape, start=self.dtype.itemsize)


class EncodedText(NamedTuple):
    """Text of `n_bytes`, which `data` codes, and byte strings of `n_raw` that it stands for.

    raw: these as they are, or coded where there are fewer bytes of it.
    """

    n_bytes: int
    data: bytes
    n_raw: int = 0
    raw: bytes = b""


class EncodedElement(NamedTuple):
    """Rows beside vertices and faces.

    corners: in rows of `width`, their vertices in output order; None where `links` holds them.
    lengths: how many of the corners each row has; None where all have the same number.
    """

    name: str
    n_rows: int
    n_corners: int
    lengths: EncodedArray | None
    corners: EncodedArray | None
    links: bytes
    attributes: list[EncodedArray]
    corner_attributes: list[EncodedArray]
    place: str = "element"


class Streams(NamedTuple):
    """Entropy-coded bytes, by what they hold."""

    word: bytes
    special_integers: bytes
    gluing: bytes
    splits: bytes | None  # None: no position is shared
    positions: bytes
    listing: Listing | None  # None: positions are not numbers in a list
    points: bytes | None  # None: vertices in no face are among the positions
    exception_rows: bytes
    exception_values: bytes
    order: OrderStreams


class EncodedMesh(NamedTuple):
    """Everything from which `pipeline.decode` restores a mesh.

    places: what names the place in the file of each part that errors speak of, by name.
    """

    dtype: np.dtype[Any]
    counts: WordCounts
    n_vertices: int
    n_exceptions: int
    lattice: Lattice
    coding: Coding
    model: WordModel
    streams: Streams
    vertex_attributes: Sequence[EncodedArray] = ()
    face_attributes: Sequence[EncodedArray] = ()
    corner_attributes: Sequence[EncodedArray] = ()
    elements: Sequence[EncodedElement] = ()
    metadata: EncodedText | None = None
    digest: bytes = b""
    places: Mapping[str, object] = NOWHERE

    @property
    def carries_more(self) -> bool:
        """Whether there is anything beside the surface and points."""
        attributes = self.vertex_attributes or self.face_attributes or self.corner_attributes
        return bool(attributes or self.elements or self.metadata)

    def place(self, part: str) -> object:
        """Where in the file a part is: chunk and offset, the part's name where there is no file."""
        return self.places.get(part, part)
