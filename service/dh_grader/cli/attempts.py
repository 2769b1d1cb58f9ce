"""`dh-grader attempts`, `learners`, `backup` and `restore`: what the database has recorded.

What is read and changed there is in ``dh_grader.store``; this file knows options and messages.
"""

import getpass
import json
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Final

import typer
from sqlalchemy import Engine, func, select
from sqlalchemy.exc import SQLAlchemyError

from dh_grader.catalogue import Exercise
from dh_grader.cli.grade import write
from dh_grader.cli.options import installed, installed_exercise
from dh_grader.cli.terminal import complain, give_up, progress, spoken, stdout, tell
from dh_grader.formats.texts import number, visible, whole_percent
from dh_grader.settings import load_settings
from dh_grader.store import (
    AttemptFilter,
    GradesFormat,
    UnknownAttemptError,
    UnusableDatabaseError,
    UnusablePointsError,
)
from dh_grader.store.database import (
    InUseError,
    before,
    compared,
    copy_of,
    file_of,
    in_transaction,
    migrate_database,
    move_to_free_place,
    open_database,
    overwrite_deleted,
    reason,
    replace_database,
    unfit,
    unmigrated_database,
)
from dh_grader.store.regrades import BATCH, RegradedAttempt, Regrading
from dh_grader.store.results import (
    LearnerData,
    counting_rules,
    data_of,
    delete_older,
    everything_of,
    exercise_statistics,
    forget,
    graded_attempts,
    is_older,
    months_before,
    override,
    page,
    written,
)
from dh_grader.store.tables import attempts
from dh_grader.translations import Sentence, joined, paragraph, say, say_count

# --- The database of this installation, for all commands that use it


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


def encodable(value: str | None) -> str | None:
    """Return the value of an option; exit if it cannot be encoded as UTF-8."""
    if value is not None and not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError:
            shown = value.encode(errors="replace").decode()
            give_up(say("{text}: this is not UTF-8 text.", text=shown))
    return value


# --- `dh-grader attempts`: the recorded attempts of this installation


