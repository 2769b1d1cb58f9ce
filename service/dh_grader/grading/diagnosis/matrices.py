"""Slips in a matrix: one entry, a column or row, the whole, or a wrong inverse.

This file knows slips of any matrix or transform. Slips in a product of links are in ``motions.py``
and ``products.py``, slips in the table that lead to a wrong matrix in ``upstream.py``.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from dh_grader.expressions import Symbol
from dh_grader.expressions.parser import in_degrees
from dh_grader.expressions.vocabulary import Node, Number, Unit, children
from dh_grader.grading.diagnosis import formulas
from dh_grader.grading.diagnosis.formulas import Rewritten, WrongEntry
from dh_grader.grading.diagnosis.motions import (
    BOTTOM_ROW,
    POSITION_BLOCK,
    ROTATION_BLOCK,
    UPPER_ROWS,
    Block,
    Explanation,
    MatrixCase,
    PositionBlock,
    RotationBlock,
    UpperRows,
    as_explanations,
    named,
)
from dh_grader.grading.diagnosis.upstream import AFTER_SIGNS, Dependence, Required, Requirements
from dh_grader.grading.judging import as_entries
from dh_grader.grading.misconception import (
    UNEXPLAINED,
    UNIT_FACTORS,
    Explained,
    Hypotheses,
    Hypothesis,
    Mask,
    Written,
    check,
    diagnosed,
    explanation,
    finding_on,
    misconception,
    other_length_unit,
    says,
)
from dh_grader.grading.numbers import EXACT_VALUE, ROUNDED_VALUE
from dh_grader.grading.report import Finding, Severity
from dh_grader.kinematics import Numbers, inverse
from dh_grader.translations import Sentence, listed, say, say_count, template

# --- Slips in a single matrix entry


# Three turning joints have three runs of joints whose angles add up: 12, 23, 123.
MAX_RUNS = 3
# Up to this many sines and cosines, a joint angle is also tried in one place alone.
MAX_PLACES = 3
# The number of nodes that are rewritten before the rest of a matrix is only compared: after many
# unexplained entries, the rest probably has the same unknown cause. An explained entry costs less,
# but not nothing, because the work must be bounded.
WORK_BUDGET = 100.0
COST_IF_EXPLAINED = 0.25
# The work of an entry, and of each node of a rewritten formula, as the budget counts it.
ENTRY_WORK, NODE_WORK = 1.0, 0.2

Formulas = Iterator[Rewritten]


def diagnose(case: WrongEntry, required: Required | None = None) -> Finding:
    """Return the finding on a wrong entry.

    ``required`` are the symbols that the correct entry depends on, or None if they are unknown.
    """
    return diagnosed(case) or _by_dependence(case, required)


def diagnose_entries(
    wrong: Mapping[tuple[int, int], WrongEntry],
    affords: Callable[[float], bool],
    work_budget: float = WORK_BUDGET,
    requirements: Requirements | None = None,
) -> dict[tuple[int, int], Finding]:
    """Return the findings on the wrong entries of a matrix.

    ``affords`` takes work from the budget of the submission; ``work_budget`` is the budget of the
    matrix. When it is used up, formulas are no longer rewritten.
    """
    findings: dict[tuple[int, int], Finding] = {}
    for place, entry in wrong.items():
        if not affords(ENTRY_WORK + (NODE_WORK * entry.size if work_budget > 0 else 0.0)):
            continue
        explained = diagnosed(entry if work_budget > 0 else replace(entry, only_compared=True))
        work_budget -= entry.size * (COST_IF_EXPLAINED if explained else 1.0)
        required = requirements.of(*place) if requirements and not explained else None
        findings[place] = explained or _by_dependence(entry, required)
    return findings


def _by_dependence(case: WrongEntry, required: Required | None) -> Finding:
    finding = diagnosed(case, Dependence(case, required))
    assert finding is not None
    return finding


@misconception(
    of=WrongEntry,
    rank=100,
    code="sign",
    rule="sine_and_cosine",
    means="the whole entry has the wrong sign",
    example=("planar-rr", "pose", {"1/2": "s12"}),
    unlike={"1/2": "c12"},
)
def sign(case: WrongEntry) -> Iterator[Written[Numbers]]:
    """The entry has the wrong sign."""
    yield Written(-case.expected, finding_on(case, say("The sign is wrong.")))


@misconception(
    of=WrongEntry,
    rank=110,
    code="degrees_as_radians",
    rule="angle_unit",
    when=lambda case: case.can_be_repaired,
    means="a number of degrees in a sine or cosine is read in radians",
    example=("planar-rr", "pose", {"1/2": "cos(q1 + q2 + 90)"}),
    unlike={"1/2": "s12"},
)
def degrees_as_radians(case: WrongEntry) -> Formulas:
    """A number in a sine or cosine was meant in degrees, but is read in radians."""
    finding = says(
        say(
            "A number in a sine or cosine was read in radians, but it fits in degrees: write the "
            "unit behind it (deg or °)."
        ),
    )
    if any(map(_has_bare_number, case.sines_and_cosines)):
        yield Rewritten(in_degrees(case.tree, is_angle=False, notes=[]), finding)


def _has_bare_number(node: Node) -> bool:
    if isinstance(node, Number):
        return node.value != 0
    return not isinstance(node, Unit) and any(map(_has_bare_number, children(node)))


@misconception(
    of=WrongEntry,
    rank=120,
    code="radians_as_degrees",
    rule="angle_unit",
    when=lambda case: case.can_be_repaired,
    means="a number of radians in a sine or cosine is read in degrees",
    example=(
        "planar-rr",
        "pose",
        (
            "[cos(q1 + q2), cos(q1 + q2 + 1.5708), 0, a1 c1 + a2 c12; s12, c12, 0, a1 s1 + a2 s12; "
            "0, 0, 1, 0; 0, 0, 0, 1]"
        ),
        "degrees",
    ),
    unlike={"4/3": "1"},
)
def radians_as_degrees(case: WrongEntry) -> Formulas:
    """A number in a sine or cosine was meant in radians, but is read in degrees."""
    finding = says(
        say(
            "A number in a sine or cosine was read in degrees, but it fits in radians: write the "
            "unit behind it (rad)."
        ),
    )
    yield Rewritten(formulas.everywhere(case.tree, formulas.without_degrees), finding)


@misconception(
    of=WrongEntry,
    rank=130,
    code="sine_for_cosine",
    rule="sine_and_cosine",
    when=lambda case: case.can_be_repaired,
    means="sine and cosine are exchanged, throughout or in one place",
    example=("planar-rr", "pose", {"1/4": "a1 s1 + a2 s12"}),
    unlike={"1/2": "s12"},
)
def sine_for_cosine(case: WrongEntry) -> Formulas:
    """Some or all sines and cosines are exchanged."""
    count = len(case.sines_and_cosines)
    if count > 0:
        finding = says(say("Sine and cosine are exchanged."))
        yield Rewritten(formulas.at_sines_and_cosines(case.tree, formulas.exchanged), finding)
    if count > 1:
        in_one_place = says(say("Sine and cosine are exchanged in one place."))
        for tree, _ in formulas.one_place(case.tree, formulas.exchanged):
            yield Rewritten(tree, in_one_place)


@misconception(
    of=WrongEntry,
    rank=140,
    code="sum_of_cosines",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="cos(a + b) is written as cos a + cos b, or the same with the sine",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 (c1 + c2)"}),
    unlike={"1/2": "s12"},
)
def sum_of_cosines(case: WrongEntry) -> Formulas:
    """The student wrote cos(a + b) as cos a + cos b, or sin(a + b) as sin a + sin b."""
    finding = says(
        say(
            "cos(a + b) is not cos(a) + cos(b), and sin(a + b) is not sin(a) + sin(b): add the "
            "angles first."
        ),
    )
    if len(case.sines_and_cosines) > 1:
        yield Rewritten(formulas.sums_merged(case.tree), finding)


@misconception(
    of=WrongEntry,
    rank=150,
    code="product_for_sum_angle",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="c12 is written as c1 c2, or s12 as s1 s2",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 c1 c2"}),
    unlike={"1/2": "s12"},
)
def product_for_sum_angle(case: WrongEntry) -> Formulas:
    """The student read the shorthand c12 as c1 c2, or s12 as s1 s2."""
    finding = says(
        say(
            "Check this product of sines or cosines: the direction of a link has one sine or "
            "cosine of a sum of joint angles."
        ),
    )
    if len(case.sines_and_cosines) > 1:
        yield Rewritten(formulas.products_merged(case.tree), finding)
        for joints in formulas.joints_multiplied(case.tree, sorted(case.turning))[:MAX_RUNS]:
            yield Rewritten(formulas.products_merged(case.tree, joints), finding)


@misconception(
    of=WrongEntry,
    rank=160,
    code="relative_angle",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="a joint's own angle is used for the sum of the angles up to it: c2 for c12",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 c2"}),
    unlike={"1/2": "s12"},
)
def relative_angle(case: WrongEntry) -> Formulas:
    """The student wrote the joint's own angle instead of a sum of angles: c2 for c12."""
    finding = says(
        say(
            "A joint angle is measured from the link before: the direction of a link is the sum "
            "of all joint angles up to it."
        ),
    )
    for first in sorted(case.turning)[:-1] if case.sines_and_cosines else ():
        summed = formulas.summed_from(first, case.turning)
        yield Rewritten(formulas.at_sines_and_cosines(case.tree, summed), finding)


