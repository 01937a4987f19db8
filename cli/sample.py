"""`ebz sample`: meshes to try things with, from nothing but a size and a seed."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ebz.cli import options
from ebz.cli.files import Output
from ebz.cli.messages import STDOUT, warnings_kept, warnings_of

if TYPE_CHECKING:
    from ebz import Mesh

MAX_VERTICES = 10**7
MAX_TRIANGLES = 10**8
TEXT_FORMATS = ("obj", "off", "gltf")

Command = TypeVar("Command", bound=Callable[..., Any])

EPILOG = """\b
Examples:
  ebz sample random-triangulation -n 100000 --seed 1 -o random.ply
  ebz sample torus -n 1000000 --noise 0.001 | ebz compress -o torus.ebz
  ebz sample grid -n 5000 -o terrain.obj
"""


@click.group(epilog=EPILOG, no_args_is_help=False)
def sample() -> None:
    """Make meshes to try things with.

    The same arguments give the same mesh on every machine and in every version.
    """


def output_options(command: Command) -> Command:
    """Adds -o, --to, -f and --seed, which every sample has."""
    for option in (
        click.option("-f", "--force", is_flag=True, help="Overwrite OUT, or use a terminal."),
        click.option(
            "--to",
            "target_format",
            type=click.Choice(options.FORMATS, case_sensitive=False),
            help="The format to write. [default: that of OUT's suffix, else binary PLY]",
        ),
        click.option(
            "-o",
            "output",
            metavar="OUT",
            type=click.Path(allow_dash=True, readable=False),
            default="-",
            help="The output. [default: -, standard output]",
        ),
        click.option(
            "--seed",
            metavar="N",
            type=click.IntRange(0),
            default=0,
            show_default=True,
            help="Which of the random meshes, or which noise.",
        ),
    ):
        command = option(command)
    return command


def shape_options(command: Command) -> Command:
    """Adds the options of the smooth shapes to those of `output_options`."""
    command = click.option(
        "--noise",
        metavar="X",
        type=click.FloatRange(0),
        default=0.0,
        help="Move every coordinate by up to X at random.",
    )(output_options(command))
    return click.option(
        "-n",
        "n_triangles",
        metavar="TRIANGLES",
        type=click.IntRange(1, MAX_TRIANGLES),
        required=True,
        help="About how many triangles.",
    )(command)


@sample.command()
@click.option(
    "-n",
    "n_vertices",
    metavar="VERTICES",
    type=click.IntRange(3, MAX_VERTICES),
    required=True,
    help="How many vertices, exactly.",
)
@output_options
def random_triangulation(n_vertices: int, seed: int, **target: Any) -> int:
    """A uniform random triangulation of the sphere, about the costliest connectivity.

    Every rooted simple triangulation of the sphere with VERTICES vertices is equally likely
    (bijection of Poulalhon and Schaeffer, linear time). Positions are distinct points on a
    sphere that know nothing of the connectivity.
    """
    from ebz.codec.sample import random_triangulation

    return _write(lambda: random_triangulation(n_vertices, seed), **target)


@sample.command()
@shape_options
def sphere(n_triangles: int, noise: float, seed: int, **target: Any) -> int:
    """A unit sphere.

    An icosahedron, each face cut into k^2 triangles.
    """
    from ebz.codec.sample import sphere

    return _write(lambda: sphere(n_triangles, noise, seed), **target)


@sample.command()
@shape_options
def torus(n_triangles: int, noise: float, seed: int, **target: Any) -> int:
    """A torus.

    Its radii are 1 and 0.4, its connectivity is regular.
    """
    from ebz.codec.sample import torus

    return _write(lambda: torus(n_triangles, noise, seed), **target)


@sample.command()
@shape_options
def grid(n_triangles: int, noise: float, seed: int, **target: Any) -> int:
    """A hilly terrain.

    Over the unit square, with regular connectivity and a long boundary.
    """
    from ebz.codec.sample import grid

    return _write(lambda: grid(n_triangles, noise, seed), **target)


def _write(
    make: "Callable[[], Mesh]", *, output: str, target_format: str | None, force: bool
) -> int:
    import ebz
    from ebz.formats.meshes import format_of_suffix

    target = Output(output, None, force=force)
    format_name = target_format or format_of_suffix(Path(output).suffix.lower()) or "ply"
    if format_name not in TEXT_FORMATS:
        target.refuse_terminal()
    buffer = BytesIO()
    with warnings_kept(), warnings_of(STDOUT if output == "-" else output, quiet=False):
        ebz.write(buffer, make(), format=format_name)
    target.write([buffer.getbuffer()])
    return 0
