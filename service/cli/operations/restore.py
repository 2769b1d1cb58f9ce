"""`dh-grader restore`: replace the database by a backup."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer
from sqlalchemy import make_url

from service.attempts.errors import UnusableDatabaseError
from service.attempts.storage.database import open_database
from service.attempts.storage.database_file import copy_into, is_in_use
from service.cli.operations.backup import USE_POSTGRESQL
from service.cli.terminal import give_up, tell
from service.settings import load_settings
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
    target = _target()
    if not file.is_file():
        give_up(say("{file}: there is no such file.", file=str(file)))
    if _damage(file):
        give_up(say("{file} is not a whole SQLite database.", file=str(file)))
    before = target.with_name(f"{target.name}.before")
    if target.exists():
        if not replace:
            give_up(
                say(
                    "{target} is there already. Add --replace; it is then kept as {before}.",
                    target=str(target),
                    before=str(before),
                )
            )
        if before.exists():
            give_up(say("{before} is there already. Move it away first.", before=str(before)))
        if is_in_use(target):
            give_up(say("{target} is in use. Stop the service first.", target=str(target)))
    new = _copy(file, target)
    # SQLite would replay an old log over the new file.
    for old, kept in zip((target, *_logs(target)), (before, *_logs(before)), strict=True):
        if old.exists():
            old.rename(kept)
    new.rename(target)
    tell(say("{target} has the content of {file}.", target=str(target), file=str(file)))


def _copy(file: Path, target: Path) -> Path:
    new = target.with_name(f"{target.name}.new")
    for each in (new, *_logs(new)):
        each.unlink(missing_ok=True)
    try:
        copy_into(file, new)
        open_database(str(new), create=False)
    except (UnusableDatabaseError, sqlite3.Error) as error:
        new.unlink(missing_ok=True)
        give_up(joined(": ", [str(file), str(error.args[0])]))
    return new


def _logs(file: Path) -> list[Path]:
    # SQLite writes changes to these files beside the database.
    return [file.with_name(f"{file.name}{end}") for end in ("-wal", "-shm", "-journal")]


def _target() -> Path:
    setting = load_settings().database
    if setting is None:
        give_up(say("Name the database: DH_GRADER_DATABASE."))
    text = setting.get_secret_value()
    if "://" not in text:
        return Path(text)
    url = make_url(text)
    if url.get_backend_name() != "sqlite":
        give_up(USE_POSTGRESQL)
    return Path(url.database or "")


def _damage(file: Path) -> bool:
    try:
        with closing(
            sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True)
        ) as connection:
            [check] = connection.execute("PRAGMA integrity_check(1)").fetchone()
            connection.execute("SELECT version_num FROM alembic_version")
    except sqlite3.Error:
        return True
    return bool(check != "ok")
