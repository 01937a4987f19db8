"""`ebz compress`: mesh files in, .ebz files out."""

from collections.abc import Callable
from typing import Any

import click

from ebz.cli import options
from ebz.cli.files import Input, Output, compressed_name
from ebz.cli.jobs import Manner, Summary, deliver, deliver_each, is_alone
from ebz.cli.messages import Progress
from ebz.codec.threads import allowed

EPILOG = """\b
Examples:
  ebz compress bunny.ply                     writes bunny.ply.ebz
  ebz compress --bits 14 -o b.ebz bunny.ply  a grid of 2^14 steps
  ebz compress --max-error 0.005 *.stl       no coordinate moves by more
  ebz compress --grid 0,0.01 tile*.ply       tiles meet without cracks
  ebz compress --keep-order rig.ply          indices stay valid
  make-mesh | ebz compress > mesh.ebz        recognised by content

On a terminal, one line per file tells the sizes; -q omits it, -v says more.
"""


@click.command(epilog=EPILOG)
@options.file_options
@click.option(
    "--from",
    "source_format",
    metavar="FMT",
    type=click.Choice(options.FORMATS, case_sensitive=False),
    help="The format of INPUT: ply, obj, off, stl, gltf or glb. [default: by content]",
)
@click.option(
    "--bits",
    metavar="N",
    type=click.IntRange(1, 30),
    help="Round positions to 2^N steps along the longest side.",
)
@click.option(
    "--max-error",
    metavar="X",
    type=float,
    help="Move no coordinate by more than X, in units of the mesh.",
)
@click.option(
    "--grid",
    metavar="ORIGIN,STEP",
    type=options.grid,
    help="Round positions to ORIGIN (one number, or X,Y,Z) plus multiples of STEP.",
)
@click.option(
    "--attribute-bits",
    metavar="NAME=N",
    multiple=True,
    type=options.named(int),
    help="Round attribute NAME to 2^N steps of its range.",
)
@click.option(
    "--attribute-error",
    metavar="NAME=X",
    multiple=True,
    type=options.named(float),
    help="Move no value of attribute NAME by more than X.",
)
@click.option(
    "--normal-bits",
    metavar="N",
    type=click.IntRange(2, 16),
    help="Round normals to about 4^N directions.",
)
@click.option(
    "--keep-order",
    is_flag=True,
    help="Keep the order of vertices and faces and the first corner of each face.",
)
@options.levels
@options.threads
@click.option("--model", metavar="NAME|FILE", help="The model that codes connectivity.")
@click.option("--embed-model", is_flag=True, help="Store the tables of the model in the file.")
@click.option("--triangulate", is_flag=True, help="Cut polygons into fans of triangles.")
def compress(
    *,
    inputs: tuple[str, ...],
    output: str | None,
    to_stdout: bool,
    keep: bool,
    remove: bool,
    force: bool,
    quiet: bool,
    verbose: bool,
    source_format: str | None,
    triangulate: bool,
    level: int | None,
    threads: int,
    **coding: Any,
) -> int:
    """Compress each INPUT (a.ply) into a file next to it (a.ply.ebz).

    PLY, OBJ, OFF, STL, glTF and GLB are read. Nothing is lost unless --bits, --max-error or
    --grid allows it, not even isolated vertices or attributes; only the order of vertices and faces
    may change, unless --keep-order is given. Mode and time of INPUT are kept. No INPUT, or "-",
    is standard input, which is compressed to standard output.
    """
    if sum(coding[name] is not None for name in ("bits", "max_error", "grid")) > 1:
        raise click.UsageError("--bits, --max-error and --grid exclude each other.")
    named = options.single_output(output, to_stdout, inputs)
    manner = Manner(force, remove and not keep, quiet, verbose, alone=is_alone(inputs, threads))
    coding["level"] = level or 6
    for name in ("attribute_bits", "attribute_error"):
        coding[name] = dict(coding[name])

    def prepare(name: str) -> Callable[[], int]:
        source = Input(name, force=force)
        target = Output(named or compressed_name(source), source, force=force)
        target.refuse_terminal()
        read_options = {"format": source_format, "triangulate": triangulate}
        return _compress_one(source, target, manner, read_options, coding)

    return deliver_each(inputs, prepare, quiet=quiet, n_threads=threads)


def _compress_one(
    source: Input,
    target: Output,
    manner: Manner,
    read_options: dict[str, Any],
    coding: dict[str, Any],
) -> Callable[[], int]:
    import ebz

    summary = Summary(manner)
    progress = Progress(source.name, quiet=manner.quiet or not manner.alone)
    mesh = ebz.read(source.mesh_source(), **read_options)
    try:
        data = ebz.compress(mesh, threads=allowed(), progress=progress, **coding)
    finally:
        progress.clear()

    def finish() -> int:
        deliver(source, target, data, manner)
        summary.show(source, target, n_plain=source.n_bytes, n_packed=len(data))
        return 0

    return finish
