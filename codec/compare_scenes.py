"""Whether a decoded scene is the original, part by part."""

from collections.abc import Sequence

from ebz.codec.attributes.comparison import Lattices
from ebz.codec.compare import Verification, compare
from ebz.codec.lattice import Lattice
from ebz.codec.mesh import Mesh
from ebz.codec.scene import Scene, in_part, label, name_of


def compare_parts(
    decoded: Mesh | Scene,
    original: Mesh | Scene,
    lattices: Sequence[Lattice],
    checked: list[str],
    *,
    attributes: Sequence[Lattices],
    keeps_order: bool = False,
) -> Verification:
    """The verdict on a decoded mesh or scene; the first difference names the part.

    lattices, attributes: the precision at which each part and its attributes were stored.
    Raises UndecidedError.
    """
    if isinstance(decoded, Mesh) and isinstance(original, Mesh):
        return compare(
            decoded,
            original,
            lattices[0],
            checked,
            lattices=attributes[0],
            keeps_order=keeps_order,
        )
    difference = _different_kind(decoded, original)
    if difference or not (isinstance(decoded, Scene) and isinstance(original, Scene)):
        return summary(decoded, checked, difference)
    verdicts: list[Verification] = []
    pairs = zip(decoded.parts, original.parts, lattices, attributes, strict=True)
    for number, (ours, theirs, lattice, others) in enumerate(pairs):
        if name_of(ours) != name_of(theirs):
            difference = f"name of part {number}: {name_of(ours)!r}, not {name_of(theirs)!r}"
            break
        with in_part(number, name_of(theirs)):
            verdict = compare(
                ours, theirs, lattice, checked, lattices=others, keeps_order=keeps_order
            )
        verdicts.append(verdict)
        if not verdict.equal:
            difference = f"{label(number, name_of(theirs))}: {verdict.first_difference}"
            break
    return _merged(decoded, checked, difference, verdicts)


def summary(
    decoded: Mesh | Scene, checked: list[str], difference: str | None = None
) -> Verification:
    """A verdict without a comparison of arrays."""
    parts = decoded.parts if isinstance(decoded, Scene) else [decoded]
    return Verification(
        equal=difference is None,
        checked=checked,
        vertices=sum(part.n_vertices for part in parts),
        faces=sum(part.n_faces for part in parts),
        first_difference=difference,
    )


def _different_kind(decoded: Mesh | Scene, original: Mesh | Scene) -> str | None:
    got, wanted = (
        f"a scene of {len(content.parts)} parts" if isinstance(content, Scene) else "a mesh"
        for content in (decoded, original)
    )
    return f"{got}, not {wanted}" if got != wanted else None


def _merged(
    decoded: Scene, checked: list[str], difference: str | None, verdicts: list[Verification]
) -> Verification:
    """The verdict on a scene; its errors are the largest of its parts."""
    whole = summary(decoded, checked, difference)
    if not verdicts:
        return whole
    every = list(dict.fromkeys(name for verdict in verdicts for name in verdict.checked))
    hows = {verdict.matched_by for verdict in verdicts}

    def largest(name: str) -> float | None:
        values = [getattr(verdict, name) for verdict in verdicts]
        return max((value for value in values if value is not None), default=None)

    return Verification(
        equal=whole.equal,
        checked=[*every, "names of the parts"],
        vertices=whole.vertices,
        faces=whole.faces,
        first_difference=difference,
        matched_by=hows.pop() if len(hows) == 1 else "parts differ",
        largest_error=largest("largest_error"),
        rms_error=largest("rms_error"),
        allowed_error=largest("allowed_error"),
    )
