"""Scenes: several meshes in one file, in their order, each with its name."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec.compare import Verification
from ebz.codec.sample import sphere, torus
from tests.codec.test_grid import shared, tiles
from tests.connectivity_check import same_under
from tests.meshes import meshes

NAMES = st.none() | st.text(max_size=5)


@st.composite
def scenes(draw: st.DrawFn) -> ebz.Scene:
    parts = draw(st.lists(meshes(finite=True), max_size=4))
    for part in parts:
        if (name := draw(NAMES)) is not None:
            part.metadata["name"] = name
    return ebz.Scene(parts, draw(st.sampled_from([{}, {"who": "me", "raw": b"\0\xff"}])))


def named(name: str | None, mesh: ebz.Mesh) -> ebz.Mesh:
    return ebz.Mesh(mesh.vertices, mesh.faces, metadata={} if name is None else {"name": name})


def scene() -> ebz.Scene:
    empty, cloud = ebz.Mesh([], []), ebz.Mesh(torus(200).vertices, [])
    parts = [named("ball", sphere(300)), named("nothing", empty), named(None, cloud)]
    return ebz.Scene(parts, {"who": "me"})


OPTIONS = [{}, {"bits": 11}, {"max_error": 0.01}, {"grid": (0, 0.01)}, {"keep_order": True}]


@settings(max_examples=80, deadline=None)
@given(scenes(), st.sampled_from(OPTIONS))
def test_scenes_come_back(scene, options):
    data, permutations = ebz.compress(scene, return_permutation=True, **options)
    decoded = ebz.decompress(data)
    assert isinstance(decoded, ebz.Scene)
    assert (decoded.names, decoded.metadata) == (scene.names, scene.metadata)
    assert len(permutations) == len(decoded.parts) == len(scene.parts)
    assert ebz.compress(decoded, **options) == data
    for part, source, permutation in zip(decoded.parts, scene.parts, permutations, strict=True):
        assert part.metadata == source.metadata
        if not {"bits", "max_error", "grid"} & options.keys():
            assert same_under(source, part, permutation.vertices)


def test_one_part_is_still_a_scene():
    decoded = ebz.decompress(ebz.compress(ebz.Scene([sphere(20)])))
    assert isinstance(decoded, ebz.Scene)
    assert len(decoded.parts) == 1
    assert ebz.decompress(ebz.compress(ebz.Scene([]))).parts == []


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_parts_share_one_box(dtype):
    parts = [ebz.Mesh(tile.vertices.astype(dtype), tile.faces) for tile in tiles()]
    seam = shared(parts[0].vertices, parts[1].vertices)
    data = ebz.compress(ebz.Scene(parts), bits=14)
    a, b = ebz.decompress(data).parts
    assert shared(a.vertices, b.vertices) == seam > 30
    lattices = [part.lattice for part in ebz.stats(data).parts]
    assert lattices[0] == lattices[1]
    assert ebz.verify(data, ebz.Scene(parts)).equal


def test_parts_of_other_types_have_other_boxes():
    left, right = tiles()
    parts = [left, ebz.Mesh(right.vertices.astype(np.float64) / 3, right.faces)]
    data = ebz.compress(ebz.Scene(parts), bits=10)
    assert ebz.compress(ebz.decompress(data), bits=10) == data
    assert ebz.verify(data, ebz.Scene(parts)).equal


def test_statistics_are_per_part_and_in_all():
    whole = scene()
    data = ebz.compress(whole)
    stats = ebz.stats(data)
    assert stats == ebz.stats(whole)
    assert stats.names == ["ball", "nothing", None]
    assert stats.total_bytes == len(data)
    assert stats.scene_bytes == len(data) - sum(part.total_bytes for part in stats.parts)
    assert [part.vertices for part in stats.parts] == [p.n_vertices for p in whole.parts]
    assert stats.vertices == sum(part.n_vertices for part in whole.parts)
    assert list(stats.as_dict())[-3:] == ["part 0 'ball'", "part 1 'nothing'", "part 2"]
    # A part costs what a file of it alone costs, but for the file's first bytes.
    assert stats.parts[0].total_bytes == len(ebz.compress(whole.parts[0])) - 9


def verify(original: ebz.Mesh | ebz.Scene, **options) -> Verification:
    return ebz.verify(ebz.compress(scene(), **options), original)


def test_verify_names_the_part_and_its_difference():
    assert verify(scene()).equal
    assert verify(scene(), bits=9).equal
    other = scene()
    other.parts[2].vertices[7, 1] += 1
    found = verify(other)
    assert not found.equal
    assert found.first_difference.startswith("part 2: ")
    other = scene()
    other.parts[1].metadata["name"] = "something"
    assert verify(other).first_difference == "name of part 1: 'nothing', not 'something'"
    fewer = ebz.Scene(scene().parts[:2])
    assert verify(fewer).first_difference == "a scene of 3 parts, not a scene of 2 parts"
    assert verify(sphere(20)).first_difference == "a scene of 3 parts, not a mesh"
    found = ebz.verify(ebz.compress(sphere(20)), scene())
    assert found.first_difference == "a mesh, not a scene of 3 parts"


@pytest.mark.parametrize("options", OPTIONS[1:4], ids=str)
def test_errors_name_the_part(options):
    whole = scene()
    whole.parts[0].vertices[3, 2] = np.nan
    with pytest.raises(ebz.MeshError, match=r"^part 0 'ball': vertex 3: z is nan, which cannot"):
        ebz.compress(whole, **options)
    far = scene()
    far.parts[2].vertices[5, 0] = 1e30
    with pytest.raises(ebz.OptionError, match=r"^part 2: vertex 5: x is 1\.0.*, more than"):
        ebz.compress(far, grid=(0, 1e-6))


def test_progress_runs_over_all_parts():
    reports: list[tuple[int, int]] = []
    data = ebz.compress(scene(), progress=lambda _, *report: reports.append(report))
    n = len(reports)
    ebz.decompress(data, progress=lambda _, *report: reports.append(report))
    for part in (reports[:n], reports[n:]):
        assert part == sorted(part)
        assert part[0][0] == 0
        assert part[-1][0] == part[-1][1]


def test_formats_of_one_mesh_join_the_parts(tmp_path):
    with pytest.warns(ebz.DroppedWarning, match="OBJ holds one mesh: the 3 parts are joined"):
        ebz.write(tmp_path / "scene.obj", scene())
    joined = ebz.read(tmp_path / "scene.obj")
    assert joined.n_vertices == sum(part.n_vertices for part in scene().parts)
    assert joined.metadata["obj"]["objects"] == ["ball", "nothing", "part 2"]
    assert np.array_equal(
        joined.vertices[joined.faces], scene().parts[0].vertices[scene().parts[0].faces]
    )


def test_what_parts_do_not_share_is_named(tmp_path):
    ids = [np.arange(3, dtype=dtype) for dtype in (np.int32, np.int32, np.int8)]
    parts = [ebz.Mesh(np.eye(3), [[0, 1, 2]], {"id": i, "k": ids[0]}) for i in ids]
    with pytest.warns(ebz.DroppedWarning) as caught:
        ebz.write(tmp_path / "a.ply", ebz.Scene(parts))
    assert [str(warning.message) for warning in caught] == [
        "PLY holds one mesh: the 3 parts are joined",
        "parts differ in vertex attributes: 'id'",
    ]
    joined = ebz.read(tmp_path / "a.ply")
    assert joined.vertex_attributes["k"].tolist() == 3 * [0, 1, 2]
    assert joined.face_attributes["object"].tolist() == [0, 1, 2]
    assert joined.faces.tolist() == [[0, 1, 2], [3, 4, 5], [6, 7, 8]]
