"""Meshes that carry everything, and the comparison of all that they hold."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

from ebz.codec.elements import Element
from ebz.codec.mesh import Mesh


def contents(mesh: Mesh) -> dict[str, Any]:
    """Everything in a mesh but its metadata, comparable; what has no entries is left out."""
    found = {
        "vertices": bits(mesh.vertices),
        "corners": bits(mesh.corners),
        "offsets": bits(mesh.offsets),
        "vertex": of(mesh.vertex_attributes),
        "face": of(mesh.face_attributes),
        "corner": of(mesh.corner_attributes),
    }
    for name, element in mesh.elements.items():
        found[name] = (bits(element.offsets), bits(element.corners))
        found[f"{name} rows"] = of(element.attributes)
        found[f"{name} corners"] = of(element.corner_attributes)
    return found


def of(attributes: dict[str, Any]) -> dict[str, Any]:
    return {name: bits(values) for name, values in attributes.items() if values.size}


def bits(values: np.ndarray) -> tuple[Any, ...]:
    return values.dtype, values.shape, values.tobytes()


def row_set(mesh: Mesh, kind: str) -> list[tuple[Any, ...]]:
    """Faces, or the rows of an element, with all that is theirs, in an order of their own."""
    if kind == "face":
        part = Element(mesh.offsets, mesh.corners, mesh.face_attributes, mesh.corner_attributes)
    else:
        part = mesh.elements[kind]
    found = []
    for row, (start, end) in enumerate(zip(part.offsets[:-1], part.offsets[1:], strict=True)):
        corners = [part.corners[start:end].tolist()]
        corners += [v[start:end].tobytes() for _, v in sorted(part.corner_attributes.items())]
        found.append((*corners, *(v[row].tobytes() for _, v in sorted(part.attributes.items()))))
    return sorted(found)


@st.composite
def ply_meshes(draw: st.DrawFn) -> Mesh:
    """Polygons of 0 to 6 corners and other elements, with attributes of rows and corners."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    mesh = _polygons(draw, rng)
    mesh.face_attributes = {"label": rng.integers(0, 9, mesh.n_faces).astype(np.int16)}
    mesh.corner_attributes = {
        "texcoord": rng.standard_normal((mesh.n_corners, 2)).astype(np.float32),
        "weight": rng.standard_normal(mesh.n_corners),
    }
    for name in draw(st.lists(st.sampled_from(["edge", "polyline", "camera"]), unique=True)):
        element = _rows(draw, rng, 0 if name == "camera" else len(mesh.vertices))
        element.attributes = {"quality": rng.standard_normal(len(element)).astype(np.float32)}
        element.corner_attributes = {"t": rng.standard_normal((len(element.corners), 2))}
        mesh.elements[name] = element
    return Mesh(**vars(mesh))


@st.composite
def obj_meshes(draw: st.DrawFn) -> Mesh:
    """Polygons, lines and points with all that OBJ has for them."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    mesh = _polygons(draw, rng)
    elements = {name: _rows(draw, rng, len(mesh.vertices)) for name in ("line", "point")}
    mesh.elements = {name: element for name, element in elements.items() if len(element)}
    names = {"groups": ["", "a b", "c#d"], "materials": ["z", "a"], "smoothing": ["off", "1"]}
    mesh.metadata = {"format": "obj", "obj": {"mtllibs": ["a.mtl b.mtl"]} | names}
    owners = [(mesh.face_attributes, mesh.n_faces)]
    owners += [(element.attributes, len(element)) for element in mesh.elements.values()]
    for attributes, n in owners:
        for name, n_names in (("group", 3), ("material", 2)):
            attributes[name] = rng.integers(0, n_names, n).astype(np.int32)
    mesh.face_attributes["smoothing"] = rng.integers(0, 2, mesh.n_faces).astype(np.int32)
    if mesh.n_corners:
        uv = rng.standard_normal((4, 2)).astype(draw(st.sampled_from(["f4", "f8"])))
        uv = uv[rng.integers(0, 4, mesh.n_corners)]
        uv[1:][rng.random(mesh.n_corners - 1) < 0.2] = np.nan
        normals = rng.standard_normal((3, 3))[rng.integers(0, 3, mesh.n_corners)]
        mesh.corner_attributes = {"uv": uv, "normal": normals}
    return Mesh(**vars(mesh))


def _polygons(draw: st.DrawFn, rng: np.random.Generator) -> Mesh:
    n = draw(st.integers(1, 9))
    vertices = rng.standard_normal((n, 3)).astype(draw(st.sampled_from(["f4", "f8"])))
    faces = _rows(draw, rng, n)
    return Mesh(vertices, faces.corners, face_offsets=faces.offsets)


def _rows(draw: st.DrawFn, rng: np.random.Generator, n_vertices: int) -> Element:
    """Up to 6 rows of up to 6 corners, of none where there is no vertex."""
    lengths = draw(st.lists(st.integers(0, 6 if n_vertices else 0), max_size=6))
    if len(lengths) > 1 and n_vertices:
        lengths[:2] = (3, 4)  # lest one value per corner be a vector of its row
    offsets = np.concatenate([[0], np.cumsum(lengths, dtype=np.int64)])
    return Element(offsets, rng.integers(0, max(n_vertices, 1), offsets[-1]).astype(np.int32))