@misconception(
    of=WrongEntry,
    rank=180,
    code="joint_variable_missing",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="a joint angle is missing in the sum in a sine or cosine",
    example=("planar-rr", "pose", {"1/2": "-s1"}),
    unlike={"1/2": "s12"},
)
def angle_left_out(case: WrongEntry) -> Formulas:
    """A joint angle is missing in a sum of joint angles: c23 for c123."""
    for symbol in _joint_angles(case):
        finding = says(
            say(
                "{angle} is missing in a sine or cosine: the direction of a link is the sum of all "
                "joint angles up to it.",
                angle=case.spelling.name(symbol),
            ),
        )
        yield from _with_angles_changed(case, formulas.with_angle(symbol), finding)


@misconception(
    of=WrongEntry,
    rank=190,
    code="joint_variable_extra",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="the entry contains a joint variable too many, alone or in a sum of joint angles",
    example=("planar-rr", "pose", {"1/4": "a1 c12 + a2 c12"}),
    unlike={"1/2": "s12"},
)
def angle_too_many(case: WrongEntry) -> Formulas:
    """A sum of joint angles contains one angle too many: c123 for c12."""
    for symbol in _joint_angles(case):
        finding = says(
            say(
                "{angle} does not belong in a sine or cosine here: check which joint angles add up "
                "to this direction.",
                angle=case.spelling.name(symbol),
            ),
        )
        yield from _with_angles_changed(case, formulas.without_angle(symbol), finding)


