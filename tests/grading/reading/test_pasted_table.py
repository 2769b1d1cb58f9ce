"""Test how a pasted table is read."""

from collections.abc import Callable, Mapping, Sequence

import pytest
from dh_grader import grading
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Submission, Verdict
from dh_grader.grading.reading import PastedPreview, preview_pasted
from dh_grader.kinematics import Convention

from tests.grading.support.robots import ROBOTS, RRRP, Robot, in_pi, with_unit
from tests.grading.support.submitting import (
    about,
    cell,
    codes,
    full_marks,
    handed_in,
    not_correct,
    part,
    points,
)
from tests.pasting.writers import FORMATS, TABLES
from tests.together import together

# --- A textbook's table, pasted in any format, gets full marks

HEADERS = ["i", "a", "alpha", "d", "theta"]
SPELLINGS: dict[str, tuple[Callable[[int], str], list[str]]] = {
    "pi": (in_pi, HEADERS),
    "deg": (with_unit, ["#", "a_i", "α_i", "d_i", "θ_i"]),
    "degrees in the header": (str, ["Link", "a", "alpha_deg", "d", "theta_(deg)"]),
    "LaTeX headers": (str, ["$i$", "$a_{i}$", r"$\alpha_{i}[^\circ]$", "$d_{i}$", r"$\theta_{i}$"]),
}


def pasted(exercise: Exercise, text: object, part_id: str = "table") -> PartReport:
    return part(handed_in(exercise, {part_id: text}), part_id)


def rows(robot: Robot, spelling: str) -> list[list[str]]:
    turn, _ = SPELLINGS[spelling]
    return [
        [label, a, turn(int(alpha)), d, theta]
        for label, (a, alpha, d, theta) in zip(robot.labels, robot.rows, strict=True)
    ]


def infos(report: PartReport) -> list[str]:
    assert {message.severity for message in report.feedback} <= {Severity.INFO}
    return [message.code for message in report.feedback]


@pytest.mark.long
@together("robot", ROBOTS)
@together("spelling", SPELLINGS)
@together("name", TABLES)
def test_a_table_with_headers_gets_full_marks(
    name: str, spelling: str, robot: Robot, catalogue: Mapping[str, Exercise]
) -> None:
    text = TABLES[name]([SPELLINGS[spelling][1], *rows(robot, spelling)])
    report = pasted(catalogue[robot.exercise], text)
    assert full_marks(report), report
    assert infos(report) in ([], ["blank_columns"])


@together("robot", ROBOTS)
@together("name", FORMATS)
def test_a_table_without_headers_gets_full_marks(
    name: str, robot: Robot, catalogue: Mapping[str, Exercise]
) -> None:
    for text_rows in (rows(robot, "pi"), [row[1:] for row in rows(robot, "deg")]):
        report = pasted(catalogue[robot.exercise], FORMATS[name](text_rows))
        assert full_marks(report), report
        assert "column_order" in infos(report)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
def test_columns_and_rows_may_be_in_any_order(
    robot: Robot, catalogue: Mapping[str, Exercise]
) -> None:
    lines = [[row[4], row[0], row[3], row[2], row[1]] for row in reversed(rows(robot, "pi"))]
    text = TABLES["CSV"]([["q", "joint", "offset", "link twist", "link length"], *lines])
    report = pasted(catalogue[robot.exercise], text)
    assert full_marks(report), report
    assert infos(report) == ["rows_reordered"]


def table_of(lines: Sequence[str]) -> str:
    return "\n".join(["a, alpha, d, theta", *lines])


RRRP_LINES = ["l2, 0, l1, q1*", "l3, 180deg, 0, q2*", "0, 0, l4, q3*", "0, 0, q4*, 0"]


def test_spans_count_in_the_pasted_text(catalogue: Mapping[str, Exercise]) -> None:
    text = table_of([*RRRP_LINES[:2], "0, 0, l4 + foo, q3*", "0, , q4, 0"])
    report = pasted(catalogue[RRRP.exercise], text)
    assert not_correct(report) == {("3", "d"): Verdict.UNREADABLE, ("4", "alpha"): Verdict.MISSING}
    [unknown] = cell(report, "3", "d").feedback
    assert unknown.span is not None
    assert text[slice(*unknown.span)] == "foo"


