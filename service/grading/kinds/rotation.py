"""Answer kind ``rotation``: a rotation matrix, of a pose or of several turns about axes."""

from service.catalogue import Robot
from service.catalogue.parts.rotation import RotationSpec
from service.catalogue.robots.formulas import ROTATION
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase
from service.grading.diagnosis.matrices.rotation_steps import Step, explain_steps
from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import Chain, chains_of
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers, slipped_answers
from service.grading.judging.content import of_rigid
from service.grading.judging.expected import (
    as_entries,
    asked_pose,
    formula_values,
    given_values,
    is_whole_chain,
)
from service.grading.judging.matrix import ExpectedMatrix
from service.grading.kinds.shared.matrix_rows import matrix_rows
from service.grading.numerics.samples import Samples
from service.grading.part import Grading, Judged
from service.grading.reading.matrices.matrix import StudentMatrix, read_matrix
from service.kinematics.rotations import about, composed
from service.kinematics.transforms import Numbers


def read_rotation_answer(part: RotationSpec, answer: object, grading: Grading) -> StudentMatrix:
    """Read the entries of a nested list or a pasted text."""
    return read_matrix(answer, ROTATION, grading.reader)


def judge_rotation_answer(part: RotationSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the matrix entry by entry."""
    exercise = grading.exercise
    steps = _steps(part, grading)
    linked = is_whole_chain(part, exercise) and isinstance(exercise.reference, Robot)

    def chains(samples: Samples) -> tuple[Chain, ...]:
        return chains_of(exercise, samples) if linked else ()

    def motion(samples: Samples) -> GivenMotion | None:
        return None if steps else GivenMotion.of(part.id, exercise, samples)

    def explanations(case: MatrixCase) -> list[Explanation]:
        return explain_steps(case, steps)

    def slipped() -> SlippedAnswers | None:
        # The formulas of steps are their angles, and not the rotation.
        answers = None if steps else slipped_answers(part, grading)
        return answers and answers.of(lambda poses: poses[:, :3, :3])

    expected = ExpectedMatrix(_expected(part, steps, grading), ROTATION, rigid=True)
    judged = matrix_rows(answer, expected, grading, chains, explanations, slipped, motion)
    content = of_rigid(expected.values, part, grading)
    return Judged(judged.rows, content, judged.feedback)


def _expected(part: RotationSpec, steps: list[Step], grading: Grading) -> Numbers:
    if steps:
        return as_entries(composed([(step.rotation, step.fixed) for step in steps]))
    given = formula_values(part, grading)
    return as_entries(asked_pose(part, grading)[:, :3, :3]) if given is None else given


def _steps(part: RotationSpec, grading: Grading) -> list[Step]:
    # [] if the part gives no turns.
    if part.steps is None:
        return []
    [angles] = given_values(part, grading)
    return [
        Step(step.axis.upper(), about(step.axis.upper(), angle), step.about == "fixed")
        for step, angle in zip(part.steps, angles, strict=True)
    ]
