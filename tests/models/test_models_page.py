"""docs/models.md: every command on the page gives what the page shows."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from ebz.cli.model import model
from ebz.codec import connectivity
from ebz.codec.models.load import load
from ebz.codec.sample import random_triangulation

PAGE = Path(__file__).parents[2] / "docs" / "models.md"
# Another version of the solver may return other, equally good potentials.
TOLERANCE = 1e-3


def examples() -> Iterator[tuple[str, str]]:
    """Each command of a console block with its output."""
    for block in re.findall(r"^```console\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE):
        command, _, output = block.partition("\n")
        yield command.removeprefix("$ "), output


def tokens(text: str) -> list[str | float]:
    """Words and numbers, so that numbers can be compared as such."""
    return [float(t) if re.fullmatch(r"-?\d+\.\d+", t) else t for t in text.split()]


@pytest.mark.parametrize(("command", "output"), list(examples()), ids=lambda text: text[:40])
def test_the_page_shows_what_the_command_prints(
    command: str, output: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    program, group, *arguments = command.split()
    assert (program, group) == ("ebz", "model")
    printed = CliRunner().invoke(model, arguments)
    assert printed.exit_code == 0
    shown, found = tokens(output), tokens(printed.stdout)
    assert len(shown) == len(found)
    for expected, actual in zip(shown, found, strict=True):
        assert actual == (
            pytest.approx(expected, abs=TOLERANCE) if isinstance(expected, float) else expected
        )


def test_the_table_of_random_triangulations() -> None:
    """Its first row; `python -m tests.bench.models` prints all of it."""
    cells = re.search(r"^\| 1 \| (\S+) \| (\S+) \|", PAGE.read_text(), re.MULTILINE)
    assert cells
    faces = random_triangulation(100_000, 1).faces
    for name, shown in zip(("loop-60", "stack"), cells.groups(), strict=True):
        word = connectivity.encode(faces, 100_000, [load(name)])[0]
        assert f"{8 * len(word.word) / 100_000:.4f}" == shown