def test_a_row_of_the_wrong_length_affects_only_itself(catalogue: Mapping[str, Exercise]) -> None:
    text = table_of([*RRRP_LINES[:3], "0, q4, 0"])
    report = pasted(catalogue[RRRP.exercise], text)
    assert [row.points for row in report.rows] == about(points(RRRP, [3] * 4))
    [feedback] = cell(report, "4", "a").feedback
    assert feedback.code == "row_length"
    assert feedback.span is not None
    assert text[slice(*feedback.span)] == "0, q4, 0"


@pytest.mark.parametrize(
    "above",
    [
        "Ada, Lovelace, 12345, HW 3",
        "Name: Ada, 12345\nHomework, 3, , ",
        "x, sentence, with, commas",
    ],
)
def test_names_above_the_headers_are_no_rows(above: str, catalogue: Mapping[str, Exercise]) -> None:
    text = f"{above}\n{table_of(RRRP_LINES)}"
    report = pasted(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert "text_left_aside" in {each.code for each in report.feedback}


def test_a_row_of_values_above_the_headers_is_kept(catalogue: Mapping[str, Exercise]) -> None:
    text = f"{RRRP_LINES[0]}\n{table_of(RRRP_LINES[1:])}"
    report = pasted(catalogue[RRRP.exercise], text)
    assert not full_marks(report)
    assert "text_left_aside" not in {each.code for each in report.feedback}


def test_a_unit_above_the_headers_is_not_lost(catalogue: Mapping[str, Exercise]) -> None:
    text = f"Ada, angles in degrees, 123, x\n{table_of(RRRP_LINES)}"
    report = pasted(catalogue[RRRP.exercise], text)
    assert [each.code for each in report.feedback] == ["text_around"]


def test_a_comma_that_may_separate_thousands_is_named_and_affects_only_its_cell(
    catalogue: Mapping[str, Exercise],
) -> None:
    text = "a;alpha;d;theta\nl2;0;l1;q1\nl3;3,142;0;q2\n0;0;l4;q3\n0;0;q4;0"
    report = pasted(catalogue[RRRP.exercise], text)
    assert not_correct(report) == {("2", "alpha"): Verdict.UNREADABLE}
    assert codes(cell(report, "2", "alpha")) == ["decimal_comma"]


def test_the_rows_of_an_object_may_be_pasted(catalogue: Mapping[str, Exercise]) -> None:
    answer = {"rows": table_of(RRRP_LINES), "convention": "standard"}
    assert full_marks(pasted(catalogue[RRRP.exercise], answer))


@pytest.mark.parametrize("text", ["", "  \n "])
def test_an_empty_paste_is_missing(text: str, catalogue: Mapping[str, Exercise]) -> None:
    assert pasted(catalogue[RRRP.exercise], text).verdict is Verdict.MISSING


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        ("q1", "wrong_shape", "q1"),
        ("1, 2, 3\n4, 5, 6", "wrong_shape", "1, 2, 3"),
        ("x, 1, 2, 3, 4", "wrong_shape", "x, 1, 2, 3, 4"),
        ("foo, alpha, d, theta\n1, 2, 3, 4", "unknown_header", "foo"),
        ("Weite, Kipp, b, c\n1, 2, 3, 4", "unknown_header", "Weite, Kipp, b, c"),
        ("a, r, d, theta\n1, 2, 3, 4", "two_headers", "r"),
        (
            "a, alpha, d, theta,, a, alpha, d, theta\n0, 0, 0, 1,, 0, 0, 0, 2",
            "two_tables",
            "a, alpha, d, theta,, a, alpha, d, theta",
        ),
        ("a, alpha, theta\n1, 2, 3", "missing_header", "a, alpha, theta"),
        ("a, alpha, d, theta", "no_rows", "a, alpha, d, theta"),
        ("a, alpha, d, theta (m)\n0, 0, 0, 0", "header_unit", "theta (m)"),
        ("a (deg), alpha, d, theta\n0, 0, 0, 0", "header_unit", "a (deg)"),
        ("i, a, alpha, d, theta\n1, 0, 0, 0, 0\n1, 0, 0, 0, 0", "duplicate_row", "1"),
        ("a,alpha,d,theta\n" + "0,0,0,0\n" * 13, "too_many_rows", None),
        ("0,0,0,0\n" * 13, "too_many_rows", None),
        ("[[0, 0, 0, 0]", "unbalanced_bracket", "["),
        ("<table><tr><td colspan=2>a", "spanning_cell", "colspan=2"),
    ],
)
def test_a_text_without_a_table_is_unreadable_as_a_whole(
    text: str, code: str, marked: str | None, catalogue: Mapping[str, Exercise]
) -> None:
    report = pasted(catalogue[RRRP.exercise], text)
    assert (report.verdict, report.points, report.rows) == (Verdict.UNREADABLE, 0.0, ())
    [feedback] = report.feedback
    assert (feedback.code, feedback.severity) == (code, Severity.ERROR)
    if marked is not None:
        assert feedback.span is not None
        assert text[slice(*feedback.span)] == marked


