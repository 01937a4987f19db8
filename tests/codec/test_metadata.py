"""Metadata come back as they were, and nothing else decodes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebz
from ebz.codec import metadata

# Lone surrogates included: file systems and damaged files put them into strings.
strings = st.text(st.characters(codec=None, exclude_categories=()))
keys = strings.filter(lambda key: key != metadata.BYTES)
scalars = (
    st.none()
    | st.booleans()
    | st.integers(-(2**200), 2**200)
    | st.floats(allow_nan=False)
    | strings
    | st.binary()
    | st.integers(200, 300).map(bytes)
)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(keys, inner, max_size=3),
    max_leaves=12,
)


def typed(value):
    """Equal for values of equal types only: 1, 1.0 and True are three things."""
    if isinstance(value, dict):
        return {key: typed(item) for key, item in value.items()}
    if isinstance(value, list):
        return [typed(item) for item in value]
    return type(value), repr(value)


@settings(deadline=None)
@given(st.dictionaries(keys, values, max_size=4))
def test_metadata_come_back(meta):
    mesh = ebz.Mesh(np.eye(3), [[0, 1, 2]], metadata=meta)
    data = ebz.compress(mesh)
    decoded = ebz.decompress(data)
    assert typed(decoded.metadata) == typed(meta)
    assert list(decoded.metadata) == list(meta)
    assert ebz.compress(decoded) == data


def test_not_a_number_and_infinities_come_back():
    meta = metadata.decode(metadata.encode({"a": [math.nan, math.inf, -math.inf, -0.0]}))
    assert [repr(value) for value in meta["a"]] == ["nan", "inf", "-inf", "-0.0"]


def nested(depth: int):
    value: list = []
    for _ in range(depth):
        value = [value]
    return value


@pytest.mark.parametrize(
    ("meta", "message"),
    [
        ({1: 2}, "metadata: key 1 is not a string"),
        ({"a": {("b",): 2}}, r"metadata: key \('b',\) is not a string"),
        ({"a": {"$bytes": 1}}, r"metadata: key '\$bytes' is reserved"),
        ({"a": {1, 2}}, "metadata: .*set"),
        ({"a": np.zeros(2)}, "metadata: .*ndarray"),
        ({"a": nested(100_000)}, "metadata: .*recursion"),
    ],
    ids=["key", "inner key", "reserved", "set", "array", "deep"],
)
def test_what_cannot_be_kept_is_refused(meta, message):
    with pytest.raises(ebz.MeshError, match=message):
        ebz.compress(ebz.Mesh(np.eye(3), [[0, 1, 2]], metadata=meta))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"[1]",
        b"1",
        b'{"a":1',
        b"\xff\xfe",
        b'{"a":{"$bytes":5}}',
        b'{"a":{"$bytes":"0g"}}',
        b'{"a":{"$bytes":true}}',
        b'{"a":{"$bytes":1.0}}',
        b'{"$bytes":"00"}',
        b'{"a":{"$bytes":"00","b":1}}',
        b'{"a":' + b"[" * 100_000 + b"]" * 100_000 + b"}",
        b'{"a":' + b"9" * 10_000 + b"}",
    ],
    ids=lambda data: repr(data[:20]),
)
def test_other_bytes_are_corrupt(data):
    with pytest.raises(ebz.CorruptError):
        metadata.from_text(data)


def test_long_byte_strings_stand_beside_the_text():
    meta = {"a": bytes(300), "b": [{"c": bytes(range(256))}, b"short"]}
    encoded = metadata.encode(meta)
    assert encoded.n_raw == 556
    assert len(encoded.raw) < 400
    assert metadata.decode(encoded) == meta
    noise = np.random.default_rng(0).bytes(1000)
    assert metadata.encode({"a": noise}).raw == noise
    assert metadata.decode(metadata.encode({"a": noise})) == {"a": noise}
    mesh = ebz.Mesh([], [], metadata=meta)
    assert ebz.decompress(ebz.compress(mesh)).metadata == meta


@pytest.mark.parametrize(
    ("text", "raw"),
    [
        (b'{"a":{"$bytes":5}}', bytes(4)),
        (b'{"a":{"$bytes":5}}', bytes(6)),
        (b'{"a":{"$bytes":-1}}', b""),
        (b'{"a":1}', bytes(1)),
    ],
)
def test_other_numbers_of_raw_bytes_are_corrupt(text, raw):
    with pytest.raises(ebz.CorruptError):
        metadata.from_text(text, raw)
