"""Answer kind ``position``: the coordinates of a point, such as the end effector's."""

import numpy as np

from service.catalogue import Robot
from service.catalogue.parts.position import PositionSpec
from service.grading.diagnosis.lists.position import WrongPosition
from service.grading.diagnosis.lists.value_list import SEARCH_WORK, search_of, slips_of
from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import chains_of
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers, slipped_answers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.judging.content import known_cells, of_list
from service.grading.judging.expected import as_entries, asked_pose, formula_values, is_whole_chain
from service.grading.judging.report_rows import value_places, value_rows
from service.grading.judging.value_list import ComparedValues, number_corrections
from service.grading.misconception import diagnosed
from service.grading.numerics.comparison import Match
from service.grading.part import Grading, Judged
from service.grading.reading.lists.component_names import names_of_coordinates
from service.grading.reading.lists.value_list import (
    HOMOGENEOUS,
    PLANAR,
    StudentValues,
    Tail,
    read_list,
)
from service.grading.report import Place
from service.kinematics.transforms import Numbers


def read_position_answer(part: PositionSpec, answer: object, grading: Grading) -> StudentValues:
    """Read the coordinates in a list or a pasted text."""
    names = names_of_coordinates(part.coordinates)
    return read_list(answer, names, grading.reader, _tails(part.coordinates))


def _tails(coordinates: str) -> tuple[Tail, ...]:
    # Such as the 0 in [x, y, 0].
    if coordinates == "xy":
        return PLANAR, HOMOGENEOUS, (*PLANAR, *HOMOGENEOUS)
    # If x and z are expected, z in [x, y, 0] may be the second or the third value.
    return (HOMOGENEOUS,) if len(coordinates) == len("xyz") else ()


def judge_position_answer(part: PositionSpec, answer: StudentValues, grading: Grading) -> Judged:
    """Judge the coordinates; the report has one row for each coordinate."""
    expected = _expected(part, grading)
    compared = ComparedValues(answer, expected, number_corrections(expected, grading))
    found = compared.matches(grading)
    wrong = found < Match.ROUNDED
    different = found == Match.DIFFERENT
    explains = wrong.any() and grading.affords(SEARCH_WORK)
    answers = _slipped(part, grading) if explains else None
    explained = _explained(part, compared, different, answers, grading) if explains else None
    slips = slips_of(compared, wrong & ~(different & bool(explained)), grading, answers)
    rows = value_rows(answer, found, slips, grading)
    content = of_list(known_cells(expected, 0.0, compared.scales(grading)))
    return Judged(rows, content, grading.messages(*explained) if explained else ())


def _expected(part: PositionSpec, grading: Grading) -> Numbers:
    given = formula_values(part, grading)
    if given is not None:
        return np.asarray(given[0])
    return as_entries(asked_pose(part, grading))[_axes(part), 3]


def _axes(part: PositionSpec) -> list[int]:
    return ["xyz".index(letter) for letter in part.coordinates]


def _explained(
    part: PositionSpec,
    compared: ComparedValues,
    wrong: Mask,
    answers: SlippedAnswers | None,
    grading: Grading,
) -> tuple[tuple[Finding], tuple[Place, ...]] | None:
    exercise = grading.exercise
    linked = is_whole_chain(part, exercise) and isinstance(exercise.reference, Robot)
    case = WrongPosition(
        compared.student.values,
        compared.expected,
        scale=exercise.length_scale,
        axes=tuple(_axes(part)),
        chains=chains_of(exercise, grading.samples) if linked else (),
        slips=search_of(answers, compared, wrong, grading),
        motion=GivenMotion.of(part.id, exercise, grading.samples),
    )
    finding = diagnosed(case)
    return ((finding,), value_places(wrong)) if finding else None


def _slipped(part: PositionSpec, grading: Grading) -> SlippedAnswers | None:
    answers = slipped_answers(part, grading)
    if answers is None or part.expected is not None:
        return answers and answers.of(lambda grid: grid[:, 0])
    return answers.of(lambda poses: poses[:, _axes(part), 3])
