"""`dh-grader attempts`: the recorded attempts of this installation."""

import getpass
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Final

import typer
from sqlalchemy import Engine, func, select
from sqlalchemy.exc import SQLAlchemyError

from service.attempts.attempt import AttemptFilter, GradesFormat
from service.attempts.errors import (
    UnknownAttemptError,
    UnusableDatabaseError,
    UnusablePointsError,
)
from service.attempts.learner_data import delete_older, is_older, months_before
from service.attempts.results.grades import counting_rules, graded_attempts, written
from service.attempts.results.listing import page
from service.attempts.results.statistics import exercise_statistics
from service.attempts.storage.database import (
    in_transaction,
    migrate_database,
    open_database,
    reason,
)
from service.attempts.storage.erasure import overwrite_deleted
from service.attempts.storage.tables import attempts
from service.attempts.tutoring import (
    LearnerData,
    data_of,
    forget,
    override,
)
from service.cli.files.output import write
from service.cli.language import spoken
from service.cli.terminal import complain, give_up, installed, installed_exercise, stdout, tell
from service.formats.shared.plain_text import number, visible, whole_percent
from service.settings import load_settings
from service.translations import joined, paragraph, say

commands = typer.Typer(
    help="Recorded attempts: read, export, regrade, forget.",
    no_args_is_help=True,
    add_completion=False,
)

_MOST_SLIPS: Final = 15
_MOST_LISTED: Final = 1_000_000
_STILL_THERE: Final = say(
    "It is still in the file -wal beside the database, because another program is reading. A "
    "service that uses the database overwrites it within a minute after that program has ended; "
    "without a service, run this command again then."
)


def encodable(value: str | None) -> str | None:
    """Return the value of an option; exit if it cannot be encoded as UTF-8."""
    if value is not None and not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError:
            shown = value.encode(errors="replace").decode()
            give_up(say("{text}: this is not UTF-8 text.", text=shown))
    return value


ExerciseArgument = Annotated[
    str,
    typer.Argument(help="The id of an exercise.", show_default=False, callback=encodable),
]
ExerciseOption = Annotated[str | None, typer.Option(help="Only this exercise.", callback=encodable)]


@contextmanager
def database(*, create: bool = False) -> Iterator[Engine]:
    """Open the database of this installation; exit if it cannot be used.

    With ``create``, a missing database is created. Older tables are not updated.
    """
    with usable_database():
        engine = open_database(database_url(), create=create, migrate=False)
    try:
        yield engine
    except SQLAlchemyError as error:
        give_up(say("The database does not answer: {reason}", reason=reason(error)))
    finally:
        engine.dispose()


def database_url() -> str:
    """Return the URL of the database of this installation; exit if there is none."""
    url = load_settings().database
    if url is None:
        give_up(say("No attempts are recorded here: DH_GRADER_DATABASE names no database."))
    return url.get_secret_value()


@contextmanager
def usable_database() -> Iterator[None]:
    """Exit if the database cannot be used."""
    try:
        yield
    except UnusableDatabaseError as error:
        give_up(joined(": ", ["DH_GRADER_DATABASE", error.args[0]]))


@commands.command("migrate")
def migrate() -> None:
    """Create or update the tables. The service does so, too, when it starts."""
    with usable_database():
        revisions = migrate_database(database_url())
    if revisions.found is None:
        tell(say("The tables were created: {known}.", known=revisions.known))
    elif revisions.found == revisions.known:
        tell(say("The tables are those of this version: {known}.", known=revisions.known))
    else:
        tell(
            say(
                "The tables were migrated from {found} to {known}.",
                found=revisions.found,
                known=revisions.known,
            )
        )


@commands.command("list")
def list_attempts(
    exercise: ExerciseOption = None,
    learner: Annotated[
        str | None, typer.Option(help="Only this learner.", callback=encodable)
    ] = None,
    limit: Annotated[
        int, typer.Option(min=1, max=_MOST_LISTED, help="The number of attempts.")
    ] = 20,
) -> None:
    """List the newest attempts."""
    wanted = AttemptFilter(exercise, learner)
    with database() as engine, engine.connect() as connection:
        shown, following = page(connection, wanted, None, limit)
    screen = stdout()
    if not shown:
        screen.print(_nothing(exercise))
    for each in shown:
        told = (
            each.id,
            f"{each.at:%Y-%m-%d %H:%M}",
            each.exercise,
            visible(each.learner),
            say("does not count")
            if each.ordinal is None
            else say("no. {number}", number=each.ordinal),
            say("{earned} of {most}", earned=number(each.earned), most=number(each.max_points)),
            say("by a tutor") if each.awarded is not None else "",
            say("late") if each.is_late else "",
        )
        screen.print("  ".join(map(spoken, filter(None, told))), soft_wrap=True)
    if following is not None:
        more = say("There are more; --limit {limit} shows twice as many.", limit=2 * limit)
        screen.print(spoken(more))


