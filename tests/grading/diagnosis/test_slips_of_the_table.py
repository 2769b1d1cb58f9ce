"""Test slips of a whole table: columns, numbers of joints, units, rows."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import permutations

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading import PartReport, Submission, Verdict, grade
from dh_grader.grading.diagnosis.table_readings import by_other_numbering
from dh_grader.grading.judging import Grading
from dh_grader.grading.kinds.tables import read_dh_table_answer
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.report import messages_of
from dh_grader.learning import ModelTable, changes_of, model_table

from tests.grading.support.submitting import graded_table, handed_in, not_correct, part, table
from tests.grading.support.submitting import part as report_part
from tests.pose_slips.unseen.algebra import STANDARD, Table
from tests.pose_slips.unseen.arms import NONE, Arm
from tests.pose_slips.unseen.slips import ArmSlip
from tests.pose_slips.unseen.trials import answer_to, exercise_of, said_of
from tests.shipped import shipped_exercises
from tests.together import together

# --- Recognise tables whose columns are in an unexpected order

SYMBOLS = ("a", "α", "d", "θ")
SCARA = [
    ("a1", "0", "0", "theta1"),
    ("a2", "180deg", "0", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
]
# Its columns can be told apart only by joint variables and angles.
RRRP = [
    ("l2", "0", "l1", "q1"),
    ("l3", "180deg", "0", "q2"),
    ("0", "0", "l4", "q3"),
    ("0", "0", "q4", "0"),
]
BAXTER = [
    ("0.069", "-90deg", "0.27035", "theta1"),
    ("0", "90deg", "0", "theta2 + 90deg"),
    ("0.069", "-90deg", "0.36435", "theta3"),
    ("0", "90deg", "0", "theta4"),
    ("0.010", "-90deg", "0.37429", "theta5"),
    ("0", "90deg", "0", "theta6"),
    ("0", "0", "0.229525", "theta7"),
]
TOOLBOX, CRAIG, WIKIPEDIA = (3, 2, 0, 1), (1, 0, 2, 3), (2, 3, 0, 1)
LAST = [[0, 0, 1, 0], [0, 0, 0, 1]]


def in_order(rows: Sequence[Sequence[str]], order: Sequence[int]) -> list[list[str]]:
    return [[row[column] for column in order] for row in rows]


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"table": answer}), "table")


def error_codes(report: PartReport) -> list[str]:
    return [message.code for message, _, _ in messages_of(report) if message.severity == "error"]


@pytest.mark.parametrize("order", [TOOLBOX, CRAIG])
@pytest.mark.parametrize(
    ("name", "rows"), [("scara", SCARA), ("rrrp", RRRP), ("baxter-left-arm", BAXTER)]
)
def test_the_column_orders_of_other_books_are_named(
    catalogue: Mapping[str, Exercise],
    name: str,
    rows: Sequence[Sequence[str]],
    order: Sequence[int],
) -> None:
    written = in_order(rows, order)
    pasted = "\n".join(", ".join(row) for row in written)
    for answer in (
        written,
        {"rows": written},
        pasted,
        [[i + 1, *r] for i, r in enumerate(written)],
    ):
        report = graded(catalogue[name], answer)
        assert error_codes(report) == ["columns_permuted"]
        assert report.points == 0.75 * report.max_points
        [message] = [each for each in report.feedback if each.code == "columns_permuted"]
        assert f"the order {', '.join(SYMBOLS[column] for column in order)}." in message.message
        # The note that the columns were read as a, α, d, θ would contradict the message.
        assert [each.code for each in report.feedback].count("column_order") == 0


@pytest.mark.parametrize("order", [WIKIPEDIA, (2, 3, 1, 0)])
def test_the_order_that_leaves_nothing_wrong_is_named(
    order: Sequence[int], catalogue: Mapping[str, Exercise]
) -> None:
    """The only length is in the first column, which may be a or d."""
    rows = [
        ("0", "-90deg", "0", "theta4"),
        ("0", "90deg", "0", "theta5"),
        ("0", "0", "d6", "theta6"),
    ]
    report = graded(catalogue["spherical-wrist"], in_order(rows, order))
    assert error_codes(report) == ["columns_permuted"]
    assert report.points == 0.75 * report.max_points


@pytest.mark.parametrize("order", [order for order in permutations(range(4)) if order[3] != 3])
def test_every_order_with_moved_angles_is_named(
    catalogue: Mapping[str, Exercise], order: tuple[int, ...]
) -> None:
    report = graded(catalogue["rrrp"], in_order(RRRP, order))
    assert error_codes(report) in (["columns_permuted"], ["columns_swapped"])
    assert report.points == 0.75 * report.max_points


def test_another_slip_is_named_in_its_own_column(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in BAXTER]
    rows[2][1] = "90deg"
    report = graded(catalogue["baxter-left-arm"], in_order(rows, TOOLBOX))
    assert sorted(error_codes(report)) == ["columns_permuted", "sign"]
    assert report.points < 0.75 * report.max_points


@pytest.mark.parametrize("order", [TOOLBOX, CRAIG, (0, 1, 3, 2), (3, 0, 1, 2), (0, 3, 1, 2)])
def test_cells_under_wrong_headers_get_one_message(
    catalogue: Mapping[str, Exercise], order: Sequence[int]
) -> None:
    names = ("a", "alpha", "d", "theta")
    rows = [dict(zip(names, row, strict=True)) for row in in_order(SCARA, order)]
    report = graded(catalogue["scara"], {"rows": rows})
    assert error_codes(report) == ["columns_permuted"]
    assert report.points == 0.75 * report.max_points
    [message] = report.feedback
    written = ", ".join(SYMBOLS[column] for column in order)
    assert message.message == (
        f"The columns stand in the order {written}. Write each parameter under its own header: a, "
        "α, d, θ."
    )


def test_one_wrong_cell_is_no_other_column_order(catalogue: Mapping[str, Exercise]) -> None:
    assert error_codes(graded(catalogue["scara"], in_order(SCARA, range(4)))) == []
    rows = [list(row) for row in SCARA]
    rows[1][1] = "0"
    assert "columns_permuted" not in error_codes(graded(catalogue["scara"], rows))
    names = ("a", "alpha", "d", "theta")
    typed = [dict(zip(names, row, strict=True)) for row in rows]
    assert error_codes(graded(catalogue["scara"], {"rows": typed})) == ["half_turn"]


def test_the_links_follow_from_the_intended_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The last link has L1 for L2: another slip, which is repeated in the links.
    rows = in_order(
        [("R", "90deg", "0", "theta1"), *(("L1", "0", "0", f"theta{i}") for i in (2, 3))], TOOLBOX
    )
    links = [
        [["c1", 0, "s1", "R c1"], ["s1", 0, "-c1", "R s1"], [0, 1, 0, 0], LAST[1]],
        *(
            [[f"c{i}", f"-s{i}", 0, f"L1 c{i}"], [f"s{i}", f"c{i}", 0, f"L1 s{i}"], *LAST]
            for i in (2, 3)
        ),
    ]
    report = handed_in(catalogue["spatial-rrr"], {"table": rows, "links": links})
    assert "columns_permuted" in error_codes(part(report, "table"))
    follows = part(report, "links")
    assert follows.follow_through
    assert follows.points == follows.max_points


# --- Recognise joint numbers that differ from the expected ones

STANFORD = [
    ("0", "-90deg", "0"), ("0", "90deg", "d2"), ("0", "0", "d3"),
    ("0", "-90deg", "0"), ("0", "90deg", "0"), ("0", "0", "d6"),
]  # fmt: skip


def stanford(*theta: str, d3: str = "d3") -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (*row, angle) for row, angle in zip(STANFORD, theta, strict=True)
    ]
    rows[2] = ("0", "0", d3, theta[2])
    return rows


JOINT_NUMBERING_RRRP = [("l2", "0", "l1"), ("l3", "180deg", "0"), ("0", "0", "l4")]
WRIST = [("0", "-90deg", "0"), ("0", "90deg", "0"), ("0", "0", "d6")]

# The exercise, the table, the code, and the only cells that are not correct.
CASES: dict[str, tuple[str, Sequence[Sequence[str]], str, set[tuple[str, str]]]] = {
    "from 0": (
        "spatial-rrr",
        [("R", "90deg", "0", "theta0"), ("L1", "0", "0", "theta1"), ("L2", "0", "0", "theta2")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta")},
    ),
    "from 0, one of them slides": (
        "rrrp",
        [(*row, f"q{i}") for i, row in enumerate(JOINT_NUMBERING_RRRP)] + [("0", "0", "q3", "0")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta"), ("4", "d")},
    ),
    "from 0, with stars": (
        "rrrp",
        [(*row, f"θ{i}*") for i, row in enumerate(JOINT_NUMBERING_RRRP)] + [("0", "0", "d3*", "0")],
        "joint_numbering",
        {("1", "theta"), ("2", "theta"), ("3", "theta"), ("4", "d")},
    ),
    "the wrist from 1": (
        "spherical-wrist",
        [(*row, f"theta{i + 1}") for i, row in enumerate(WRIST)],
        "joint_numbering",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "the wrist from 3": (
        "spherical-wrist",
        [(*row, f"theta{i + 3}") for i, row in enumerate(WRIST)],
        "joint_numbering",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "turning joints by themselves": (
        "stanford-arm",
        stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5"),
        "joint_numbering_by_kind",
        {("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "turning and sliding joints by themselves": (
        "stanford-arm",
        stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5", d3="d1"),
        "joint_numbering_by_kind",
        {("3", "d"), ("4", "theta"), ("5", "theta"), ("6", "theta")},
    ),
    "the last joint of SCARA": (
        "scara",
        [("a1", "0", "0", "q1"), ("a2", "pi", "0", "q2"), ("0", "0", "d3", "0"),
         ("0", "0", "d4", "theta3")],
        "joint_numbering_by_kind",
        {("4", "theta")},
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_another_numbering_gets_one_message_with_its_places(
    catalogue: Mapping[str, Exercise], case: str
) -> None:
    exercise, rows, code, cells = CASES[case]
    report = graded_table(catalogue[exercise], rows)
    assert error_codes(report) == [code]
    assert not_correct(report) == dict.fromkeys(cells, Verdict.INCORRECT)
    [message] = [message for message in report.feedback if message.code == code]
    assert {(place.row, place.cell) for place in message.places or ()} == cells


def test_another_numbering_costs_a_quarter(catalogue: Mapping[str, Exercise]) -> None:
    exercise, rows, *_ = CASES["from 0"]
    report = graded_table(catalogue[exercise], rows)
    assert report.points == 0.75 * report.max_points


def test_another_slip_costs_points_and_is_named(catalogue: Mapping[str, Exercise]) -> None:
    rows = stanford("theta1", "theta2", "0", "theta3", "theta4", "theta5")
    alone = graded_table(catalogue["stanford-arm"], rows)
    rows[3] = ("0", "90deg", "0", "theta3")
    both = graded_table(catalogue["stanford-arm"], rows)
    assert sorted(error_codes(both)) == ["joint_numbering_by_kind", "sign"]
    assert both.points < alone.points


def test_the_first_joint_has_the_name_that_the_student_uses(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [("R", "90°", "0", "q0"), ("L1", "0", "0", "q1"), ("L2", "0", "0", "q2")]
    [message] = graded_table(catalogue["spatial-rrr"], rows).feedback
    assert "from 0" in message.message
    assert message.message.endswith("is q1.")


@pytest.mark.parametrize(
    "angles",
    [
        ("theta2", "theta1", "theta3"),
        ("theta1", "theta1", "theta3"),
        ("theta0", "theta2", "theta3"),
    ],
)
def test_other_wrong_variables_are_no_numbering(
    catalogue: Mapping[str, Exercise], angles: tuple[str, ...]
) -> None:
    rows = [("R", "90deg", "0"), ("L1", "0", "0"), ("L2", "0", "0")]
    report = graded_table(
        catalogue["spatial-rrr"], [(*row, angle) for row, angle in zip(rows, angles, strict=True)]
    )
    assert "joint_numbering" not in error_codes(report)
    assert report.points < report.max_points


def test_a_lazy_table_gains_nothing_by_another_numbering(catalogue: Mapping[str, Exercise]) -> None:
    lazy = [("0", "0", "0", f"theta{i}") for i in range(3)]
    usual = [("0", "0", "0", f"theta{i + 1}") for i in range(3)]
    exercise = catalogue["spatial-rrr"]
    assert graded_table(exercise, lazy).points <= graded_table(exercise, usual).points


Rows = Sequence[Sequence[str]]
TABLES = [
    (exercise, part)
    for exercise in shipped_exercises().values()
    for part in exercise.parts
    if isinstance(part, DhTableSpec)
]


def right_table(exercise: Exercise, part: DhTableSpec) -> ModelTable:
    robot = exercise.robot
    convention = robot.convention if part.convention == "either" else part.convention
    return model_table(robot, convention, exercise.symbols)


def shifted(rows: Rows) -> Iterator[Rows]:
    """Yield the table with its rows moved, in all ways that students move them."""
    rows = list(rows)
    for blank in (["0"] * 4, [""] * 4):
        for count in range(1, len(rows)):
            yield [*[blank] * count, *rows[:-count]]
            yield [*rows[count:], *[blank] * count]
        for i in range(len(rows)):
            yield [*rows[:i], blank, *rows[i:]][: len(rows)]
            yield [*rows[:i], blank, *rows[i:]]
            yield [*rows[:i], *rows[i + 1 :], blank]
    for i in range(len(rows)):
        yield [*rows[:i], *rows[i + 1 :]]


def is_renumbered(exercise: Exercise, part: DhTableSpec, rows: Rows) -> bool:
    samples = draw(exercise, "")
    grading = Grading(exercise, samples, Reader.of(exercise, samples, "radians"))
    answer = read_dh_table_answer(part, table(rows), grading)
    assert answer is not None
    return by_other_numbering(answer, grading) is not None


@together(("exercise", "part"), TABLES)
def test_rows_that_begin_one_row_too_late_are_no_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    rows = right_table(exercise, part).texts
    assert not is_renumbered(exercise, part, [["0"] * 4, *rows[:-1]])


@pytest.mark.long
@together(("exercise", "part"), TABLES)
def test_rows_shifted_in_any_way_are_no_numbering(exercise: Exercise, part: DhTableSpec) -> None:
    for rows in shifted(right_table(exercise, part).texts):
        assert not is_renumbered(exercise, part, rows), rows


@pytest.mark.long
@pytest.mark.parametrize(
    ("exercise", "part"), TABLES[::4], ids=[each.id for each, _ in TABLES[::4]]
)
def test_a_report_on_shifted_rows_does_not_tell_a_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    rows = right_table(exercise, part).texts
    for blank in (["0"] * 4, [""] * 4):
        for answer in ([blank, *rows[:-1]], [*rows[1:], blank]):
            report = report_part(handed_in(exercise, {part.id: table(answer)}), part.id)
            codes = {message.code for message, _, _ in messages_of(report)}
            assert not codes & {"joint_numbering", "joint_numbering_by_kind"}


@together(("exercise", "part"), [each for each in TABLES if not each[1].given])
def test_joints_that_are_numbered_from_0_are_a_numbering(
    exercise: Exercise, part: DhTableSpec
) -> None:
    right = right_table(exercise, part)
    from_0, _ = changes_of("joint_numbering", right)
    rows = [list(each) for each in right.texts]
    for (i, j), text in from_0.items():
        rows[i][j] = text
    assert is_renumbered(exercise, part, rows)
    # A row that the student left empty does not hide the numbering.
    rows[1] = [""] * 4
    assert is_renumbered(exercise, part, rows)


def test_one_wrong_index_is_no_numbering(catalogue: Mapping[str, Exercise]) -> None:
    rows = [("a1", "0", "0", "theta0"), ("a2", "0", "0", "theta2")]
    report = graded_table(catalogue["planar-rr"], rows)
    assert error_codes(report) == ["joint_variable_absent"]


# --- Recognise tables whose lengths are in the wrong unit

# The lengths of the UR5e: a2, a3, d1, d4, d5 and d6.
METRES = (-0.425, -0.3922, 0.1625, 0.1333, 0.0997, 0.0996)


def table_in_units(lengths: tuple[float, ...], first_alpha: str = "90deg", sign: int = 1) -> str:
    a2, a3, d1, d4, d5, d6 = lengths
    return (
        "a, alpha, d, theta\n"
        f"0, {first_alpha}, {d1:.7g}, theta1\n{sign * a2:.7g}, 0, 0, theta2\n"
        f"{a3:.7g}, 0, 0, theta3\n0, 90deg, {d4:.7g}, theta4\n"
        f"0, -90deg, {d5:.7g}, theta5\n0, 0, {d6:.7g}, theta6\n"
    )


def graded_in_units(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    report = grade(catalogue["ur5e"], Submission({"table": text}))
    return next(part for part in report.parts if part.part == "table")


def codes(part: PartReport) -> set[str]:
    found = [*part.feedback]
    for row in part.rows:
        found += [*row.feedback, *(message for cell in row.cells for message in cell.feedback)]
    return {message.code for message in found}


@pytest.mark.parametrize("factor", [1000, 100, 0.001], ids=["mm", "cm", "km"])
def test_lengths_in_another_unit_are_one_mistake(
    catalogue: Mapping[str, Exercise], factor: float
) -> None:
    part = graded_in_units(catalogue, table_in_units(tuple(factor * each for each in METRES)))
    assert codes(part) == {"other_length_unit"}
    # A slip of the whole table costs a quarter.
    assert part.points == 0.75 * part.max_points
    wrong = [c.label for row in part.rows for c in row.cells if c.verdict is Verdict.INCORRECT]
    assert sorted(wrong) == ["a", "a", "d", "d", "d", "d"]


def test_another_slip_beside_the_unit_is_named(catalogue: Mapping[str, Exercise]) -> None:
    millimetres = tuple(1000 * each for each in METRES)
    turned = graded_in_units(catalogue, table_in_units(millimetres, "-90deg"))
    assert {"other_length_unit", "sign"} <= codes(turned)
    negated = graded_in_units(catalogue, table_in_units(millimetres, sign=-1))
    assert codes(negated) == {"other_length_unit", "sign"}
    assert negated.points < 0.75 * negated.max_points


def test_a_table_of_numbers_in_metres_has_no_other_unit(catalogue: Mapping[str, Exercise]) -> None:
    assert graded_in_units(catalogue, table_in_units(METRES)).verdict is Verdict.CORRECT
    # One length is ten times too large, and one is wrong.
    for wrong in ((-4.25, *METRES[1:]), (-0.5, *METRES[1:])):
        assert "other_length_unit" not in codes(graded_in_units(catalogue, table_in_units(wrong)))


# --- A wrong pose reveals a wrong row or column of the table it was computed from

UP, DOWN = {"": 1.0}, {"": -1.0}
ROW1 = (NONE, DOWN, {"d1": 1.0}, {"q1": 1.0})
ROW2 = ({"a2": 1.0}, UP, {"d2": 1.0}, {"q2": 1.0})
ROW3 = ({"a3": 1.0}, NONE, NONE, {"q3": 1.0})
ROW4 = ({"a4": 1.0}, UP, {"d4": 1.0}, {"q4": 1.0})
ARM = Arm((ROW1, ROW2, ROW3, ROW4), "RRRR", STANDARD)
EXERCISE = exercise_of(ARM)


def said(table: Table, kind: str = "transform", arm: Arm = ARM) -> tuple[tuple[str, str], ...]:
    slip = ArmSlip("", frozenset(), table, arm.convention, tuple(range(len(table))))
    exercise = EXERCISE if arm is ARM else exercise_of(arm)
    return said_of(exercise, kind, answer_to(kind, slip))


@pytest.mark.parametrize(
    ("table", "code", "words"),
    [
        (
            ((ROW1[2], DOWN, NONE, ROW1[3]), ROW2, ROW3, ROW4),
            "columns_swapped",
            (
                "The length a and the offset d are exchanged in row 1: a is measured along x, d "
                "along z."
            ),
        ),
        (
            tuple((d, alpha, a, theta) for a, alpha, d, theta in ARM.table),
            "columns_swapped",
            (
                "The lengths a and the offsets d are exchanged throughout: a is measured along "
                "x, d along z."
            ),
        ),
        (
            ((NONE, UP, *ROW1[2:]), (ROW2[0], DOWN, *ROW2[2:]), ROW3, (ROW4[0], DOWN, *ROW4[2:])),
            "parameter_sign",
            (
                "α has the wrong sign throughout: it is measured about x, positive by the "
                "right-hand rule."
            ),
        ),
        (
            (
                (NONE, NONE, *ROW1[2:]),
                (*ROW1[:2], *ROW2[2:]),
                (*ROW2[:2], *ROW3[2:]),
                (*ROW3[:2], *ROW4[2:]),
                (*ROW4[:2], NONE, NONE),
            ),
            "other_convention",
            (
                "A table of the modified convention is multiplied with the link transform of the "
                "standard one: use the same convention for both."
            ),
        ),
        (
            (ROW1, ROW4, ROW3, ROW2),
            "row_order",
            (
                "Rows 2 and 4, or their link transforms, are exchanged: check which joint each "
                "row of the table belongs to."
            ),
        ),
        (
            (ROW1, (*ROW4[:3], ROW2[3]), ROW3, (*ROW2[:3], ROW4[3])),
            "row_order",
            (
                "Rows 2 and 4 are exchanged, but for their joint variables: check which joint "
                "each row of the table belongs to."
            ),
        ),
    ],
)
def test_the_slip_is_named(table: Table, code: str, words: str) -> None:
    assert said(table) == ((code, words),)


def test_a_standard_table_in_a_modified_product_is_named() -> None:
    first = (NONE, NONE, *ROW1[2:])
    last = ({"a3": 1.0}, NONE, NONE, NONE)
    rows = (first, (NONE, DOWN, *ROW2[2:]), (*ROW2[:2], *ROW3[2:]), last)
    standard = ((NONE, DOWN, *ROW1[2:]), ROW2, ROW3)
    [(code, words)] = said(standard, arm=Arm(rows, "RRR", "modified"))
    assert code == "other_convention"
    assert words.startswith("A table of the standard convention is multiplied with the link")


def test_exchanged_rows_are_no_missing_link() -> None:
    # The last length is 0, so the position does not show an exchange of rows 3 and 4.
    wrist = (ROW1, ROW2, (NONE, UP, {"d3": 1.0}, {"q3": 1.0}), (NONE, NONE, NONE, {"q4": 1.0}))
    arm = Arm(wrist, "RRRR", STANDARD)
    [(code, words)] = said((wrist[0], wrist[2], wrist[1], wrist[3]), "position", arm)
    assert code == "row_order"
    assert "Rows 2 and 3, or their link transforms, are exchanged" in words


def test_a_missing_link_is_named() -> None:
    [(code, words)] = said((ROW1, ROW2, ROW4))
    assert (code, words) == (
        "missing_link",
        (
            "This matrix is the product without A3. Check that each row of the table takes part "
            "in the product."
        ),
    )


def test_exchanged_rows_and_a_missing_link_are_both_named_if_both_fit() -> None:
    # Row 3 only turns: without A3, the position is the same as with rows 3 and 4 exchanged.
    rows = (ROW1, ROW2, (NONE, UP, NONE, {"q3": 1.0}), ROW4)
    [(code, words)] = said((*rows[:2], ROW4), "position", Arm(rows, "RRRR", STANDARD))
    assert (code, words) == (
        "row_order",
        (
            "One of these slips explains it: rows 3 and 4, or their link transforms, are "
            "exchanged; or A3 is missing in the product. Check each of them."
        ),
    )


def test_exchanged_lengths_and_columns_are_both_named_if_both_fit() -> None:
    [(code, words)] = said((ROW1, (ROW2[2], UP, ROW2[0], ROW2[3]), ROW3, ROW4))
    assert (code, words) == (
        "columns_swapped",
        (
            "One of these slips explains it: the length a and the offset d are exchanged in row "
            "2; or the lengths a2 and d2 are exchanged. Check each of them."
        ),
    )


def test_the_two_axes_are_named() -> None:
    turned = (ROW1, (ROW2[0], NONE, *ROW2[2:]), ROW3, ROW4)
    [(code, words)] = said(turned)
    assert code == "quarter_turn"
    assert words.endswith("is not right: compare z1 and z2 in the home position.")
