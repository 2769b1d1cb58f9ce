"""Find joint variables in answers for the home position, where these variables are 0."""

from collections.abc import Sequence

import numpy as np

from service.catalogue import Exercise
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase
from service.grading.diagnosis.screws.all_screws import WrongScrews
from service.grading.diagnosis.wrong_value import Mask
from service.grading.misconception import register
from service.grading.reading.entry import Entry
from service.translations import say

NOT_AT_HOME = register(
    of=WrongScrews,
    code="not_at_home",
    rule="screw_axis",
    means="an answer for the home position, such as a screw axis or the home pose M, contains "
    "a joint variable",
    example=("planar-rpr-poe", "space-screws", {"3/4": "q1 q2"}),
    unlike={"3/4": "1"},
).finding(
    say("In the home position every joint variable is 0: no joint variable belongs here."),
    say("Put 0 for each joint variable."),
)


def with_joint_variable(entries: Sequence[Sequence[Entry]], exercise: Exercise) -> Mask:
    """Return a mask ``(rows, columns)`` of the entries that contain a joint variable."""
    variables = {joint.variable for joint in exercise.joints}
    return np.array(
        [
            [
                entry.expression is not None and not variables.isdisjoint(entry.expression.symbols)
                for entry in row
            ]
            for row in entries
        ],
        dtype=np.bool_,
    )


def explain_moving(
    case: MatrixCase, entries: Sequence[Sequence[Entry]], exercise: Exercise
) -> list[Explanation]:
    """Return explanations for entries of a home pose that wrongly contain a joint variable."""
    moving = np.asarray(case.wrong & with_joint_variable(entries, exercise))
    return [Explanation(NOT_AT_HOME, moving)] if moving.any() else []
