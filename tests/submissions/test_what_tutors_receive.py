"""Texts as students hand them in, with lines around the table that are no rows of it."""

from collections.abc import Mapping

import pytest

from service.catalogue import Exercise
from service.grading import PartReport, Submission, grade
from service.submissions.documents import pasted_from

ROWS = (
    ("1", "a1", "0", "0", "theta1"), ("2", "a2", "180°", "0", "theta2"),
    ("3", "0", "0", "d3", "0"), ("4", "0", "0", "d4", "theta4"),
)  # fmt: skip
BLANKS = "\n".join(map(" ".join, ROWS))
UNLABELLED = "\n".join(" ".join(row[1:]) for row in ROWS)
HEAD = ("i", "a", "alpha", "d", "theta")


def separated(sign: str, *around: str, first: str = "") -> str:
    lines = [sign.join(row) for row in (HEAD, *ROWS)]
    return "\n".join([*filter(None, [first]), *lines, *around])


def table(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    return grade(catalogue["scara"], Submission({"table": text})).parts[0]


@pytest.mark.parametrize(
    "text",
    [
        f"{BLANKS}\nz3 and z4 point downwards.",
        f"{BLANKS}\nHans Peter Schmidt Gruppe 7",
        separated(";", "Bemerkung;z2 zeigt nach oben;;;"),
        separated(";", "Hans Schmidt;1234567;;;"),
        separated(",", "Note, that z2, like z3, points down"),
        separated("\t", "Legende\ttheta = Gelenkwinkel"),
        separated("\t", "Name\tAnna\t\t\t1234567"),
        separated("\t", "Hinweis:\td3 ist variabel"),
        f"Hans Peter Schmidt\nMatrikelnummer: 1234567\nAufgabe 3: SCARA\n\n{UNLABELLED}",
        f"Hans Peter Schmidt\n\n{UNLABELLED}",
        f"Hans Schmidt (1234567)\n{UNLABELLED}",
        f"Ines Costa 2345678\n\n{UNLABELLED}",
        f"{UNLABELLED}\nHans Schmidt 1234567",
        separated(",", first="Joint,Link length,Twist,Offset,Angle"),
        separated("\t", first="Gelenk\tLänge\tVerwindung\tVersatz\tDrehwinkel"),
        separated(";").replace("180°", "180,0°").replace("a1;0;", "a1;0.0;"),
    ],
)
def test_lines_around_a_right_table_cost_nothing(
    text: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, text)
    assert report.points == report.max_points, report.feedback


SENTENCES = (
    "This is the answer", "I hope it's right", "Das ist meine Lösung", "Voilà la réponse finale",
    "Esta es la respuesta", "Danke und viele Grüße", "Best regards, Anna Meier", "Page 3 of 4",
    "Hans Peter Schmidt 1234567", "Seite 2 von 3", "第 2 页", "- 3 -", "这是我的 答案 张伟 谢谢",
)  # fmt: skip
POSE = """c123 -s123 0 l1*c1+l2*c12+l3*c123
s123 c123 0 l1*s1+l2*s12+l3*s123
0 0 1 0
0 0 0 1"""


@pytest.mark.parametrize("gap", ["\n", "\n\n"])
@pytest.mark.parametrize("sentence", SENTENCES)
def test_a_sentence_with_as_many_words_as_a_row_has_values_costs_nothing(
    sentence: str, gap: str, catalogue: Mapping[str, Exercise]
) -> None:
    for text in (f"{UNLABELLED}{gap}{sentence}", f"{sentence}{gap}{UNLABELLED}"):
        report = table(catalogue, text)
        assert report.points == report.max_points, report.feedback
    for text in (f"{POSE}{gap}{sentence}", f"{sentence}{gap}{POSE}"):
        pose = grade(catalogue["planar-rrr"], Submission({"pose": text})).parts[1]
        assert pose.points == pose.max_points, pose.feedback
        codes = [
            message.code for row in pose.rows for cell in row.cells for message in cell.feedback
        ]
        assert "text_left_aside" in codes


@pytest.mark.parametrize("last", ["null null null eins", "This is the answer"])
def test_a_row_of_words_is_no_sentence_while_rows_are_missing(
    last: str, catalogue: Mapping[str, Exercise]
) -> None:
    text = "\n".join([*POSE.splitlines()[:3], last])
    pose = grade(catalogue["planar-rrr"], Submission({"pose": text})).parts[1]
    assert [cell.verdict.value for cell in pose.rows[3].cells] == ["unreadable"] * 4


def test_unknown_headers_in_words_are_no_sentence(catalogue: Mapping[str, Exercise]) -> None:
    report = table(catalogue, f"Drehung Versatz Laenge Verdrehung\n{UNLABELLED}")
    assert [message.code for message in report.feedback] == ["unknown_header"]


@pytest.mark.parametrize(
    "text",
    [
        f"{BLANKS}\nAll angles in degrees except where marked",
        separated(";", "all lengths;in mm;;;"),
        separated(";", "the second row; is wrong; it should; be a1;"),
    ],
)
def test_a_line_that_may_change_the_table_is_refused(
    text: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, text)
    assert [each.code for each in report.feedback] == ["text_around"]


def test_units_of_a_second_header_row_count(catalogue: Mapping[str, Exercise]) -> None:
    text = separated(";", first="Joint;Link length;Twist;Offset;Angle")
    text = text.replace("i;a;alpha;d;theta", "i;a_i [m];α_i [deg];d_i [m];θ_i [rad]")
    report = table(catalogue, text.replace("180°", "180"))
    assert report.points == report.max_points, report.feedback


def test_an_unreadable_row_is_no_remark_while_rows_are_missing(
    catalogue: Mapping[str, Exercise],
) -> None:
    text = "\n".join(";".join(row) for row in (HEAD, *ROWS[:3], ("4", "foo", "bar", "baz", "qux")))
    assert [row.verdict.value for row in table(catalogue, text).rows][3] == "unreadable"


@pytest.mark.parametrize("label", ["e", "tool", "Werkzeug", "Tool TCP"])
def test_a_last_row_of_numbers_is_no_remark(label: str, catalogue: Mapping[str, Exercise]) -> None:
    rows = ("i;a;alpha;d;theta", "1;0;0;0;q1", "2;l1;0;0;q2", "3;l2;0;0;q3")
    text = "\n".join([*rows, f"{label};0;0;0;0"])
    [report, *_] = grade(catalogue["planar-rrr"], Submission({"table": text})).parts
    # Only the length of the tool is wrong.
    assert [cell.verdict.value for cell in report.rows[3].cells] == [
        "incorrect", "correct", "correct", "correct",
    ]  # fmt: skip


def test_a_row_with_a_value_too_many_is_not_left_aside(catalogue: Mapping[str, Exercise]) -> None:
    text = "1 0 0 0 q1\n2 l1 0 0 q2\n3 l2 0 0 q3\nTool TCP 0 0 0 0"
    [report, *_] = grade(catalogue["planar-rrr"], Submission({"table": text})).parts
    assert [each.code for each in report.feedback] == ["ambiguous_columns"]


def test_an_unreadable_row_with_a_label_is_no_remark(catalogue: Mapping[str, Exercise]) -> None:
    rows = ("i;a;alpha;d;theta", "1;0;0;0;q1", "2;l1;0;0;q2", "3;l2;0;0;q3", "e;foo;bar;baz;qux")
    [report, *_] = grade(catalogue["planar-rrr"], Submission({"table": "\n".join(rows)})).parts
    assert report.rows[3].verdict.value == "unreadable"


@pytest.mark.parametrize("above", ["% theta d a alpha", "% theta [rad], d [m], a [m], alpha [rad]"])
def test_the_comment_above_a_matrix_in_a_matlab_file_says_the_order(
    above: str, catalogue: Mapping[str, Exercise]
) -> None:
    file = (
        f"% homework 3\nclear all\n{above}\nDH = [theta1 0 a1 0;\n"
        " theta2 0 a2 pi;\n 0 d3 0 0;\n theta4 d4 0 0];\n"
    )
    report = table(catalogue, pasted_from(file, ".m"))
    assert report.points == report.max_points, report.feedback