def _joint_angles(case: WrongEntry) -> list[Symbol]:
    return [case.turning[k] for k in sorted(case.turning)] if case.sines_and_cosines else []


def _with_angles_changed(
    case: WrongEntry, change: formulas.Rewriting, finding: Finding
) -> Formulas:
    # If the formula is short, each single sine or cosine is also changed alone.
    yield Rewritten(formulas.at_sines_and_cosines(case.tree, change), finding, signed=True)
    if 1 < len(case.sines_and_cosines) <= MAX_PLACES:
        for tree, _ in formulas.one_place(case.tree, change):
            yield Rewritten(tree, finding, signed=True)


@misconception(
    of=WrongEntry,
    rank=170,
    code="term_sign",
    rule="sine_and_cosine",
    when=lambda case: case.can_be_repaired,
    means="one term has the wrong sign",
    example=("planar-rr", "pose", {"1/4": "a1 c1 - a2 c12"}),
    unlike={"1/4": "a1 c1 + 2 a2 c12"},
)
def term_sign(case: WrongEntry) -> Formulas:
    """One term of a sum has the wrong sign."""
    finding = says(say("One term has the wrong sign."))
    for change in (formulas.other_operator, formulas.first_term_negated):
        for tree, _ in formulas.one_place(case.tree, change):
            yield Rewritten(tree, finding, signed=True)


# --- Columns and rows of a matrix whose signs are all wrong


class Lines:
    """The columns and rows of a wrong matrix."""