def test_an_unknown_header_is_named(catalogue: Mapping[str, Exercise]) -> None:
    report = pasted(catalogue[RRRP.exercise], "foo, alpha, d, bar\n1, 2, 3, 4")
    assert "`foo`, `bar`" in report.feedback[0].message


@pytest.mark.parametrize("extra", ["type", "Joint variable", "comment"])
def test_a_column_of_another_quantity_is_ignored(
    extra: str, catalogue: Mapping[str, Exercise]
) -> None:
    lines = [f"{line}, R" for line in RRRP_LINES]
    text = "\n".join([f"a, alpha, d, theta, {extra}", *lines])
    report = pasted(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert infos(report) == ["column_left_aside"]


@pytest.mark.parametrize(
    ("labels", "notes"),
    [
        (["1", "2", "3", "4"], []),
        (["Link 1", "Link 2", "Link 3", "Link 4"], []),
        (["0→1", "1→2", "2→3", "3→4"], []),
        (["4", "5", "6", "7"], []),
        (["", "", "", ""], []),
        (["arm", "2", "3", "4"], ["row_labels"]),
    ],
)
def test_labels(labels: list[str], notes: list[str], catalogue: Mapping[str, Exercise]) -> None:
    lines = [f"{label}, {line}" for label, line in zip(labels, RRRP_LINES, strict=True)]
    text = "\n".join(["joint, a, alpha, d, theta", *lines])
    report = pasted(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert infos(report) == notes


@pytest.mark.long
@together(
    ("header", "label"),
    [
        ("Glied", "Glied {}"), ("Gelenk", "{}. Gelenk"), ("Zeile", "Zeile {}"),
        ("Glied-Nr.", "Glied Nr. {}"), ("Articulation", "Articulation {}"),
        ("N° d'articulation", "articulation n° {}"), ("Segment", "Segment {}"),
        ("Liaison", "Liaison {}"), ("Corps", "Corps {}"), ("Articulación", "Articulación {}"),
        ("Eslabón", "Eslabón {}"), ("连杆", "连杆 {}"), ("关节", "关节{}"),
    ],
)  # fmt: skip
def test_rows_may_have_labels_in_the_language_of_the_student(
    header: str, label: str, catalogue: Mapping[str, Exercise]
) -> None:
    rows = [(label.format(i + 1), *line.split(", ")) for i, line in enumerate(RRRP_LINES)]
    head = (header, "a", "alpha", "d", "theta")
    exercise = catalogue[RRRP.exercise]
    for separator in (", ", "\t", ";"):
        in_order, turned = (
            "\n".join(map(separator.join, (head, *each))) for each in (rows, rows[::-1])
        )
        assert full_marks(pasted(exercise, in_order))
        assert "row_labels" not in infos(pasted(exercise, in_order))
        report = pasted(exercise, turned)
        assert full_marks(report)
        assert "rows_reordered" in infos(report)


def test_indices_of_headers_do_not_decide_the_convention(
    catalogue: Mapping[str, Exercise],
) -> None:
    text = "\n".join(["a_{i-1}, α_{i-1}, d_i, θ_i", *RRRP_LINES])
    report = pasted(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert infos(report) == ["convention_hint"]


def test_an_empty_row_of_a_table_stays_in_its_place(catalogue: Mapping[str, Exercise]) -> None:
    text = "l2, 0, l1, q1\n, , ,\n0, 0, l4, q3\n0, 0, q4, 0"
    report = part(handed_in(catalogue["rrrp"], {"table": text}), "table")
    verdicts = [row.verdict for row in report.rows]
    assert verdicts[1] is Verdict.MISSING
    assert verdicts[0] is verdicts[2] is verdicts[3] is Verdict.CORRECT


# --- Read column names and units from the comments of a script

CAPTION = r"""\caption{Parameters (mm)}
\begin{tabular}{cccc} a & $\alpha$ & d & $\theta$ \\ 400 & 0 & 0 & $q_1$ \\ 0 & 0 & 0 & $q_2$
\end{tabular}"""
HTML = """<table><caption>lengths in mm</caption>
<tr><th>a</th><th>alpha</th><th>d</th><th>theta</th></tr>
<tr><td>400</td><td>0</td><td>0</td><td>q1</td></tr></table>"""
ROWS = "[q1 400 300 90; q2 0 0 0; q3 0 0 0]"


@pytest.fixture
def arm(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["rrrp"]


def first_row(shown: PastedPreview) -> list[str]:
    return [cell.text for cell in shown.rows[0]]


@pytest.mark.parametrize(
    "comment",
    [
        "% theta [deg], d [mm], a [mm], alpha [deg]",
        "# theta(deg) d(mm) a(mm) alpha(deg)",
        "// theta_deg | d/mm | a/mm | alpha/deg",
    ],
)
def test_a_comment_names_the_columns_and_their_units(comment: str, arm: Exercise) -> None:
    shown = preview_pasted(f"{comment}\nDH = {ROWS};", arm, "table")
    assert first_row(shown) == ["300/1000", "90deg", "400/1000", "q1"]


@pytest.mark.parametrize(
    "text",
    [
        "dh = {(* theta, d, a, alpha *) {q1, l1, l2, 0}, {q2, 0, l3, Pi}, {q3, l4, 0, 0}};",
        "{ /* theta, d, a, alpha */\n  {q1, l1, l2, 0},\n  {q2, 0, l3, Pi},\n  {q3, l4, 0, 0} }",
    ],
)
def test_a_comment_in_brackets_names_the_columns(text: str, arm: Exercise) -> None:
    assert first_row(preview_pasted(text, arm, "table")) == ["l2", "0", "l1", "q1"]


@pytest.mark.parametrize(
    "comment", ["% lengths in mm", "% angles in degrees", "# Winkel in Grad", "% [mm, deg]"]
)
def test_a_unit_without_columns_is_refused(comment: str, arm: Exercise) -> None:
    problem = preview_pasted(f"{comment}\nDH = {ROWS};", arm, "table").problem
    assert problem is not None
    assert problem.code == "text_around"


@pytest.mark.parametrize("comment", ["% angles in rad", "% in m", "% joint 1 turns by 90 deg"])
def test_other_comments_are_ignored(comment: str, arm: Exercise) -> None:
    shown = preview_pasted(f"{comment}\nDH = [0 0 0.4 q1; 0 0 0 q2];", arm, "table")
    assert first_row(shown) == ["0", "0", "0.4", "q1"]


def test_headers_in_the_table_count_more_than_a_comment(arm: Exercise) -> None:
    shown = preview_pasted(
        "#, d (mm), theta, a (mm), alpha (deg)\n1, 400, q1, 300, 90", arm, "table"
    )
    assert first_row(shown) == ["300/1000", "90deg", "400/1000", "q1"]


def test_a_unit_of_the_other_kind_is_refused(arm: Exercise) -> None:
    shown = preview_pasted(f"% theta [mm], d, a, alpha\nDH = {ROWS};", arm, "table")
    assert shown.problem is not None
    assert shown.problem.code == "header_unit"


@pytest.mark.parametrize(
    "text",
    [
        "% all dimensions in mm\nL(1) = Link('d', 135, 'a', 0, 'alpha', 0);",
        "# angles in degrees\nDHRobot([RevoluteDH(d=0.135, alpha=90), RevoluteDH(a=0.4)])",
        "a = [0, 400]  # mm\nalpha = [0, 0]\nd = [135, 0]\ntheta = [q1, q2]",
        CAPTION,
        HTML,
    ],
)
def test_a_unit_in_a_script_or_a_caption_is_refused(text: str, arm: Exercise) -> None:
    problem = preview_pasted(text, arm, "table").problem
    assert problem is not None
    assert problem.code == "text_around"
    graded = part(handed_in(arm, {"table": text}), "table")
    assert graded.verdict is Verdict.UNREADABLE
    assert [message.code for message in graded.feedback] == ["text_around"]


@pytest.mark.parametrize(
    "comment", ["% angles in degrees", "% limits in deg", "% all lengths in metres"]
)
def test_a_script_that_converts_its_angles_is_read(comment: str, arm: Exercise) -> None:
    script = f"{comment}\nL(1) = Link('d', 0.4, 'a', 0, 'alpha', deg2rad(90));"
    assert first_row(preview_pasted(script, arm, "table")) == ["0", "90deg", "0.4", "q1"]


# --- Rows for the base, empty rows at the end and repeated headers cost a right table nothing

ROWS_OF_NO_JOINT_HEADERS = "i, a, alpha, d, theta"
SCARA = ("1, a1, 0, 0, theta1", "2, a2, 180deg, 0, theta2", "3, 0, 0, d3, 0", "4, 0, 0, d4, theta4")


def graded(catalogue: Mapping[str, Exercise], *rows: str, exercise: str = "scara") -> PartReport:
    report = grading.grade(catalogue[exercise], Submission({"table": "\n".join(rows)}))
    return next(part for part in report.parts if part.part == "table")


@pytest.mark.parametrize(
    "base",
    [
        "0, -, -, -, -",
        "0, , , , ",
        "0, Base frame, , , ",
        "Base, , , , ",
        "Basis, -, -, -, -",
        "0, –, –, –, –",
        "0, base, base, base, base",
        "{0}, , , , ",
        "基座, , , , ",
    ],
)
def test_a_row_of_the_base_without_values_costs_nothing(
    base: str, catalogue: Mapping[str, Exercise]
) -> None:
    part = graded(catalogue, ROWS_OF_NO_JOINT_HEADERS, base, *SCARA)
    assert part.points == part.max_points == 8
    assert "text_left_aside" in [message.code for message in part.feedback]


@pytest.mark.parametrize("end", [["5, , , , "], ["5, -, -, -, -"], ["5, , , , ", "6, , , , "]])
def test_empty_numbered_rows_at_the_end_cost_nothing(
    end: list[str], catalogue: Mapping[str, Exercise]
) -> None:
    assert graded(catalogue, ROWS_OF_NO_JOINT_HEADERS, *SCARA, *end).points == 8


def test_a_row_of_dashes_without_labels_costs_nothing(catalogue: Mapping[str, Exercise]) -> None:
    rows = [row.partition(", ")[2] for row in SCARA]
    assert graded(catalogue, "a, alpha, d, theta", "-, -, -, -", *rows).points == 8
    assert graded(catalogue, "-, -, -, -", *rows).points == 8


@pytest.mark.parametrize(
    "rows",
    [
        # A value in the row: it is a row too many.
        ["0, a2, 0, 0, 0", *SCARA],
        [*SCARA, "5, a2, 0, 0, 0"],
        ["0, -, -, -, theta1", *SCARA],
        # The row of a joint is empty, so that there are no rows too many.
        ["0, -, -, -, -", *SCARA[:3]],
        ["1, , , , ", *SCARA[1:]],
        [*SCARA[:3], "4, , , , "],
        # Words that are no name of the base.
        ["5, no, idea, , ", *SCARA],
    ],
)
def test_other_rows_still_cost_points(rows: list[str], catalogue: Mapping[str, Exercise]) -> None:
    assert graded(catalogue, ROWS_OF_NO_JOINT_HEADERS, *rows).points < 8


def test_a_correction_in_the_row_of_the_base_is_not_ignored(
    catalogue: Mapping[str, Exercise],
) -> None:
    part = graded(catalogue, ROWS_OF_NO_JOINT_HEADERS, "0, base: row 2 is wrong, , , ", *SCARA)
    assert part.points < 8


@pytest.mark.parametrize("place", [2, 4, 5])
def test_repeated_headers_cost_nothing(place: int, catalogue: Mapping[str, Exercise]) -> None:
    rows = [ROWS_OF_NO_JOINT_HEADERS, *SCARA]
    part = graded(catalogue, *rows[:place], ROWS_OF_NO_JOINT_HEADERS, *rows[place:])
    assert part.points == 8
    assert "text_left_aside" in [message.code for message in part.feedback]


def test_headers_in_another_order_are_not_repeated_headers(
    catalogue: Mapping[str, Exercise],
) -> None:
    part = graded(
        catalogue, ROWS_OF_NO_JOINT_HEADERS, *SCARA[:2], "i, a, d, alpha, theta", *SCARA[2:]
    )
    assert part.points < 8


def test_a_fixed_first_row_is_before_the_first_joint(catalogue: Mapping[str, Exercise]) -> None:
    assert catalogue["scara"].robot.convention is Convention.STANDARD
    part = graded(catalogue, ROWS_OF_NO_JOINT_HEADERS, "0, 0, 0, 0, 0", *SCARA)
    assert part.points == 8
    [message] = [each.message for each in part.feedback if each.code == "rows_matched"]
    assert "row 1 with the fixed row 0 before the first joint" in message
