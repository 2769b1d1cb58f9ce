"""Texts as students hand them in, with lines around the table that are no rows of it."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Submission, grade
from dh_grader.submissions.documents import UnusableFileError, pasted_from
from dh_grader.submissions.files import read_content

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
        assert "text_left_aside" in [message.code for message in pose.feedback]


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


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize(
    "text",
    [separated(", "), separated("\t", first="Lösung von 王芳").replace("theta", "θ")],
)
def test_utf_16_without_a_byte_order_mark_is_read(
    text: str, encoding: str, catalogue: Mapping[str, Exercise]
) -> None:
    content = read_content(text.replace("\n", "\r\n").encode(encoding), "table.txt")
    report = table(catalogue, str(content.value))
    assert report.points == report.max_points, report.feedback


@pytest.mark.parametrize(
    "data",
    [
        separated(",").encode("utf-16-le")[:-1],
        b"x" + separated(",").encode("utf-16-le"),
        separated(",").encode("utf-32-le"),
        b"a\0b, \0" * 21 + b"0",
        b"\x89PNG\0\1\2\3" + bytes(range(256)),
        # Control characters in the place of letters.
        bytes(letter for sign in range(1, 80) for letter in (sign, 0)),
        "".join(map(chr, range(0x4E00, 0x4E80))).encode("utf-16-le"),
    ],
)
def test_other_files_with_zero_bytes_are_no_text(data: bytes) -> None:
    with pytest.raises(UnusableFileError, match="zero bytes; if it is a text, save it as UTF-8"):
        read_content(data, "table.txt")


LENGTHS = (
    "i;a [mm];alpha [deg];d [mm];theta\n1;0;90;0;q1\n2;431,8;0;0;q2\n3;20,3;-90;150,05;q3\n"
    "4;0;90;431,8;q4\n5;0;-90;0;q5\n6;0;0;0;q6"
)


def lengths(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    return grade(catalogue["puma-560"], Submission({"table": text})).parts[0]


@pytest.mark.parametrize(
    ("typed", "number"),
    [
        ("1.431,8", "1431.8"), ("12.431,8", "12431.8"), ("1.000.431,8", "1000431.8"),
        ("1 431,8", "1431.8"), ("1\u202f431,8", "1431.8"), ("1\u00a0431,8", "1431.8"),
        ("1'431.8", "1431.8"), ("1’431,8", "1431.8"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("sign", [";", "\t"])
def test_a_thousands_separator_is_named(
    typed: str, number: str, sign: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = lengths(catalogue, LENGTHS.replace("431,8;0;0", f"{typed};0;0").replace(";", sign))
    cell = report.rows[1].cells[0]
    assert cell.verdict.value == "unreadable"
    [message] = cell.feedback
    shown = typed.replace("\u202f", " ").replace("\u00a0", " ")
    assert message.message == f"`{shown}` has a thousands separator. Write {number}."
    # Only this cell is unread: the decimal commas of the others are sure.
    assert report.points == report.max_points - 1.25


def test_a_point_between_thousands_beside_decimal_commas_is_refused(
    catalogue: Mapping[str, Exercise],
) -> None:
    report = lengths(catalogue, LENGTHS.replace("431,8;0;0", "1.431;0;0"))
    [message] = report.feedback
    assert message.code == "decimal_comma"
    assert "Write 1431 or 1,431." in message.message


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("\n\n0 0 0 q1\n\nl1 0 q2\nl2 0 0 q3\nl3 0 0 0\n", "table.txt", "Lines 3 and 5 seem"),
        (
            "Anna Meier\n\n| a | d |\n|---|---|\nsee = below\n| 0 | 1 |\n",
            "table.txt",
            "Line 5 is in",
        ),
        (
            "# Homework\n\n| a | d |\n|---|---|\n| 0 | `1 |\nsee = 5\n| 0 | 1 |\n",
            "table.md",
            "Line 6 ",
        ),
        (
            "\nAnna\n\n0, 0, 0, q1\n\nl1, 0, 0, q2\na and d are swapped\n",
            "table.txt",
            "in line 7 may",
        ),
        (
            "\nAnna\n\n0, 0, 0, q1\n\nl1, 0, 0, q2\nlengths in mm\n",
            "table.txt",
            "Line 7 names a unit",
        ),
        ("\n% lengths in mm\n\nDH = [0 0 0 q1; l1 0 0 q2]", "table.txt", "Line 2 names a unit"),
        ("\nDH = [0 0 0 q1;\n\nl1 0 0 (q2]", "table.txt", "Line 4: "),
        ('\n\na,alpha,d,theta\n\n0,0,0,"q1\nl1,0,0,q2', "table.csv", "Line 5: "),
    ],
)
def test_messages_count_lines_as_an_editor_does(
    text: str, name: str, message: str, catalogue: Mapping[str, Exercise]
) -> None:
    content = read_content(text.encode(), name)
    report = grade(catalogue["planar-rrr"], Submission({"table": str(content.value)})).parts[0]
    [found] = report.feedback
    assert message in found.message


def test_remarks_on_a_matrix_are_at_no_entry(catalogue: Mapping[str, Exercise]) -> None:
    report = grade(catalogue["planar-rrr"], Submission({"pose": f"My pose\n{POSE}"})).parts[1]
    codes = {message.code for message in report.feedback}
    assert codes == {"text_left_aside", "blank_columns"}
    assert not [message for row in report.rows for cell in row.cells for message in cell.feedback]


def test_a_cell_with_a_tab_is_quoted_readably(catalogue: Mapping[str, Exercise]) -> None:
    report = table(
        catalogue, "| a | alpha | d\tx | theta |\n| 0 | 0 | 0 | q1 |\n| 1 | 0 | 0 | q2 |"
    )
    [message] = report.feedback
    assert "`d x` (with a tab character in it)" in message.message


@pytest.mark.parametrize(
    "around",
    [
        "HW4 - SCARA arm - John Smith\n================================\n{}\n",
        "{}\n\n--\nJohn Smith\njohn.smith@uni.edu\n",
        "Übung 3\n*****\n{}\n*****\nhttps://example.org/robots\n",
    ],
)
@pytest.mark.parametrize("sign", [" ", ", ", "; ", "\t"])
def test_rules_and_addresses_around_a_table_cost_nothing(
    around: str, sign: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, around.format(separated(sign)))
    assert report.points == report.max_points, report.feedback


SCRIPT = "dh = [[a1, 0, 0, theta1], [a2, pi, 0, theta2], [0, 0, d3, 0], [0, 0, d4, theta4]]"


@pytest.mark.parametrize(
    "docstring",
    [
        '"""Homework 3."""',
        "'''Homework 3.\n\nAuthor: Anna\n'''",
        '#!/usr/bin/env python3\n"""Hi.\n"""',
    ],
)
def test_a_docstring_above_a_table_costs_nothing(
    docstring: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table(catalogue, f"{docstring}\nimport numpy as np\n\n{SCRIPT}\n")
    assert report.points == report.max_points, report.feedback


def test_a_docstring_that_names_a_unit_is_refused(catalogue: Mapping[str, Exercise]) -> None:
    report = table(catalogue, f'"""The arm.\n\nAll lengths in mm.\n"""\n{SCRIPT}\n')
    [message] = report.feedback
    assert message.code == "text_around"
    assert message.message.startswith("Line 3 names a unit")
