"""Warnings of what is left out."""

import warnings
from collections.abc import Mapping

from ebz.codec.errors import DroppedWarning
from ebz.codec.mesh import Mesh


def warn_dropped(message: str) -> None:
    """Warns that what `message` names is left out."""
    warnings.warn(message, DroppedWarning, stacklevel=3)


def warn_attributes(format_name: str, **owners: Mapping[str, object]) -> None:
    """Warns of the attributes, by owner, that a file of `format_name` cannot carry."""
    for owner, attributes in owners.items():
        if attributes:
            names = ", ".join(repr(name) for name in attributes)
            warn_dropped(f"{format_name} cannot carry {owner} attributes: {names}")


def warn_elements(format_name: str, mesh: Mesh) -> None:
    """Warns of the elements of a mesh that a file of `format_name` cannot carry."""
    parts = [f"{name!r} ({len(element)})" for name, element in mesh.elements.items()]
    if parts:
        warn_dropped(f"{format_name} cannot carry elements: {', '.join(parts)}")
