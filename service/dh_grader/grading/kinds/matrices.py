"""Answer kinds ``vector``, ``transform``, ``rotation``, ``position`` and ``matrix``.

Each kind has a function that reads and one that judges (``AnswerKind``). They only put together
what ``reading``, ``judging.py`` and ``diagnosis`` know.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from dh_grader.catalogue import Robot
from dh_grader.catalogue.kinds import (
    MatrixSpec,
    PositionSpec,
    RotationSpec,
    TransformSpec,
    VectorSpec,
)
from dh_grader.catalogue.robot import HOMOGENEOUS, ROTATION
from dh_grader.expressions.printing import PLAIN
from dh_grader.grading.diagnosis.formulas import WrongEntry
from dh_grader.grading.diagnosis.lists import SEARCH_WORK, WrongPosition, search_of, slips_of
from dh_grader.grading.diagnosis.matrices import (
    WORK_BUDGET,
    check_yourself,
    diagnose_entries,
    explain,
    unexplained,
)
from dh_grader.grading.diagnosis.motions import (
    Chain,
    Explanation,
    GivenMotion,
    MatrixCase,
    chains_of,
)
from dh_grader.grading.diagnosis.products import (
    Step,
    explain_moving,
    explain_product,
    explain_steps,
)
from dh_grader.grading.diagnosis.upstream import (
    Requirements,
    SlippedAnswers,
    SlipSearch,
    slipped_answers,
)
from dh_grader.grading.judging import (
    ComparedValues,
    ExpectedMatrix,
    Grading,
    Judged,
    StudentChain,
    as_entries,
    asked_pose,
    entry_rows,
    formula_values,
    given_values,
    is_whole_chain,
    known_cells,
    number_corrections,
    of_list,
    of_matrix,
    of_rigid,
    value_places,
    value_rows,
)
from dh_grader.grading.marks import stands_still
from dh_grader.grading.misconception import Mask, diagnosed, number_formula, spelled
from dh_grader.grading.numbers import Match, Samples
from dh_grader.grading.reading.lists import (
    ONE_TAIL,
    ZERO_TAIL,
    StudentValues,
    Tail,
    names_of_components,
    names_of_coordinates,
    read_list,
)
from dh_grader.grading.reading.matrices import StudentMatrix, read_matrix
from dh_grader.grading.report import Correction, Feedback, Finding, Place, RowReport
from dh_grader.kinematics import Matrices, Numbers, about, composed, products

# --- Answer kind ``vector``: a list of lengths, angles and numbers


def read_vector_answer(part: VectorSpec, answer: object, grading: Grading) -> StudentValues:
    """Read the values in a list or a pasted text."""
    names = names_of_components(
        tuple((each.name, each.quantity) for each in part.components), grading.reader.vocabulary
    )
    tails = (ZERO_TAIL,) if len(part.components) == len("xy") else ()
    return read_list(answer, names, grading.reader, tails)


def judge_vector_answer(part: VectorSpec, answer: StudentValues, grading: Grading) -> Judged:
    """Judge the values; the report has one row for each component."""
    [expected] = given_values(part, grading)
    [formulas] = grading.exercise.formulas[part.id]
    compared = ComparedValues(answer, expected)
    found = compared.matches(grading)
    wrong = found < Match.ROUNDED
    corrections: list[Correction | None] = [None] * len(formulas)
    if wrong.any() and grading.corrects:
        spelling = grading.spelling(answer.entries)
        corrections = [spelled(formula.tree, spelling) for formula in formulas]
    different = found == Match.DIFFERENT
    explains = wrong.any() and grading.affords(SEARCH_WORK)
    answers = slipped_answers(part, grading) if explains else None
    answers = answers and answers.of(lambda grid: grid[:, 0])
    explained = _slip_of_all(answers, compared, different, grading) if different.sum() > 1 else None
    wrong &= ~(different & bool(explained))
    corrected = ComparedValues(answer, expected, corrections)
    slips = slips_of(corrected, wrong, grading, answers)
    content = of_list(known_cells(expected, 0.0, compared.scales(grading)))
    feedback = grading.messages((explained,), value_places(different)) if explained else ()
    return Judged(value_rows(answer, found, slips, grading), content, feedback)


def _slip_of_all(
    answers: SlippedAnswers | None, compared: ComparedValues, wrong: Mask, grading: Grading
) -> Finding | None:
    # None if fewer than two values are wrong.
    search = search_of(answers, compared, wrong, grading)
    found = search.explanation(np.ones_like(wrong)) if search else None
    return None if found is None else found.findings[0]


# --- Answer kind ``transform``: a homogeneous transform, such as the pose of the end effector


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


# --- Answer kind ``rotation``: a rotation matrix, of a pose or of several turns about axes


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

    expected = ExpectedMatrix(_expected_rotation(part, steps, grading), ROTATION, rigid=True)
    judged = matrix_rows(answer, expected, grading, chains, explanations, slipped, motion)
    content = of_rigid(expected.values, part, grading)
    return Judged(judged.rows, content, judged.feedback)


def _expected_rotation(part: RotationSpec, steps: list[Step], grading: Grading) -> Numbers:
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


# --- Answer kind ``position``: the coordinates of a point, such as the end effector's


def read_position_answer(part: PositionSpec, answer: object, grading: Grading) -> StudentValues:
    """Read the coordinates in a list or a pasted text."""
    names = names_of_coordinates(part.coordinates)
    return read_list(answer, names, grading.reader, _tails(part.coordinates))


def _tails(coordinates: str) -> tuple[Tail, ...]:
    # Such as the 0 in [x, y, 0].
    if coordinates == "xy":
        return ZERO_TAIL, ONE_TAIL, (*ZERO_TAIL, *ONE_TAIL)
    # If x and z are expected, z in [x, y, 0] may be the second or the third value.
    return (ONE_TAIL,) if len(coordinates) == len("xyz") else ()


def judge_position_answer(part: PositionSpec, answer: StudentValues, grading: Grading) -> Judged:
    """Judge the coordinates; the report has one row for each coordinate."""
    expected = _expected_position(part, grading)
    compared = ComparedValues(answer, expected, number_corrections(expected, grading))
    found = compared.matches(grading)
    wrong = found < Match.ROUNDED
    different = found == Match.DIFFERENT
    explains = wrong.any() and grading.affords(SEARCH_WORK)
    answers = _slipped_positions(part, grading) if explains else None
    explained = _explained(part, compared, different, answers, grading) if explains else None
    slips = slips_of(compared, wrong & ~(different & bool(explained)), grading, answers)
    rows = value_rows(answer, found, slips, grading)
    content = of_list(known_cells(expected, 0.0, compared.scales(grading)))
    return Judged(rows, content, grading.messages(*explained) if explained else ())


def _expected_position(part: PositionSpec, grading: Grading) -> Numbers:
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


def _slipped_positions(part: PositionSpec, grading: Grading) -> SlippedAnswers | None:
    answers = slipped_answers(part, grading)
    if answers is None or part.expected is not None:
        return answers and answers.of(lambda grid: grid[:, 0])
    return answers.of(lambda poses: poses[:, _axes(part), 3])


# --- Answer kind ``matrix``: a matrix with any meaning, entry by entry


def read_matrix_answer(part: MatrixSpec, answer: object, grading: Grading) -> StudentMatrix:
    """Read the entries of a nested list or a pasted text."""
    return read_matrix(answer, part.quantities, grading.reader)


def judge_matrix_answer(part: MatrixSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the matrix entry by entry."""
    expected = ExpectedMatrix(given_values(part, grading), part.quantities)
    judged = matrix_rows(answer, expected, grading)
    content = of_matrix(expected.values, expected.scale(grading.exercise.length_scale))
    return Judged(judged.rows, content, judged.feedback)


