"""The type of report formats, and what a format needs besides the submissions."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from service.formats.shared.graded import AnsweredExercise, GradedSubmission, Visibility
from service.translations import ENGLISH, Language

if TYPE_CHECKING:
    from rich.console import Console  # its import takes a tenth of a second


@dataclass(frozen=True, slots=True)
class Setting:
    """What a format needs besides the submissions, such as the language and the time."""

    # The assigned exercises in order.
    exercises: tuple[AnsweredExercise, ...]
    # The width, colours and encoding of the output.
    console: "Console"
    # In UTC.
    now: datetime
    # The environment variables, in which platforms describe the submission.
    environment: Mapping[str, str] = field(default_factory=dict)
    visibility: Visibility = Visibility.VISIBLE
    language: Language = ENGLISH
    # The folder that the documents are written to, if they are several.
    folder: Path | None = None
    # The entries of the class that are no submissions, but earlier outputs or worksheets.
    left_out: tuple[str, ...] = ()


class UnusableSettingError(ValueError):
    """A format cannot write its document; the text gives the reason."""


@dataclass(frozen=True, slots=True)
class Document:
    """A file of a folder: its path in the folder, and its content."""

    path: str
    pieces: Iterable[bytes]


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """A report format: a function that writes submissions, and its properties."""

    # Takes submissions one by one and yields the document piece by piece. It decides no points and
    # no verdicts. It may raise UnusableSettingError before its first piece.
    pieces: Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]
    # Matches the beginning of each document, and of nothing that others write.
    mark: re.Pattern[bytes]
    # A document holds exactly one submission.
    is_single: bool = False
    # The first pieces are useful before the others are written.
    is_stream: bool = False
    # Students read the document, so by default it shows no more than the exercise allows.
    for_students: bool = False
    # The document shows how each cell was read.
    shows_entries: bool = False
    # Writes several submissions as files of one folder. Each file must be written before the next
    # file is taken.
    folder: Callable[[Iterable[GradedSubmission], Setting], Iterator[Document]] | None = None


def single(
    document: Callable[[GradedSubmission, Setting], bytes],
) -> Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]:
    """Return the function ``pieces`` of a format whose documents hold one submission.

    The function raises UnusableSettingError for any other number of submissions.
    """

    def pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
        found = iter(submissions)
        only = next(found, None)
        if only is None or next(found, None) is not None:
            raise UnusableSettingError("a document of this format holds one submission")
        yield document(only, setting)

    return pieces
