"""A report format, and the setting that it writes in."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING

from service.formats.shared.graded import AnsweredExercise, GradedSubmission, Visibility

if TYPE_CHECKING:
    from rich.console import Console  # a tenth of a second, which only one format needs


@dataclass(frozen=True, slots=True)
class Setting:
    """What a format may know besides the submissions.

    ``exercises`` are those that were set, in order. ``console`` has the width, colours and encoding
    of the output. ``now`` is the time in UTC. ``environment`` are the environment variables, by
    which platforms tell a grader what it grades.
    """

    exercises: tuple[AnsweredExercise, ...]
    console: "Console"
    now: datetime
    environment: Mapping[str, str] = field(default_factory=dict)
    visibility: Visibility = Visibility.VISIBLE


class UnusableSettingError(ValueError):
    """A format lacks what it needs here; the text says what."""


@dataclass(frozen=True, slots=True)
class Document:
    """A file of a folder: its path there, in which ``/`` stands between names, and its content."""

    path: str
    pieces: Iterable[bytes]


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """One format of reports.

    ``pieces`` takes submissions one by one and yields the document piece by piece; it decides
    nothing: no points, no verdicts. It raises UnusableSettingError before its first piece.
    ``is_single`` says that a document holds one submission. ``is_stream`` says that the pieces so
    far are of use without those to come. ``for_students`` says that students
    read the document, so that it tells no more than the exercise allows unless more is asked for.
    ``shows_entries`` says that it shows how each cell was read. ``folder`` writes several
    submissions as files of one folder, one after the other, each to be written before the next is
    asked for.
    """

    pieces: Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]
    is_single: bool = False
    is_stream: bool = False
    for_students: bool = False
    shows_entries: bool = False
    folder: Callable[[Iterable[GradedSubmission], Setting], Iterator[Document]] | None = None


def single(
    document: Callable[[GradedSubmission, Setting], bytes],
) -> Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]:
    """The pieces of a format whose document holds one submission.

    They raise UnusableSettingError where there is another number of submissions.
    """

    def pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
        found = iter(submissions)
        only = next(found, None)
        if only is None or next(found, None) is not None:
            raise UnusableSettingError("a document of this format holds one submission")
        yield document(only, setting)

    return pieces
