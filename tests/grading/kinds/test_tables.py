"""Test tables, rows of tables, and tables with a slip to find."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import CatalogueError, Exercise, FeedbackLevel
from dh_grader.grading import Correction, PartReport, Verdict
from dh_grader.grading.grade import Submission, grade
from dh_grader.grading.kinds.tables import shown_shape
from dh_grader.grading.report import MAX_REPAIRS

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import (
    SPATIAL_RRR,
    Make,
    all_codes,
    full_marks,
    graded,
    graded_table,
    handed_in,
    not_correct,
    one_part,
    part,
    table,
)
from tests.shipped import shipped_exercises
from tests.together import together

# --- Tables that were once graded wrongly

Rows = list[tuple[str, str, str, str]]

# The exercise, the table, and the cells that are wrong in it.
BLAMED: dict[str, tuple[str, Rows, list[tuple[str, str]]]] = {
    "a sliding joint's sign, in a small robot": (
        "scara",
        [
            ("a1", "0", "0", "theta1"),
            ("a2", "180deg", "0", "theta2"),
            ("0", "0", "-d3", "0"),
            ("0", "0", "d4", "theta4"),
        ],
        [("3", "d")],
    ),
    "a sliding joint's variable is nowhere, beside huge offsets": (
        "scara",
        [
            ("a1", "0", "0", "theta1"),
            ("a2", "180deg", "0", "theta2"),
            ("0", "0", "9e8", "0"),
            ("0", "0", "d4 - 9e8", "theta4"),
        ],
        [("3", "d")],
    ),
    "a foreign variable, small enough to be rounding": (
        "stanford-arm",
        [
            ("0", "-pi/2", "0", "theta1 + 0.0005*theta2"),
            ("0", "1.57 + 0.0001*theta1", "d2", "theta2"),
            *EXACT.rows(STANFORD)[2:],
        ],
        [("1", "theta"), ("2", "alpha")],
    ),
    "a number beside the variable, small enough to be rounding": (
        "stanford-arm",
        [
            *EXACT.rows(STANFORD)[:2],
            ("0", "0", "d3 + 0.0003", "0"),
            *EXACT.rows(STANFORD)[3:],
        ],
        [("3", "d")],
    ),
}


@pytest.mark.parametrize(("exercise", "rows", "wrong"), BLAMED.values(), ids=list(BLAMED))
def test_only_these_cells_are_wrong(
    exercise: str, rows: Rows, wrong: list[tuple[str, str]], catalogue: Mapping[str, Exercise]
) -> None:
    assert list(not_correct(graded_table(catalogue[exercise], rows))) == wrong


def test_a_millimetre_beside_a_thousand_kilometres_is_wrong(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Only the sum of the two offsets counts, so either row may be the wrong one.
    rows = [("a1", "0", "1e6", "theta1"), ("a2", "0", "-1e6 + 0.0009", "theta2")]
    wrong = list(not_correct(graded_table(catalogue["planar-rr"], rows)))
    assert wrong in ([("1", "d")], [("2", "d")])


def test_an_unread_cell_makes_no_other_wrong(catalogue: Mapping[str, Exercise]) -> None:
    # If the unread cell in row 3 is d3 + 0.5, then row 4 is correct.
    rows = [
        ("a1", "0", "0", "theta1"),
        ("a2", "pi", "0", "theta2"),
        ("0", "0", "", "0"),
        ("0", "0", "d4 - 0.5", "theta4"),
    ]
    assert list(not_correct(graded_table(catalogue["scara"], rows))) == [("3", "d")]


def codes(report: PartReport) -> list[str]:
    return [message.code for message in report.feedback]


def test_a_missing_row_in_the_middle_is_found_by_the_variables(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [("0", "0", "0", "q1"), ("l2", "0", "0", "q3"), ("l3", "0", "0", "0")]
    report = graded_table(catalogue["planar-rrr"], rows)
    assert codes(report) == ["missing_row", "rows_matched"]
    # Rows 2, 3 and e have a length as a content cell. With a fifth for each row these are 3.8 units
    # of 8 / 3.8, about 2 points; each row shares in the other 2 points.
    assert report.points == 8 - (2 + 0.5)


def test_an_axis_with_one_offset_gets_no_message_on_sums(catalogue: Mapping[str, Exercise]) -> None:
    rows = [*EXACT.rows(STANFORD)[:5], ("0", "0", "0", "theta6")]
    report = graded_table(catalogue["stanford-arm"], rows)
    [message] = [m.message for cell in report.rows[5].cells for m in cell.feedback]
    assert "sum" not in message


def test_frames_that_miss_the_tool_are_not_a_valid_choice(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [
        ("0", "0", "l1", "q1"),
        ("l1", "0", "0", "q2"),
        ("l3", "180deg", "l4", "-q3"),
        ("0.7", "0", "q4", "0"),
    ]
    assert codes(graded_table(catalogue["rrrp-proximal"], rows)) == ["tool_not_reached"]


# The Stanford arm with the wrong sign of every α.
SIGNS_TURNED = [
    ("0", "90deg", "0", "theta1"),
    ("0", "-90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "90deg", "0", "theta4"),
    ("0", "-90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]


def test_the_cells_agree_with_a_slip_of_the_whole_table(catalogue: Mapping[str, Exercise]) -> None:
    # Two half turns of θ would also repair the table, but the slip is in the signs of α.
    report = graded_table(catalogue["stanford-arm"], SIGNS_TURNED)
    assert codes(report) == ["column_sign"]
    assert set(not_correct(report)) == {(row, "alpha") for row in "1245"}
    assert not [m.code for row in report.rows for cell in row.cells for m in cell.feedback]
    assert {place.row: place.correction for place in report.feedback[0].places or ()} == {
        "1": Correction("-90deg", r"-90^{\circ}"),
        "2": Correction("90deg", r"90^{\circ}"),
        "4": Correction("-90deg", r"-90^{\circ}"),
        "5": Correction("90deg", r"90^{\circ}"),
    }


def test_two_half_turns_are_not_a_slip_of_the_whole_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[0][3], rows[5][3] = "theta1 + pi", "theta6 + pi"
    report = graded_table(catalogue["stanford-arm"], rows)
    assert codes(report) == []
    assert list(not_correct(report)) == [("1", "theta"), ("6", "theta")]
    told = [(row.label, m.code) for row in report.rows for c in row.cells for m in c.feedback]
    assert told == [("1", "half_turn"), ("6", "half_turn")]


def test_the_number_of_repaired_cells_is_bounded(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [[f"(tehta1 + {i}.{j}" for j in range(4)] for i in range(7)]
    report = part(handed_in(catalogue["baxter-left-arm"], {"table": table(rows)}), "table")
    messages = [m for row in report.rows for cell in row.cells for m in cell.feedback]
    helped = [(m.suggestion or "").startswith("(theta1 + ") for m in messages]
    assert helped == [True] * MAX_REPAIRS + [False] * (28 - MAX_REPAIRS)


def test_rounded_angles_and_a_fixed_row_raise_no_error(catalogue: Mapping[str, Exercise]) -> None:
    # Rows are compared as objects, because comparing the arrays in them would raise an error.
    rows = [
        ("0", "0", "l1", "q1"),
        ("l2", "3.14", "0", "-q2"),
        ("l3", "0", "l4", "-q3"),
        ("0", "0", "q4 + l1", "0"),
        ("0", "0", "0", "1.57"),
    ]
    assert not_correct(graded_table(catalogue["rrrp-proximal"], rows))


def test_a_value_under_an_unknown_name_is_not_missing(
    catalogue: Mapping[str, Exercise],
) -> None:
    answer = table(EXACT.rows(STANFORD))
    answer["rows"][1]["alpha [rad]"] = answer["rows"][1].pop("alpha")
    report = part(handed_in(catalogue["stanford-arm"], {"table": answer}), "table")
    [message] = report.rows[1].cells[1].feedback
    assert message.code == "wrong_shape"


# --- Grade answers that give the DH row of a transform

Cells = dict[str, Any]

FIRST: Cells = {"a": "l", "alpha": "-90deg", "d": "h", "theta": "phi"}
FOURTH: Cells = {"a": 3, "alpha": 0, "d": 2, "theta": "pi/2"}
NONE: Cells = {"none": True}


@pytest.fixture
def conditions(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["dh-conditions"]


@together(
    ("part_id", "answer"),
    [
        ("first", FIRST),
        ("first", {"rows": [FIRST]}),
        ("first", {**FIRST, "alpha": "3pi/2", "theta": "phi - 2pi"}),
        ("second", NONE),
        ("second", "none"),
        ("third", " None "),
        ("third", "none."),
        ("third", '"none"'),
        ("third", '{"none": true}'),
        ("second", {**NONE, "a": "", "alpha": None, "d": " "}),
        ("second", {**NONE, "why": "x1 is not perpendicular to z0"}),
        ("fourth", FOURTH),
        ("fourth", {"none": False, **FOURTH}),
        ("fourth", {"none": None, **FOURTH}),
        ("fourth", {"a": 3, "α": 0, "d_i": 2, "θ": "pi/2"}),
        ("fourth", [3, 0, 2, "pi/2"]),
        ("fourth", [[3, 0, 2, "pi/2"]]),
        ("fourth", "3, 0, 2, pi/2"),
        ("fourth", "a,alpha,d,theta\n3,0,2,pi/2"),
        ("fourth", "a=3, d=2, theta=90deg, alpha=0"),
        ("fourth", "a = 3; alpha = 0; d = 2; theta = pi/2"),
        ("fourth", "α: 0\nθ: 90°\na: 3\nd: 2\n"),
        ("fourth", r"$a_1 = 3,\ \alpha_1 = 0,\ d_1 = 2,\ \theta_1 = \frac{\pi}{2}$"),
        ("fourth", "a=3 alpha=0 d=2 theta=90deg"),
        ("first", "a=l, d=h, theta=phi and alpha=-90deg"),
        ("fourth", "(3, 0, 2, pi/2)"),
        ("fourth", "3; 0; 2; pi/2"),
        ("fourth", "3\n0\n2\npi/2"),
        ("fourth", "3 0 2 pi/2"),
        ("second", r"\text{none}"),
        ("second", r"$\mathrm{None}$"),
        ("third", "N/A"),
        ("third", "There is no row."),
        ("third", {"a": "n/a", "alpha": "", "d": None, "theta": "n/a"}),
    ],
)
def test_right_rows_get_full_marks(part_id: str, answer: object, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1"]


@pytest.mark.parametrize(
    ("part_id", "answer", "code"),
    [
        ("first", NONE, "dh_row_exists"),
        ("second", {"a": "l", "alpha": 0, "d": "h", "theta": "phi"}, "dh_not_perpendicular"),
        ("third", {"a": "l", "alpha": "phi", "d": "h", "theta": 0}, "dh_not_intersecting"),
    ],
)
def test_a_row_instead_of_none_and_none_instead_of_a_row(
    part_id: str, answer: object, code: str, conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert (report.verdict, report.points) == (Verdict.INCORRECT, 0)
    assert [message.code for message in report.rows[0].feedback] == [code]


@pytest.mark.parametrize(
    ("cells", "blamed", "codes"),
    [
        ({"a": 2, "d": 3}, {"a", "d"}, {"exchanged_parameters"}),
        ({"alpha": "pi/2", "theta": 0}, {"alpha", "theta"}, {"exchanged_parameters"}),
        ({"a": -3}, {"a"}, {"sign"}),
        ({"theta": "-90deg"}, {"theta"}, {"sign"}),
        ({"theta": "90"}, {"theta"}, {"degrees_as_radians"}),
        ({"d": "2.5"}, {"d"}, {"value"}),
        ({"d": "(2"}, {"d"}, {"unbalanced_bracket"}),
    ],
)
def test_a_wrong_cell_affects_only_itself(
    cells: Cells, blamed: set[str], codes: set[str], conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {"fourth": FOURTH | cells}), "fourth")
    assert {cell for _, cell in not_correct(report)} == blamed
    # a, d and theta are worth a third of the points each; alpha is 0.
    assert report.points == pytest.approx(6 * (3 - len(blamed)) / 3, abs=1e-5)
    assert codes <= all_codes(report) <= codes | {"sign", "quarter_turn"}


@pytest.mark.parametrize(
    "answer", [[], 1, "", "no idea", {"none": "yes"}, {"rows": [FIRST, FIRST]}, {"rows": 3}, [1, 2]]
)
def test_an_answer_of_another_shape_is_unreadable(answer: object, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"first": answer}), "first")
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)


@pytest.mark.parametrize("part_id", ["second", "fourth"])
@pytest.mark.parametrize(
    "answer",
    [
        {**NONE, **FOURTH},
        {**NONE, "a": 0},
        {**NONE, "θ": "phi"},
        {**NONE, "a": "", "alpha (deg)": 90},
        {**NONE, "rows": [FOURTH]},
        {"none": "yes", **FOURTH},
    ],
)
def test_none_with_a_row_contradicts_itself(
    part_id: str, answer: object, conditions: Exercise
) -> None:
    report = part(handed_in(conditions, {part_id: answer}), part_id)
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)
    assert all_codes(report) == {"contradiction"}


@pytest.mark.parametrize("text", ["no", "-", "impossible", "3, 0, 2", "3 0 2", "3,0\n2,1"])
def test_text_without_a_row_gets_a_message_on_rows(text: str, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert (report.verdict, all_codes(report)) == (Verdict.UNREADABLE, {"wrong_shape"})
    [message] = report.feedback
    assert "One row" in message.message
    assert "none" in message.message
    assert "table" not in message.message


MODIFIED = one_part(
    "dh_row",
    """convention = "modified"
