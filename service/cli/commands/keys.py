"""`dh-grader keys`: create, list and revoke API keys."""

from datetime import UTC, datetime, timedelta
from typing import Annotated

import typer
from sqlalchemy import Connection

from service.access.caller import Scope
from service.access.key_table import add_key, all_keys, fits, revoke_key, settle
from service.access.key_text import new_key_text
from service.access.keys import WRONG_SECRET, Key
from service.attempts.storage.database import in_transaction
from service.cli.commands.attempts import database, encodable
from service.cli.language import spoken
from service.cli.terminal import complain, give_up, installed_exercise, stdout, tell
from service.courses import roll
from service.courses.errors import CourseError
from service.formats.shared.plain_text import visible
from service.settings import load_settings
from service.translations import Sentence, say

commands = typer.Typer(
    help="API keys of the service: create, list, revoke.",
    no_args_is_help=True,
    add_completion=False,
)


@commands.command("create")
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


@commands.command("list")
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


@commands.command("revoke")
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
