"""Submissions with their reports: what every format is given."""

from dataclasses import dataclass
from enum import StrEnum

from service.grading import Report, Verdict
from service.grading.report import rounded_points
from service.submissions.outline import SetExercise

# Scores are rounded to six digits, so 1/3 passes a pass mark of 0.33333333.
_ROUNDED = 5e-7


@dataclass(frozen=True, slots=True)
class AnsweredPart:
    """A part of an exercise that was set, whether it was answered or not."""

    id: str
    title: str
    points: float


@dataclass(frozen=True, slots=True)
class AnsweredExercise:
    """An exercise that was set, as far as a reader of results needs to know it.

    ``worth`` are the points that it counts in a submission: those of its parts, unless an
    assignment weighs it otherwise.
    """

    id: str
    title: str
    source: str
    parts: tuple[AnsweredPart, ...]
    worth: float

    @property
    def points(self) -> float:
        """The points of all its parts."""
        return sum(part.points for part in self.parts)


def answered(exercise: SetExercise, worth: float | None = None) -> AnsweredExercise:
    """The exercise as it stands in results; it counts its own points, or else ``worth``."""
    parts = tuple(AnsweredPart(part.id, part.title, part.points) for part in exercise.parts)
    worth = sum(part.points for part in parts) if worth is None else worth
    return AnsweredExercise(exercise.id, exercise.title, exercise.source, parts, worth)


def is_answered(report: Report) -> bool:
    """Whether any part of the exercise has an answer, readable or not."""
    return any(part.verdict is not Verdict.MISSING for part in report.parts)


@dataclass(frozen=True, slots=True)
class GradedFile:
    """A file with its report, or with the problem because of which there is none.

    With both, a part of what was handed in could not be used.

    ``file`` is its name; empty where an exercise has no file.
    """

    file: str
    exercise: AnsweredExercise
    report: Report | None
    problem: str = ""

    @property
    def weight(self) -> float:
        """What a point of the report counts in the submission."""
        return self.exercise.worth / self.exercise.points

    @property
    def points(self) -> float:
        """The points that the file earns for the submission."""
        return self.report.points * self.weight if self.report else 0.0


@dataclass(frozen=True, slots=True)
class GradedSubmission:
    """What one learner handed in: a file for each exercise that was set.

    ``name`` tells it apart from the others, ``learner`` says whose it is. ``pass_mark`` is the
    score to reach, of 1.
    """

    name: str
    learner: str
    files: tuple[GradedFile, ...]
    pass_mark: float

    @property
    def points(self) -> float:
        """The points of all files; one without a report has none."""
        return rounded_points(sum(file.points for file in self.files))

    @property
    def max_points(self) -> float:
        """The most points that there are."""
        return rounded_points(sum(file.exercise.worth for file in self.files))

    @property
    def score(self) -> float:
        """The points as a share of the most points, 0..1."""
        return rounded_points(self.points / self.max_points)

    @property
    def is_graded(self) -> bool:
        """Whether there is any report."""
        return any(file.report for file in self.files)

    @property
    def is_gradable(self) -> bool:
        """Whether anything that was handed in could be read."""
        return any(file.report and file.report.gradable for file in self.files)

    @property
    def is_answered(self) -> bool:
        """Whether anything was handed in, readable or not."""
        return any(file.report and is_answered(file.report) for file in self.files)

    @property
    def problems(self) -> tuple[str, ...]:
        """The problems of its files, each once."""
        return tuple(dict.fromkeys(file.problem for file in self.files if file.problem))

    @property
    def passed(self) -> bool:
        """Whether the submission was graded and reaches the pass mark."""
        return self.is_graded and self.score >= self.pass_mark - _ROUNDED


class Visibility(StrEnum):
    """The time from which students see a result, on platforms that let a grader decide it.

    The names are Gradescope's.
    """

    VISIBLE = "visible"
    AFTER_DUE_DATE = "after_due_date"
    AFTER_PUBLISHED = "after_published"
    HIDDEN = "hidden"
