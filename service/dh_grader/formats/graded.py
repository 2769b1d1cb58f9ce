"""What every format gets: submissions with their reports, told in a language, safe as JSON."""

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dh_grader.catalogue import Exercise
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    PartReport,
    Report,
    RowReport,
    Verdict,
)
from dh_grader.grading.report import rounded_points
from dh_grader.regex import regex
from dh_grader.submissions import SetExercise
from dh_grader.translations import ENGLISH, Language, told

if TYPE_CHECKING:
    from rich.console import Console


# --- JSON that is safe to print to a terminal or the log of a build


# In UTF-8: the start of a build's command (`##[…]`), and control characters that JSON allows.
_UNPRINTABLE: Final = regex(rb"#(?=#)|\x7f|\xc2[\x80-\x9f]")


def json_document(content: Mapping[str, object]) -> bytes:
    """Return the content as indented UTF-8 JSON."""
    # Names of files may contain bytes that are not UTF-8; these are replaced.
    text = json.dumps(content, indent=2, ensure_ascii=False)
    return printable(text.encode("utf-8", "replace")) + b"\n"


def printable(document: bytes) -> bytes:
    """Return equivalent JSON that is safe to print to a terminal or the log of a build."""
    return _UNPRINTABLE.sub(lambda sign: b"\\u%04x" % ord(sign[0].decode()), document)


# --- Submissions with their reports: the input of every format


# Scores are rounded to six digits, so 1/3 passes a pass mark of 0.33333333.
_ROUNDED = 5e-7


@dataclass(frozen=True, slots=True)
class AnsweredPart:
    """A part (one question) of an assigned exercise, with or without an answer."""

    id: str
    title: str
    points: float


@dataclass(frozen=True, slots=True)
class AnsweredExercise:
    """An assigned exercise as report formats need it: its points, parts, symbols and texts."""

    id: str
    title: str
    source: str
    parts: tuple[AnsweredPart, ...]
    # The exercise's points in a submission; an assignment may change them.
    worth: float
    # The names that the exercise declares, if they are known.
    symbols: frozenset[str] = frozenset()
    # The paragraphs of a variant's texts: the student may have these texts nowhere else.
    task: tuple[str, ...] = ()

    @property
    def points(self) -> float:
        """Return the points of the exercise, before any rescaling: the sum of its parts' points."""
        return sum(part.points for part in self.parts)


def answered(exercise: SetExercise, worth: float | None = None) -> AnsweredExercise:
    """Return an assigned exercise in the form that report formats need.

    ``worth`` is the exercise's points, by default the sum of the points of its parts.
    """
    parts = tuple(AnsweredPart(part.id, part.title, part.points) for part in exercise.parts)
    worth = sum(part.points for part in parts) if worth is None else worth
    symbols = exercise.symbols if isinstance(exercise, Exercise) else frozenset()
    task = _task(exercise) if isinstance(exercise, Exercise) and exercise.seed else ()
    return AnsweredExercise(
        exercise.id, exercise.title, exercise.source, parts, worth, symbols, task
    )


def _task(exercise: Exercise) -> tuple[str, ...]:
    prompts = (f"{part.id}: {part.title}. {part.prompt}" for part in exercise.parts)
    paragraphs = (exercise.title, *exercise.statement.split("\n\n"), *prompts)
    return tuple(" ".join(each.split()) for each in paragraphs)


def is_answered(report: Report) -> bool:
    """True if any part of the exercise has an answer, readable or not."""
    return any(part.verdict is not Verdict.MISSING for part in report.parts)


def is_mostly_unread(part: PartReport) -> bool:
    """True if at least half of the written cells of a part could not be read.

    Then the points of the part say too little, and a person has to grade it.
    """
    written = [
        cell.verdict
        for row in part.rows
        for cell in row.cells
        if cell.verdict is not Verdict.MISSING
    ]
    unread = written.count(Verdict.UNREADABLE)
    return part.verdict is Verdict.UNREADABLE or 0 < len(written) <= 2 * unread


@dataclass(frozen=True, slots=True)
class GradedFile:
    """A file with its report, or with the problem that prevents a full report."""

    # The path of the file; empty if there is no file for the exercise.
    file: str
    exercise: AnsweredExercise
    report: Report | None
    problem: str = ""
    # The names that the student gave the files, without the additions of a platform.
    names: tuple[str, ...] = ()
    # A sentence about each file that was not read, by the student's own name of the file.
    unread: Mapping[str, str] = field(default_factory=dict)

    @property
    def weight(self) -> float:
        """Return the factor that converts points of the report into points of the submission."""
        return self.exercise.worth / self.exercise.points

    @property
    def points(self) -> float:
        """Return the points that the file earns in the submission."""
        return self.report.points * self.weight if self.report else 0.0

    @property
    def is_unread(self) -> bool:
        """True if so much in the file could not be read that its points say too little."""
        parts = self.report.parts if self.report else ()
        return bool(self.problem) or any(map(is_mostly_unread, parts))

    @property
    def has_unread_cells(self) -> bool:
        """True if any cell could not be read."""
        parts = self.report.parts if self.report else ()
        return any(
            cell.verdict is Verdict.UNREADABLE
            for part in parts
            for row in part.rows
            for cell in row.cells
        )


