"""Grade what a student handed in; make it what every format gets, told in a language."""

import json
import re
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from enum import StrEnum
from functools import partial
from itertools import groupby, islice
from pathlib import Path
from typing import TYPE_CHECKING, Final

from dh_grader.catalogue import Exercise, in_language
from dh_grader.grading import (
    CellReport,
    Correction,
    Feedback,
    FeedbackLevel,
    PartReport,
    Report,
    RowReport,
    Severity,
    Submission,
    Verdict,
    grade,
)
from dh_grader.grading.report import messages_of, rounded_points, was_read, was_read_in_full
from dh_grader.regex import regex
from dh_grader.submissions import AssignedExercise, Assignment, SetExercise
from dh_grader.submissions.answers import ExerciseAnswers, answers_in, of_file
from dh_grader.submissions.bodies import GradeRequest, nearest
from dh_grader.submissions.documents import Excerpt, UnusableFileError
from dh_grader.submissions.files import HandedIn
from dh_grader.translations import ENGLISH, Language, joined, paragraph, say, told

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


def _lacks_much(part: PartReport) -> bool:
    # True if an entry is missing, or if the part earned no more than zeros in all cells may earn.
    return not was_read_in_full(part) or part.points <= _MOST_OF_LAZY * part.max_points


# An answer of nothing but zeros and joint variables earns at most this share (see marks.py).
_MOST_OF_LAZY: Final = 0.25
NOTHING_READ: Final = say("Nothing in this submission could be read.")
NOTHING_ANSWERED: Final = say("Nothing is answered.")


def _nothing_read(file: str, parts: Iterable[PartReport]) -> str:
    if all(part.verdict is Verdict.MISSING for part in parts):
        return say("{file} has no entries.", file=file)
    nothing = say("Nothing in {file} could be read.", file=file)
    errors = (
        message.message
        for part in parts
        for message, _, _ in messages_of(part)
        if message.severity is Severity.ERROR
    )
    return paragraph(nothing, *islice(errors, 1))


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
    # The parts that each file answers.
    parts: Mapping[str, frozenset[str]] = field(default_factory=dict)
    # The names of the files that were read except for their pictures.
    with_pictures: tuple[str, ...] = ()
    # The report with its rows, if ``report`` has none because its level of feedback has none.
    full_report: Report | None = None

    @property
    def weight(self) -> float:
        """Return the factor that converts points of the report into points of the submission."""
        return self.exercise.worth / self.exercise.points

    @property
    def points(self) -> float:
        """Return the points that the file earns in the submission."""
        return self.report.points * self.weight if self.report else 0.0

    @property
    def by_hand(self) -> str:
        """Return the reason why a person must grade the file, or "" if its points count.

        The points do not count if they may say too little: because a file, most of a part, or what
        may hold the rest of an answer was not read.
        """
        report = self.full_report or self.report
        if self.problem or report is None:
            return self.problem
        reports = {part.part: part for part in report.parts}
        reasons: list[str] = []
        for name, ids in self.parts.items():
            parts = [reports[each] for each in ids if each in reports]
            if parts and not any(map(was_read, parts)):
                reasons.append(_nothing_read(name, parts))
        pictures = [say("a picture in {file}", file=name) for name in self.with_pictures]
        others = joined(", ", [*self.unread, *pictures])
        if reasons and others:
            reasons.append(say("This was not read, either: {files}.", files=others))
        if reasons:
            return paragraph(*reasons)
        if self.names and not report.gradable:
            return NOTHING_READ if is_answered(report) else NOTHING_ANSWERED
        titles = {part.id: part.title for part in self.exercise.parts}
        mostly = [titles[part.part] for part in report.parts if is_mostly_unread(part)]
        if mostly:
            return say(
                "At least half of the entries could not be read: {parts}.", parts=", ".join(mostly)
            )
        if others and any(map(_lacks_much, report.parts)):
            return say(
                "The answer is not complete, and something that was not read may hold the rest: "
                "{files}.",
                files=others,
            )
        return ""

    @property
    def is_unread(self) -> bool:
        """True if a person must grade the file."""
        return bool(self.by_hand)

    @property
    def beside(self) -> tuple[str, ...]:
        """Return a sentence about each file beside the answer that was not read."""
        return () if self.by_hand else tuple(self.unread.values())

    @property
    def has_unread_cells(self) -> bool:
        """True if any cell could not be read."""
        report = self.full_report or self.report
        parts = report.parts if report else ()
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
        """Return the distinct reasons why a person must grade the submission."""
        return tuple(dict.fromkeys(filter(None, (file.by_hand for file in self.files))))

    @property
    def beside(self) -> tuple[str, ...]:
        """Return the distinct sentences about files beside the answers that were not read."""
        return tuple(dict.fromkeys(each for file in self.files for each in file.beside))

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


