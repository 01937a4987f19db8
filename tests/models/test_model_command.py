"""`ebz model`: what it prints and writes, as a shell user sees it."""

import json
from pathlib import Path

from click.testing import CliRunner, Result

import ebz
from ebz.cli.model import model
from ebz.codec.errors import EbzError, OptionError
from ebz.codec.models.table import Table
from tests.cli.shell import Shell


def ebz_model(*arguments: str) -> Result:
    return CliRunner().invoke(model, arguments)


def test_list_names_every_built_in_table() -> None:
    found = json.loads(ebz_model("list", "--json").stdout)
    assert found["loop-60"]["contexts"] == 60
    assert found["stack"]["bits_per_vertex"] < found["loop-60"]["bits_per_vertex"]


def test_certify_prints_the_bound() -> None:
    found = json.loads(ebz_model("certify", "loop-60", "--json").stdout)
    assert found["bits_per_vertex"] == found["bits_per_c"] + found["bits_per_other"]


def test_show_prices_every_symbol() -> None:
    found = json.loads(ebz_model("show", "loop-60", "--json").stdout)
    assert list(found["symbols"]) == list("CLRSE")
    assert found["symbols"]["C"]["forbidden_in_contexts"] > 0


def test_fit_writes_a_table_that_loads(tmp_path: Path) -> None:
    path = tmp_path / "small.npz"
    result = ebz_model(
        "fit", "--loops", "1", "--max-length", "5", "--max-conflict", "3", "-o", str(path), "--json"
    )
    assert json.loads(result.stdout)["model"] == "small"
    assert Table.load(path).name == "small"


def test_fit_writes_to_standard_output(sh: Shell) -> None:
    done = sh("ebz model fit --loops 1 --max-length 5 -o -")
    assert Table.from_bytes(done.stdout).name == "fit"
    assert (done.status, done.stderr) == (0, b"")


def test_nothing_is_overwritten_without_force(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    path.write_text("kept")
    result = ebz_model("fit", "--loops", "1", "-o", str(path))
    assert isinstance(result.exception, EbzError)
    assert str(result.exception) == f"{path}: already exists; use -f to overwrite it"
    assert path.read_text() == "kept"
    assert ebz_model("fit", "--loops", "1", "-fo", str(path)).exit_code == 0


def test_a_malformed_table_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bad.npz"
    path.write_bytes(b"bad")
    result = ebz_model("certify", str(path))
    assert isinstance(result.exception, OptionError)
    assert str(result.exception).startswith(f"{path}: ")


def test_figures_have_numbers() -> None:
    assert json.loads(ebz_model("figure", "1", "--json").stdout)["rows"]


def test_a_figure_is_a_file_or_json() -> None:
    assert ebz_model("figure", "1", "-o", "f.svg", "--json").exit_code == 2


def test_a_figure_without_a_file_is_its_numbers() -> None:
    assert "0.6180" in ebz_model("figure", "1").stdout


def test_the_adversary_s_mesh_codes_to_what_it_says(tmp_path: Path) -> None:
    path = tmp_path / "costly.ply"
    found = json.loads(ebz_model("adversary", "-n", "60", "-o", str(path), "--json").stdout)
    mesh = ebz.read(path)
    assert len(mesh.vertices) == found["vertices"]
    assert found["bits"] <= found["certified_bits"]
    n_bytes = ebz.stats(ebz.compress(mesh, model="stack")).streams
    (word,) = (stream.bytes for stream in n_bytes if stream.name == "word")
    assert 0 <= 8 * word - found["bits"] < 8 * 20  # the chunk's frame, and the last byte


def test_the_adversary_is_for_stack_tables() -> None:
    result = ebz_model("adversary", "loop-60")
    assert str(result.exception).startswith("model 'loop-60': an automaton")


def test_json_is_one_line(tmp_path: Path) -> None:
    small = ["--loops", "1", "--max-length", "4", "--max-conflict", "2"]
    for arguments in (
        ["list"],
        ["fit", *small, "-o", str(tmp_path / "t.npz")],
        ["show", str(tmp_path / "t.npz")],
        ["certify", str(tmp_path / "t.npz")],
        ["figure", "2"],
    ):
        printed = ebz_model(*arguments, "--json").stdout
        assert printed.count("\n") == 1
        assert json.loads(printed)


def test_tables_and_figures_do_not_go_to_a_folder_that_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "missing" / "t.npz"
    result = ebz_model("fit", "--loops", "1", "-o", str(path))
    assert str(result.exception) == f"{path}: No such file or directory"
