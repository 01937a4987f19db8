"""What a compressed scene is made of: every part, and all of them together."""

from dataclasses import asdict, dataclass
from typing import Any

from ebz.codec.scene import Scene, label
from ebz.codec.statistics import Stats


@dataclass(frozen=True)
class SceneStats:
    """Sums over the parts of a scene, and the parts; as_dict() is what --json prints.

    names: of the parts, None where one has none.  scene_bytes: what frames the parts.
    """

    names: list[str | None]
    parts: list[Stats]
    vertices: int
    faces: int
    connectivity_bytes: int
    geometry_bytes: int
    order_bytes: int
    attribute_bytes: int
    scene_bytes: int
    total_bytes: int
    raw_bytes: int
    ratio: float
    bits_per_vertex: float

    def as_dict(self) -> dict[str, Any]:
        """The sums by name, then the parts by number and name."""
        sums = {key: value for key, value in vars(self).items() if key not in ("names", "parts")}
        pairs = enumerate(zip(self.names, self.parts, strict=True))
        parts = {label(number, name): asdict(part) for number, (name, part) in pairs}
        return {"parts": len(self.parts)} | sums | parts


def describe(scene: Scene, parts: list[Stats], frame_sizes: dict[str, int]) -> SceneStats:
    """The statistics of a scene; frame_sizes: bytes of the file that are in no part."""

    def total(name: str) -> int:
        return sum(getattr(part, name) for part in parts)

    n_vertices, frame = total("vertices"), sum(frame_sizes.values())
    n_bytes, raw = total("total_bytes") + frame, total("raw_bytes")
    return SceneStats(
        names=scene.names,
        parts=parts,
        vertices=n_vertices,
        faces=total("faces"),
        connectivity_bytes=total("connectivity_bytes"),
        geometry_bytes=total("geometry_bytes"),
        order_bytes=total("order_bytes"),
        attribute_bytes=total("attribute_bytes"),
        scene_bytes=frame,
        total_bytes=n_bytes,
        raw_bytes=raw,
        ratio=raw / n_bytes,
        bits_per_vertex=8 * n_bytes / n_vertices if n_vertices else 0.0,
    )
