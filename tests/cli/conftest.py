from collections.abc import Callable

import pytest
from typer.testing import CliRunner, Result

from service.cli.program import program

Run = Callable[..., Result]


@pytest.fixture
def run() -> Run:
    """A function that runs the command line in this process, with output as for a pipe."""
    runner = CliRunner()
    return lambda *arguments: runner.invoke(program, [str(argument) for argument in arguments])
