"""`ebz.models` and `ebz.compress(model=...)`: what is exported, and what is refused."""

import sys
from pathlib import Path
from subprocess import run

import numpy as np
import pytest

import ebz
from ebz.codec.models import guarantee
from ebz.codec.models.table import C, E
from tests.cli.shell import Shell

TETRAHEDRON = ebz.Mesh(np.eye(4)[:, :3], np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]))


def unsound() -> ebz.models.Table:
    """The table of a small automaton with a C forbidden that meshes may need."""
    table = ebz.models.fit(1, 5, 3)
    state = int(np.flatnonzero(table.frequencies[1:, C])[0]) + 1
    table.frequencies[state, E] += table.frequencies[state, C]
    table.frequencies[state, C] = table.successors[state, C] = 0
    return table


def test_everything_exported_is_there_and_documented() -> None:
    for name in ebz.models.__all__:
        assert getattr(ebz.models, name).__doc__
    assert dir(ebz.models) == ebz.models.__all__
    with pytest.raises(AttributeError, match=r"'ebz.models' has no attribute 'nothing'"):
        _ = ebz.models.nothing  # type: ignore[attr-defined]


def test_importing_ebz_loads_no_model() -> None:
    code = "import sys, ebz; assert 'models' in dir(ebz); sys.exit('ebz.models' in sys.modules)"
    assert run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_certified_table_of_one_s_own_is_used(tmp_path: Path) -> None:
    table = ebz.models.fit(1, 5, 3)
    table.save(tmp_path / "mine.npz")
    for model in (table, tmp_path / "mine.npz"):
        data = ebz.compress(TETRAHEDRON, model=model)
        assert ebz.stats(data).guarantee_bits_per_vertex == pytest.approx(
            ebz.models.certify(table).bits_per_vertex
        )


def test_a_table_without_a_certificate_is_refused(tmp_path: Path) -> None:
    table, path = unsound(), tmp_path / "bad.npz"
    table.save(path)
    with pytest.raises(ebz.OptionError, match=r"^it guarantees nothing: .*unsound: state"):
        ebz.compress(TETRAHEDRON, model=table)
    with pytest.raises(ebz.OptionError, match=rf"^{path}: it guarantees nothing: .*unsound"):
        ebz.compress(TETRAHEDRON, model=path)


def test_a_table_in_a_file_needs_no_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    from ebz import coding

    monkeypatch.setattr(coding, "guaranteed_bits", lambda table: 0.0)
    triangle = ebz.Mesh(np.eye(3), np.array([(0, 1, 2)]))
    data = ebz.compress(triangle, model=unsound())
    assert ebz.verify(data, triangle).equal
    assert ebz.stats(data).guarantee_bits_per_vertex == float("inf")


def test_built_in_tables_are_not_certified_again(monkeypatch: pytest.MonkeyPatch) -> None:
    from ebz.codec.models import certify

    def refuse(table: object) -> None:
        raise AssertionError("certified")

    monkeypatch.setattr(certify, "certify", refuse)
    for name in guarantee.BUILT_IN:
        ebz.compress(TETRAHEDRON, model=name)


def test_the_shell_says_why_a_table_is_refused(sh: Shell, tmp_path: Path) -> None:
    unsound().save(tmp_path / "bad.npz")
    done = sh("ebz compress --model bad.npz a.ply")
    assert done.status == 1
    assert done.stderr.startswith(b"ebz: bad.npz: it guarantees nothing: model 'fit': unsound")
    assert not (tmp_path / "a.ply.ebz").exists()
