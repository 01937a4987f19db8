"""Memory that decoding takes stays below what is announced, and absurd files take next to none."""

import resource
import subprocess
import sys

import numpy as np
import pytest

import ebz
from ebz.codec.sample import grid, random_triangulation
from tests.container.files import files, join, split, with_header

# Decodes a file in a process of its own; prints the error or nothing, and the growth of its peak.
DECODE = """
import resource, sys
import numpy, ebz
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
tiny = ebz.Mesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
ebz.decompress(ebz.compress(tiny, level=int(sys.argv[3])))  # everything is loaded
data = open(sys.argv[1], "rb").read()
before = peak()
try:
    ebz.decompress(data, memory_limit=int(sys.argv[2]))
except ebz.EbzError as error:
    print(type(error).__name__)
print(peak() - before)
"""


def decode(path, memory_limit: int, level: int = 6) -> list[str]:
    command = [sys.executable, "-c", DECODE, str(path), str(memory_limit), str(level)]

    def cap() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

    done = subprocess.run(command, capture_output=True, text=True, check=True, preexec_fn=cap)
    return done.stdout.split()


def announced(data: bytes) -> int:
    with pytest.raises(ebz.MemoryLimitError) as raised:
        ebz.decompress(data, memory_limit=0)
    return int(str(raised.value).split()[4].replace(",", ""))


def grid_with_attributes() -> ebz.Mesh:
    mesh = grid(60_000)
    colours = np.zeros((len(mesh.vertices), 4), np.uint8)
    return ebz.Mesh(mesh.vertices, mesh.faces, {"rgba": colours}, {"corner": mesh.faces})


def soup() -> ebz.Mesh:
    """Every triangle has its own vertices, at positions shared with others."""
    mesh = grid(40_000)
    vertices = mesh.vertices[mesh.faces.reshape(-1)]
    return ebz.Mesh(vertices, np.arange(len(vertices)).reshape(-1, 3))


def fans() -> ebz.Mesh:
    """Nothing but gluing: triangles around few vertices."""
    rng = np.random.default_rng(0)
    return ebz.Mesh(rng.normal(size=(300, 3)), rng.integers(0, 300, (30_000, 3)))


MESHES = {
    "random": lambda: random_triangulation(30_000, seed=0),
    "grid with attributes": grid_with_attributes,
    "soup": soup,
    "fans": fans,
    "points": lambda: ebz.Mesh(np.random.default_rng(0).normal(size=(60_000, 3)), []),
}


@pytest.mark.parametrize("options", [{"level": 1}, {"level": 9, "keep_order": True}], ids=str)
@pytest.mark.parametrize("name", MESHES)
def test_decoding_takes_no_more_memory_than_announced(tmp_path, name, options):
    data = ebz.compress(MESHES[name](), **options)
    path = tmp_path / "mesh.ebz"
    path.write_bytes(data)
    (growth,) = decode(path, 4 << 30, options["level"])
    assert int(growth) <= announced(data)


def test_a_limit_of_what_is_announced_is_enough():
    data = ebz.compress(random_triangulation(500, seed=0))
    limit = announced(data)
    assert ebz.decompress(data, memory_limit=limit)
    with pytest.raises(ebz.MemoryLimitError):
        ebz.decompress(data, memory_limit=limit - 1)


@pytest.mark.parametrize("name", ["everything", "stack", "float"])
def test_absurd_files_take_little_memory(tmp_path, name):
    """Counts as large as the streams could hold, streams of zeros that hold very much."""
    data, path = files()[name], tmp_path / "absurd.ebz"
    zeros = [
        (kind, bytes(20_000) if kind in b"WPQSG" else payload) for kind, payload in split(data)
    ]
    for absurd in (
        with_header(data, n_vertices=2**31 - 2),
        with_header(data, n_symbols=2**29, n_closed=0),
        with_header(data, n_copies=2**40),
        with_header(join(zeros), n_vertices=10**7),
        with_header(join(zeros), n_symbols=10**7),
        with_header(join(zeros), n_vertices=10**6, n_symbols=10**5),
    ):
        path.write_bytes(absurd)
        error, growth = decode(path, 256 << 20)
        assert error in {"CorruptError", "MemoryLimitError"}
        assert int(growth) < 300 << 20


def test_a_header_of_endless_integers_takes_no_time():
    chunks = split(files()["empty"])
    payload = chunks[0][1][:1] + b"\xff" * 5_000_000
    with pytest.raises(ebz.CorruptError, match="more than 10 bytes"):
        ebz.decompress(join([(b"H", payload), *chunks[1:]]))


def test_a_table_of_very_many_rows_takes_no_time():
    chunks = split(files()["automaton"])
    kind, payload = chunks[1]
    name = payload[: payload.index(b"loop-60") + 7]
    absurd = name + b"\xff\xff\xff\x7f" + bytes(5_000_000)
    with pytest.raises(ebz.CorruptError):
        ebz.decompress(join([chunks[0], (kind, absurd), *chunks[2:]]))
