"""`dh-grader serve`, `keys` and `doctor`: run the service, its keys, and a check of all.

The service itself is in ``dh_grader.server``.
"""

import gc
import os
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Annotated, Final

import typer
from sqlalchemy import Connection, select
from sqlalchemy.exc import SQLAlchemyError

from dh_grader.access import WRONG_SECRET, Key, Scope, new_key_text
from dh_grader.access.key_ring import add_key, all_keys, fits, revoke_key, settle
from dh_grader.api.permissions import is_loopback
from dh_grader.catalogue import CatalogueError, load_catalogue
from dh_grader.cli.attempts import database, encodable
from dh_grader.cli.options import installed_exercise
from dh_grader.cli.terminal import complain, give_up, spoken, stdout, tell, tell_verdict
from dh_grader.courses import CourseError, roll, zone_named
from dh_grader.formats.texts import visible
from dh_grader.settings import Settings, SettingsError, load_settings
from dh_grader.store import UnusableDatabaseError
from dh_grader.store.database import (
    before,
    file_of,
    in_transaction,
    reason,
    revisions_of,
    safe_url,
    unfinished,
    unfit,
    unmigrated_database,
)
from dh_grader.store.tables import courses
from dh_grader.translations import Sentence, joined, say, say_count, template

# --- `dh-grader serve`: run the service on this machine


serve_commands = typer.Typer(add_completion=False)


@serve_commands.command("serve")
def serve_command(
    host: Annotated[
        str | None, typer.Option(help="The address to listen on; 0.0.0.0 for all. [127.0.0.1]")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="The port; 0 for a free one. [8000]", show_default=False)
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="The number of processes. [1]", show_default=False)
    ] = None,
) -> None:
    """Start the service. Configure it by environment variables DH_GRADER_…."""
    settings = load_settings(host=host, port=port, workers=workers)
    # Until the application has started: loading modules produces no garbage to search for.
    gc.disable()
    # Import here: the web framework is half of the program, and grading needs none of it.
    from dh_grader.server import serve

    if not serve(settings):
        give_up(
            say(
                "The service cannot listen on {host}, port {port}. Choose another with --host and "
                "--port, or with DH_GRADER_HOST and DH_GRADER_PORT.",
                host=settings.host,
                port=settings.port,
            )
        )


# --- `dh-grader keys`: create, list and revoke API keys


keys_commands = typer.Typer(
    help="API keys of the service: create, list, revoke.",
    no_args_is_help=True,
    add_completion=False,
)


@keys_commands.command("create")
def create(
    name: Annotated[
        str,
        typer.Argument(
            help="The purpose of the key, such as the name of a course.",
            show_default=False,
            callback=encodable,
        ),
    ],
    scope: Annotated[
        list[Scope] | None, typer.Option(help="A right besides grading. Repeatable.")
    ] = None,
    exercise: Annotated[
        list[str] | None, typer.Option(help="Only this exercise. Repeatable. \\[all]")
    ] = None,
    course: Annotated[
        str | None, typer.Option(help="Only this course. \\[all]", callback=encodable)
    ] = None,
    days: Annotated[int, typer.Option(min=1, max=3650, help="The key's lifetime in days.")] = 365,
) -> None:
    """Create a key and show it, once."""
    secret = load_settings().known_secret()
    if secret is None:
        give_up(
            say(
                "Keys need a secret, which the service must know as well. Make one with "
                "openssl rand -hex 32, and set DH_GRADER_SECRET, or DH_GRADER_SECRET_FILE."
            )
        )
    if course is not None and exercise:
        give_up(say("A key is for a course or for exercises: leave out --course or --exercise."))
    bound = [installed_exercise(each).id for each in exercise] if exercise else None
    text = new_key_text()
    digest = secret.key_digest(text)
    now = datetime.now(UTC)
    until = now + timedelta(days=days)
    scopes = {Scope.GRADE, *(scope or ())}

    def added(connection: Connection) -> Key | None:
        if not settle(connection, secret, now):
            return None
        if course is not None:
            roll.course(connection, course)
        return add_key(connection, name[:200], digest, scopes, bound, now, until, course)

    with database(create=True) as engine:
        try:
            key = in_transaction(engine, added)
        except CourseError as error:
            give_up(error)
    if key is None:
        give_up(WRONG_SECRET)
    # Only the key goes to standard output, for scripts.
    typer.echo(text)
    complain(
        say(
            "Key {key}, valid until {day}. Keep it now: it is not shown again.",
            key=key.id,
            day=f"{key.expires_at:%Y-%m-%d}",
        )
    )