@misconception(
    of=Lines,
    rank=10,
    code=("column_sign", "row_sign"),
    rule="rotation_columns",
    means=(
        "a whole column has the wrong sign: an axis of the last frame points the opposite way",
        "a whole row has the wrong sign: an axis of the first frame points the opposite way",
    ),
    example=("homogeneous-inverse", "numbers", {"3/2": "1", "3/4": "-2"}),
    unlike={"1/4": "1"},
)
def line_sign(case: MatrixCase) -> Hypotheses:
    """A whole column or row has the wrong sign.

    A column or row with a single wrong entry is not reported here.
    """
    opposite = case.agree(case.actual, -case.expected)
    wrong = case.wrong & case.mask(UPPER_ROWS)
    columns = [j for j in range(wrong.shape[1]) if opposite[:3, j].all() and wrong[:, j].sum() > 1]
    rows = [i for i in range(3) if opposite[i].all() and wrong[i].sum() > 1]
    by_column = case.mask(*((slice(0, 3), slice(j, j + 1)) for j in columns))
    by_row = case.mask(*((slice(i, i + 1), slice(None)) for i in rows))
    if columns and (by_column & wrong).sum() >= (by_row & wrong).sum():
        yield Written(-case.expected[by_column], _column_sign(columns), by_column)
    elif rows:
        yield Written(-case.expected[by_row], _row_sign(rows), by_row)


def _column_sign(columns: list[int]) -> Finding:
    # Translators: {parts} is a list such as "x axis and position".
    hint = say_count(
        "Column {columns} has the wrong sign throughout: check which way the {parts} of the last "
        "frame should point.",
        "Columns {columns} have the wrong sign throughout: check which way the {parts} of the last "
        "frame should point.",
        count=len(columns),
        columns=_numbers(columns),
        parts=_axes_named(columns),
    )
    return Finding("column_sign", hint, say("Change the sign of each entry there."))


def _row_sign(rows: list[int]) -> Finding:
    # Translators: {parts} is a list such as "x axis and z axis".
    hint = say_count(
        "Row {rows} has the wrong sign throughout: check which way the {parts} of the first frame "
        "should point.",
        "Rows {rows} have the wrong sign throughout: check which way the {parts} of the first "
        "frame should point.",
        count=len(rows),
        rows=_numbers(rows),
        parts=_axes_named(rows),
    )
    return Finding("row_sign", hint, say("Change the sign of each entry there."))


def _numbers(indices: list[int]) -> str:
    return listed([str(i + 1) for i in indices])


def _axes_named(indices: list[int]) -> str:
    names = [*(say("{letter} axis", letter=letter) for letter in "xyz"), say("position vector")]
    return listed([names[i] for i in indices])


# --- Slips in a whole matrix, or in its whole rotation or position
#
# If such a slip explains an entry, the entry gets no finding of its own.


class BottomRow:
    """The bottom row of a wrong matrix."""


def explain(case: MatrixCase) -> list[Explanation]:
    """Return explanations of the whole matrix, its rotation or its position."""
    whole = explanation(case)
    if whole is not None or not case.rigid:
        return as_explanations(case, whole)
    explained = as_explanations(case, explanation(case, of=BottomRow))
    if case.wrong[UPPER_ROWS].any():
        explained += as_explanations(case, explanation(case, of=UpperRows)) or _of_blocks(case)
    return explained


def _of_blocks(case: MatrixCase) -> list[Explanation]:
    explained: list[Explanation] = []
    for block, kind in ((ROTATION_BLOCK, RotationBlock), (POSITION_BLOCK, PositionBlock)):
        if case.wrong[block].any():
            explained += as_explanations(case, explanation(case, of=kind))
    rest = replace(case, wrong=unexplained(case, explained))
    return explained + as_explanations(rest, explanation(rest, of=Lines))


def unexplained(case: MatrixCase, explained: Sequence[Explanation]) -> Mask:
    """Return a mask of the wrong entries that no explanation covers."""
    return np.asarray(case.wrong & ~np.any([each.entries for each in explained], axis=0))


def check_yourself(case: MatrixCase, slips: Mapping[tuple[int, int], Finding]) -> Finding | None:
    """Return a finding if the student's rotation is left-handed or not orthonormal, else None.

    ``slips`` are the findings on the single entries.
    """
    rotation = np.moveaxis(case.actual[ROTATION_BLOCK], -1, 0)
    codes = [finding.code for (i, j), finding in slips.items() if i < 3 and j < 3]
    if not (case.rigid and codes and np.isfinite(rotation).all()):
        return None
    return diagnosed(case, WrongAxes(rotation, codes))


