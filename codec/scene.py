"""Several meshes in one file, each with its name, and what stands beside them."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from ebz.codec.errors import EbzError
from ebz.codec.mesh import Mesh


@dataclass(eq=False)
class Scene:
    """Meshes in their order; any of them may be empty.

    parts: each with a name of its own in part.metadata["name"], if it has one.
    metadata: JSON-like values by name, of the whole.
    """

    parts: list[Mesh]
    metadata: dict[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"Scene({len(self.parts)} parts: {', '.join(map(repr, self.names))})"

    @property
    def names(self) -> list[str | None]:
        """The name of each part, None where it has none."""
        return [name_of(part) for part in self.parts]


def name_of(part: Mesh) -> str | None:
    """metadata["name"] where that is text."""
    name = part.metadata.get("name")
    return name if isinstance(name, str) else None


def label(number: int, name: str | None = None) -> str:
    """What messages call a part."""
    return f"part {number}" if name is None else f"part {number} {name!r}"


@contextmanager
def in_part(number: int, name: str | None = None) -> Iterator[None]:
    """Put the part in front of the message of an error that is raised within."""
    try:
        yield
    except EbzError as error:
        error.message = f"{label(number, name)}: {error.message}"
        raise