transform = [
    ["cos(phi)", "-sin(phi)", "0", "l"],
    ["0", "0", "1", "k"],
    ["-sin(phi)", "-cos(phi)", "0", "0"],
    ["0", "0", "0", "1"],
]""",
)


def test_a_modified_row_is_right(make_exercise: Make) -> None:
    # The transform is Rot_x(−90°) Trans_x(l) Rot_z(φ) Trans_z(k), multiplied out by hand.
    exercise = make_exercise(MODIFIED)
    row = {"a": "l", "alpha": "-pi/2", "d": "k", "theta": "phi"}
    assert full_marks(graded(exercise, row))
    assert all_codes(graded(exercise, "none")) == {"dh_row_exists"}


def test_a_row_of_the_other_convention_is_named(make_exercise: Make) -> None:
    # A turn about z and a shift along x form a DH row in both conventions.
    exercise = make_exercise(
        one_part(
            "dh_row",
            'transform = [["0", "-1", "0", "0"], ["1", "0", "0", "l"], ["0", "0", "1", "0"], '
            '["0", "0", "0", "1"]]',
        )
    )
    assert full_marks(graded(exercise, {"a": "l", "alpha": 0, "d": 0, "theta": "pi/2"}))
    inverse = {"a": "-l", "alpha": 0, "d": 0, "theta": "-pi/2"}
    assert all_codes(graded(exercise, inverse)) >= {"sign"}


def test_an_unreadable_named_cell_has_its_span(conditions: Exercise) -> None:
    text = "a = 3, d = 2 + foo, theta = 90deg, alpha = 0"
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert not_correct(report) == {("1", "d"): Verdict.UNREADABLE}
    [message] = report.rows[0].cells[2].feedback
    assert message.span is not None
    assert text[slice(*message.span)] == "foo"


def test_an_unnamed_cell_is_missing(conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": "a=3, theta=pi/2"}), "fourth")
    assert not_correct(report) == {
        ("1", "alpha"): Verdict.MISSING,
        ("1", "d"): Verdict.MISSING,
    }


@pytest.mark.parametrize(
    "text", ["a=3, a=2, d=0, theta=0", "b=3, d=2", "3 - 2 pi", "-", "x: 3, alpha: 0", "(3)(0)"]
)
def test_other_texts_are_not_rows(text: str, conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": text}), "fourth")
    assert report.verdict is Verdict.UNREADABLE


def test_a_message_without_joints_does_not_mention_home(conditions: Exercise) -> None:
    report = part(handed_in(conditions, {"fourth": "3, 0, 2, 0"}), "fourth")
    [message] = report.rows[0].cells[3].feedback
    assert message.code == "quarter_turn"
    assert "home" not in message.message


# --- Marking the wrong cell earns half of the points, correcting the table the other half

RIGHT = [
    ["a1", "0", "0", "theta1"],
    ["a2", "180deg", "0", "theta2"],
    ["0", "0", "d3", "0"],
    ["0", "0", "d4", "theta4"],
]
# The axes of joints 3 and 4 point up.
GIVEN = [RIGHT[0], ["a2", "0", "0", "theta2"], *RIGHT[2:]]
OTHER_FRAMES = [*GIVEN[:2], ["0", "180deg", "-d3 - d4", "0"], ["0", "0", "0", "theta4"]]


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["find-the-slip-scara"]


def found(
    exercise: Exercise, answer: object, feedback: FeedbackLevel = FeedbackLevel.HINTS
) -> PartReport:
    return part(handed_in(exercise, {"slip": answer}, feedback=feedback), "slip")


def test_the_given_table_is_shown(scara: Exercise) -> None:
    assert shown_shape(scara.parts[0], scara).model_dump()["given"] == GIVEN


@pytest.mark.parametrize("rows", [RIGHT, OTHER_FRAMES])
@pytest.mark.parametrize(
    "marked", ["2.alpha", "2 α", " Row 2: alpha ", ["2.alpha"], ["2/alpha", "2.alpha"]]
)
def test_a_marked_and_mended_slip_has_full_marks_and_its_name(
    marked: object, rows: list[list[str]], scara: Exercise
) -> None:
    report = found(scara, {"marked": marked, "table": table(rows)})
    assert full_marks(report)
    [message] = report.rows[0].cells[0].feedback
    assert message.code == "slip_found"
    assert "off by 180°" in message.message


@pytest.mark.parametrize(
    ("marked", "rows", "points", "codes"),
    [
        ("2.alpha", None, 4, {"not_mended"}),
        ("2.alpha", GIVEN, 4, {"half_turn"}),
        ("2.alpha", [*GIVEN[:3], ["0", "0", "d3", "theta4"]], 4, None),
        (None, RIGHT, 4, set()),
        ("3.alpha", RIGHT, 4, {"slip_elsewhere"}),
        ("2", RIGHT, 4, {"slip_elsewhere"}),
        (["2.alpha", "3.alpha"], RIGHT, 4, {"slip_elsewhere"}),
        ("3.alpha", GIVEN, 0, {"slip_elsewhere"}),
        (None, GIVEN, 0, set()),
        ("beta", RIGHT, 4, {"unknown_place"}),
    ],
)
def test_each_half_is_right_or_not(
    marked: object,
    rows: list[list[str]] | None,
    points: float,
    codes: set[str] | None,
    scara: Exercise,
) -> None:
    answer: dict[str, object] = {"marked": marked, "table": rows and table(rows)}
    report = found(scara, answer)
    assert report.points == points
    assert codes is None or all_codes(report) == codes
    assert sum(row.max_points for row in report.rows) == report.max_points
    assert sum(row.points for row in report.rows) == report.points


def test_lost_points_name_the_mark_and_the_table(scara: Exercise) -> None:
    lost = found(scara, {"marked": "3.alpha", "table": table(GIVEN)}).lost
    assert [(each.message, each.points) for each in lost] == [
        ("the mark", 4),
        ("the mended table", 4),
    ]


@pytest.mark.parametrize("level", FeedbackLevel)
def test_the_report_does_not_find_the_slip_for_the_student(
    level: FeedbackLevel, scara: Exercise
) -> None:
    for marked in (None, "3.alpha", "nonsense"):
        report = found(scara, {"marked": marked, "table": table(GIVEN)}, level)
        assert all(row.label in ("marked", "table") for row in report.rows)
        assert "half_turn" not in all_codes(report)
        assert "alpha" not in str(report.lost)


def test_the_name_of_the_slip_is_a_hint(scara: Exercise) -> None:
    answer = {"marked": "2.alpha", "table": table(RIGHT)}
    assert "slip_found" not in all_codes(found(scara, answer, FeedbackLevel.VERDICTS))


def test_an_unreadable_cell_is_not_a_wrong_one(scara: Exercise) -> None:
    rows = [*RIGHT[:3], ["0", "0", "d9", "theta4"]]
    report = found(scara, {"marked": "2.alpha", "table": table(rows)})
    assert not_correct(report) == {("4", "d"): Verdict.UNREADABLE}
    report = found(scara, {"marked": "1.a", "table": table(rows)})
    assert not_correct(report)["table", "table"] is Verdict.UNREADABLE
    report = found(scara, {"marked": "1.a", "table": table([*GIVEN[:3], rows[3]])})
    assert not_correct(report)["table", "table"] is Verdict.INCORRECT


@pytest.mark.parametrize("unit", ["radians", "degrees"])
def test_the_given_table_means_the_same_in_both_units(unit: Any, make_exercise: Make) -> None:
    fields = 'convention = "standard"\nslip = "degrees_as_radians"'
    exercise = make_exercise(one_part("find_slip", fields, SPATIAL_RRR))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given[0][1] == "90 rad"
    right = [["R", "90deg", "0", "theta1"], *given[1:]]
    assert full_marks(graded(exercise, {"marked": "1.alpha", "table": table(right)}, unit))
    back = graded(exercise, {"marked": "1.alpha", "table": table(given)}, unit)
    assert back.points == 3
    assert all_codes(back) == {"degrees_as_radians"}


ROWS = 'convention = "standard"\nslip = "row_order"\nseed = 3'


@pytest.mark.parametrize(
    ("marked", "is_right"),
    [
        (["1", "2"], True),
        (["1.a", "1.alpha", "1.theta", "2.a", "2.alpha", "2.theta"], True),
        (["1", "2", "3"], False),
        ("1", False),
        (["1.a", "2.a"], False),
    ],
)
def test_rows_are_marked_whole_or_by_their_cells(
    marked: object, is_right: bool, make_exercise: Make
) -> None:
    exercise = make_exercise(one_part("find_slip", ROWS, SPATIAL_RRR))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given == [
        ["L1", "0", "0", "theta2"],
        ["R", "90deg", "0", "theta1"],
        ["L2", "0", "0", "theta3"],
    ]
    report = graded(exercise, {"marked": marked})
    assert report.points == (3 if is_right else 0)


def test_an_offset_that_neighbours_share_may_be_marked_in_each(make_exercise: Make) -> None:
    # The three axes of a planar arm are parallel: only the sum of d1, d2 and d3 counts.
    setting = """
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["l1", "0", "0", "q1"], ["l2", "90deg", "h", "q2"]]
[symbols]
h = { kind = "length", description = "height" }
l1 = { kind = "length", description = "a length" }
l2 = { kind = "length", description = "a length" }
"""
    fields = 'convention = "standard"\nslip = "distance_left_out"\nseed = 2'
    exercise = make_exercise(one_part("find_slip", fields, setting))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given[1][2] == "0"
    for marked, points in (("2.d", 3), ("1.d", 3), (["1.d", "2.d"], 0), ("1.a", 0)):
        assert graded(exercise, {"marked": marked}).points == points


def test_writing_never_earns_less_than_leaving_empty(scara: Exercise) -> None:
    answers: list[dict[str, object]] = [
        {"marked": marked, "table": rows and table(rows)}
        for marked in (None, "1.a", "2.alpha")
        for rows in (None, GIVEN, RIGHT)
    ]
    points = {str(answer): found(scara, answer).points for answer in answers}
    for answer in answers:
        for name in answer:
            assert points[str({**answer, name: None})] <= points[str(answer)]


@pytest.mark.parametrize(
    "answer",
    [
        7,
        [1],
        {"rows": 5},
        {"marked": "2.alpha", "rows": []},
        {"marked": "2.alpha", "cells": []},
        True,
        {"table": 7},
    ],
)
def test_another_shape_is_refused(answer: object, scara: Exercise) -> None:
    report = found(scara, answer)
    assert report.verdict is Verdict.UNREADABLE
    assert [message.code for message in report.feedback] == ["wrong_shape"]


def test_an_unreadable_table_does_not_lose_the_mark(scara: Exercise) -> None:
    report = found(scara, {"marked": "2.alpha", "table": 7})
    assert report.points == 4
    assert all_codes(report) == {"wrong_shape"}


def test_a_table_alone_is_the_mended_one(scara: Exercise) -> None:
    pasted = "\n".join(", ".join(row) for row in RIGHT)
    for answer in (table(RIGHT), pasted, {"table": pasted}):
        assert found(scara, answer).points == 4
    assert full_marks(found(scara, f"marked: 2.alpha\n{pasted}"))


@pytest.mark.parametrize(
    "answer", ["", {}, {"marked": "", "table": None}, {"marked": []}, {"rows": []}]
)
def test_an_empty_answer_is_missing(answer: object, scara: Exercise) -> None:
    assert found(scara, answer).verdict is Verdict.MISSING


def test_the_parts_of_a_slip_cannot_be_counted_by_rows(make_exercise: Make) -> None:
    fields = 'convention = "standard"\nmarking = "rows"'
    with pytest.raises(CatalogueError, match="each worth half"):
        make_exercise(one_part("find_slip", fields, SPATIAL_RRR))


# --- Rows that an exercise gives earn nothing and cannot be changed

OWN = [["l2", "0", "0", "q3"], ["l3", "0", "0", "0"]]
GIVEN_ROWS = [["0", "0", "0", "q1"], ["l1", "0", "0", "q2"]]
EMPTY = ["", "", "", ""]


def graded_given_rows(
    table: object, exercise: str = "planar-rrr-faded", unit: str = "radians"
) -> PartReport:
    submission = Submission({"table": table}, "degrees" if unit == "degrees" else "radians")
    report = grade(shipped_exercises()[exercise], submission)
    return report.parts[0]


def codes_of_given_rows(part: PartReport) -> list[str]:
    return [each.code for each in part.feedback]


@pytest.mark.parametrize(
    "table",
    [
        OWN,
        [*GIVEN_ROWS, *OWN],
        [EMPTY, EMPTY, *OWN],
        [["0", "", "", "q1"], EMPTY, *OWN],
        [GIVEN_ROWS[1], *OWN],
        "a, alpha, d, theta\nl2, 0, 0, q3\nl3, 0, 0, 0",
        "theta, d, a, alpha\nq1, 0, 0, 0\nq2, 0, l1, 0\nq3, 0, l2, 0\n0, 0, l3, 0",
    ],
)
def test_given_rows_may_be_left_out(table: object) -> None:
    part = graded_given_rows(table)
    assert (part.points, part.verdict, codes_of_given_rows(part)) == (4, Verdict.CORRECT, [])


def test_given_rows_earn_nothing() -> None:
    part = graded_given_rows([*GIVEN_ROWS, EMPTY, EMPTY])
    assert part.points == 0
    assert [row.max_points for row in part.rows] == [0, 0, 2, 2]
    assert (
        graded_given_rows([*GIVEN_ROWS, OWN[0], EMPTY]).points
        == graded_given_rows([OWN[0], EMPTY]).points
        == 2
    )
    assert (
        graded_given_rows([GIVEN_ROWS[1], OWN[0]]).points == graded_given_rows([OWN[0]]).points == 2
    )


def test_a_changed_given_row_is_graded_as_it_is_given() -> None:
    part = graded_given_rows([["0", "0", "0", "q1"], ["l2", "0", "0", "q2"], *OWN])
    assert (part.points, codes_of_given_rows(part)) == (4, ["given_row_changed"])
    assert part.feedback[0].message.startswith("Row 2 is given,")


def test_a_given_row_between_others() -> None:
    own = [["a2", "180deg", "0", "theta2"], ["0", "0", "d4", "theta4"]]
    assert graded_given_rows(own, "scara-faded").points == 4
    assert graded_given_rows([own[0]], "scara-faded").points < 4
    whole = [["a1", "0", "0", "theta1"], own[0], ["0", "0", "d3", "0"], own[1]]
    assert codes_of_given_rows(graded_given_rows(whole, "scara-faded", "degrees")) == []


def test_a_slip_costs_a_share_of_the_other_rows() -> None:
    part = graded_given_rows([["l3", "0", "0", "q3"], OWN[1]])
    assert part.rows[2].points < part.rows[2].max_points
    assert part.points == 4 - (part.rows[2].max_points - part.rows[2].points)


def test_too_many_rows_are_graded_as_they_are() -> None:
    part = graded_given_rows([*GIVEN_ROWS, *OWN, ["l3", "0", "0", "0"]])
    assert "extra_row" in codes_of_given_rows(part)
    assert part.points < 4