@keys_commands.command("list")
def list_keys() -> None:
    """List the keys, without their texts."""
    secret = load_settings().known_secret()
    with database() as engine, engine.connect() as connection:
        found = all_keys(connection)
        has_their_secret = secret is None or fits(connection, secret)
    now = datetime.now(UTC)
    screen = stdout()
    for key in found:
        used = say("never used")
        if key.last_used_at:
            used = say("used {time}", time=f"{key.last_used_at:%Y-%m-%d %H:%M}")
        scopes = " ".join(sorted(key.scopes))
        told = (key.id, visible(key.name), scopes, _bound(key), _state(key, now), used)
        screen.print("  ".join(map(spoken, told)), soft_wrap=True)
    # After the list: if the secret is lost, the list shows which keys to revoke.
    if not has_their_secret:
        give_up(WRONG_SECRET)


@keys_commands.command("revoke")
def revoke(
    key: Annotated[
        str, typer.Argument(help="The id of a key, as list shows it.", callback=encodable)
    ],
) -> None:
    """Revoke a key and all tokens made with it."""
    with database() as engine:
        now = datetime.now(UTC)
        if not in_transaction(engine, lambda connection: revoke_key(connection, key, now)):
            give_up(
                say(
                    "There is no key {key} that could be revoked; dh-grader keys list shows them.",
                    key=key,
                )
            )
    tell(say("Revoked. Each running service knows it within seconds."))


def _bound(key: Key) -> str:
    if key.course:
        return say("course {course}", course=key.course)
    return say("all exercises") if key.exercises is None else ", ".join(sorted(key.exercises))


def _state(key: Key, now: datetime) -> Sentence:
    if key.revoked_at is not None:
        return say("revoked {day}", day=f"{key.revoked_at:%Y-%m-%d}")
    day = f"{key.expires_at:%Y-%m-%d}"
    return say("expired {day}", day=day) if key.expires_at <= now else say("until {day}", day=day)


# --- `dh-grader doctor`: check this installation, and say what is wrong and how to mend it


doctor_commands = typer.Typer(add_completion=False)

_OWNERS_ONLY: Final = 0o077


class AilmentError(Exception):
    """Something is wrong with the installation; the message says how to mend it."""


@doctor_commands.command("doctor")
def doctor_command() -> None:
    """Check this installation, and say how to mend it. Nothing is changed."""
    try:
        settings = load_settings()
        settings.known_secret()
    except SettingsError as error:
        tell_verdict(False, say("settings: {found}", found=error.args[0]))
        raise SystemExit(1) from error
    tell_verdict(True, say("settings"))
    wrong = 0
    for named, check in _CHECKS.items():
        try:
            for line in check(settings):
                tell_verdict(True, Sentence(named, {"found": line}))
        except AilmentError as error:
            wrong += 1
            tell_verdict(False, Sentence(named, {"found": error.args[0]}))
    tell(say("Wrong: {count}.", count=wrong) if wrong else say("Nothing is wrong."))
    raise SystemExit(1 if wrong else 0)


def _exercises(settings: Settings) -> Iterator[str]:
    try:
        count = len(load_catalogue(*settings.exercises_dir))
    except CatalogueError as error:
        raise AilmentError(error.args[0]) from error
    yield say_count("{count} exercise", "{count} exercises", count=count)


def _time_zones(_: Settings) -> Iterator[str]:
    try:
        zone_named("Europe/Berlin")
    except CourseError as error:
        raise AilmentError(
            say("there are no time zones. Install the package tzdata of the system or of Python.")
        ) from error
    yield say("time zones are known")


def _folders(settings: Settings) -> Iterator[str]:
    folder = settings.editor_dir
    if folder is None:
        return
    if not (folder.is_dir() and os.access(folder, os.W_OK)):
        raise AilmentError(
            say(
                "DH_GRADER_EDITOR_DIR: {folder} is no folder in which files can be saved.",
                folder=str(folder),
            )
        )
    yield say("the editor saves in {folder}", folder=str(folder))


def _database(settings: Settings) -> Iterator[str]:
    if settings.database is None:
        yield say(
            "none; nothing is recorded. DH_GRADER_DATABASE=attempts.db would record attempts."
        )
        return
    yield from _asked(settings, _state_of_database)


def _state_of_database(connection: Connection, _: Settings) -> Iterator[str]:
    revisions = revisions_of(connection)
    name = safe_url(connection.engine)
    if (path := file_of(connection.engine)) is not None:
        _check_file(path)
        found = connection.exec_driver_sql("PRAGMA quick_check(1)").scalar()
        if found != "ok":
            raise AilmentError(
                say(
                    "{database} is damaged: {found}. Restore a backup: dh-grader restore FILE.",
                    database=name,
                    found=str(found),
                )
            )
    if revisions.is_newer:
        raise AilmentError(joined(": ", [name, unfit(revisions)]))
    if revisions.found is None:
        yield say("{database} is empty; the service makes its tables when it starts", database=name)
    elif revisions.found != revisions.known:
        yield say(
            "{database} has tables {current}; the service migrates them to {newest} at its start",
            database=name,
            current=revisions.found,
            newest=revisions.known,
        )
    else:
        yield say("{database} answers; its tables are those of this version", database=name)