# --- Grade the submission of one student on this machine

_LONGEST_NAME = 60


@dataclass(frozen=True, slots=True)
class GradingTerms:
    """The assignment to grade, and the options of the reports.

    ``feedback`` is the level of detail; if None, the submission chooses it. ``echo`` adds to a
    report how each entry was read.
    """

    # With ``for_students``, the exercise limits the level that the submission chooses.

    assignment: Assignment
    pass_mark: float
    feedback: FeedbackLevel | None = None
    for_students: bool = False
    echo: bool = False
    language: Language = ENGLISH

    @property
    def answered(self) -> tuple[AnsweredExercise, ...]:
        """The assigned exercises, with texts in ``language``."""
        return tuple(
            answered(self._told(assigned.exercise), assigned.worth)
            for assigned in self.assignment.exercises
        )

    def _told(self, exercise: SetExercise) -> SetExercise:
        return in_language(exercise, self.language) if isinstance(exercise, Exercise) else exercise

    def submission(self, body: GradeRequest, assigned: AssignedExercise) -> Submission:
        """Return ``body`` as a submission for the grader, with the chosen feedback level."""
        most = self.assignment.ceiling(assigned) if self.for_students else FeedbackLevel.FULL
        submission = body.submission(most)
        feedback = submission.feedback if self.feedback is None else self.feedback
        return replace(submission, feedback=feedback, echo=self.echo or submission.echo)


# A function that returns the report on answers to an exercise and "", or None and a problem.
ReportOn = Callable[[GradeRequest, AssignedExercise, GradingTerms], tuple[Report | None, str]]


def unknown_part(body: GradeRequest, assigned: AssignedExercise) -> str:
    """Return an error message if the answers name an unknown part of the exercise, else ""."""
    known = [part.id for part in assigned.exercise.parts]
    unknown = next((part for part in body.answers if part not in known), None)
    if unknown is None:
        return ""
    meant = nearest(unknown, known)
    name, exercise, listed = unknown[:_LONGEST_NAME], assigned.exercise.id, ", ".join(known)
    if meant is None:
        return say(
            "answers {part!r}, but {exercise} has only {parts}",
            part=name,
            exercise=exercise,
            parts=listed,
        )
    return say(
        "answers {part!r}, but {exercise} has only {parts}. Did you mean {meant}?",
        part=name,
        exercise=exercise,
        parts=listed,
        meant=meant,
    )


def report_of(body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms) -> Report:
    """Return the report on answers, in the language of the terms. Raises UnknownPartError."""
    report = grade(_own_exercise(assigned), terms.submission(body, assigned))
    return report_in(report, terms.language)


def _own_exercise(assigned: AssignedExercise) -> Exercise:
    exercise = assigned.exercise
    if not isinstance(exercise, Exercise):
        raise TypeError(f"{exercise.id} is an exercise of a server, and cannot be graded here")
    return exercise


def report_here(
    body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms
) -> tuple[Report | None, str]:
    """Grade answers on this machine; return a report and "", or None and an error message."""
    _own_exercise(assigned)
    if problem := unknown_part(body, assigned):
        return None, problem
    try:
        return report_of(body, assigned, terms), ""
    except Exception as error:  # noqa: BLE001 - a fault of the program affects only this submission
        place = traceback.extract_tb(error.__traceback__)[-1]
        return None, say(
            "cannot be graded because of a fault in the program; please report it: {error} in "
            "{place}, line {line}",
            error=type(error).__name__,
            place=place.name,
            line=place.lineno or 0,
        )


