"""`dh-grader backup`: copy the database while the service runs."""

import sqlite3
from pathlib import Path
from typing import Annotated

import typer

from service.attempts.storage.database_file import copy_into
from service.cli.commands.attempts import database
from service.cli.terminal import give_up, tell
from service.translations import say

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
            give_up(say("{file} is there already. Choose another name.", file=str(file)))
        try:
            copy_into(Path(engine.url.database or ""), file)
        except (OSError, sqlite3.Error) as error:
            file.unlink(missing_ok=True)
            give_up(say("{file}: cannot be written: {reason}", file=str(file), reason=str(error)))
    tell(
        say(
            "{file}: {size} bytes. Only you can read it. Keep it safe.",
            file=str(file),
            size=file.stat().st_size,
        )
    )
