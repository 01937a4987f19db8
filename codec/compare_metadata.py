"""Whether a decoded mesh or scene has the names, comments and other metadata of the original."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from ebz.codec.compare import Verification
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene, label, name_of

# What is said of the order of faces, which may have changed.
ABOUT_ORDER = "runs"


def with_metadata(
    verdict: Verification, decoded: Mesh | Scene, original: Mesh | Scene
) -> Verification:
    """The verdict on arrays, and on metadata where both are from files of one format."""
    if not verdict.equal or decoded.metadata.get("format") != original.metadata.get("format"):
        return verdict
    difference = next(_differences(decoded, original), None)
    checked = [*verdict.checked, "metadata"]
    return replace(verdict, equal=difference is None, first_difference=difference, checked=checked)


def _differences(decoded: Mesh | Scene, original: Mesh | Scene) -> Iterator[str]:
    yield from _of_values("metadata", _lasting(decoded), _lasting(original))
    if isinstance(decoded, Scene) and isinstance(original, Scene):
        for number, (ours, theirs) in enumerate(zip(decoded.parts, original.parts, strict=True)):
            place = f"{label(number, name_of(theirs))}: metadata"
            yield from _of_values(place, _lasting(ours), _lasting(theirs))


def _lasting(mesh: Mesh | Scene) -> dict[str, Any]:
    return {name: value for name, value in mesh.metadata.items() if name != ABOUT_ORDER}


def _of_values(place: str, got: Any, wanted: Any) -> Iterator[str]:
    if isinstance(got, dict) and isinstance(wanted, dict):
        for name in sorted(got.keys() | wanted.keys()):
            if name not in got or name not in wanted:
                yield f"{place} {name!r}: {'missing' if name in wanted else 'not in MESH'}"
            else:
                yield from _of_values(f"{place} {name!r}", got[name], wanted[name])
    elif isinstance(got, list | tuple) and isinstance(wanted, list | tuple):
        if len(got) != len(wanted):
            yield f"{place}: {len(got)} entries, not {len(wanted)}"
        for row, (ours, theirs) in enumerate(zip(got, wanted, strict=False)):
            yield from _of_values(f"{place} {row}", ours, theirs)
    elif got != wanted and not (got != got and wanted != wanted):  # noqa: PLR0124 (NaN)
        yield f"{place}: {got!r}, not {wanted!r}"
