"""`dh-grader backup`: copy the database while the service runs."""

import sqlite3
from pathlib import Path
from typing import Annotated

import typer

from service.attempts.storage.database import file_of, unmigrated_database
from service.attempts.storage.database_file import copy_of, move_to_free_place
from service.cli.commands.attempts import database_url, usable_database
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
    source = sqlite_file()
    if not source.is_file():
        give_up(say("{file}: there is no such file.", file=str(source)))
    if file.exists():
        give_up(_is_there(file))
    try:
        # The tables may be those of any version: this command only copies them.
        with copy_of(source, file) as copy:
            move_to_free_place(copy, file)
    except FileExistsError:
        # Another backup was faster.
        give_up(_is_there(file))
    except (OSError, sqlite3.Error) as error:
        give_up(say("{file}: cannot be written: {reason}", file=str(file), reason=str(error)))
    tell(
        say(
            "{file}: {size} bytes. Only you can read it. Keep it safe.",
            file=str(file),
            size=file.stat().st_size,
        )
    )


def sqlite_file() -> Path:
    """Return the path of this installation's SQLite database; exit if there is none."""
    with usable_database():
        engine = unmigrated_database(database_url())
    if engine.dialect.name != "sqlite":
        give_up(USE_POSTGRESQL)
    path = file_of(engine)
    if path is None:
        give_up(say("Name the database by the path of its file: DH_GRADER_DATABASE."))
    return path


def _is_there(file: Path) -> str:
    return say("{file} is there already. Choose another name.", file=str(file))