@misconception(
    of=MatrixCase,
    rank=10,
    code=("transposed_matrix", "transposed_rotation"),
    rule="rotation_columns",
    means=(
        "the whole matrix is transposed",
        "the rotation is transposed: its columns are the axes of the first frame in the last",
    ),
    example=("planar-rpr-poe", "home", {"1/4": "0", "4/1": "L1 + L2"}),
    unlike={"3/3": "0", "3/4": "1"},
)
def transposed_matrix(case: MatrixCase) -> Hypotheses:
    """The student exchanged the rows and the columns of the whole matrix."""
    code = "transposed_rotation" if case.rigid and not case.is_transform else "transposed_matrix"
    finding = Finding(code, say("This matrix is transposed."), say("Write its rows as columns."))
    if case.expected.shape[0] == case.expected.shape[1]:
        yield Written(np.swapaxes(case.expected, 0, 1), finding)


@misconception(
    of=UpperRows,
    rank=50,
    code="inverse_transform",
    rule="inverse",
    means="the answer is the inverse: the first frame in the last",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), -sin(phi), 0, px; sin(phi), cos(phi), 0, py; 0, 0, 1, pz; 0, 0, 0, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def inverse_transform(case: MatrixCase) -> Hypotheses:
    """The student submitted the inverse of the correct transform."""
    if case.is_transform:
        yield Written(_inverted(case.expected)[UPPER_ROWS], INVERTED, UPPER_ROWS)


INVERTED = says(
    say("This matrix leads the other way: it is the inverse of the transform that is asked for."),
    say("Its columns are the axes and the origin of the last frame, seen from the first."),
)

# The message for the inverse of another pose than the one asked for.
OTHER_WAY = replace(
    INVERTED,
    hint=say(
        "This matrix leads the other way: check which frame it describes, and from which frame."
    ),
    correction="",
)


def _inverted(matrix: Numbers) -> Numbers:
    return as_entries(inverse(np.moveaxis(matrix, -1, -3)))


@misconception(of=UpperRows, rank=60)
def other_pose(case: MatrixCase) -> Hypotheses:
    """The student submitted a wrong pose, such as the pose of a wrong frame."""
    for pose, entries in zip(*case.other_poses, strict=True):
        # Translators: {pose} is a name such as "the pose of frame {2}".
        found = named(pose, template("This matrix is {pose}. {advice}"))
        yield Written(entries[UPPER_ROWS], found, UPPER_ROWS, record=pose.record)


@misconception(
    of=UpperRows,
    rank=70,
    code=("inverse_transform",),
    rule="inverse",
    means="the answer is the inverse: the first frame in the last",
    example=(
        "scara",
        "pose",
        "[c12, s12, 0, -a2 - a1 c2; s12, -c12, 0, -a1 s2; 0, 0, -1, -d3; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "90"},
)
def inverse_of_other_pose(case: MatrixCase) -> Hypotheses:
    """The student submitted the inverse of a wrong pose."""
    if case.is_transform:
        poses, entries = case.other_poses
        for pose, inverted in zip(poses, _inverted(entries), strict=True):
            # Translators: {pose} is a name such as "the pose of frame {2}".
            finding = named(pose, template("This is the inverse of {pose}. {advice}"), OTHER_WAY)
            yield Written(inverted[UPPER_ROWS], finding, UPPER_ROWS)


@misconception(
    of=RotationBlock,
    rank=10,
    code="transposed_rotation",
    rule="rotation_columns",
    means="the rotation is transposed: its columns are the axes of the first frame in the last",
    example=("planar-rrr", "pose", {"1/2": "s123", "2/1": "-s123"}),
    unlike={"1/3": "1", "4/4": "0"},
)
def transposed_rotation(case: MatrixCase) -> Hypotheses:
    """The rotation is transposed."""
    finding = says(
        say(
            "The rotation is transposed: its columns, not its rows, must be the axes of the frame "
            "that is described."
        ),
        say("Write its rows as columns."),
    )
    yield Written(np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1), finding, ROTATION_BLOCK)


