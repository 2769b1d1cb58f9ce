"""The exercise's own answer must get full marks."""

import math
from collections.abc import Iterator
from typing import Final

from service.authoring.grading import graded, in_words
from service.authoring.remarks import Remark, failed
from service.catalogue import Exercise
from service.expressions import LIMITS, AngleUnit
from service.solutions import solve

UNITS: Final[tuple[AngleUnit, ...]] = ("radians", "degrees")


def model_answer(exercise: Exercise) -> Iterator[Remark]:
    """Parts in which the model solution does not get full marks, in radians or in degrees."""
    answers = solve(exercise).answers
    fields = {part.id: f"parts[{i}]" for i, part in enumerate(exercise.parts)}
    too_long = [part for part, answer in answers.items() if _longest(answer) > LIMITS.characters]
    for part in too_long:
        yield failed(
            fields[part],
            f"the right answer to {part} has an entry of more than the {LIMITS.characters} "
            f"characters that are read, so nobody can hand it in; ask for less, such as the pose "
            f"of a frame in between",
        )
    for unit in UNITS:
        reports = graded(exercise, answers, unit)
        short = [report for report in reports.values() if report.points < report.max_points]
        for report in short:
            if report.part not in too_long:
                yield failed(
                    fields[report.part],
                    f"the model answer to {report.part} is not right with angles in {unit}: "
                    f"{in_words(report)}",
                )
        if short:
            return


def _longest(answer: object) -> float:
    """The number of characters of the longest entry of an answer."""
    match answer:
        case None:
            return math.inf
        case str():
            return len(answer)
        case dict():
            return max(map(_longest, answer.values()), default=0)
        case list():
            return max(map(_longest, answer), default=0)
        case _:
            return 0
