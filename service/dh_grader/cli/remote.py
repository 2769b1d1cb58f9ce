"""Let a server grade instead of this program, as `dh-grader grade --server` does.

Most runs have no server, so the client, and ``remote_grading.py`` with it, is imported late.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dh_grader.cli.options import installed_exercise
from dh_grader.cli.running import mapped_in_threads
from dh_grader.cli.terminal import complain, give_up, spoken
from dh_grader.formats.graded import GradedSubmission, GradingTerms
from dh_grader.formats.texts import visible
from dh_grader.settings import Settings
from dh_grader.submissions import Assignment, SetExercise
from dh_grader.submissions.files import HandedIn
from dh_grader.translations import say

if TYPE_CHECKING:
    from dh_grader.client import GraderClient

# Concurrent requests without --jobs: the server has work while answers are on their way.
REQUESTS: Final = 4


@contextmanager
def server_of(settings: Settings) -> Iterator["GraderClient | None"]:
    """Open a client of the server in the settings; yield None if no server is set.

    Exits with code 2 if the server's address or the key is invalid.
    """
    if settings.server is None:
        yield None
        return
    from dh_grader.client import GraderClient

    try:
        client = GraderClient(settings.server, _key(settings), language=settings.language)
    except ValueError as error:
        give_up(visible(spoken(error.args[0])))
    with client:
        yield client


def _key(settings: Settings) -> str | None:
    return None if settings.key is None else settings.key.get_secret_value()


def set_exercise(exercise_id: str, *, server: "GraderClient | None") -> SetExercise:
    """Return the exercise from the server, or from this installation if ``server`` is None.

    Raises UnknownExerciseError.
    """
    if server is None:
        return installed_exercise(exercise_id)
    from dh_grader.cli.remote_grading import exercise_of
    from dh_grader.client import GraderClientError

    try:
        return exercise_of(server, exercise_id)
    except GraderClientError as error:
        give_up(visible(spoken(error.args[0])))


def require_no_own_files(assignment: Assignment) -> None:
    """Exit with code 2 if an exercise is a local file, which the server does not have."""
    for assigned in assignment.exercises:
        if assigned.path is not None:
            give_up(
                say(
                    "{file} is a file of yours, and a server grades by its own exercises: name "
                    "one of them by its id.",
                    file=str(assigned.path),
                )
            )


@contextmanager
def graded_by(
    server: "GraderClient",
    terms: GradingTerms,
    found: Sequence[HandedIn],
    requests: int,
    output: Path | None,
    settings: Settings,
) -> Iterator[Iterator[GradedSubmission]]:
    """Yield an iterator over the submissions in order, graded by the server.

    ``requests`` is the number of concurrent requests. If the server fails, the reports so far stay
    in the journal beside the output.
    """
    from dh_grader.cli.remote_grading import Journal, RemoteGrading, journal_beside

    journal = Journal(journal_beside(output))
    grading = RemoteGrading(server, _key(settings), terms, journal)
    with mapped_in_threads(grading.graded, found, requests) as graded:
        yield graded
    if not grading.ungraded:
        journal.remove()
        return
    complain(
        say(
            "Not graded: {count} of {all}, for {reason}",
            count=len(grading.ungraded),
            all=len(found),
            reason=visible(grading.reason),
        )
    )
    complain(
        say(
            "The reports on the others are kept in {file}. Give the same command again, and only "
            "the rest is sent.",
            file=visible(str(journal.path)),
        )
    )
