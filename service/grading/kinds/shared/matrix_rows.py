"""The rows of a report on a matrix, for all kinds with matrices."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from service.expressions.printing.spelling import PLAIN
from service.grading.diagnosis.formulas.formula_repair import WrongEntry
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase
from service.grading.diagnosis.matrices.matrix_entry import WORK_BUDGET, diagnose_entries
from service.grading.diagnosis.matrices.whole_matrix import check_yourself, explain, unexplained
from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import Chain
from service.grading.diagnosis.upstream.missing_symbol import Requirements
from service.grading.diagnosis.upstream.slip_search import SlipSearch
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.formula_text import number_formula
from service.grading.judging.matrix import ExpectedMatrix
from service.grading.judging.report_rows import entry_rows
from service.grading.numerics.comparison import Match
from service.grading.numerics.samples import Samples
from service.grading.part import Grading
from service.grading.reading.matrices.matrix import StudentMatrix
from service.grading.report import Feedback, Place, RowReport

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


def _no_chains(_samples: Samples) -> tuple[Chain, ...]:
    return ()


def _no_explanations(_case: MatrixCase) -> list[Explanation]:
    return []


def _no_slips() -> SlippedAnswers | None:
    return None


def _no_motion(_samples: Samples) -> GivenMotion | None:
    return None


def matrix_rows(
    student: StudentMatrix,
    expected: ExpectedMatrix,
    grading: Grading,
    chains: Callable[[Samples], tuple[Chain, ...]] = _no_chains,
    explanations: Callable[[MatrixCase], list[Explanation]] = _no_explanations,
    slipped: Callable[[], SlippedAnswers | None] = _no_slips,
    motion: Callable[[Samples], GivenMotion | None] = _no_motion,
    work_budget: float = WORK_BUDGET,
    name: str = "",
) -> MatrixRows:
    """Return the report rows of a matrix, with explanations of its wrong entries.

    The functions among the arguments are called only if an entry is wrong.
    """
    # ``explanations`` returns the explanations that only this kind of answer has; the general ones
    # are tried only if there are none of these. ``chains`` returns the links whose product is the
    # matrix, ``motion`` the motion in given formulas, both at given samples. ``slipped`` returns
    # the matrices that follow from slips in the table. ``work_budget`` limits the search in
    # products. ``name`` is the name of this matrix if the answer has several, as in the row "A2.1".
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
    findings = [(each.finding, _cells(each.entries & case.wrong, labels)) for each in explained]
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


def _cells(entries: Mask, labels: Sequence[str]) -> tuple[Place, ...]:
    return tuple(Place(labels[i], str(j + 1)) for i, j in np.argwhere(entries).tolist())