def _check_file(file: Path) -> None:
    if not os.access(file, os.W_OK) or not os.access(file.parent, os.W_OK):
        raise AilmentError(
            say(
                "{file} and its folder must be writable for the user that runs the service.",
                file=str(file),
            )
        )
    if left := unfinished(file):
        raise AilmentError(
            say(
                "{left} is left of a command that was killed, and contains answers of learners. "
                "Delete it, unless dh-grader restore is running.",
                left=str(left[0]),
            )
        )
    if os.name == "posix" and file.stat().st_mode & _OWNERS_ONLY:
        raise AilmentError(
            say(
                "other users of this machine can read {file}. Run: chmod 600 {file}", file=str(file)
            )
        )


def _keys(settings: Settings) -> Iterator[str]:
    if settings.database is None:
        _check_openness(settings, has_keys=False)
        yield say("none, because there is no database")
        return
    yield from _asked(settings, _state_of_keys)


def _state_of_keys(connection: Connection, settings: Settings) -> Iterator[str]:
    revisions = revisions_of(connection)
    if revisions.found is None:
        _check_openness(settings, has_keys=False)
        yield say("none yet")
    if revisions.found != revisions.known:
        return
    now, secret = datetime.now(UTC), settings.known_secret()
    found = all_keys(connection)
    valid = [each for each in found if each.revoked_at is None and each.expires_at > now]
    if found and secret is None:
        raise AilmentError(
            say("there are keys, but no secret: set DH_GRADER_SECRET or DH_GRADER_SECRET_FILE.")
        )
    if secret is not None and not fits(connection, secret):
        raise AilmentError(WRONG_SECRET)
    _check_openness(settings, has_keys=bool(found))
    tutors = sum(Scope.TUTOR in each.scopes for each in valid)
    if found and not tutors:
        raise AilmentError(say("no tutor can sign in: dh-grader keys create NAME --scope tutor"))
    yield say(
        "{valid} valid, {tutors} of them of tutors, {ended} ended",
        valid=len(valid),
        tutors=tutors,
        ended=len(found) - len(valid),
    )


def _check_openness(settings: Settings, *, has_keys: bool) -> None:
    is_here = settings.host == "localhost" or is_loopback(settings.host)
    if not (is_here or has_keys or settings.open is not None):
        raise AilmentError(
            say(
                "other machines can reach {host}, but there are no keys, so the service does not "
                "start. Create one: dh-grader keys create NAME --scope tutor",
                host=settings.host,
            )
        )


def _courses(settings: Settings) -> Iterator[str]:
    if settings.database is not None:
        yield from _asked(settings, _state_of_courses)


def _state_of_courses(connection: Connection, _: Settings) -> Iterator[str]:
    revisions = revisions_of(connection)
    if revisions.found != revisions.known:
        return
    zones = connection.execute(select(courses.c.id, courses.c.zone)).all()
    for course, zone in zones:
        try:
            zone_named(zone)
        except CourseError as error:
            raise AilmentError(
                say("the course {course}: {found}", course=course, found=error.args[0])
            ) from error
    yield say_count("{count} course", "{count} courses", count=len(zones))


def _asked(
    settings: Settings, question: Callable[[Connection, Settings], Iterator[str]]
) -> Iterator[str]:
    assert settings.database is not None
    try:
        engine = unmigrated_database(settings.database.get_secret_value())
    except UnusableDatabaseError as error:
        raise AilmentError(joined(": ", ["DH_GRADER_DATABASE", error.args[0]])) from error
    if engine.dialect.name == "sqlite":
        path = Path(engine.url.database or "").absolute()
        if not path.parent.is_dir():
            raise AilmentError(
                say(
                    "DH_GRADER_DATABASE: {folder} is no folder. Create it.", folder=str(path.parent)
                )
            )
        if not path.exists():
            if left := [each for each in (before(path), *unfinished(path)) if each.exists()]:
                raise AilmentError(
                    say(
                        "{file} is not there, but {left} is: a restore was interrupted. Run "
                        "dh-grader restore again, or move {left} away.",
                        file=str(path),
                        left=str(left[0]),
                    )
                )
            yield say(
                "{file} is not there yet; the service creates it when it starts", file=str(path)
            )
            return
    try:
        with engine.connect() as connection:
            yield from list(question(connection, settings))
    except SQLAlchemyError as error:
        raise AilmentError(
            say(
                "{database} does not answer: {reason}",
                database=safe_url(engine),
                reason=reason(error),
            )
        ) from error
    finally:
        engine.dispose()


# The checks by the templates of their lines.
_CHECKS: Final[dict[str, Callable[[Settings], Iterator[str]]]] = {
    template("exercises: {found}"): _exercises,
    template("time zones: {found}"): _time_zones,
    template("folders: {found}"): _folders,
    template("database: {found}"): _database,
    template("keys: {found}"): _keys,
    template("courses: {found}"): _courses,
}
