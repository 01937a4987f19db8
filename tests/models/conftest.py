"""The shell of the tests of the command line."""

from tests.cli.conftest import sh

__all__ = ["sh"]