@misconception(
    of=RotationBlock,
    rank=50,
    code="columns_exchanged",
    rule="rotation_columns",
    means="the columns of the rotation are in the wrong order",
    example=("rigid-motion-chain", "parallel-axes", "[0, 1, 0; 0, 0, -1; 1, 0, 0]"),
    unlike={"1/1": "0", "1/3": "1"},
)
def columns_exchanged(case: MatrixCase) -> Hypotheses:
    """The columns of the rotation are in the wrong order."""
    for order in list(permutations(range(3)))[1:]:
        finding = says(
            say(
                "The columns of the rotation are in the wrong order: check which axis belongs in "
                "which column."
            ),
            say("Your columns are its {axes} axes.", axes=", ".join("xyz"[j] for j in order)),
        )
        yield Written(case.expected[:3, order], finding, ROTATION_BLOCK)


@misconception(of=RotationBlock, rank=60)
def other_rotation(case: MatrixCase) -> Hypotheses:
    """The rotation is that of a wrong pose, such as the pose of a wrong frame."""
    # Translators: {pose} is a name such as "the pose of frame {2}".
    told = template("The rotation comes from {pose}. {advice}")
    return _from_other_poses(case, ROTATION_BLOCK, told)


@misconception(
    of=PositionBlock,
    rank=50,
    code="other_length_unit",
    rule="position_vector",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=("ur5e", "home", {"1/4": "-817.2", "2/4": "-232.9", "3/4": "62.8"}),
    unlike={"1/4": "-817.2"},
)
def length_unit(case: MatrixCase) -> Hypotheses:
    """The position is in a wrong unit of length."""
    for times in UNIT_FACTORS if case.is_transform else ():
        position = times * case.expected[POSITION_BLOCK]
        yield Written(position, other_length_unit(times), POSITION_BLOCK)


@misconception(of=PositionBlock, rank=60)
def other_position(case: MatrixCase) -> Hypotheses:
    """The position is that of a wrong pose, such as the pose of a wrong frame."""
    # Translators: {pose} is a name such as "the pose of frame {2}".
    told = template("The position comes from {pose}. {advice}")
    return _from_other_poses(case, POSITION_BLOCK, told)


def _from_other_poses(case: MatrixCase, block: Block, told: str) -> Hypotheses:
    poses, entries = case.other_poses
    # A constant block, such as a position of zeros, does not show which pose it belongs to.
    varies = np.ptp(entries[:, *block], axis=-1).max(axis=(1, 2)) > EXACT_VALUE
    for i in np.flatnonzero(varies).tolist():
        found = named(poses[i], told)
        yield Written(entries[i][block], found, block, record=poses[i].record)


