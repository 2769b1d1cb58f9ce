"""A textbook's table, pasted in any format, gets full marks."""

from collections.abc import Callable, Mapping, Sequence

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Verdict

from tests.grading.support.robots import ROBOTS, RRRP, Robot, in_pi, with_unit
from tests.grading.support.submitting import cell, codes, full_marks, handed_in, not_correct, part
from tests.grading.support.worth import about, points
from tests.pasting.writers import FORMATS, TABLES
from tests.together import together

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
