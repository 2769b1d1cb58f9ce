from collections.abc import Callable

import pytest
from typer.testing import CliRunner, Result

from service.cli.program import program

Run = Callable[..., Result]


@pytest.fixture
def run() -> Run:
    runner = CliRunner()
    return lambda *arguments: runner.invoke(program, [str(argument) for argument in arguments])
