"""Frozen files decode to what they held, and compressing it again gives the same bytes."""

import json

import pytest

import ebz
from tests.data.golden import FOLDER, SUMMARIES, cases, summary

EXPECTED = json.loads(SUMMARIES.read_text())
FILES = sorted(FOLDER.glob("*.ebz"))


def test_every_file_is_described():
    assert {path.stem for path in FILES} == set(EXPECTED) == set(cases())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_frozen_files_decode_to_what_they_held(path):
    assert summary(ebz.read(path)) == EXPECTED[path.stem]


@pytest.mark.parametrize("name", cases())
def test_frozen_meshes_compress_to_the_frozen_bytes(name):
    mesh, options = cases()[name]
    data = (FOLDER / f"{name}.ebz").read_bytes()
    assert ebz.compress(mesh, **options) == data
    assert ebz.compress(ebz.decompress(data), **options) == data


def test_frozen_files_are_small():
    assert max(path.stat().st_size for path in FILES) < 16_000
