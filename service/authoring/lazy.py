"""The marks of a student who knows nothing, for the author of an exercise to look at."""

import math
from collections.abc import Iterator, Mapping
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise
from service.grading import FeedbackLevel, PartReport, Submission, grade

# Half of a pose is its rotation, which a lazy student may know where all axes are parallel.
MOST: Final = 0.25
MOST_OF_A_POSE: Final = 0.5


def lazy_shares(exercise: Exercise) -> Mapping[str, float]:
    """The largest share of its points that a lazy answer earns, for each part by its id."""
    from service.solutions.kinds import LAZY

    return {
        part.id: max(
            _share(_report(exercise, part.id, answer)) for answer in LAZY[part.kind](part, exercise)
        )
        for part in exercise.parts
    }


def lazy_answers(exercise: Exercise) -> Iterator[Remark]:
    """Parts in which a lazy answer earns much."""
    shares = lazy_shares(exercise)
    for i, part in enumerate(exercise.parts):
        share = shares[part.id]
        if share > (MOST_OF_A_POSE if part.kind == "transform" else MOST):
            yield warning(
                f"parts[{i}]",
                f"an answer of zeros and bare joint variables earns {math.floor(100 * share)} % of "
                f"{part.id}; ask for more, or mark it by content",
            )


def _report(exercise: Exercise, part: str, answer: object) -> PartReport:
    reports = grade(exercise, Submission({part: answer}, feedback=FeedbackLevel.SCORE)).parts
    return next(report for report in reports if report.part == part)


def _share(report: PartReport) -> float:
    return report.points / report.max_points