attempts_commands = typer.Typer(
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


ExerciseArgument = Annotated[
    str,
    typer.Argument(help="The id of an exercise.", show_default=False, callback=encodable),
]
ExerciseOption = Annotated[str | None, typer.Option(help="Only this exercise.", callback=encodable)]


@attempts_commands.command("migrate")
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


@attempts_commands.command("list")
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


@attempts_commands.command("statistics")
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


@attempts_commands.command("export")
def attempts_export(
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


@attempts_commands.command("regrade")
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
    from dh_grader.authoring import failures

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


@attempts_commands.command("override")
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


@attempts_commands.command("expire")
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


@attempts_commands.command("forget")
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


# --- `dh-grader attempts regrade`: in one process or several


# The time between two counts of the queue, and to wait for other processes at the end (seconds).
_PAUSE: Final = 0.2
_MOST_SHOWN: Final = 200


def show_what_would_change(engine: Engine, exercise: Exercise, course: str | None) -> None:
    """Grade all outdated attempts; print whose result would change, and why."""
    regrading = Regrading(exercise, load_settings().feedback, course)
    changes: list[RegradedAttempt] = []
    with engine.connect() as connection:
        numbers = regrading.outdated(connection)
        with progress(len(numbers)) as bar:
            for i in range(0, len(numbers), BATCH):
                for each in regrading.preview(connection, numbers[i : i + BATCH]):
                    bar.advance()
                    if each.is_changed:
                        changes.append(each)
    screen = stdout()
    for each in changes[:_MOST_SHOWN]:
        counted = each.counted or each
        why = [*each.reasons] or [say("what a late attempt earns")]
        if counted.awarded is not None:
            why.append(say("a tutor's {points} stays", points=number(counted.awarded)))
        line = say(
            "{learner}, attempt {attempt}: {before} → {after} of {most} ({why})",
            learner=visible(each.learner),
            attempt=each.ordinal or "-",
            before=number(counted.before),
            after=number(counted.after),
            most=number(counted.max_points),
            why=joined("; ", why),
        )
        screen.print(spoken(line))
    if len(changes) > _MOST_SHOWN:
        screen.print(spoken(say("… and {count} more", count=len(changes) - _MOST_SHOWN)))
    kept = sum(each.awarded is not None for each in changes)
    screen.print(spoken(_summary(len(numbers), len(changes), kept)))
    if numbers:
        saved = say("Nothing is saved yet: add --apply to save. The old reports are kept.")
        screen.print(spoken(saved))


def _summary(outdated: int, changed: int, kept: int) -> Sentence:
    if not kept:
        return say_count(
            "{count} attempt was graded by another version; {changed} would change.",
            "{count} attempts were graded by another version; {changed} would change.",
            count=outdated,
            changed=changed,
        )
    return say_count(
        "{count} attempt was graded by another version; {changed} would change, of which {kept} "
        "would keep the points of a tutor.",
        "{count} attempts were graded by another version; {changed} would change, of which {kept} "
        "would keep the points of a tutor.",
        count=outdated,
        changed=changed,
        kept=kept,
    )


def regrade_all(engine: Engine, exercise: Exercise, course: str | None, jobs: int) -> None:
    """Regrade all outdated attempts in ``jobs`` processes; other programs may do so meanwhile."""
    regrading = Regrading(exercise, load_settings().feedback, course)
    in_transaction(engine, regrading.enqueue)
    with engine.connect() as connection:
        total = left = regrading.waiting(connection)
    context = get_context("spawn")
    args = (exercise.id, course)
    others = [context.Process(target=work, args=args, daemon=True) for _ in range(jobs - 1)]
    for each in others:
        each.start()
    try:
        with progress(total) as bar:
            look_again = 0.0
            while left:
                done = regrading.next_batch(engine)
                begun = time.monotonic()
                if done and begun < look_again:
                    continue
                with engine.connect() as connection:
                    before, left = left, regrading.waiting(connection)
                # Counting millions of rows takes as long as regrading many attempts.
                look_again = begun + max(_PAUSE, 20 * (time.monotonic() - begun))
                for _ in range(before - left):
                    bar.advance()
                if left and not done:
                    time.sleep(_PAUSE)
    finally:
        for each in others:
            each.kill()
            each.join()
    stdout().print(spoken(say("Regraded: {total}. The reports before are kept.", total=total)))


def work(exercise_id: str, course: str | None) -> None:
    """Regrade attempts until the queue is empty; this is the main function of a process."""
    settings = load_settings()
    assert settings.database is not None
    try:
        engine = open_database(settings.database.get_secret_value(), create=False, migrate=False)
        regrading = Regrading(installed_exercise(exercise_id), settings.feedback, course)
        while regrading.next_batch(engine):
            pass
        engine.dispose()
    except (SQLAlchemyError, UnusableDatabaseError):
        # The attempts of this batch stay in the queue for the parent process.
        return


# --- `dh-grader learners`: the data about one learner


learners_commands = typer.Typer(
    help="Learners: export all that is known of one.", no_args_is_help=True, add_completion=False
)


@learners_commands.callback()
def _group() -> None:
    """Learners."""


@learners_commands.command("export")
def learners_export(
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


# --- `dh-grader backup`: copy the database while the service runs


backup_commands = typer.Typer(add_completion=False)

USE_POSTGRESQL = (
    "The database is PostgreSQL; its own programs copy it: pg_dump and pg_restore. "
    "docs/operations.md has the commands."
)


@backup_commands.command("backup")
def backup_command(
    file: Annotated[Path, typer.Argument(help="The file to write. It must not exist yet.")],
) -> None:
    """Copy the database to a file, also while the service runs."""
    source = sqlite_file()
    if not source.is_file():
        give_up(say("{file}: there is no such file.", file=str(source)))
    if file.exists():
        give_up(_backup_is_there(file))
    try:
        # The tables may be those of any version: this command only copies them.
        with copy_of(source, file) as copy:
            move_to_free_place(copy, file)
    except FileExistsError:
        # Another backup was faster.
        give_up(_backup_is_there(file))
    except (OSError, sqlite3.Error) as error:
        give_up(say("{file} cannot be written: {reason}", file=str(file), reason=str(error)))
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


def _backup_is_there(file: Path) -> str:
    return say("{file} is there already. Choose another name.", file=str(file))


# --- `dh-grader restore`: replace the database by a backup


restore_commands = typer.Typer(add_completion=False)


@restore_commands.command("restore")
def restore_command(
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
            give_up(_restore_is_there(kept))
    try:
        with copy_of(file, target) as copy:
            replace_database(copy, target)
    except InUseError:
        give_up(say("{target} is in use. Stop the service first.", target=str(target)))
    except FileExistsError:
        give_up(_restore_is_there(kept))
    except (OSError, sqlite3.Error) as error:
        give_up(joined(": ", [str(file), str(error)]))
    tell(say("{target} has the content of {file}.", target=str(target), file=str(file)))


def _restore_is_there(kept: Path) -> str:
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
