"""The adversary comes within a fraction of a bit of the certificate, and never above it."""

import numpy as np
import pytest

from ebz.codec import connectivity
from ebz.codec.errors import OptionError
from ebz.codec.models.adversary import costly_word
from ebz.codec.models.certify_stack import certify_stack
from ebz.codec.models.stack import StackTable
from ebz.codec.models.table import SYMBOLS
from tests.topology import is_simple_sphere

TABLE = StackTable.load("stack")
CERTIFICATE = certify_stack(TABLE)


@pytest.mark.parametrize(("n_vertices", "width"), [(4, 1), (200, 20)])
def test_the_certificate_is_tight(n_vertices: int, width: int) -> None:
    word = costly_word(TABLE, n_vertices, width)
    assert 0 <= word.limit(CERTIFICATE) - word.bits < 0.1
    assert abs(word.n_vertices - n_vertices) < 0.1 * n_vertices + 2


def test_its_mesh_encodes_to_its_word() -> None:
    word = costly_word(TABLE, 60, 10)
    faces = word.faces()
    assert is_simple_sphere(faces.astype(np.int64))
    encoded = connectivity.encode(faces, word.n_vertices, [TABLE])[0]
    assert "".join(SYMBOLS[symbol] for symbol in encoded.symbols[::-1]) == word.symbols
    assert 0 <= 8 * len(encoded.word) - word.bits < 9


@pytest.mark.parametrize(("n_vertices", "width"), [(3, 30), (100_001, 30), (10, 0), (10, 10_001)])
def test_limits_are_checked(n_vertices: int, width: int) -> None:
    with pytest.raises(OptionError, match="adversary: "):
        costly_word(TABLE, n_vertices, width)
