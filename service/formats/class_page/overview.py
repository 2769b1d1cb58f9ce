"""The data of the index, collected from submissions one by one."""

import os
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from service.formats.shared.graded import AnsweredExercise, GradedSubmission
from service.formats.shared.plain_text import points
from service.statistics import ClassStatistics


@dataclass(frozen=True, slots=True)
class ByHand:
    """The reason why a file must be graded by hand; ``file`` is the path to it, or empty."""

    reason: str
    file: str


@dataclass(frozen=True, slots=True)
class SubmissionLine:
    """A submission in the index; ``page`` is the path from the index to its page."""

    name: str
    learner: str
    person: str
    page: str
    points: str
    score: float
    passed: bool
    is_graded: bool
    is_gradable: bool
    problems: tuple[ByHand, ...]


@dataclass(slots=True)
class Overview:
    """A class: its exercises by id, a line for each submission, and the statistics.

    In the statistics, the number of a submission is its index in ``lines``.
    """

    exercises: dict[str, AnsweredExercise]
    lines: list[SubmissionLine] = field(default_factory=list)
    statistics: ClassStatistics = field(default_factory=ClassStatistics)
    pass_mark: float = 0.0
    graders: set[str] = field(default_factory=set)
    # The folder of the index, from which the paths to files lead; None if it is unknown.
    folder: Path | None = None
    # The entries of the class that are no submissions.
    left_out: tuple[str, ...] = ()
    _learners: Counter[str] = field(default_factory=Counter)

    def add(self, submission: GradedSubmission, page: str) -> None:
        """Count a submission and add its line; its reports are not stored."""
        number = len(self.lines)
        self.pass_mark = submission.pass_mark
        self._learners[submission.learner] += 1
        self.lines.append(
            SubmissionLine(
                name=submission.name,
                learner=submission.learner,
                person=submission.person,
                page=page,
                points=points(submission.points, submission.max_points),
                score=submission.score,
                passed=submission.passed,
                is_graded=submission.is_complete,
                is_gradable=submission.is_gradable,
                problems=_problems(submission, self.folder),
            )
        )
        if submission.is_complete:
            self.statistics.scores.add(submission.score, passed=submission.passed)
        for file in submission.files:
            self.exercises.setdefault(file.exercise.id, file.exercise)
            if file.report is not None:
                self.graders.add(file.report.grader)
                self.statistics.add(number, file.report)

    def listed(self, numbers: Iterable[int]) -> list[SubmissionLine]:
        """Return the index's lines for the submissions with these numbers."""
        return [self.lines[number] for number in numbers]

    def shown(self, line: SubmissionLine) -> str:
        """Return the learner's name, or the submission's if the learner has several submissions.

        If the name in the gradebook is a number, the name of the person is before it.
        """
        if self._learners[line.learner] > 1:
            return line.name
        is_known = not line.person or line.person == line.learner
        return line.learner if is_known else f"{line.person} ({line.learner})"

    @property
    def ungraded(self) -> list[SubmissionLine]:
        """Return the submissions with a problem, and those in which nothing was readable."""
        return [line for line in self.lines if line.problems or not line.is_gradable]


def _problems(submission: GradedSubmission, folder: Path | None) -> tuple[ByHand, ...]:
    has_several = len(submission.files) > 1
    found = (
        ByHand(
            f"{file.exercise.title}: {file.problem}" if has_several else file.problem,
            _path(file.file, folder),
        )
        for file in submission.files
        if file.problem
    )
    return tuple(dict.fromkeys(found))


def _path(file: str, folder: Path | None) -> str:
    # A file in a zip file has no path.
    if folder is None or not file or not Path(file).is_file():
        return ""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # on another drive of Windows
        return Path(file).absolute().as_uri()
