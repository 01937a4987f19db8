"""`ebz verify`: is a file whole, and does it equal a mesh?"""

from typing import TYPE_CHECKING, Any

import click

from ebz.cli import options, table
from ebz.cli.files import Input
from ebz.cli.jobs import for_each

if TYPE_CHECKING:
    from ebz import Verification

DIFFERENT = 2

EPILOG = """\b
Examples:
  ebz verify *.ebz
  ebz verify --against bunny.ply bunny.ply.ebz
  ebz compress -c --bits 12 a.ply | ebz verify --against a.ply --json
  ebz verify -q --against a.ply a.ply.ebz && rm a.ply

Exit status: 0 fine, 1 an error (damage too), 2 a difference to MESH.
"""


@click.command(epilog=EPILOG)
@options.inputs
@click.option(
    "--against",
    metavar="MESH",
    type=click.Path(allow_dash=True, readable=False),
    help="Compare with this mesh, up to the order that INPUT does not keep.",
)
@click.option("-q", "--quiet", is_flag=True, help="Show errors only: the exit status tells.")
@options.as_json
@options.memory_limit
def verify(
    inputs: tuple[str, ...], against: str | None, quiet: bool, as_json: bool, memory_limit: int
) -> int:
    """Check each INPUT: its checksums, its digest, and by decoding all of it.

    With --against, tell whether it holds the same vertices and faces as MESH, how far
    coordinates moved, and what the first difference is. No INPUT, or "-", is standard input.
    """
    if against == "-" and (not inputs or "-" in inputs):
        raise click.UsageError("INPUT and MESH cannot both be standard input.")
    reference = _Reference(against, memory_limit)

    def work(name: str) -> int:
        import ebz

        data = Input(name, follow=True).read(memory_limit)
        result = ebz.verify(data, reference.mesh(), memory_limit=memory_limit)
        if not quiet:
            _show(result, name, against, as_json=as_json, titled=len(inputs) > 1)
        return 0 if result.equal else DIFFERENT

    return for_each(inputs, work, quiet=quiet)


class _Reference:
    """The mesh to compare with, read once, when it is first needed."""

    def __init__(self, name: str | None, memory_limit: int) -> None:
        self._name = name
        self._memory_limit = memory_limit
        self._mesh: Any = None

    def mesh(self) -> Any:
        if self._mesh is None and self._name is not None:
            import ebz

            source = Input(self._name, follow=True)
            self._mesh = ebz.read(source.mesh_source(), memory_limit=self._memory_limit)
        return self._mesh


def _show(
    result: "Verification", name: str, against: str | None, *, as_json: bool, titled: bool
) -> None:
    compared = {"against": against} if against else {}
    table.show(compared | result.as_dict(), name, as_json=as_json, titled=titled)
