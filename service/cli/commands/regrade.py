"""Regrade the attempts at an exercise in one process or several."""

import time
from multiprocessing import get_context
from typing import Final

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.attempts.errors import UnusableDatabaseError
from service.attempts.regrades.outdated import BATCH, RegradedAttempt, Regrading
from service.attempts.storage.database import in_transaction, open_database
from service.catalogue import Exercise
from service.cli.language import spoken
from service.cli.running.progress import progress
from service.cli.terminal import installed_exercise, stdout
from service.formats.shared.plain_text import number, visible
from service.settings import load_settings
from service.translations import Sentence, joined, say, say_count

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
    """Regrade all outdated attempts in ``jobs`` processes."""
    # Other programs may do so at the same time.
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
