"""Text like its prior costs next to nothing; any text comes back, any bytes are some text."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import _kernels, metadata
from tests.oracles import text as oracle

PLY = {
    "format": "ply",
    "ply": {
        "format": "binary_little_endian",
        "header": [
            "comment VCGLIB generated",
            "element vertex",
            *(f"property float {name}" for name in "xyz"),
            "element face",
            "property list uchar int vertex_indices",
        ],
    },
}


def encoded(prior: bytes, text: bytes) -> bytes:
    return _kernels.TextCoder(prior).encode(text)


def decoded(prior: bytes, data: bytes, n: int) -> bytes:
    return _kernels.TextCoder(prior).decode(data, n).tobytes()


@settings(deadline=None)
@given(st.binary(max_size=60), st.binary(max_size=300))
def test_any_text_comes_back(prior, text):
    assert decoded(prior, encoded(prior, text), len(text)) == text


@settings(deadline=None, max_examples=30)
@given(st.text("ab\n", max_size=40), st.text("abc\0\xff", max_size=120))
def test_the_twin_makes_the_same_bytes(prior, text):
    prior, text = prior.encode("latin-1"), text.encode("latin-1")
    assert encoded(prior, text) == oracle.encode(prior, text)


@settings(deadline=None)
@given(st.binary(max_size=40), st.integers(0, 500))
def test_any_bytes_are_some_text(data, n):
    assert len(decoded(b"prior", data, n)) == n


def test_what_a_usual_file_remembers_costs_a_few_bytes():
    assert len(metadata.encode(PLY).data) <= 16
    plain, marked = (ebz.Mesh(np.eye(3), [[0, 1, 2]], metadata=meta) for meta in ({}, PLY))
    assert len(ebz.compress(marked)) - len(ebz.compress(plain)) <= 24


def test_text_of_no_prior_is_shorter_too():
    text = b"usemtl steel_%d\n"
    lines = b"".join(text.replace(b"%d", str(i % 7).encode()) for i in range(300))
    assert len(encoded(b"", lines)) < len(lines) / 40
