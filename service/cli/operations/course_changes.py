"""Change and delete courses from the command line."""

from collections.abc import Callable, Mapping
from typing import Final, TypeVar

import typer
from sqlalchemy import Connection

from service.attempts.storage.database import in_transaction
from service.cli.commands.attempts import database
from service.cli.language import spoken
from service.cli.terminal import give_up, tell
from service.contract.courses import DeletedData, DeletionRequest
from service.courses.errors import CourseError
from service.translations import Sentence, joined, say, template

D = TypeVar("D", bound=DeletionRequest)
R = TypeVar("R")

# What a deletion counts, by the fields of DeletedData.
_COUNTS: Final[Mapping[str, str]] = {
    "assignments": template("assignments: {count}"),
    "learners": template("learners: {count}"),
    "extensions": template("extensions: {count}"),
    "keys": template("keys: {count}"),
    "attempts": template("attempts: {count}"),
}


def changed(work: Callable[[Connection], R], *, create: bool = False) -> R:
    """Run ``work`` in a transaction and return its result; exit on an error.

    With ``create``, a missing database is created.
    """
    with database(create=create) as engine:
        try:
            return in_transaction(engine, work)
        except CourseError as error:
            give_up(error)


def deleted(
    name: str, work: Callable[[Connection, D], DeletedData], wanted: D, *, yes: bool
) -> None:
    """Ask the user for confirmation, delete data with ``work``, and print what was deleted.

    ``name`` is the name of the data in messages. ``yes`` skips the question.
    """
    found = changed(lambda it: work(it, wanted))
    if not wanted.with_attempts:
        # They stay, or they prevent the deletion.
        found = found.model_copy(update={"attempts": 0})
    numbers = found.model_dump(exclude={"deleted"})
    counts = joined(
        ", ",
        [Sentence(_COUNTS[kind], {"count": count}) for kind, count in numbers.items() if count],
    )
    if not yes:
        question = say("Delete {name} permanently? {counts}", name=name, counts=counts)
        typer.confirm(spoken(question), abort=True)
    apply = wanted.model_copy(update={"apply": True})
    changed(lambda it: work(it, apply))
    tell(say("Deleted {name}: {counts}.", name=name, counts=counts))
