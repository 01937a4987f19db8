"""Options that several commands share, and the types of their values."""

import re
from collections.abc import Callable
from typing import Any, TypeVar

import click

FORMATS = ("ply", "obj", "off", "stl", "gltf", "glb")
POWERS = {unit: power for power, unit in enumerate((None, "k", "m", "g", "t"))}

Command = TypeVar("Command", bound=Callable[..., Any])


def size(text: str) -> int:
    """A number of bytes: 64MiB = 64M = 2^26, 1GB = 10^9, as in the GNU tools."""
    parts = re.fullmatch(r"(\d{1,15}(?:\.\d+)?) ?(?:([kmgt])(i?b)?|b)?", text, re.I | re.A)
    if not parts:
        raise click.BadParameter(f"{text!r} is not a size such as 64MiB, 1GB or 500k.")
    number, unit, suffix = (part and part.lower() for part in parts.groups())
    base = 1000 if suffix == "b" else 1024
    n_bytes = int(float(number) * base ** POWERS[unit])
    if n_bytes < 1:
        raise click.BadParameter(f"{text!r} leaves no memory at all.")
    return n_bytes


def grid(text: str) -> tuple[list[float], float]:
    """The origin and the step of a grid: ORIGIN,STEP or X,Y,Z,STEP."""
    try:
        *origin, step = map(float, text.split(","))
    except ValueError:
        origin, step = [], 0.0
    if len(origin) not in (1, 3):
        raise click.BadParameter(f"{text!r} is not ORIGIN,STEP or X,Y,Z,STEP.")
    return origin, step


def named(kind: Callable[[str], Any]) -> Callable[[str], tuple[str, Any]]:
    """A parser of NAME=VALUE; names may have = in them."""

    def parse(text: str) -> tuple[str, Any]:
        name, equals, value = text.rpartition("=")
        try:
            if equals:
                return name, kind(value)
        except ValueError:
            pass
        raise click.BadParameter(f"{text!r} is not NAME=VALUE, VALUE being a number.")

    return parse


class LevelOption(click.Option):
    """One of -1 .. -9; the first stands for all of them in the help."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        return ("-1 .. -9", self.help or "") if self.opts == ["-1"] else None


def levels(command: Command) -> Command:
    """Adds the options -1 .. -9, which set `level`; the last one given counts."""
    for level in range(9, 0, -1):
        command = click.option(
            f"-{level}",
            "level",
            cls=LevelOption,
            type=int,
            flag_value=level,
            default=None,
            help="Faster .. smaller. [default: -6]",
        )(command)
    return command


def file_options(command: Command) -> Command:
    """Adds what compress and decompress have in common with zstd."""
    for option in (
        click.option("-v", "--verbose", is_flag=True, help="Show sizes, ratio and time per file."),
        click.option("-q", "--quiet", is_flag=True, help="Show errors only."),
        click.option(
            "-f",
            "--force",
            is_flag=True,
            help="Overwrite files, follow symbolic links, use terminals.",
        ),
        click.option(
            "--rm", "remove", is_flag=True, help="Remove each INPUT once its output file is safe."
        ),
        click.option("-k", "--keep", is_flag=True, help="Keep each INPUT. [default]"),
        click.option("-c", "--stdout", "to_stdout", is_flag=True, help="The same as -o -."),
        click.option(
            "-o",
            "output",
            metavar="OUT",
            type=click.Path(allow_dash=True, readable=False),
            help="The output, for a single INPUT; - is standard output.",
        ),
        inputs,
    ):
        command = option(command)
    return command


inputs = click.argument(
    "inputs", metavar="[INPUT]...", nargs=-1, type=click.Path(allow_dash=True, readable=False)
)
as_json = click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
memory_limit = click.option(
    "--memory-limit",
    metavar="SIZE",
    type=size,
    default="4GiB",
    show_default=True,
    help="Refuse what needs more memory than this: 64MiB, 1GB, 500k.",
)


threads = click.option(
    "-T",
    "--threads",
    metavar="N",
    type=click.IntRange(0),
    default=1,
    show_default=True,
    help="Use up to N threads, 0 for one per core; the output is the same.",
)


def single_output(output: str | None, to_stdout: bool, inputs: tuple[str, ...]) -> str | None:
    """The output named by -o or -c, which exclude each other and take one input only."""
    if to_stdout and output not in (None, "-"):
        raise click.UsageError("-c and -o exclude each other.")
    name = "-" if to_stdout else output
    if name is not None and len(inputs) > 1:
        raise click.UsageError(f"{'-c' if to_stdout else '-o'} takes one INPUT only.")
    return name
