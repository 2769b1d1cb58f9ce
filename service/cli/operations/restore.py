"""`dh-grader restore`: replace the database by a backup."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from service.attempts.storage.database import compared, unfit
from service.attempts.storage.database_file import InUseError, before, copy_of, replace_database
from service.cli.operations.backup import sqlite_file
from service.cli.terminal import give_up, tell
from service.translations import joined, say

commands = typer.Typer(add_completion=False)


@commands.command("restore")
def command(
    file: Annotated[Path, typer.Argument(help="A file that dh-grader backup wrote.")],
    replace: Annotated[
        bool, typer.Option("--replace", help="Replace the database; keep it as FILE.before.")
    ] = False,
) -> None:
    """Put a backup in the place of the database, while no service runs."""
    target = sqlite_file()
    if not file.is_file():
        give_up(say("{file}: there is no such file.", file=str(file)))
    if problem := _problem(file):
        give_up(problem)
    kept = before(target)
    if target.exists():
        if not replace:
            give_up(
                say(
                    "{target} is there already. Add --replace; it is then kept as {before}.",
                    target=str(target),
                    before=str(kept),
                )
            )
        if kept.exists() and not kept.samefile(target):
            give_up(_is_there(kept))
    try:
        with copy_of(file, target) as copy:
            replace_database(copy, target)
    except InUseError:
        give_up(say("{target} is in use. Stop the service first.", target=str(target)))
    except FileExistsError:
        give_up(_is_there(kept))
    except (OSError, sqlite3.Error) as error:
        give_up(joined(": ", [str(file), str(error)]))
    tell(say("{target} has the content of {file}.", target=str(target), file=str(file)))


def _is_there(kept: Path) -> str:
    return say("{before} is there already. Move it away first.", before=str(kept))


def _problem(file: Path) -> str:
    # Return why the backup cannot be used, or "". Its tables may be older: the service updates
    # them when it starts.
    try:
        with closing(
            sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True)
        ) as connection:
            [check] = connection.execute("PRAGMA integrity_check(1)").fetchone()
            revisions = connection.execute("SELECT version_num FROM alembic_version").fetchall()
    except sqlite3.Error:
        return say("{file} is not a whole SQLite database.", file=str(file))
    if check != "ok" or len(revisions) != 1:
        return say("{file} is not a whole SQLite database.", file=str(file))
    found = compared(revisions[0][0])
    return joined(": ", [str(file), unfit(found)]) if found.is_newer else ""