@commands.command("statistics")
def show_statistics(exercise: ExerciseArgument) -> None:
    """Show how many answers are right in each part and cell, and the most common mistakes."""
    with database() as engine, engine.connect() as connection:
        told = exercise_statistics(connection, AttemptFilter(exercise))
    screen = stdout()
    if not told.attempts:
        screen.print(_nothing(exercise))
        return
    counts = say(
        "{exercise}: {attempts} attempts of {learners} learners",
        exercise=exercise,
        attempts=told.attempts,
        learners=told.learners,
    )
    screen.print(spoken(counts))
    for part in told.parts:
        right = say("nobody answered")
        if part.share is not None:
            share = whole_percent(part.share)
            right = say("{share} right of {answered}", share=share, answered=part.answered)
        screen.print(f"{part.part}: {spoken(right)}")
        for row in part.rows:
            cells = "  ".join(f"{cell.label} {_share(cell.share)}" for cell in row.cells)
            screen.print(f"  {row.label}: {cells}")
    for slip in told.misconceptions[:_MOST_SLIPS]:
        screen.print(f"{slip.attempts:>6} {slip.code} ({slip.part})")
    for group in told.identical[:_MOST_SLIPS]:
        among = ", ".join(visible(each) for each in group.among)
        same = say(
            "{learners} learners sent the same wrong answers: {among}",
            learners=group.learners,
            among=among,
        )
        screen.print(spoken(same))


def _nothing(exercise: str | None) -> str:
    found = say("No attempts are recorded.")
    if exercise is None or exercise in (known := installed()):
        return spoken(found)
    unknown = say(
        "No exercise is called {exercise}; there are {known}.",
        exercise=visible(exercise),
        known=", ".join(known),
    )
    return spoken(paragraph(found, unknown))


def _share(share: float | None) -> str:
    return "-" if share is None else whole_percent(share)


@commands.command("export")
def export(
    exercise: ExerciseOption = None,
    form: Annotated[
        GradesFormat,
        typer.Option(
            "--format",
            help="csv or jsonl: every attempt; canvas or moodle: a gradebook with each learner's "
            "attempt that counts.",
        ),
    ] = GradesFormat.CSV,
    output: Annotated[Path | None, typer.Option(help="The file to write.")] = None,
) -> None:
    """Export attempts, for a spreadsheet or a gradebook."""
    if form.is_gradebook and exercise is None:
        give_up(
            say(
                "A gradebook has one column for one exercise: --format {format} needs --exercise.",
                format=form.value,
            )
        )
    rules = counting_rules(installed())
    with database() as engine, engine.connect() as connection:
        graded = graded_attempts(connection, AttemptFilter(exercise), rules)
        write(written(graded, form, exercise or ""), output, at_once=False)


@commands.command("regrade")
def regrade(
    exercise: ExerciseArgument,
    apply: Annotated[
        bool, typer.Option("--apply", help="Save the changes; otherwise only show them.")
    ] = False,
    jobs: Annotated[
        int, typer.Option(min=1, max=64, help="The number of processes; PostgreSQL only.")
    ] = 1,
    course: Annotated[
        str | None, typer.Option(help="Only attempts in this course.", callback=encodable)
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Save although the exercise fails its check.")
    ] = False,
) -> None:
    """Regrade the attempts at a corrected exercise."""
    # Import here: no other command of this group grades.
    from service.authoring import failures
    from service.cli.commands.regrade import regrade_all, show_what_would_change

    corrected = installed_exercise(exercise)
    with database() as engine:
        if wrong := failures(corrected):
            fails = say("{exercise} fails its check:", exercise=exercise)
            complain(joined("\n  ", [fails, *wrong]))
        if wrong and apply and not force:
            give_up(
                say(
                    "Nothing is regraded. Correct the file of the exercise, or add --force to "
                    "regrade with it as it is."
                )
            )
        if not apply:
            show_what_would_change(engine, corrected, course)
            return
        if jobs > 1 and engine.dialect.name != "postgresql":
            give_up(say("SQLite has one writer at a time: leave --jobs out, or use PostgreSQL."))
        regrade_all(engine, corrected, course, jobs)


