"""Choose the convention in which a submitted table is judged."""

from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.feedback import Finding
from service.grading.judging.table import Judgement, judged_table
from service.grading.misconception import register
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentTable
from service.grading.report import Severity
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.translations import say

_TAKEN = register(
    of=StudentTable,
    code="convention_taken",
    rule="convention",
    means="either convention will do and the answer names none: it was read in the one that fits "
    "best (an info)",
    example=("skew", "table", "a, alpha, d, theta ↵ 0, 60°, 0, theta1 ↵ a2, 0, 0, theta2"),
    unlike={"1/alpha": "0"},
)
_NOT_ASKED_FOR = register(
    of=StudentTable,
    code="convention_not_asked_for",
    rule="convention",
    means="the answer, or the links of a script, name another convention than the part; it was "
    "graded in the part's, and costs nothing by that",
    example=(
        "planar-rr",
        "table",
        {"convention": "modified", "rows": [["a1", "0", "0", "q1"], ["a2", "0", "0", "q2"]]},
    ),
    unlike="a2, 0, 0, theta2",
)


def judged_in_convention(
    part: DhTableSpec, table: StudentTable, grading: Grading
) -> tuple[Convention, Judgement, tuple[Finding, ...]]:
    """Choose the convention of a table, and judge the table; also return findings on the choice.

    If both conventions are allowed, the convention with fewer wrong cells is chosen.
    """
    # If the counts are equal, the reference's convention is chosen.
    if part.convention == "either" and table.convention is None:
        convention, judgement = _fitting(part, table, grading)
        return convention, judgement, (_taken(convention),)
    asked = table.convention if part.convention == "either" else part.convention
    assert asked is not None
    findings = _not_asked_for(asked, table)
    return asked, judged_table(part, table.rows, asked, grading), findings


def _fitting(
    part: DhTableSpec, table: StudentTable, grading: Grading
) -> tuple[Convention, Judgement]:
    own = grading.exercise.robot.convention
    first = judged_table(part, table.rows, own, grading)
    if not _misfit(first):
        return own, first
    [other] = set(Convention) - {own}
    second = judged_table(part, table.rows, other, grading)
    return (other, second) if _misfit(second) < _misfit(first) else (own, first)


def _misfit(judgement: Judgement) -> int:
    return judgement.wrong + len(COLUMNS) * len(judgement.extra) + (not judgement.reached)


def _taken(convention: Convention) -> Finding:
    if convention is Convention.STANDARD:
        hint = say(
            "The answer names no convention; it was read as standard, which fits it best. Check "
            "which convention you used, and name it."
        )
    else:
        hint = say(
            "The answer names no convention; it was read as modified, which fits it best. Check "
            "which convention you used, and name it."
        )
    return _TAKEN.finding(hint, severity=Severity.INFO)


def _not_asked_for(asked: Convention, table: StudentTable) -> tuple[Finding, ...]:
    if table.convention in (None, asked):
        return ()
    if asked is Convention.STANDARD:
        hint = say(
            "This part asks for the standard convention and was graded in it, but the answer says "
            "modified."
        )
    else:
        hint = say(
            "This part asks for the modified convention and was graded in it, but the answer says "
            "standard."
        )
    return (_NOT_ASKED_FOR.finding(hint, severity=Severity.WARNING),)
