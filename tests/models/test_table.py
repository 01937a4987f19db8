"""Tables: the same integers in and out, and every malformed file refused with its place."""

import io
import sys
import zipfile
from contextlib import suppress
from pathlib import Path
from subprocess import run

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ebz.codec.errors import OptionError
from ebz.codec.models import build
from ebz.codec.models.certify import certify
from ebz.codec.models.guarantee import BUILT_IN, guaranteed_bits
from ebz.codec.models.load import from_bytes, load
from ebz.codec.models.table import TABLES, TOTAL, C, S, Table, table_names


@pytest.fixture
def table() -> Table:
    loaded = Table.load("loop-60")
    return Table(loaded.name, loaded.frequencies.copy(), loaded.successors.copy())


def changed(table: Table, **arrays: object) -> bytes:
    buffer = io.BytesIO()
    fields = {
        "name": "x",
        "kind": table.kind,
        "frequencies": table.frequencies,
        "successors": table.successors,
    }
    np.savez(buffer, **{k: np.asarray(v) for k, v in (fields | arrays).items() if v is not None})
    return buffer.getvalue()


@pytest.mark.parametrize("name", table_names())
def test_built_in_tables_keep_their_form(name: str) -> None:
    table = load(name)
    assert table.name == name
    assert (table.frequencies.sum(axis=1) == TOTAL).all()
    assert (TABLES / f"{name}.npz").stat().st_size <= 64 << 10


def test_refitting_gives_the_same_bytes() -> None:
    assert build.loop_60().to_bytes() == (TABLES / "loop-60.npz").read_bytes()


@pytest.mark.parametrize("name", table_names())
def test_guarantees_of_built_in_tables_are_their_certificates(name: str) -> None:
    table = load(name)
    assert guaranteed_bits(table) == BUILT_IN[name]
    assert -1e-9 < BUILT_IN[name] - certify(table).bits_per_vertex < 2e-5


def test_a_changed_table_of_a_built_in_name_has_its_own_guarantee(table: Table) -> None:
    table.frequencies[0, C] -= 1000
    table.frequencies[0, S] += 1000
    assert guaranteed_bits(table) > BUILT_IN["loop-60"]


def test_loop_60_beats_the_most_visited_states(table: Table) -> None:
    assert len(table.frequencies) <= 60


def test_loading_imports_no_scipy() -> None:
    code = (
        "import sys; from ebz.codec.models.table import Table; Table.load('loop-60');"
        "sys.exit('scipy' in sys.modules)"
    )
    assert run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_table_survives_its_file(table: Table, tmp_path: Path) -> None:
    path = tmp_path / "t.npz"
    table.save(path)
    again = Table.load(path)
    assert (again.frequencies == table.frequencies).all()
    assert (again.successors == table.successors).all()
    assert again.to_bytes() == path.read_bytes()


def test_an_unknown_name_says_which_there_are() -> None:
    with pytest.raises(OptionError, match=r"no model 'loop-61'.*loop-60"):
        Table.load("loop-61")


def test_an_unknown_kind_is_refused(table: Table) -> None:
    with pytest.raises(OptionError, match="unknown kind 'tree'"):
        from_bytes(changed(table, kind="tree"))


def test_a_folder_is_not_a_table(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="cannot read it"):
        Table.load(tmp_path)


def test_a_row_that_does_not_sum_up_is_named(table: Table) -> None:
    table.frequencies[7, S] += 1
    with pytest.raises(OptionError, match="row 7 sums to 65537"):
        Table.from_bytes(table.to_bytes())


def test_only_c_may_be_forbidden(table: Table) -> None:
    table.frequencies[3, C] += table.frequencies[3, S]
    table.frequencies[3, S] = 0
    with pytest.raises(OptionError, match="row 3 forbids S"):
        Table.from_bytes(table.to_bytes())


def test_the_start_must_allow_c(table: Table) -> None:
    table.frequencies[0, S] += table.frequencies[0, C]
    table.frequencies[0, C] = 0
    with pytest.raises(OptionError, match="state 0"):
        Table.from_bytes(table.to_bytes())


def test_a_successor_out_of_range_is_named(table: Table) -> None:
    table.successors[5, S] = 60
    with pytest.raises(OptionError, match="row 5, S: successor 60 of 60 states"):
        Table.from_bytes(table.to_bytes())


def test_a_successor_of_a_forbidden_symbol_is_refused(table: Table) -> None:
    row = int(np.flatnonzero(table.frequencies[:, C] == 0)[0])
    table.successors[row, C] = 1
    with pytest.raises(OptionError, match=f"row {row}, C: successor 1 of a forbidden symbol"):
        Table.from_bytes(table.to_bytes())


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"frequencies": None}, "no array 'frequencies'"),
        ({"kind": "tree"}, "kind 'tree' is not 'automaton'"),
        ({"frequencies": np.zeros((60, 4), np.uint32)}, r"not both \(n, 5\)"),
        ({"frequencies": np.zeros((60, 5))}, "declares"),
        ({"frequencies": np.full((60, 5), -1)}, "does not fit uint32"),
        ({"successors": np.full((60, 5), 65536)}, "does not fit uint16"),
        ({"frequencies": np.zeros((0, 5), int), "successors": np.zeros((0, 5), int)}, "0 states"),
        ({"frequencies": np.zeros(1 << 19, np.uint8)}, "declares"),
    ],
)
def test_malformed_arrays_are_refused(
    table: Table, arrays: dict[str, object], message: str
) -> None:
    with pytest.raises(OptionError, match=message):
        Table.from_bytes(changed(table, **arrays))


def test_a_declared_size_is_not_believed() -> None:
    """A header of a few bytes that declares 2^40 numbers is refused before any is allocated."""
    header = b"{'descr': '<u4', 'fortran_order': False, 'shape': (1099511627776, 5)}\n"
    content = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("frequencies.npy", content)
    with pytest.raises(OptionError, match="declares"):
        Table.from_bytes(buffer.getvalue())


def test_every_prefix_is_refused(table: Table) -> None:
    data = table.to_bytes()
    for length in range(0, len(data), 7):
        with pytest.raises(OptionError):
            Table.from_bytes(data[:length])


@given(st.data())
def test_a_flipped_byte_never_gives_another_error(data: st.DataObject) -> None:
    content = bytearray((TABLES / "loop-60.npz").read_bytes())
    place = data.draw(st.integers(0, len(content) - 1))
    content[place] ^= data.draw(st.integers(1, 255))
    with suppress(OptionError):
        assert Table.from_bytes(bytes(content)).frequencies.shape == (60, 5)
