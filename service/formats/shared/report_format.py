"""The type of report formats, and the setting in which they write."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING

from service.formats.shared.graded import AnsweredExercise, GradedSubmission, Visibility
from service.translations import ENGLISH, Language

if TYPE_CHECKING:
    from rich.console import Console  # its import takes a tenth of a second


@dataclass(frozen=True, slots=True)
class Setting:
    """The input of a format besides the submissions.

    ``exercises`` are the assigned exercises in order. ``console`` has the width, colours and
    encoding of the output. ``now`` is the time in UTC. ``environment`` has the environment
    variables, in which platforms describe the submission. ``language`` is the reports' language.
    """

    exercises: tuple[AnsweredExercise, ...]
    console: "Console"
    now: datetime
    environment: Mapping[str, str] = field(default_factory=dict)
    visibility: Visibility = Visibility.VISIBLE
    language: Language = ENGLISH


class UnusableSettingError(ValueError):
    """A format cannot write in this setting; the text gives the reason."""


@dataclass(frozen=True, slots=True)
class Document:
    """A file of a folder: its path in the folder, with ``/`` between names, and its content."""

    path: str
    pieces: Iterable[bytes]


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """A report format.

    - ``pieces`` takes submissions one by one and yields the document piece by piece. It decides no
      points and no verdicts. It may raise UnusableSettingError before its first piece.
    - ``is_single``: a document holds exactly one submission.
    - ``is_stream``: the first pieces are useful before the others are written.
    - ``for_students``: students read the document, so by default it shows no more than the
      exercise allows.
    - ``shows_entries``: it shows how each cell was read.
    - ``folder`` writes several submissions as files of one folder. Each file must be written before
      the next file is taken.
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
    """Make the function ``pieces`` of a format from a function that writes one submission.

    The result raises UnusableSettingError for any other number of submissions.
    """

    def pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
        found = iter(submissions)
        only = next(found, None)
        if only is None or next(found, None) is not None:
            raise UnusableSettingError("a document of this format holds one submission")
        yield document(only, setting)

    return pieces
