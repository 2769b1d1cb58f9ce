"""Submissions with their reports: the input of every format."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from service.catalogue import Exercise
from service.grading import PartReport, Report, Verdict
from service.grading.report import rounded_points
from service.submissions.outline import SetExercise

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