@dataclass(frozen=True, slots=True)
class GradedSubmission:
    """The submission of one learner: a file for each assigned exercise."""

    # Unique among all submissions.
    name: str
    learner: str
    files: tuple[GradedFile, ...]
    # The score to reach, 0..1.
    pass_mark: float
    # The name of the person, if it is known.
    person: str = ""

    @property
    def points(self) -> float:
        """Return the points of all files; a file without a report has none."""
        return rounded_points(sum(file.points for file in self.files))

    @property
    def max_points(self) -> float:
        """Return the maximum points."""
        return rounded_points(sum(file.exercise.worth for file in self.files))

    @property
    def score(self) -> float:
        """Return the points as a fraction of the maximum points, 0..1."""
        return rounded_points(self.points / self.max_points)

    @property
    def is_graded(self) -> bool:
        """True if any file has a report."""
        return any(file.report for file in self.files)

    @property
    def is_complete(self) -> bool:
        """True if the points count: each file and most of each answer was read.

        An unread file or answer is not wrong: somebody has to grade it by hand.
        """
        return self.is_graded and not any(file.is_unread for file in self.files)

    @property
    def is_gradable(self) -> bool:
        """True if anything in the submission could be read."""
        return any(file.report and file.report.gradable for file in self.files)

    @property
    def is_answered(self) -> bool:
        """True if the submission has any answer, readable or not."""
        return any(file.report and is_answered(file.report) for file in self.files)

    @property
    def problems(self) -> tuple[str, ...]:
        """Return the distinct problems of the files."""
        return tuple(dict.fromkeys(file.problem for file in self.files if file.problem))

    @property
    def passed(self) -> bool:
        """True if the submission was graded and reaches the pass mark."""
        return self.is_graded and self.score >= self.pass_mark - _ROUNDED


class Visibility(StrEnum):
    """When students see a result on a grading platform, with Gradescope's names."""

    VISIBLE = "visible"
    AFTER_DUE_DATE = "after_due_date"
    AFTER_PUBLISHED = "after_published"
    HIDDEN = "hidden"


# --- The type of report formats, and what a format needs besides the submissions


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


# --- Reports in the language of their reader


# Returns a text of a report, changed.
ChangedText = Callable[[str], str]


def report_in(report: Report, language: Language) -> Report:
    """Return the report with its sentences in a language."""
    translation = language.translation
    if translation is None:
        return report
    return with_texts(report, lambda text: told(text, translation))


def with_texts(report: Report, changed: ChangedText) -> Report:
    """Return a copy of the report, with each sentence replaced by ``changed(sentence)``."""
    # Sentences are messages, corrections in words, and the reasons of lost points.
    return replace(report, parts=tuple(_part(part, changed) for part in report.parts))


def _part(part: PartReport, changed: ChangedText) -> PartReport:
    worth = part.little_worth
    return replace(
        part,
        rows=tuple(_row(row, changed) for row in part.rows),
        feedback=_messages(part.feedback, changed),
        lost=tuple(replace(each, message=changed(each.message)) for each in part.lost),
        little_worth=worth and replace(worth, message=changed(worth.message)),
    )


def _row(row: RowReport, changed: ChangedText) -> RowReport:
    if not row.feedback and not any(cell.feedback for cell in row.cells):
        return row
    cells = tuple(_cell(cell, changed) if cell.feedback else cell for cell in row.cells)
    return replace(row, cells=cells, feedback=_messages(row.feedback, changed))


def _cell(cell: CellReport, changed: ChangedText) -> CellReport:
    return replace(cell, feedback=_messages(cell.feedback, changed))


def _messages(messages: tuple[Feedback, ...], changed: ChangedText) -> tuple[Feedback, ...]:
    return tuple(
        replace(
            message,
            message=changed(message.message),
            correction=_correction(message.correction, changed),
            places=message.places
            and tuple(
                replace(place, correction=_correction(place.correction, changed))
                for place in message.places
            ),
        )
        for message in messages
    )


def _correction(correction: Correction | None, changed: ChangedText) -> Correction | None:
    if correction is None or correction.latex is not None:
        return correction
    return replace(correction, text=changed(correction.text))
