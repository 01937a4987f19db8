"""`ebz model`: the tables that the connectivity coder takes its probabilities from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ebz.cli.files import Output
from ebz.cli.table import json_of

as_json = click.option("--json", "as_json", is_flag=True, help="Print one line of JSON.")
force = click.option("-f", "--force", is_flag=True, help="Overwrite files, use terminals.")
named = click.argument("model", metavar="NAME|FILE")

EPILOG = """\b
Examples:
  ebz model list
  ebz model certify loop-60
  ebz model fit --loops 3 --max-length 8 --max-conflict 8 -o big.npz
  ebz compress --model big.npz bunny.ply
  ebz model adversary stack -o costly.ply
"""


@click.group(epilog=EPILOG, no_args_is_help=False)
def model() -> None:
    """Make, show and certify models of the connectivity coder.

    A model gives the probability of each symbol of the CLRSE word. Its certificate bounds the
    bits per vertex on every mesh of genus 0, whatever its shape.
    """


@model.command("list")
@as_json
def list_models(as_json: bool) -> None:
    """List the built-in models with their guaranteed bits per vertex."""
    from ebz.codec.models.guarantee import guaranteed_bits
    from ebz.codec.models.load import load
    from ebz.codec.models.table import table_names

    tables = {name: load(name) for name in table_names()}
    rows = {
        name: {
            "kind": table.kind,
            "contexts": len(table.frequencies),
            "bits_per_vertex": guaranteed_bits(table),
        }
        for name, table in tables.items()
    }
    _print(rows, as_json)


@model.command()
@named
@as_json
def show(model: str, as_json: bool) -> None:
    """Show a model: its states, its size, its bound, and what each symbol costs in bits."""
    from ebz.codec.models.load import load
    from ebz.codec.models.summary import summary

    _print(summary(load(model)), as_json)


@model.command()
@named
@as_json
def certify(model: str, as_json: bool) -> None:
    """Derive the guarantee of a model from its integers alone, or say why there is none."""
    from ebz.codec.models.certify import certify as derive
    from ebz.codec.models.load import load

    _print(derive(load(model)).as_dict(), as_json)


@model.command()
@click.option("--loops", default=2, show_default=True, help="Loops of the stack to remember.")
@click.option("--max-length", default=12, show_default=True, help="Longest loop to remember.")
@click.option("--max-conflict", default=12, show_default=True, help="Largest conflict to remember.")
@click.option(
    "--states", "n_states", type=int, help="Choose that many of the states, as well as is found."
)
@click.option("-o", "--output", metavar="TABLE", required=True, help='File to write ("-": stdout).')
@force
@as_json
def fit(output: str, force: bool, as_json: bool, **limits: Any) -> None:
    """Fit a model to the language of all meshes and write its table.

    Prints the certificate, unless the table goes to standard output.
    """
    from ebz.codec.models.certify import certify
    from ebz.codec.models.fit import fit as fit_table

    target = _binary_output(output, force)
    to_stdout = target.descriptor is not None
    table = fit_table(**limits, name="fit" if to_stdout else Path(output).stem)
    certificate = certify(table)
    target.write([table.to_bytes()])
    if not to_stdout:
        _print(certificate.as_dict(), as_json)


@model.command()
@click.argument("number", type=click.Choice(["1", "2", "4"]))
@click.option("-o", "--output", metavar="FILE", help="File to draw, .svg or .png.")
@force
@as_json
def figure(number: str, output: str | None, force: bool, as_json: bool) -> None:
    """Reproduce figure 1, 2 or 4 of the paper, as a drawing or (without -o) as its numbers.

    \b
    1  probabilities and word counts of the golden-mean language
    2  its bits per symbol under a constraint on one symbol
    4  bits per vertex and growth of loop automata against their number of states
    """
    if output is not None and as_json:
        raise click.UsageError("-o FILE and --json exclude each other.")
    if output is None:
        from ebz.codec.models.theory import FIGURES

        _print(FIGURES[int(number)](), as_json)
        return
    from ebz.codec.models.figures import draw

    target = _binary_output(output, force)
    target.write([draw(int(number), Path(output).suffix.removeprefix("."))])


@model.command()
@click.argument("model", metavar="[NAME|FILE]", default="stack")
@click.option(
    "-n", "n_vertices", metavar="VERTICES", default=1000, show_default=True, help="About how many."
)
@click.option(
    "--width", metavar="N", default=30, show_default=True, help="How many words are kept at a time."
)
@click.option("-o", "--output", metavar="MESH", help="Write the costliest mesh, as binary PLY.")
@force
@as_json
def adversary(
    model: str, n_vertices: int, width: int, output: str | None, force: bool, as_json: bool
) -> None:
    """Search the mesh that costs a stack model most, to see how tight its guarantee is.

    Prints the bits of the costliest word found, and what the certificate grants it.
    """
    from ebz.codec.models.adversary import costly_word, stack_table
    from ebz.codec.models.certify import certify
    from ebz.codec.models.load import load

    target = None if output is None else _binary_output(output, force)
    table = stack_table(load(model))
    word = costly_word(table, n_vertices, width)
    if target is not None:
        target.write([_mesh_file(word.faces())])
    if target is None or target.descriptor is None:
        limit = word.limit(certify(table))
        result = {
            "model": table.name,
            "vertices": word.n_vertices,
            "bits": word.bits,
            "certified_bits": limit,
            "bits_per_vertex": word.bits / word.n_vertices,
            "certified_bits_per_vertex": limit / word.n_vertices,
        }
        _print(result, as_json)


def _mesh_file(faces: Any) -> bytes:
    """A PLY file of those faces; the positions know nothing of them."""
    from io import BytesIO

    import ebz
    from ebz.codec.sample import spiral

    buffer = BytesIO()
    ebz.write(buffer, ebz.Mesh(spiral(int(faces.max()) + 1), faces), format="ply")
    return buffer.getvalue()


def _binary_output(name: str, force: bool) -> Output:
    target = Output(name, None, force=force)
    target.refuse_terminal()
    return target


def _print(result: dict[str, Any], as_json: bool) -> None:
    if as_json:
        click.echo(json_of(result), nl=False)
        return
    if all(isinstance(value, dict) for value in result.values()):
        _print_rows(result)
        return
    width = max(map(len, result))
    for name, value in result.items():
        if isinstance(value, dict) and all(isinstance(cell, dict) for cell in value.values()):
            click.echo()
            _print_rows(value)
        elif isinstance(value, list):
            _print_rows({str(number): row for number, row in enumerate(value, 1)})
        elif isinstance(value, dict):
            click.echo(f"{name:{width}}  " + "  ".join(f"{k} {_text(v)}" for k, v in value.items()))
        elif value is not None:
            click.echo(f"{name:{width}}  {_text(value)}")


def _print_rows(rows: dict[str, dict[str, Any]]) -> None:
    """A table with one line per row and one aligned column per field."""
    names = list(next(iter(rows.values())))
    first = max(map(len, rows))
    cells = {row: [_text(values[name]) for name in names] for row, values in rows.items()}
    lines = [names, *cells.values()]
    widths = [max(len(line[i]) for line in lines) for i in range(len(names))]
    for label, row in {"": names, **cells}.items():
        columns = (f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True))
        click.echo(f"{label:{first}}  " + "  ".join(columns))


def _text(value: Any) -> str:
    return f"{value:.5f}" if isinstance(value, float) else str(value)