def graded(
    handed: HandedIn, terms: GradingTerms, report_on: ReportOn = report_here
) -> GradedSubmission:
    """Grade a submission; return a report or an error message for each exercise."""
    answers = answers_in(handed, terms.assignment, partial(_readable_excerpt, terms, report_on))
    files = tuple(
        _graded_file(each, assigned, shown, terms, report_on)
        for each, assigned, shown in zip(
            answers, terms.assignment.exercises, terms.answered, strict=True
        )
    )
    return GradedSubmission(handed.name, handed.learner, files, terms.pass_mark, handed.person)


def _readable_excerpt(
    terms: GradingTerms,
    report_on: ReportOn,
    assigned: AssignedExercise,
    part: str,
    excerpts: Sequence[Excerpt],
) -> str:
    """Return the text of the excerpt that can be graded as this part.

    Raises UnusableFileError if several excerpts of one level can be graded and earn different
    points: no program knows which one the student means.
    """
    whole: tuple[PartReport, str] | None = None
    for _, group in groupby(sorted(excerpts, key=lambda it: it.level), key=lambda it: it.level):
        graded = [
            (report, excerpt.text)
            for excerpt in group
            if (report := _part_report(excerpt.text, part, assigned, terms, report_on))
        ]
        if whole is not None:
            # A legend beside a table belongs to the whole sheet, but not to one of its blocks.
            graded = [each for each in graded if _is_better_piece(*each, *whole)]
        if len({report.points for report, _ in graded}) > 1:
            raise UnusableFileError(
                say(
                    "has several answers to {part}, which differ; leave only one of them",
                    part=part,
                )
            )
        if graded and (whole is not None or was_read_in_full(graded[0][0])):
            return graded[0][1]
        if graded:
            whole = graded[0]
    return excerpts[0].text if whole is None else whole[1]


def _is_better_piece(report: PartReport, text: str, whole: PartReport, whole_text: str) -> bool:
    # True if a piece of a text has nothing unreadable, and earns more than all of the text.
    is_piece = set(text.split()) <= set(whole_text.split())
    return is_piece and was_read_in_full(report) and report.points > whole.points


def _part_report(
    text: str, part: str, assigned: AssignedExercise, terms: GradingTerms, report_on: ReportOn
) -> PartReport | None:
    # The report on a text as the answer to a part, if the text can be read.
    report, _ = report_on(GradeRequest(answers={part: text}), assigned, terms)
    found = next((each for each in report.parts if each.part == part), None) if report else None
    is_read = found is not None and found.verdict not in (Verdict.UNREADABLE, Verdict.MISSING)
    return found if is_read else None


def _graded_file(
    answers: ExerciseAnswers,
    assigned: AssignedExercise,
    shown: AnsweredExercise,
    terms: GradingTerms,
    report_on: ReportOn,
) -> GradedFile:
    report, problem = None, ""
    full_report = None
    if answers.body is not None:
        report, problem = report_on(answers.body, assigned, terms)
        if report and report.feedback is FeedbackLevel.SCORE:
            # Only the rows show how much was read.
            with_rows = replace(terms, feedback=FeedbackLevel.VERDICTS, for_students=False)
            full_report, _ = report_on(answers.body, assigned, with_rows)
        if problem:
            problem = of_file(answers.names[0] if answers.names else assigned.exercise.id, problem)
    problems = joined("; ", list(filter(None, (answers.problem, problem))))
    translation = terms.language.translation
    unread = {name: told(each, translation) for name, each in answers.unread.items()}
    return GradedFile(
        answers.file,
        shown,
        report,
        told(problems, translation),
        answers.names,
        unread,
        answers.parts,
        answers.with_pictures,
        full_report,
    )
