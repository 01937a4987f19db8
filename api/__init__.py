"""ebz: lossless and bounded-error compression of triangle meshes, with a worst-case guarantee.

    >>> import ebz
    >>> mesh = ebz.read("bunny.ply")
    >>> data = ebz.compress(mesh, bits=14)
    >>> ebz.write("bunny.obj", ebz.decompress(data))

Everything is loaded on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ebz._version import __version__

if TYPE_CHECKING:
    from ebz import models
    from ebz.codec.compare import Verification
    from ebz.codec.elements import Element
    from ebz.codec.errors import (
        CorruptError,
        DroppedWarning,
        EbzError,
        MemoryLimitError,
        MeshError,
        NotEbzError,
        OptionError,
        TruncatedError,
        VersionError,
    )
    from ebz.codec.mesh import Mesh
    from ebz.codec.order import Permutation
    from ebz.codec.scene import Scene
    from ebz.codec.scene_statistics import SceneStats
    from ebz.codec.statistics import Stats
    from ebz.coding import compress, decompress
    from ebz.files import read, write
    from ebz.reports import stats, verify

_HOMES = {
    "Element": "ebz.codec.elements",
    "Mesh": "ebz.codec.mesh",
    "Permutation": "ebz.codec.order",
    "Scene": "ebz.codec.scene",
    "SceneStats": "ebz.codec.scene_statistics",
    "Stats": "ebz.codec.statistics",
    "Verification": "ebz.codec.compare",
    "compress": "ebz.coding",
    "decompress": "ebz.coding",
    "read": "ebz.files",
    "write": "ebz.files",
    "stats": "ebz.reports",
    "verify": "ebz.reports",
}
_ERRORS = [
    "CorruptError",
    "DroppedWarning",
    "EbzError",
    "MemoryLimitError",
    "MeshError",
    "NotEbzError",
    "OptionError",
    "TruncatedError",
    "VersionError",
]
_HOMES |= dict.fromkeys(_ERRORS, "ebz.codec.errors")

__all__ = [
    "CorruptError",
    "DroppedWarning",
    "EbzError",
    "Element",
    "MemoryLimitError",
    "Mesh",
    "MeshError",
    "NotEbzError",
    "OptionError",
    "Permutation",
    "Scene",
    "SceneStats",
    "Stats",
    "TruncatedError",
    "Verification",
    "VersionError",
    "__version__",
    "compress",
    "decompress",
    "models",
    "read",
    "stats",
    "verify",
    "write",
]


def __getattr__(name: str) -> Any:
    if name == "models":
        return import_module("ebz.models")  # which makes it an attribute
    if name not in _HOMES:
        raise AttributeError(f"module 'ebz' has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
