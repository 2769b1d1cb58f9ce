"""Answer kind ``transform``: a homogeneous transform, such as the pose of the end effector."""

import numpy as np

from service.catalogue import Robot
from service.catalogue.parts.transform import TransformSpec
from service.catalogue.robots.formulas import HOMOGENEOUS
from service.grading.diagnosis.matrices.exponentials import explain_product
from service.grading.diagnosis.matrices.home_position import explain_moving
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase
from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import Chain, chains_of
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers, slipped_answers
from service.grading.follow_through import stands_still
from service.grading.judging.content import of_rigid
from service.grading.judging.expected import as_entries, asked_pose, formula_values, is_whole_chain
from service.grading.judging.matrix import ExpectedMatrix
from service.grading.kinds.shared.matrix_rows import matrix_rows
from service.grading.numerics.samples import Samples
from service.grading.part import Grading, Judged, StudentChain
from service.grading.reading.matrices.matrix import StudentMatrix, read_matrix
from service.kinematics.chain import products
from service.kinematics.transforms import Matrices


def read_transform_answer(part: TransformSpec, answer: object, grading: Grading) -> StudentMatrix:
    """Read the entries of a nested list or a pasted text."""
    return read_matrix(answer, HOMOGENEOUS, grading.reader)


def judge_transform_answer(part: TransformSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the matrix entry by entry."""
    exercise = grading.exercise
    given = formula_values(part, grading)
    values = as_entries(asked_pose(part, grading)) if given is None else given
    whole = is_whole_chain(part, exercise)
    linked = whole and isinstance(exercise.reference, Robot)

    def chains(samples: Samples) -> tuple[Chain, ...]:
        return chains_of(exercise, samples) if linked else ()

    def motion(samples: Samples) -> GivenMotion | None:
        return GivenMotion.of(part.id, exercise, samples)

    def explanations(case: MatrixCase) -> list[Explanation]:
        if part.home:
            return explain_moving(case, answer.entries, exercise)
        return explain_product(case, exercise, grading.samples) if whole else []

    def slipped() -> SlippedAnswers | None:
        return slipped_answers(part, grading)

    expected = ExpectedMatrix(values, HOMOGENEOUS, rigid=True)
    judged = matrix_rows(answer, expected, grading, chains, explanations, slipped, motion)
    may_stand_still = whole and not judged.is_right
    return Judged(
        judged.rows,
        of_rigid(values, part, grading),
        judged.feedback,
        stands_still=may_stand_still and stands_still(answer.with_zeros, HOMOGENEOUS, grading),
        chain=lambda: _chain(answer),
    )


def _chain(answer: StudentMatrix) -> StudentChain | None:
    if np.isnan(answer.values).any():
        return None

    def frames_at(samples: Samples) -> Matrices:
        return products(np.moveaxis(answer.values_at(samples), -1, 0)[None])

    return StudentChain(products(np.moveaxis(answer.values, -1, 0)[None]), frames_at)
