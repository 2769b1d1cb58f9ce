"""Test the reports on wrong poses."""

# SymPy multiplies out the poses from elementary turns and shifts.

from collections.abc import Callable, Mapping, Sequence
from functools import cache

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, PartReport, Severity, Verdict
from sympy import Matrix

from tests.grading.support.robots import PLANAR_RRR, SCARA, STANFORD, Robot
from tests.grading.support.submitting import (
    codes,
    codes_at,
    full_marks,
    graded_pose,
    handed_in,
    part,
)


def turn_z(angle: sp.Expr) -> Matrix:
    c, s = sp.cos(angle), sp.sin(angle)
    return Matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def turn_x(angle: sp.Expr) -> Matrix:
    c, s = sp.cos(angle), sp.sin(angle)
    return Matrix([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def shift(x: sp.Expr, z: sp.Expr) -> Matrix:
    return Matrix([[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]])


def factors(robot: Robot) -> list[tuple[Matrix, Matrix]]:
    # Return two transforms for each row: one about and along z, one about and along x.
    rows = []
    for a, alpha, d, theta in robot.rows:
        length, offset, angle = (
            sp.Integer(0) if cell == "0" else sp.Symbol(cell.removesuffix("*"))
            for cell in (a, d, theta)
        )
        z = turn_z(angle) * shift(sp.Integer(0), offset)
        rows.append((z, shift(length, sp.Integer(0)) * turn_x(sp.rad(int(alpha)))))
    return rows


def links(robot: Robot, modified: bool = False) -> list[Matrix]:
    return [x * z if modified else z * x for z, x in factors(robot)]


def product(matrices: Sequence[Matrix]) -> Matrix:
    total = sp.eye(4)
    for matrix in matrices:
        total = (total * matrix).applyfunc(sp.expand)
    return total


def without_squares(entry: sp.Expr) -> sp.Expr:
    # Return the entry with 1 - cos² for each sin²; trigsimp would take seconds.
    expanded = sp.expand(entry)
    sines = {sine**2: 1 - sp.cos(sine.args[0]) ** 2 for sine in expanded.atoms(sp.sin)}
    return sp.expand(expanded.subs(sines))


def inverse_of(pose: Matrix) -> Matrix:
    turned_back = pose[:3, :3].T
    upper = turned_back.row_join((-turned_back * pose[:3, 3]).applyfunc(without_squares))
    return upper.col_join(Matrix([[0, 0, 0, 1]]))


def with_rotation(pose: Matrix, rotation: Matrix) -> Matrix:
    changed = pose.copy()
    changed[:3, :3] = rotation
    return changed


def with_position(pose: Matrix, position: Matrix) -> Matrix:
    changed = pose.copy()
    changed[:3, 3] = position
    return changed


def text(matrix: Matrix) -> list[list[str]]:
    return [[str(entry).replace("**", "^") for entry in matrix.row(i)] for i in range(matrix.rows)]


@cache
def links_of(robot: Robot) -> list[Matrix]:
    return links(robot)


@cache
def pose_of(robot: Robot) -> Matrix:
    return product(links_of(robot))


def rotation() -> Matrix:
    return pose_of(STANFORD)[:3, :3]


WHOLE = {(i, j) for i in range(3) for j in range(4)}
ROTATION = {(i, j) for i in range(3) for j in range(3)}
POSITION = {(i, 3) for i in range(3)}

# Robot, answer, the codes of the part's messages, words of them, and the entries they explain.
Slip = tuple[Robot, Callable[[], Matrix], list[str], str, set[tuple[int, int]]]
SLIPS: dict[str, Slip] = {
    "inverse": (
        SCARA,
        lambda: inverse_of(pose_of(SCARA)),
        ["inverse_transform"],
        "the inverse of the transform",
        WHOLE,
    ),
    "transposed throughout": (
        SCARA,
        lambda: pose_of(SCARA).T,
        ["transposed_matrix"],
        "transposed",
        {(i, j) for i in range(4) for j in range(4)},
    ),
    "transposed rotation": (
        STANFORD,
        lambda: with_rotation(pose_of(STANFORD), rotation().T),
        ["transposed_rotation"],
        "The rotation is transposed",
        ROTATION,
    ),
    "reverse order": (
        STANFORD,
        lambda: product(links_of(STANFORD)[::-1]),
        ["reversed_product"],
        "A6·A5·A4·A3·A2·A1",
        WHOLE,
    ),
    "other convention": (
        STANFORD,
        lambda: product(links(STANFORD, modified=True)),
        ["other_convention"],
        "link transform of the modified convention",
        WHOLE,
    ),
    "stops early": (
        STANFORD,
        lambda: product(links_of(STANFORD)[:5]),
        ["wrong_frame"],
        "the pose of frame {5}. The pose of frame {6} is asked for. Go on with A6.",
        WHOLE,
    ),
    "stops in the middle": (
        STANFORD,
        lambda: product(links_of(STANFORD)[:3]),
        ["wrong_frame"],
        "Go on with A4·A5·A6.",
        WHOLE,
    ),
    "starts late": (
        STANFORD,
        lambda: product(links_of(STANFORD)[1:]),
        ["wrong_base"],
        "seen from frame {1}. The pose in frame {0} is asked for. Put A1 in front.",
        WHOLE,
    ),
    "a link left out": (
        STANFORD,
        lambda: product([*links_of(STANFORD)[:3], *links_of(STANFORD)[4:]]),
        ["missing_link"],
        "the product without A4",
        WHOLE,
    ),
    "another link left out": (
        SCARA,
        lambda: product([links_of(SCARA)[0], *links_of(SCARA)[2:]]),
        ["missing_link"],
        "the product without A2",
        WHOLE,
    ),
    "one from the left": (
        STANFORD,
        lambda: product([links_of(STANFORD)[2], *links_of(STANFORD)[:2], *links_of(STANFORD)[3:]]),
        ["premultiplied"],
        "A3·A1·A2·A4·A5·A6",
        WHOLE,
    ),
    "all from the left": (
        STANFORD,
        lambda: product(links(STANFORD, modified=True)[::-1]),
        ["premultiplied"],
        "all rotations and translations, each put on the left",
        WHOLE,
    ),
    "inverse of the reverse order": (
        STANFORD,
        lambda: product([inverse_of(link) for link in links_of(STANFORD)]),
        ["inverse_transform", "reversed_product"],
        "This is the inverse of the product",
        WHOLE,
    ),
    "position without the tool": (
        STANFORD,
        lambda: with_position(pose_of(STANFORD), product(links_of(STANFORD)[:5])[:3, 3]),
        ["distance_left_out"],
        "d, the offset along the axis of joint 6, is left out",
        POSITION,
    ),
    "rotation of another frame": (
        STANFORD,
        lambda: with_rotation(pose_of(STANFORD), product(links_of(STANFORD)[:4])[:3, :3]),
        ["wrong_frame"],
        "The rotation comes from the pose of frame {4}",
        ROTATION,
    ),
    "rotation and position, each its own way": (
        STANFORD,
        lambda: with_rotation(
            with_position(pose_of(STANFORD), product(links_of(STANFORD)[:5])[:3, 3]), rotation().T
        ),
        ["transposed_rotation", "distance_left_out"],
        "d6",
        WHOLE,
    ),
    "columns in another order": (
        STANFORD,
        lambda: with_rotation(pose_of(STANFORD), rotation()[:, [1, 0, 2]]),
        ["columns_exchanged"],
        "Your columns are its y, x, z axes.",
        {(i, j) for i in range(3) for j in range(2)},
    ),
    "an axis turned over": (
        STANFORD,
        lambda: pose_of(STANFORD) * sp.diag(1, -1, 1, 1),
        ["column_sign"],
        "Column 2 has the wrong sign throughout: check which way the y axis of the last frame",
        {(i, 1) for i in range(3)},
    ),
    "two axes turned over": (
        STANFORD,
        lambda: pose_of(STANFORD) * sp.diag(-1, -1, 1, 1),
        ["column_sign"],
        "Columns 1 and 2 have the wrong sign",
        {(i, j) for i in range(3) for j in range(2)},
    ),
    "position from the tool to the base": (
        STANFORD,
        lambda: with_position(pose_of(STANFORD), -pose_of(STANFORD)[:3, 3]),
        ["column_sign"],
        "check which way the position",
        POSITION,
    ),
    "a base axis turned over": (
        STANFORD,
        lambda: sp.diag(1, 1, -1, 1) * pose_of(STANFORD),
        ["row_sign"],
        "Row 3 has the wrong sign throughout: check which way the z axis of the first frame",
        {(2, j) for j in range(4)},
    ),
    "bottom row": (
        SCARA,
        lambda: pose_of(SCARA)[:3, :].col_join(Matrix([[0, 0, 1, 0]])),
        ["bottom_row"],
        "It is 0 0 0 1.",
        {(3, 2), (3, 3)},
    ),
    "bottom row and inverse": (
        SCARA,
        lambda: inverse_of(pose_of(SCARA))[:3, :].col_join(Matrix([[1, 1, 1, 1]])),
        ["bottom_row", "inverse_transform"],
        "inverse",
        WHOLE | {(3, 0), (3, 1), (3, 2)},
    ),
}


def wrong_entries(report: PartReport) -> set[tuple[int, int]]:
    return {
        (i, j)
        for i, row in enumerate(report.rows)
        for j, cell in enumerate(row.cells)
        if cell.verdict is Verdict.INCORRECT
    }


@pytest.mark.parametrize("slip", SLIPS.values(), ids=SLIPS.keys())
def test_a_misconception_explains_its_matrix(slip: Slip, catalogue: Mapping[str, Exercise]) -> None:
    # There is one message on the part, and none on the entries that it explains.
    robot, matrix, expected, words, explained = slip
    report = graded_pose(catalogue[robot.exercise], text(matrix()))
    assert [message.code for message in report.feedback] == expected
    assert all(message.severity is Severity.ERROR for message in report.feedback)
    told = [(message.message, message.correction) for message in report.feedback]
    assert words in " ".join(f"{hint} {better.text if better else ''}" for hint, better in told)
    wrong = wrong_entries(report)
    places = {
        (int(p.row) - 1, int(p.cell or 0) - 1) for m in report.feedback for p in m.places or ()
    }
    assert places == wrong
    assert wrong
    assert wrong <= explained
    assert all(not codes(report.rows[i].cells[j]) for i, j in wrong)
    assert report.points < report.max_points


@pytest.mark.parametrize("robot", [SCARA, STANFORD], ids=lambda robot: robot.exercise)
def test_a_correct_matrix_gets_no_messages(robot: Robot, catalogue: Mapping[str, Exercise]) -> None:
    report = graded_pose(catalogue[robot.exercise], text(product(links(robot))))
    assert full_marks(report)
    assert report.feedback == ()
    assert not any(codes(cell) for row in report.rows for cell in row.cells)


def test_the_correction_is_not_shown_below_full(catalogue: Mapping[str, Exercise]) -> None:
    answers = {"pose": text(product(links_of(STANFORD)[::-1]))}
    exercise = catalogue[STANFORD.exercise]
    [told] = part(handed_in(exercise, answers, feedback=FeedbackLevel.HINTS), "pose").feedback
    assert "Multiply" not in told.message
    assert told.correction is None
    for level in (FeedbackLevel.VERDICTS, FeedbackLevel.SCORE):
        assert part(handed_in(exercise, answers, feedback=level), "pose").feedback == ()


def test_no_frame_of_another_convention_is_named(catalogue: Mapping[str, Exercise]) -> None:
    # Messages on a standard table do not mention the modified frame {2} of the SCARA arm.
    z1, x1 = factors(SCARA)[0]
    z2, _ = factors(SCARA)[1]
    report = graded_pose(catalogue[SCARA.exercise], text(product([z1, x1, z2])))
    messages = [
        *report.feedback,
        *(m for row in report.rows for c in row.cells for m in c.feedback),
    ]
    assert messages
    assert not [m for m in messages if "convention" in m.message]


def changed(pose: Matrix, entries: Mapping[tuple[int, int], str]) -> list[list[str]]:
    matrix = text(pose)
    for (i, j), entry in entries.items():
        matrix[i][j] = entry
    return matrix


# Robot, changed entries, the codes of the part's messages, the codes of each changed entry.
SINGLE: dict[str, tuple[Robot, dict[tuple[int, int], str], list[str], list[str]]] = {
    "one sign": (SCARA, {(2, 3): "d3 + d4"}, [], ["sign"]),
    "signs apart": (
        STANFORD,
        {(0, 0): f"-({pose_of(STANFORD)[0, 0]})", (1, 1): f"-({pose_of(STANFORD)[1, 1]})"},
        [],
        ["sign", "sign"],
    ),
    "one entry of the rotation": (
        SCARA,
        {(0, 0): "2*cos(q1 + q2 - q4)"},
        ["rotation_not_orthonormal"],
        ["value"],
    ),
    "a joint left out of an entry": (SCARA, {(0, 0): "c1"}, [], ["independent_of"]),
    "one entry that is explained": (SCARA, {(0, 0): "sin(q1 + q2 - q4)"}, [], ["sine_for_cosine"]),
    "one entry of the position": (SCARA, {(0, 3): "a1"}, [], ["independent_of"]),
    "a position of zeros": (
        SCARA,
        {(0, 3): "0", (1, 3): "0", (2, 3): "0"},
        [],
        ["independent_of", "independent_of", "independent_of"],
    ),
    "a left-handed frame": (SCARA, {(2, 2): "1"}, ["left_handed_rotation"], ["sign"]),
    "no rotation at all": (
        SCARA,
        {(0, 0): "a1 + 3", (2, 2): "2"},
        ["rotation_not_orthonormal"],
        ["quantity", "value"],
    ),
    "a part that is unreadable": (SCARA, {(0, 0): "?", (1, 1): "c1"}, [], ["independent_of"]),
    "a part without a value": (SCARA, {(0, 0): "1/0"}, [], ["undefined"]),
}


@pytest.mark.parametrize("case", SINGLE.values(), ids=SINGLE.keys())
def test_wrong_entries_get_messages_of_their_own(
    case: tuple[Robot, dict[tuple[int, int], str], list[str], list[str]],
    catalogue: Mapping[str, Exercise],
) -> None:
    robot, entries, of_part, of_entries = case
    report = graded_pose(catalogue[robot.exercise], changed(product(links(robot)), entries))
    found = [m.code for m in report.feedback if m.severity is not Severity.ERROR]
    assert found == of_part
    wrong = sorted(wrong_entries(report))
    said = [codes_at(report, str(i + 1), str(j + 1)) for i, j in wrong]
    assert [codes[-1:] for codes in said] == [[code] for code in of_entries]


def test_a_rotation_says_which_column_to_check(catalogue: Mapping[str, Exercise]) -> None:
    pose = changed(pose_of(SCARA), {(0, 0): "2*cos(q1 + q2 - q4)"})
    message = graded_pose(catalogue[SCARA.exercise], pose).feedback[0]
    assert message.severity is Severity.HINT
    assert "column 1 is no unit vector" in message.message
    angle = "q1 + 2*q2 + 3*q4"
    skewed = changed(pose_of(SCARA), {(0, 1): f"cos({angle})", (1, 1): f"sin({angle})"})
    message = graded_pose(catalogue[SCARA.exercise], skewed).feedback[0]
    assert "columns 1 and 2 are not at right angles" in message.message


def test_misconceptions_without_effect_are_not_named(catalogue: Mapping[str, Exercise]) -> None:
    # All links of a planar arm turn about one direction, so their order does not matter.
    pose = product([x * z for z, x in factors(PLANAR_RRR)])
    slightly_off = changed(pose, {(0, 0): "cos(q1 + q2 + q3) + 0*q1 + c1/5000"})
    report = graded_pose(catalogue[PLANAR_RRR.exercise], slightly_off)
    assert report.feedback == ()
    assert wrong_entries(report) == {(0, 0)}


def test_the_work_budget_limits_explanations(catalogue: Mapping[str, Exercise]) -> None:
    # If early entries use up the budget, later entries are only compared and not explained.
    exercise = catalogue[SCARA.exercise]
    late = {(2, 2): "cos(0)*cos(pi/2)*c1", (2, 3): "-d3 + d4"}
    nonsense = "c1*s1*c2*s2*c4*s4*a1*a2*d3*d4*c1*s1*c2*s2*c4"
    for long, code in (("c1", "term_sign"), (nonsense, "value")):
        early = {(i, j): long for i in range(2) for j in range(4)}
        report = graded_pose(exercise, changed(pose_of(SCARA), early | late))
        assert codes_at(report, "3", "4")[-1:] == [code]


def test_without_position_the_rotation_is_still_explained(
    catalogue: Mapping[str, Exercise],
) -> None:
    matrix = text(with_rotation(pose_of(STANFORD), rotation().T))
    for i in range(3):
        matrix[i][3] = "?"
    report = graded_pose(catalogue[STANFORD.exercise], matrix)
    assert [message.code for message in report.feedback] == ["transposed_rotation"]
