"""Answer kind ``rotation``: a rotation matrix, of a pose or made of turns about axes."""

from dataclasses import dataclass

from service.catalogue import Robot
from service.catalogue.formulas import ROTATION
from service.catalogue.parts.rotation import RotationSpec
from service.grading.diagnosis.matrix_case import Explanation, MatrixCase, chains_of
from service.grading.diagnosis.rotation_steps import Step, explain_steps
from service.grading.judging.expected import as_entries, asked_pose, is_whole_chain, own_values
from service.grading.kinds.matrix_rows import (
    ExpectedMatrix,
    UnreadableMatrixError,
    judged_matrix,
    read_matrix,
)
from service.grading.part import Grading, PartTerms
from service.grading.report import PartReport, Verdict
from service.kinematics.rotations import about, composed
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class RotationKind:
    """Grades a 3×3 matrix entry by entry."""

    def grade(self, part: RotationSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a rotation matrix, row by row and entry by entry."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        try:
            entries = read_matrix(answer, ROTATION, grading.reader)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        exercise, samples = grading.exercise, grading.samples
        steps = _steps(part, grading)
        own = own_values(part.id, exercise, samples)
        if steps:
            values = as_entries(composed([(step.rotation, step.fixed) for step in steps]))
        elif own is not None:
            values = own
        else:
            values = as_entries(asked_pose(part, grading)[:, :3, :3])

        def misconceptions(case: MatrixCase) -> list[Explanation]:
            return explain_steps(case, steps)

        whole = is_whole_chain(part, exercise) and isinstance(exercise.reference, Robot)
        judged = judged_matrix(
            entries,
            ExpectedMatrix(values, ROTATION, rigid=True),
            part.points,
            grading,
            chains=lambda samples: chains_of(exercise, samples) if whole else (),
            misconceptions=misconceptions,
        )
        return terms.report(judged.rows, judged.feedback)


def _steps(part: RotationSpec, grading: Grading) -> list[Step]:
    """The turns that the rotation is made of, in numbers; none where it is not given so."""
    if part.steps is None:
        return []
    angles: Numbers | None = own_values(part.id, grading.exercise, grading.samples)
    if angles is None:
        return []
    return [
        Step(step.axis.upper(), about(step.axis.upper(), angle), step.about == "fixed")
        for step, angle in zip(part.steps, angles[0], strict=True)
    ]
