"""What makes no sense is refused by an error of ebz that says so, not by one from within."""

import numpy as np
import pytest

import ebz
from ebz.codec.sample import random_triangulation

MESH = random_triangulation(40, seed=1)
CARRYING = ebz.Mesh(MESH.vertices, MESH.faces, {"q": np.zeros(MESH.n_vertices)})
DATA = ebz.compress(MESH)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"threads": "2"}, "threads is '2', not an integer of at least 0"),
        ({"threads": None}, "threads is None"),
        ({"threads": 1.5}, "threads is 1.5"),
        ({"threads": -1}, "threads is -1"),
        ({"max_error": "x"}, "max_error is 'x', not a finite number of at least 0"),
        ({"max_error": 10**400}, "max_error is 1000"),
        ({"max_error": [1]}, r"max_error is \[1\]"),
        ({"bits": 12.5}, "bits is 12.5, not 1 to 30"),
        ({"bits": 12.0}, "bits is 12.0, not 1 to 30"),
        ({"level": None}, "level is None, not 1 to 9"),
        ({"normal_bits": "8"}, "normal_bits is '8', not 2 to 16"),
        ({"attribute_bits": 3}, "attribute_bits is 3, not a dict by attribute's name"),
        ({"attribute_bits": [("q", 3)]}, "attribute_bits is .*, not a dict"),
        ({"attribute_bits": {"q": None}}, "bits of attribute 'q' are None, not 1 to 30"),
        ({"attribute_error": {"q": "x"}}, "error of attribute 'q' is 'x', not a finite number"),
        ({"grid": 1}, "grid is 1, not"),
        ({"model": 3}, "model is 3, neither a name, a path nor a table"),
        ({"model": b"stack"}, "model is b'stack', neither"),
        ({"progress": 3}, "progress is 3, not a function"),
    ],
    ids=str,
)
def test_options_of_other_types_are_refused(options, message):
    with pytest.raises(ebz.OptionError, match=f"^{message}"):
        ebz.compress(CARRYING, **options)


@pytest.mark.parametrize(
    "options",
    [{"bits": np.int64(9)}, {"max_error": np.float32(0.5)}, {"level": np.uint8(1)}],
    ids=str,
)
def test_numbers_of_numpy_are_numbers(options):
    plain = {name: value.item() for name, value in options.items()}
    assert ebz.compress(MESH, **options) == ebz.compress(MESH, **plain)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"threads": "x"}, "threads is 'x'"),
        ({"memory_limit": "1G"}, "memory_limit is '1G', not a number of bytes"),
        ({"memory_limit": None}, "memory_limit is None"),
        ({"progress": "x"}, "progress is 'x', not a function"),
    ],
    ids=str,
)
def test_options_of_decompress_are_refused(options, message):
    with pytest.raises(ebz.OptionError, match=f"^{message}"):
        ebz.decompress(DATA, **options)


@pytest.mark.parametrize("read", [ebz.decompress, ebz.stats, ebz.verify])
@pytest.mark.parametrize("thing", ["a.ebz", None, 3, object()], ids=lambda x: type(x).__name__)
def test_what_is_no_bytes_is_refused_by_its_type(read, thing):
    with pytest.raises(ebz.NotEbzError, match=f"^{type(thing).__name__} is not bytes: .* ebz.read"):
        read(thing)


def test_what_is_no_mesh_is_refused_wherever_one_is_expected(tmp_path):
    for call in (lambda: ebz.verify(DATA, "a.ply"), lambda: ebz.write(tmp_path / "a.ply", "a")):
        with pytest.raises(ebz.MeshError, match=r"^str is neither a Mesh nor a Scene$"):
            call()
    with pytest.raises(ebz.MeshError, match=r"^part 1 is of type int, not a Mesh$"):
        ebz.compress(ebz.Scene([MESH, 3]))
    with pytest.raises(ebz.MeshError, match=r"^the parts of the scene are of type int, not"):
        ebz.compress(ebz.Scene(3))
    assert not list(tmp_path.iterdir())


def test_what_is_no_file_is_refused():
    with pytest.raises(
        ebz.OptionError, match=r"^bytes is neither a path nor a binary file to read$"
    ):
        ebz.read(DATA)
    with pytest.raises(ebz.OptionError, match=r"^int is neither a path nor a binary file to wr"):
        ebz.write(3, MESH)


@pytest.mark.parametrize("attributes", [[1], {3: np.zeros(40)}], ids=str)
def test_attributes_have_names(attributes):
    with pytest.raises(ebz.MeshError, match=r"^vertex attributes are not a dict of arrays"):
        ebz.Mesh(MESH.vertices, MESH.faces, attributes)
