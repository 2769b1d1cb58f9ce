"""`dh-grader backup`: copy the database while the service runs."""

import sqlite3
from pathlib import Path
from typing import Annotated

import typer

from service.attempts.storage.database_file import copy_into
from service.cli.commands.attempts import database
from service.cli.terminal import give_up

commands = typer.Typer(add_completion=False)

USE_POSTGRESQL = (
    "The database is PostgreSQL; its own programs copy it: pg_dump and pg_restore. "
    "docs/operations.md has the commands."
)


@commands.command("backup")
def command(
    file: Annotated[Path, typer.Argument(help="The file to write. It must not exist yet.")],
) -> None:
    """Copy the database to a file, also while the service runs."""
    with database() as engine:
        if engine.dialect.name != "sqlite":
            give_up(USE_POSTGRESQL)
        if file.exists():
            give_up(f"{file} is there already. Choose another name.")
        try:
            copy_into(Path(engine.url.database or ""), file)
        except (OSError, sqlite3.Error) as error:
            file.unlink(missing_ok=True)
            give_up(f"{file}: cannot be written: {error}")
    typer.echo(f"{file}: {file.stat().st_size} bytes. Only you can read it. Keep it safe.")
