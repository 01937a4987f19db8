"""The group of all commands, each imported only when it is called."""

import importlib
import sys
from collections.abc import Sequence
from typing import Any

import click

from ebz._version import __version__
from ebz.cli import messages

# name: the line shown in `ebz --help`, so that the list needs no import of the commands.
COMMANDS = {
    "compress": "Compress mesh files into .ebz files.",
    "decompress": "Turn .ebz files into mesh files again.",
    "stats": "Show what is in a file, and what every part of it costs.",
    "verify": "Check that a file is whole, or that it equals a mesh.",
    "model": "Make and inspect models of the connectivity coder.",
    "sample": "Make meshes to try things with.",
}

EPILOG = """\b
Examples:
  ebz compress bunny.ply                      writes bunny.ply.ebz
  ebz decompress bunny.ply.ebz                writes bunny.ply
  ebz compress --max-error 0.01 *.stl         at most 0.01 units of error
  ebz verify --against bunny.ply bunny.ply.ebz
  curl -s $URL | ebz decompress --to obj > mesh.obj

\b
Exit status: 0 fine, 1 an error, 2 a difference found by verify.
Completion of options and files for bash; zsh_source and fish_source work too:
  eval "$(_EBZ_COMPLETE=bash_source ebz)"
"""


class LazyGroup(click.Group):
    """A group whose commands live in modules of this package named like them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"ebz.cli.{cmd_name}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(
    cls=LazyGroup,
    epilog=EPILOG,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, "-V", "--version", message="ebz %(version)s")
@click.pass_context
def ebz(ctx: click.Context) -> int:
    """Compress triangle meshes without loss, or within a bound that you give.

    Reads and writes PLY, OBJ, OFF, STL, glTF and GLB. "-" or no file means standard input.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
    return 0


def run(arguments: Sequence[str]) -> int:
    """Runs one command line and returns the exit status; every error becomes a line on stderr."""
    try:
        result: Any = ebz.main(list(arguments), prog_name="ebz", standalone_mode=False)
        if sys.stdout:
            sys.stdout.flush()
    except click.UsageError as error:
        messages.say(_usage(error))
        return 1
    except (KeyboardInterrupt, click.Abort):
        return messages.interrupted()
    except OSError as error:
        # Outside of `jobs.for_each`, only standard output can fail.
        messages.report(error, messages.STDOUT)
        messages.discard_stdout()
        return 1
    except Exception as error:
        messages.report(error)
        return 1
    return result if isinstance(result, int) else 0


def _usage(error: click.UsageError) -> str:
    command = error.ctx.command_path if error.ctx else "ebz"
    return f"ebz: {error.format_message()}\nTry '{command} --help'."