# --- The rows of a report on a matrix, for all kinds with matrices


# The number of samples of each half that distinguish whole matrices.
SUBSET = 4
# The budgeted work of all explanations: of a single matrix, for which all slips of a table are
# tried, and of one of several matrices.
MATRIX_WORK, LINK_WORK = 15.0, 12.0


@dataclass(frozen=True, slots=True)
class MatrixRows:
    """The report rows of a matrix, and the messages on the matrix as a whole."""

    rows: tuple[RowReport, ...]
    feedback: tuple[Feedback, ...] = ()
    is_right: bool = False


def matrix_rows(
    student: StudentMatrix,
    expected: ExpectedMatrix,
    grading: Grading,
    chains: Callable[[Samples], tuple[Chain, ...]] = lambda _: (),
    explanations: Callable[[MatrixCase], list[Explanation]] = lambda _: [],
    slipped: Callable[[], SlippedAnswers | None] = lambda: None,
    motion: Callable[[Samples], GivenMotion | None] = lambda _: None,
    work_budget: float = WORK_BUDGET,
    name: str = "",
) -> MatrixRows:
    """Return the report rows of a matrix, with explanations of its wrong entries.

    The functions among the arguments are called only if an entry is wrong. ``explanations`` returns
    the explanations that only this kind of answer has; the general ones are tried only if there are
    none of these. ``chains`` returns the links whose product is the matrix, ``motion`` the motion
    in given formulas, both at given samples. ``slipped`` returns the matrices that follow from
    slips in the table. ``work_budget`` limits the search in products. ``name`` is the name of this
    matrix if the answer has several, as in the row "A2.1".
    """
    notes = grading.messages(student.findings)
    labels = [f"{name}.{i + 1}" if name else str(i + 1) for i in range(len(student.entries))]
    found = expected.matches(student, grading.exercise.length_scale, grading.samples)
    if (found >= Match.ROUNDED).all():
        rows = entry_rows(student.entries, found, {}, grading, labels=labels)
        return MatrixRows(rows, notes, is_right=True)
    if not grading.affords(LINK_WORK if name else MATRIX_WORK):
        return MatrixRows(entry_rows(student.entries, found, {}, grading, labels=labels), notes)
    scale = expected.scale(grading.exercise.length_scale)
    actual = Samples.subset_of(student.values, SUBSET)
    right = Samples.subset_of(expected.values, SUBSET)
    wrong = found == Match.DIFFERENT
    search = None
    if (answers := slipped()) is not None:
        search = SlipSearch(
            answers,
            grading.samples,
            actual,
            right,
            wrong,
            scale,
            name=grading.symbol_names(chain(*student.entries)),
            unwritten=grading.unwritten(chain(*student.entries)),
        )
    case = MatrixCase(
        actual=actual,
        expected=right,
        scale=scale,
        wrong=wrong,
        rigid=expected.rigid,
        chains=chains(grading.samples.subset(SUBSET)),
        slips=search,
        motion=motion(grading.samples.subset(SUBSET)),
    )
    explained = explanations(case) or explain(case)
    left = unexplained(case, explained) | (found == Match.UNDEFINED)
    spelling = grading.spelling(chain(*student.entries)) if left.any() else PLAIN
    entries = {
        (int(i), int(j)): WrongEntry(
            expression=expression,
            actual=student.values[i, j],
            expected=expected.values[i, j],
            samples=grading.samples,
            scale=float(scale[i, j]),
            angle=False,
            correction=number_formula(expected.values[i, j]) if grading.corrects else None,
            spelling=spelling,
            turning=grading.exercise.vocabulary.turning,
            corrects=grading.corrects,
        )
        for i, j in np.argwhere(left)
        if (expression := student.entries[i][j].expression) is not None
    }
    requirements = (
        None
        if answers is None
        else Requirements(answers, grading.exercise, grading.samples, expected.values, scale)
    )
    slips = diagnose_entries(entries, grading.affords, work_budget, requirements)
    check = check_yourself(case, slips)
    findings = [(each.finding, _places_of(each.entries & case.wrong, labels)) for each in explained]
    findings += [(check, tuple(map(Place, labels[:3])))] if check else []
    return MatrixRows(
        entry_rows(student.entries, found, slips, grading, labels=labels),
        (
            *notes,
            *chain.from_iterable(
                grading.messages((finding,), places) for finding, places in findings
            ),
        ),
    )


def _places_of(entries: Mask, labels: Sequence[str]) -> tuple[Place, ...]:
    return tuple(Place(labels[i], str(j + 1)) for i, j in np.argwhere(entries).tolist())
