"""Warnings of what is left out."""

import warnings
from collections.abc import Mapping

from ebz.codec.errors import DroppedWarning


def warn_dropped(message: str) -> None:
    """Warns that what `message` names is left out."""
    warnings.warn(message, DroppedWarning, stacklevel=3)


def warn_attributes(format_name: str, **owners: Mapping[str, object]) -> None:
    """Warns of the attributes, by owner, that a file of `format_name` cannot carry."""
    for owner, attributes in owners.items():
        if attributes:
            names = ", ".join(repr(name) for name in attributes)
            warn_dropped(f"{format_name} cannot carry {owner} attributes: {names}")