@check(of=UpperRows, rank=20)
def slip_of_rows(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong rotation and position."""
    return _of_slips(case, UPPER_ROWS)


@check(of=RotationBlock, rank=20)
def slip_of_rotation(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong rotation."""
    return _of_slips(case, ROTATION_BLOCK)


@check(of=PositionBlock, rank=20)
def slip_of_position(case: MatrixCase) -> Explained | None:
    """A mistake in the DH table explains the wrong position."""
    return _of_slips(case, POSITION_BLOCK)


def _of_slips(case: MatrixCase, block: Block) -> Explained | None:
    # If axes with wrong signs explain the block, too, that simpler explanation is preferred.
    entries = case.mask(block)
    if case.slips is None or (case.wrong[block].sum() == 1 and block != UPPER_ROWS):
        return None
    found = case.slips.explanation(entries)
    if found is not None and found.findings[0].code in AFTER_SIGNS:
        signs = explanation(case, of=Lines)
        left = case.wrong & entries
        if signs is not None and not (left & ~case.mask(signs.entries)).any():
            return signs if block == UPPER_ROWS else None
    return found


@check(
    of=BottomRow,
    rank=10,
    code="bottom_row",
    rule="rotation_columns",
    means="the bottom row is not 0 0 0 1",
    example=("homogeneous-inverse", "numbers", {"4/3": "1"}),
    unlike={"3/3": "1"},
)
def bottom_row(case: MatrixCase) -> Explained | None:
    """The bottom row is not 0 0 0 1."""
    if not (case.is_transform and case.wrong[BOTTOM_ROW].any()):
        return None
    hint = say("The bottom row of a homogeneous transform is the same for every transform.")
    return Hypothesis(None, says(hint, say("It is 0 0 0 1.")), BOTTOM_ROW)


@dataclass(frozen=True)
class WrongAxes:
    """The rotation ``(SAMPLES, 3, 3)`` of a wrong matrix."""

    rotation: Numbers
    # The codes of the findings on the entries of the rotation.
    codes: list[str]


@check(
    of=WrongAxes,
    rank=10,
    code="left_handed_rotation",
    rule="rotation_columns",
    means="the columns form a left-handed frame (a warning)",
    example=("rigid-motion-chain", "parallel-axes", {"2/3": "1"}),
    unlike={"2/3": "0"},
)
def left_handed_rotation(axes: WrongAxes) -> Finding | None:
    """The columns form a left-handed frame: det R = −1."""
    if _fault(axes.rotation) is not None or not (np.linalg.det(axes.rotation) < 0).all():
        return None
    finding = says(
        say(
            "The columns of the rotation form a left-handed frame (the determinant is negative): "
            "x × y must be z."
        ),
    )
    return replace(finding, severity=Severity.WARNING)


@check(
    of=WrongAxes,
    rank=20,
    code="rotation_not_orthonormal",
    rule="rotation_columns",
    when=lambda axes: UNEXPLAINED in axes.codes,
    means="the columns are not unit vectors at right angles; appears only with an unexplained "
    "entry (a hint)",
    example=("rigid-motion-chain", "parallel-axes", {"2/3": "0"}),
    unlike={"1/1": "l1"},
)
def rotation_not_orthonormal(axes: WrongAxes) -> Finding | None:
    """The columns are not perpendicular unit vectors."""
    fault = _fault(axes.rotation)
    if fault is None:
        return None
    return replace(says(fault), severity=Severity.HINT)


def _fault(rotation: Numbers) -> Sentence | None:
    products = np.swapaxes(rotation, 1, 2) @ rotation
    wrong = np.abs(products - np.eye(3)).max(axis=0) > 4 * ROUNDED_VALUE
    for j in range(3):
        if wrong[j, j]:
            return say(
                "The columns of a rotation are unit vectors at right angles to each other, so you "
                "can check yours: column {column} is no unit vector.",
                column=j + 1,
            )
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if wrong[i, j]:
            return say(
                "The columns of a rotation are unit vectors at right angles to each other, so you "
                "can check yours: columns {first} and {second} are not at right angles.",
                first=i + 1,
                second=j + 1,
            )
    return None


# --- Slips in the inverse of a homogeneous transform
#
# If R and p are the rotation and position of a transform, its inverse has Rᵀ and −Rᵀp. The same
# wrong numbers also occur in transforms that are not inverses. They then mean a vector in the wrong
# frame or in the opposite direction.


def _with_rule(sentence: Sentence) -> Finding:
    return says(say("{sentence} The inverse of (R, p) is (Rᵀ, −Rᵀp).", sentence=sentence))


def _parts_of_inverse(case: MatrixCase) -> tuple[Numbers, Numbers]:
    # The rotation (3, 3, samples) and the position (3, samples) of the inverse.
    rotation = np.swapaxes(case.expected[ROTATION_BLOCK], 0, 1)
    return rotation, -_turned(rotation, case.expected[:3, 3])


def _turned(rotation: Numbers, vector: Numbers) -> Numbers:
    return np.asarray(np.einsum("ijs,js->is", rotation, vector))


@misconception(
    of=MatrixCase,
    rank=20,
    code="transposed_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the answer is the transpose of the transform instead of its inverse",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), sin(phi), 0, 0; -sin(phi), cos(phi), 0, 0; 0, 0, 1, 0; px, py, pz, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def transposed_for_inverse(case: MatrixCase) -> Hypotheses:
    """The student transposed the whole transform to invert it."""
    finding = _with_rule(
        say(
            "This is the transpose of the transform, not its inverse: only a rotation is inverted "
            "so."
        )
    )
    if case.is_transform:
        rotation, position = _parts_of_inverse(case)
        written = np.swapaxes(case.expected, 0, 1).copy()
        written[:3, :3] = np.swapaxes(rotation, 0, 1)
        written[3, :3], written[:3, 3] = position, 0.0
        yield Written(written, finding)


@misconception(
    of=UpperRows,
    rank=80,
    code="negated_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="signs are changed instead of inverting: −R for Rᵀ, or R with −p",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cos(phi), -sin(phi), 0, -px; sin(phi), cos(phi), 0, -py; 0, 0, 1, -pz; 0, 0, 0, 1]",
    ),
    unlike={"1/4": "-px", "2/4": "-py"},
)
def negated_for_inverse(case: MatrixCase) -> Hypotheses:
    """The student changed signs to invert a transform."""
    if case.is_transform:
        rotation, position = _parts_of_inverse(case)
        for sign in (1, -1):
            written = np.concatenate([sign * rotation, -position[:, None]], axis=1)
            yield Written(written, NEGATED, UPPER_ROWS)


