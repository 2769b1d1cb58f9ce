from collections.abc import Callable

import pytest
from dh_grader.cli import program
from typer.testing import CliRunner, Result

Run = Callable[..., Result]


@pytest.fixture
def run() -> Run:
    runner = CliRunner()
    return lambda *arguments: runner.invoke(program, [str(argument) for argument in arguments])
