"""Answer kind ``transform``: a homogeneous transform, such as the pose of the end effector."""

from dataclasses import dataclass

from service.catalogue import Robot
from service.catalogue.parts.transform import TransformSpec
from service.expressions import Kind
from service.grading.diagnosis.exponentials import explain_product
from service.grading.diagnosis.matrix_case import Chain, Explanation, MatrixCase, chains_of
from service.grading.judging.expected import as_entries, asked_pose, is_whole_chain, own_values
from service.grading.kinds.matrix_rows import (
    ExpectedMatrix,
    UnreadableMatrixError,
    judged_matrix,
    read_matrix,
)
from service.grading.part import Grading, PartTerms
from service.grading.report import PartReport, Verdict
from service.grading.samples import Samples

_LINE: tuple[Kind, ...] = ("number", "number", "number", "length")
HOMOGENEOUS: tuple[tuple[Kind, ...], ...] = (_LINE, _LINE, _LINE, ("number",) * 4)


@dataclass(frozen=True, slots=True)
class TransformKind:
    """Grades a 4×4 matrix: a pose of the robot, or what the exercise says."""

    def grade(self, part: TransformSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a 4×4 matrix, row by row and entry by entry."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        try:
            entries = read_matrix(answer, HOMOGENEOUS, grading.reader)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        exercise, samples = grading.exercise, grading.samples
        own = own_values(part.id, exercise, samples)
        values = as_entries(asked_pose(part, grading)) if own is None else own
        whole = is_whole_chain(part, exercise)
        linked = whole and isinstance(exercise.reference, Robot)

        def chains(samples: Samples) -> tuple[Chain, ...]:
            return chains_of(exercise, samples) if linked else ()

        def misconceptions(case: MatrixCase) -> list[Explanation]:
            return explain_product(case, exercise, samples) if whole else []

        judged = judged_matrix(
            entries,
            ExpectedMatrix(values, HOMOGENEOUS, rigid=True),
            part.points,
            grading,
            chains=chains,
            misconceptions=misconceptions,
        )
        return terms.report(judged.rows, judged.feedback)
