"""`dh-grader learners`: the data about one learner."""

import json
from pathlib import Path
from typing import Annotated

import typer

from service.attempts.learner_data import everything_of
from service.cli.commands.attempts import database, encodable
from service.cli.files.output import write
from service.cli.terminal import give_up
from service.translations import say

commands = typer.Typer(
    help="Learners: export all that is known of one.", no_args_is_help=True, add_completion=False
)


@commands.callback()
def _group() -> None:
    """Learners."""


@commands.command("export")
def export(
    learner: Annotated[
        str, typer.Argument(help="The learner's id in attempts and courses.", callback=encodable)
    ],
    output: Annotated[Path | None, typer.Option(help="The file to write.")] = None,
) -> None:
    """Write everything that is known of a learner, as JSON."""
    with database() as engine, engine.connect() as connection:
        found = everything_of(connection, learner)
    if not any(rows for name, rows in found.items() if name != "learner"):
        give_up(say("Nothing is recorded of this learner."))
    text = json.dumps(found, indent=2, ensure_ascii=False)
    write([f"{text}\n".encode()], output, at_once=True)
