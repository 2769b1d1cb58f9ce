"""The points of answers that consist only of zeros and joint variables."""

import math
from collections.abc import Iterator, Mapping
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise
from service.grading import FeedbackLevel, PartReport, Submission, grade
from service.translations import Sentence, joined, say, say_count

# The largest share without a warning. A pose may earn more: with parallel axes, the lazy answer to
# its rotation, half of the pose, is right.
MOST: Final = 0.25
MOST_OF_A_POSE: Final = 0.5


def lazy_shares(exercise: Exercise) -> Mapping[str, float]:
    """Return the fraction of points that zeros and joint variables alone earn, by part id."""
    from service.solutions.kinds import LAZY

    return {
        part.id: max(
            _share(_report(exercise, part.id, answer)) for answer in LAZY[part.kind](part, exercise)
        )
        for part in exercise.parts
    }


def summary(exercise: Exercise) -> Sentence:
    """Return one sentence about an exercise: its parts, its checks and its easiest points."""
    earned = [
        say("{share} % of {part}", share=math.floor(100 * share), part=part)
        for part, share in lazy_shares(exercise).items()
    ]
    return say(
        "{parts}, {checks}. Writing only zeros and joint variables earns {earned}.",
        parts=say_count("{count} part", "{count} parts", count=len(exercise.parts)),
        checks=say_count("{count} check", "{count} checks", count=len(exercise.checks)),
        earned=joined(", ", earned),
    )


def lazy_answers(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning for each part in which zeros and joint variables alone earn many points."""
    shares = lazy_shares(exercise)
    for i, part in enumerate(exercise.parts):
        share = shares[part.id]
        if share > (MOST_OF_A_POSE if part.kind == "transform" else MOST):
            yield warning(
                f"parts[{i}]",
                say(
                    "an answer of only zeros and joint variables earns {share} % of {part}; ask "
                    "for more, or mark it by content",
                    share=math.floor(100 * share),
                    part=part.id,
                ),
            )


def _report(exercise: Exercise, part: str, answer: object) -> PartReport:
    reports = grade(exercise, Submission({part: answer}, feedback=FeedbackLevel.SCORE)).parts
    return next(report for report in reports if report.part == part)


def _share(report: PartReport) -> float:
    return report.points / report.max_points
