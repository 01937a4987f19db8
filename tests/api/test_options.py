"""Options of compress, what they refuse, and that nothing depends on the thread."""

import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import ebz
from ebz.codec import _kernels
from ebz.codec.models.table import Table, table_names
from ebz.codec.sample import random_triangulation
from tests.connectivity_check import same_mesh
from tests.container.files import read_header, split

MESH = random_triangulation(300, seed=7)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"bits": 0}, "bits is 0, not 1 to 30"),
        ({"bits": 31}, "bits is 31, not 1 to 30"),
        ({"bits": -1}, "bits is -1"),
        ({"bits": 7.5}, "bits is 7.5, not 1 to 30"),
        ({"bits": "7"}, "bits is '7', not 1 to 30"),
        ({"max_error": -1.0}, "max_error is -1.0"),
        ({"max_error": float("nan")}, "max_error is nan"),
        ({"max_error": float("inf")}, "max_error is inf"),
        ({"bits": 3, "max_error": 1.0}, "exclude each other"),
        ({"level": 0}, "level is 0, not 1 to 9"),
        ({"level": 10}, "level is 10, not 1 to 9"),
        ({"model": "no such model"}, "no such model"),
    ],
    ids=str,
)
def test_options_out_of_range_are_refused(options, message):
    with pytest.raises(ebz.OptionError, match=message):
        ebz.compress(MESH, **options)


@pytest.mark.parametrize("thing", [None, (MESH.vertices, MESH.faces)], ids=["None", "tuple"])
def test_what_is_no_mesh_is_refused_by_its_type(thing):
    with pytest.raises(ebz.MeshError, match=rf"^{type(thing).__name__} is neither a Mesh nor"):
        ebz.compress(thing)


def test_faces_of_several_sizes_need_offsets():
    with pytest.raises(ebz.MeshError, match=r"^faces: rows of several lengths need face_offsets$"):
        ebz.Mesh(MESH.vertices, [[0, 1, 2], [0, 1, 2, 3]])


def test_option_errors_are_value_errors_too():
    assert issubclass(ebz.OptionError, ValueError)
    assert issubclass(ebz.OptionError, ebz.EbzError)


@pytest.mark.parametrize("level", range(1, 10))
def test_every_level_loses_nothing(level):
    assert same_mesh(MESH, ebz.decompress(ebz.compress(MESH, level=level)))


@pytest.mark.parametrize("embed_model", [False, True])
@pytest.mark.parametrize("name", table_names())
def test_built_in_models_are_embedded_on_request_only(name, embed_model):
    data = ebz.compress(MESH, model=name, embed_model=embed_model)
    assert (b"M" in dict(split(data))) == embed_model
    assert (read_header(data)[0]["model"] == 0) == embed_model
    decoded = ebz.decompress(data)
    assert same_mesh(MESH, decoded)
    assert ebz.compress(decoded, model=name, embed_model=embed_model) == data


def test_a_table_file_is_always_embedded(tmp_path):
    Table.load("loop-60").save(tmp_path / "mine.npz")
    for path in (tmp_path / "mine.npz", str(tmp_path / "mine.npz")):
        data = ebz.compress(MESH, model=path)
        assert b"M" in dict(split(data))
        assert same_mesh(MESH, ebz.decompress(data))


def test_a_table_of_ones_own_is_embedded():
    uniform = np.array([[65536 - 4 * 13107, 13107, 13107, 13107, 13107]], np.uint32)
    table = Table("mine", uniform, np.zeros((1, 5), np.uint16))
    data = ebz.compress(MESH, model=table)
    assert b"M" in dict(split(data))
    assert same_mesh(MESH, ebz.decompress(data))


def test_progress_is_reported_from_start_to_end():
    data = ebz.compress(MESH)
    for call, argument in ((ebz.compress, MESH), (ebz.decompress, data)):
        reports: list[tuple[str, int, int]] = []
        call(argument, progress=lambda *report, reports=reports: reports.append(report))
        totals = {total for _, _, total in reports}
        assert len(totals) == 1
        assert [done for _, done, _ in reports] == list(range(totals.pop() + 1))
        assert all(isinstance(stage, str) for stage, _, _ in reports)


def test_threads_give_the_same_bytes():
    meshes = [random_triangulation(2000, seed=seed) for seed in range(4)] * 3
    expected = [ebz.compress(mesh) for mesh in meshes]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(ebz.compress, meshes)) == expected
        decoded = list(pool.map(ebz.decompress, expected))
    assert all(same_mesh(a, b) for a, b in zip(meshes, decoded, strict=True))


def test_the_kernels_release_the_lock_of_the_interpreter():
    """With an endless switch interval, another thread moves only while the lock is released."""
    faces, n_turns, running = MESH.faces.reshape(-1), 0, True
    pause = threading.Event()

    def count() -> None:
        nonlocal n_turns
        while running:
            n_turns += 1
            pause.wait(1e-4)

    other = threading.Thread(target=count)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    try:
        other.start()
        before = n_turns
        for _ in range(10_000):
            _kernels.encode_connectivity(faces, len(MESH.vertices))
            if n_turns > before:
                break
        moved = n_turns > before
    finally:
        running = False
        sys.setswitchinterval(interval)
        other.join()
    assert moved
