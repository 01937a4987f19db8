"""`ebz stats`: what is in a file, and what every part of it costs."""

from typing import TYPE_CHECKING

import click

from ebz.cli import options, table
from ebz.cli.files import Input
from ebz.cli.jobs import for_each

if TYPE_CHECKING:
    from ebz import SceneStats, Stats

EPILOG = """\b
Examples:
  ebz stats bunny.ply.ebz
  ebz stats bunny.ply  what compress would make of it
  ebz stats --json *.ebz | jq .connectivity_bytes
"""


@click.command(epilog=EPILOG)
@options.inputs
@options.as_json
@options.memory_limit
def stats(inputs: tuple[str, ...], as_json: bool, memory_limit: int) -> int:
    """Show what each INPUT holds, and the bytes and bits per vertex of its streams.

    The bits stand beside Tutte's limit, the guarantee of the model in use and the entropy of
    the vertex degrees. INPUT is an .ebz file or a mesh file. No INPUT, or "-", is standard input.
    """

    def work(name: str) -> int:
        result = _stats(Input(name, follow=True), memory_limit).as_dict()
        table.show(result, name, as_json=as_json, titled=len(inputs) > 1)
        return 0

    return for_each(inputs, work)


def _stats(source: Input, memory_limit: int) -> "Stats | SceneStats":
    import ebz

    data = source.read(memory_limit)
    try:
        return ebz.stats(data, memory_limit=memory_limit)
    except ebz.NotEbzError:
        mesh = ebz.read(source.mesh_source(data), memory_limit=memory_limit)
        return ebz.stats(mesh, memory_limit=memory_limit)
