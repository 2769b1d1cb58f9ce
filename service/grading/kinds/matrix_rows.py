"""Reading handed-in matrices and judging them entry by entry, whatever they stand for."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from service.expressions import Kind
from service.grading.comparison import Match, matches
from service.grading.diagnosis.formula_repair import WrongEntry
from service.grading.diagnosis.matrix_case import Chain, Explanation, MatrixCase
from service.grading.diagnosis.matrix_entry import WORK_BUDGET, diagnose_entries
from service.grading.diagnosis.whole_matrix import check_yourself, explain, unexplained
from service.grading.feedback import Finding
from service.grading.judging.report_rows import entry_rows
from service.grading.part import Grading
from service.grading.reading.entry import MISSING, Entry, Reader, unreadable
from service.grading.reading.pasted import from_grid_error, read_pasted_matrix
from service.grading.report import Feedback, RowReport
from service.grading.samples import Samples
from service.grids import GridError
from service.kinematics.transforms import Numbers

# How many samples of each half show what a whole matrix is.
FEW = 4


@dataclass(frozen=True, slots=True)
class ExpectedMatrix:
    """What a matrix must be: ``values`` is ``(rows, columns, samples)``, each of a quantity.

    ``rigid`` marks a homogeneous transform (4×4) or a rotation (3×3).
    """

    values: Numbers
    quantities: tuple[tuple[Kind, ...], ...]
    rigid: bool = False

    def scale(self, length_scale: float) -> Numbers:
        """What each entry is measured against, ``(rows, columns)``."""
        return np.array(
            [[length_scale if q == "length" else 1.0 for q in row] for row in self.quantities]
        )


class UnreadableMatrixError(Exception):
    """The answer is no matrix of the size asked for; ``finding`` says what it would look like."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.hint)
        self.finding = finding


def read_matrix(
    answer: object, quantities: Sequence[Sequence[Kind]], reader: Reader
) -> list[list[Entry]]:
    """The entries of a nested list or of pasted text, one for each quantity asked for.

    Rows that were left off at the end are missing; a row of the wrong length is unreadable, because
    nobody can say which entry is which. Raises UnreadableMatrixError where there are no rows at
    all, or too many.
    """
    if isinstance(answer, str):
        return _pasted(answer, quantities, reader)
    if not isinstance(answer, list) or not answer or len(answer) > len(quantities):
        rows, columns = len(quantities), len(quantities[0])
        raise UnreadableMatrixError(
            Finding(
                "wrong_shape",
                f"This answer is a matrix of {rows} rows with {columns} entries each, written as "
                f"a list of lists.",
                reading=True,
            )
        )
    absent: list[object] = [None] * (len(quantities) - len(answer))
    return [
        _row(row, row_quantities, reader)
        for row, row_quantities in zip([*answer, *absent], quantities, strict=True)
    ]


def _pasted(text: str, quantities: Sequence[Sequence[Kind]], reader: Reader) -> list[list[Entry]]:
    try:
        entries = read_pasted_matrix(text, quantities, reader) if text.strip() else []
    except GridError as error:
        raise UnreadableMatrixError(from_grid_error(error)) from error
    absent = [[MISSING] * len(row) for row in quantities[len(entries) :]]
    return [*entries, *absent]


def _row(row: object, quantities: Sequence[Kind], reader: Reader) -> list[Entry]:
    if row is None:
        return [MISSING] * len(quantities)
    if not isinstance(row, list) or len(row) != len(quantities):
        found = f"{len(row)} entries" if isinstance(row, list) else "no list"
        finding = Finding(
            "row_length", f"A row has {len(quantities)} entries; this is {found}.", reading=True
        )
        return [unreadable(finding)] * len(quantities)
    return [reader.read(raw, quantity) for raw, quantity in zip(row, quantities, strict=True)]


def numbers_of(
    entries: list[list[Entry]], quantities: Sequence[Sequence[Kind]], reader: Reader
) -> Numbers:
    """The values of a matrix's entries, ``(rows, columns, SAMPLES)``; NaN where there are none."""
    flat = reader.numbers(list(chain(*entries)), list(chain(*quantities)))
    return flat.reshape(len(entries), len(quantities[0]), -1)


@dataclass(frozen=True, slots=True)
class JudgedMatrix:
    """The report rows "1".."n" of a matrix, and what is to be said of it as a whole."""

    rows: tuple[RowReport, ...]
    feedback: tuple[Feedback, ...] = ()


def _no_chains(_samples: Samples) -> tuple[Chain, ...]:
    return ()


def _no_misconceptions(_case: MatrixCase) -> list[Explanation]:
    return []


def judged_matrix(
    entries: list[list[Entry]],
    expected: ExpectedMatrix,
    points: float,
    grading: Grading,
    chains: Callable[[Samples], tuple[Chain, ...]] = _no_chains,
    misconceptions: Callable[[MatrixCase], list[Explanation]] = _no_misconceptions,
    work_budget: float = WORK_BUDGET,
) -> JudgedMatrix:
    """A matrix that is worth ``points``, entry by entry.

    ``chains`` gives the links, at the samples it is handed, that the matrix is the product of where
    it is one; ``misconceptions`` explains the matrix by what else it is made of, and is asked
    first. Both are asked only where something is wrong. ``work_budget`` bounds how
    much is taken apart.
    """
    actual = numbers_of(entries, expected.quantities, grading.reader)
    scale = expected.scale(grading.exercise.length_scale)
    rounded = [[entry.may_be_rounded for entry in row] for row in entries]
    found = matches(actual, expected.values, scale, rounded=rounded)
    if (found >= Match.ROUNDED).all():
        return JudgedMatrix(entry_rows(entries, found, {}, points, grading))
    case = MatrixCase(
        actual=Samples.subset_of(actual, FEW),
        expected=Samples.subset_of(expected.values, FEW),
        scale=scale,
        wrong=found == Match.DIFFERENT,
        rigid=expected.rigid,
        chains=chains(grading.samples.subset(FEW)),
    )
    explanations = misconceptions(case) or explain(case)
    told_apart = unexplained(case, explanations) | (found == Match.UNDEFINED)
    wrong = {
        (int(i), int(j)): WrongEntry(
            expression=expression,
            actual=actual[i, j],
            expected=expected.values[i, j],
            expected_text=constant_text(expected.values[i, j]),
            samples=grading.samples,
            scale=float(scale[i, j]),
            angle=False,
            turning=grading.exercise.vocabulary.turning,
        )
        for i, j in np.argwhere(told_apart)
        if (expression := entries[i][j].expression) is not None
    }
    slips = diagnose_entries(wrong, work_budget)
    check = check_yourself(case, slips)
    told = tuple(
        message
        for explanation in explanations
        for message in grading.visible((explanation.finding,), explanation.row)
    )
    return JudgedMatrix(
        entry_rows(entries, found, slips, points, grading),
        (*told, *grading.visible((check,) if check else ())),
    )


def constant_text(values: Numbers) -> str:
    """An entry that is a plain number everywhere, as text; empty where it varies."""
    if np.ptp(values) > 1e-12:
        return ""
    return f"{values[0] + 0.0:.4g}"
