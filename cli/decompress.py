"""`ebz decompress`: .ebz files in, mesh files out."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ebz.cli import options
from ebz.cli.files import SUFFIX, Input, Output, stripped_name
from ebz.cli.jobs import Manner, Summary, deliver, deliver_each, is_alone
from ebz.cli.messages import Progress
from ebz.codec.threads import allowed

if TYPE_CHECKING:
    from ebz import Mesh, Scene

# What no text has: the control characters but for tab, line feed and return.
BINARY_CONTROLS = bytes(code for code in (*range(32), 127) if code not in b"\t\n\r")

EPILOG = """\b
Examples:
  ebz decompress bunny.ply.ebz            writes bunny.ply, as it was
  ebz decompress --to obj bunny.ply.ebz   writes bunny.obj
  ebz decompress -c bunny.ply.ebz | head  text formats may go to a terminal
  curl -s $URL | ebz decompress > bunny.ply
"""


@click.command(epilog=EPILOG)
@options.file_options
@click.option(
    "--to",
    "target_format",
    metavar="FMT",
    type=click.Choice(options.FORMATS, case_sensitive=False),
    help="The format to write: ply, obj, off, stl, gltf or glb. [default: by the suffix of OUT, "
    "else that of the original]",
)
@options.memory_limit
@options.threads
def decompress(
    *,
    inputs: tuple[str, ...],
    output: str | None,
    to_stdout: bool,
    keep: bool,
    remove: bool,
    force: bool,
    quiet: bool,
    verbose: bool,
    target_format: str | None,
    memory_limit: int,
    threads: int,
) -> int:
    """Turn each INPUT (a.ply.ebz) into the mesh file that it was made of (a.ply).

    What the format of the output cannot carry is named in a warning. Mode and time of INPUT are
    kept. No INPUT, or "-", is standard input, which is decompressed to standard output.
    """
    named = options.single_output(output, to_stdout, inputs)
    manner = Manner(force, remove and not keep, quiet, verbose, alone=is_alone(inputs, threads))

    def prepare(name: str) -> Callable[[], int]:
        source = Input(name, force=force)
        # An output that is certain to fail is found out before the work.
        early = Output(named, source, force=force) if named else None
        stem = "-" if named else stripped_name(source)
        summary = Summary(manner)
        packed = source.read(memory_limit)
        mesh = _decode(packed, source, manner, memory_limit)
        format_name = target_format or _format_of(mesh, named, source.path)
        target = early or Output(_with_suffix(stem, format_name), source, force=force)
        plain = _encode(mesh, format_name)
        if target.is_terminal() and not _is_text(plain):
            target.refuse_terminal()

        def finish() -> int:
            deliver(source, target, plain, manner)
            summary.show(source, target, n_plain=len(plain), n_packed=len(packed))
            return 0

        return finish

    return deliver_each(inputs, prepare, quiet=quiet, n_threads=threads)


def _decode(packed: bytes, source: Input, manner: Manner, memory_limit: int) -> "Mesh | Scene":
    import ebz

    progress = Progress(source.name, quiet=manner.quiet or not manner.alone)
    try:
        return ebz.decompress(
            packed, memory_limit=memory_limit, threads=allowed(), progress=progress
        )
    finally:
        progress.clear()


def _encode(mesh: "Mesh | Scene", format_name: str) -> memoryview:
    import ebz

    buffer = BytesIO()
    ebz.write(buffer, mesh, format=format_name)
    return buffer.getbuffer()


def _format_of(mesh: "Mesh | Scene", named: str | None, source_path: str) -> str:
    """The format of the suffix that the user gave, of the original, or of the input's name."""
    recorded = mesh.metadata.get("format")
    if recorded not in options.FORMATS:
        recorded = _suffix_format(source_path.removesuffix(SUFFIX))
    return _suffix_format(named or "") or recorded or _default_format(mesh)


def _default_format(mesh: "Mesh | Scene") -> str:
    import ebz

    return "glb" if isinstance(mesh, ebz.Scene) else "ply"


def _suffix_format(name: str) -> str | None:
    suffix = Path(name).suffix.lower().removeprefix(".")
    return suffix if suffix in options.FORMATS else None


def _with_suffix(stem: str, format_name: str) -> str:
    """`stem` with the suffix of the format: replaces that of another format, or is added."""
    if stem == "-" or _suffix_format(stem) == format_name:
        return stem
    if _suffix_format(stem):
        stem = stem[: -len(Path(stem).suffix)]
    return f"{stem}.{format_name}"


def _is_text(data: memoryview) -> bool:
    return len(bytes(data).translate(None, BINARY_CONTROLS)) == len(data)