@commands.command("override")
def override_points(
    attempt: Annotated[str, typer.Argument(help="The id of an attempt.", callback=encodable)],
    points: Annotated[
        float | None, typer.Argument(help="The new points; omit them to withdraw earlier ones.")
    ] = None,
    reason_given: Annotated[
        str, typer.Option("--reason", help="The reason; required.", callback=encodable)
    ] = "",
    author: Annotated[
        str | None, typer.Option("--by", help="The author. \\[your user name]", callback=encodable)
    ] = None,
) -> None:
    """Override the points of an attempt, with a reason."""
    if not reason_given.strip():
        give_up(say("Give a reason: --reason."))
    by = author or getpass.getuser()
    now = datetime.now(UTC)
    with database() as engine:
        try:
            in_transaction(
                engine,
                lambda connection: override(connection, attempt, points, reason_given, by, now),
            )
        except UnknownAttemptError:
            give_up(
                say("No attempt has the id {id}; dh-grader attempts list shows them.", id=attempt)
            )
        except UnusablePointsError as error:
            give_up(error)
    done = say("Withdrawn.")
    if points is not None:
        done = say("The attempt has {points} points.", points=number(points))
    tell(done)


@commands.command("expire")
def expire(
    months: Annotated[
        int | None, typer.Option(min=1, max=1200, help="[DH_GRADER_KEEP_MONTHS]")
    ] = None,
    apply: Annotated[
        bool, typer.Option("--apply", help="Delete them; otherwise only count them.")
    ] = False,
) -> None:
    """Delete the attempts that are older than some months."""
    kept = months or load_settings().keep_months
    if kept is None:
        give_up(
            say("Say for how many months attempts are kept: --months, or DH_GRADER_KEEP_MONTHS.")
        )
    before = months_before(datetime.now(UTC), kept)
    with database() as engine:
        if not apply:
            with engine.connect() as connection:
                old = select(func.count(attempts.c.number)).where(attempts.c.at < before)
                count = connection.scalar(old.where(is_older(before))) or 0
                kept = (connection.scalar(old) or 0) - count
            tell(
                say(
                    "{count} attempts are from before {date}. --apply deletes them.",
                    count=count,
                    date=f"{before:%Y-%m-%d}",
                )
            )
            if kept:
                tell(
                    say(
                        "{kept} older attempts are kept: their assignments have no due date, "
                        "or were closed later.",
                        kept=kept,
                    )
                )
            return
        count = in_transaction(engine, lambda connection: delete_older(connection, before))
        erased = overwrite_deleted(engine)
    tell(
        say(
            "Deleted: {count} attempts from before {date}.",
            count=count,
            date=f"{before:%Y-%m-%d}",
        )
    )
    if erased is False:
        tell(_STILL_THERE)


@commands.command("forget")
def forget_learner(
    learner: Annotated[
        str, typer.Argument(help="The learner's name in the attempts.", callback=encodable)
    ],
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
) -> None:
    """Delete all records of a learner."""
    with database() as engine:
        with engine.connect() as connection:
            found = data_of(connection, learner)
        if not (found.attempts or found.courses):
            # After an earlier call, deleted data may still wait to be overwritten.
            left = overwrite_deleted(engine) is False
            give_up(
                paragraph(say("Nothing is recorded of this learner."), _STILL_THERE if left else "")
            )
        if not yes:
            question = say(
                "Delete {name} permanently? {counts}.", name=visible(learner), counts=_counts(found)
            )
            typer.confirm(spoken(question), abort=True)
        deleted = in_transaction(engine, lambda connection: forget(connection, learner))
        erased = overwrite_deleted(engine)
    tell(say("Deleted: {counts}.", counts=_counts(deleted)))
    if erased is False:
        tell(_STILL_THERE)


def _counts(data: LearnerData) -> str:
    return say(
        "attempts: {attempts}, earlier reports: {reports}, points given by tutors: {overrides}, "
        "courses: {courses}",
        attempts=data.attempts,
        reports=data.earlier_reports,
        overrides=data.overrides,
        courses=data.courses,
    )