@misconception(
    of=RotationBlock,
    rank=80,
    code="negated_for_inverse",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="signs are changed instead of inverting: −R for Rᵀ, or R with −p",
    example=("rigid-motion-chain", "parallel-axes", {"1/1": "-1"}),
    unlike={"1/1": "0", "1/3": "1"},
)
def negated_rotation(case: MatrixCase) -> Hypotheses:
    """The student changed signs to invert a rotation."""
    rotation = case.expected[ROTATION_BLOCK]
    for written in (-np.swapaxes(rotation, 0, 1), -rotation):
        yield Written(written, NEGATED, ROTATION_BLOCK)


NEGATED = _with_rule(say("The signs were changed, but that does not invert a rotation."))


@misconception(
    of=PositionBlock,
    rank=80,
    code="position_not_turned",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is described in the other frame: in an inverse, −p for −Rᵀp",
    example=("homogeneous-inverse", "about-z", {"1/4": "-px", "2/4": "-py"}),
    unlike={"1/1": "0", "1/4": "0", "3/4": "0", "4/4": "0"},
)
def position_not_turned(case: MatrixCase) -> Hypotheses:
    """The student wrote −p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(
        say(
            "The position is the right vector, but seen in the axes of the other frame: it must "
            "be turned, too."
        )
    )
    if case.is_transform:
        _, position = _parts_of_inverse(case)
        yield _position(-position, finding)


@misconception(
    of=PositionBlock,
    rank=82,
    code="position_not_inverted",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is not inverted: in an inverse, p for −Rᵀp",
    example=("simple-twist", "exponential", {"2/4": "2*sin(theta)"}),
    unlike={"3/3": "0", "3/4": "1"},
)
def position_not_inverted(case: MatrixCase) -> Hypotheses:
    """The student wrote p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(
        say("The position is still that of the transform that was to be inverted.")
    )
    if case.is_transform:
        _, position = _parts_of_inverse(case)
        yield _position(position, finding)


@misconception(
    of=PositionBlock,
    rank=84,
    code="reversed_position",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the whole position has the wrong sign: in an inverse, Rᵀp for −Rᵀp",
    example=(
        "homogeneous-inverse",
        "about-z",
        "[cφ, sφ, 0, px cφ + py sφ; -sφ, cφ, 0, py cφ - px sφ; 0, 0, 1, pz; 0, 0, 0, 1]",
    ),
    unlike={"3/4": "2*pz"},
)
def position_reversed(case: MatrixCase) -> Hypotheses:
    """The student wrote Rᵀp instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(say("Every coordinate of the position has the wrong sign."))
    if case.is_transform:
        yield _position(-case.expected[:3, 3], finding)


@misconception(
    of=PositionBlock,
    rank=86,
    code="position_turned_back",
    rule="inverse",
    when=lambda case: case.motion is not None,
    means="the position is turned by R instead of Rᵀ: in an inverse, −R p for −Rᵀp",
    example=("homogeneous-inverse", "numbers", {"1/4": "1"}),
    unlike={"2/4": "3"},
)
def position_turned_back(case: MatrixCase) -> Hypotheses:
    """The student wrote −R p instead of −Rᵀp for the position of the inverse."""
    finding = _with_rule(say("The position was turned by R, not by its transpose."))
    if case.is_transform:
        rotation, position = _parts_of_inverse(case)
        for sign in (-1, 1):
            yield _position(sign * _turned(rotation, position), finding)


def _position(position: Numbers, finding: Finding) -> Written[Numbers]:
    return Written(position[:, None], finding, POSITION_BLOCK)
