"""Threads change nothing but the time: order, bytes and errors are those of one thread."""

import threading

import numpy as np
import pytest

import ebz
from ebz.codec import sample, threads
from ebz.codec.errors import OptionError
from ebz.codec.scene import Scene


def test_results_come_in_order_and_share_the_threads() -> None:
    barrier = threading.Barrier(3, timeout=30)

    def work(item: int) -> tuple[int, int]:
        barrier.wait()  # passes only if all three run at once
        return item, threads.allowed()

    with threads.using(7):
        assert threads.run(work, range(3)) == [(0, 2), (1, 2), (2, 2)]
    assert threads.allowed() == 1


def test_the_error_of_the_first_item_is_raised() -> None:
    def work(item: int) -> int:
        raise ValueError(item)

    with threads.using(4), pytest.raises(ValueError, match="0"):
        threads.run(work, range(4))


def _mesh() -> ebz.Mesh:
    mesh = sample.sphere(2000, noise=0.02, seed=1)
    rng = np.random.default_rng(1)
    n = len(mesh.vertices)
    return ebz.Mesh(
        mesh.vertices.astype(np.float32),
        mesh.faces,
        vertex_attributes={"a": rng.integers(0, 9, n), "b": rng.random((n, 2), np.float32)},
    )


@pytest.mark.parametrize("level", [1, 6, 9])
@pytest.mark.parametrize("content", [_mesh(), Scene([_mesh(), _mesh()])], ids=["mesh", "scene"])
def test_bytes_and_meshes_are_the_same_for_any_number(
    level: int, content: ebz.Mesh | Scene
) -> None:
    alone = ebz.compress(content, level=level)
    for n in (0, 2, 5):
        assert ebz.compress(content, level=level, threads=n) == alone
        assert ebz.compress(ebz.decompress(alone, threads=n), level=level) == alone


def test_there_is_no_negative_number_of_threads() -> None:
    with pytest.raises(OptionError, match="threads is -1"):
        ebz.compress(_mesh(), threads=-1)
