"""Lists of different integers, and what is not one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebz.codec.errors import CorruptError
from ebz.codec.listing import Listing, listed, listing_of

INT64 = st.integers(-(2**63), 2**63 - 1)


@settings(max_examples=200, deadline=None)
@given(st.sets(INT64 | st.integers(-20, 20), max_size=60), st.booleans())
def test_lists_come_back(values, is_mirrored):
    values |= {~x for x in values} if is_mirrored else set()
    found = np.array(sorted(values), np.int64)
    listing = listing_of(found)
    assert np.array_equal(listing.at(np.arange(len(found))), found)


def test_what_is_mirrored_is_told_once():
    half = np.unique(np.random.default_rng(0).integers(0, 2**40, 500))
    both = np.concatenate([~half[::-1], half])
    assert listing_of(both).size < 1.1 * listing_of(half).size


def test_plain_bits_cost_no_more_than_they_are():
    found = np.unique(np.random.default_rng(0).integers(0, 2**52, 20))
    assert listing_of(found).size <= 20 * 52 / 8


def test_those_that_fill_their_range_or_hardly_come_again_are_not_listed():
    rng = np.random.default_rng(0)
    assert listed(rng.integers(0, 50, 900)) is None
    assert listed(rng.integers(0, 2**40, 900)) is None
    assert listed(rng.integers(0, 2**40, 50)[rng.integers(0, 50, 900)]) is not None


@pytest.mark.parametrize("n", [1, 5, 60])
@settings(max_examples=200, deadline=None)
@given(data=st.binary(max_size=40))
def test_any_bytes_are_a_list_or_refused(n, data):
    try:
        found = Listing(n, data).at(np.arange(n))
    except CorruptError:
        return
    assert (np.diff(found) >= 0).all()


def test_numbers_beyond_a_list_are_refused():
    listing = listing_of(np.array([3, 8]))
    for which in (-1, 2):
        with pytest.raises(CorruptError):
            listing.at(np.array([which]))
