"""Test hand-ins as tutors receive them."""

import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

import pytest
import xlsxwriter
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.formats import report_format
from dh_grader.formats.graded import GradedSubmission, GradingTerms, Setting, graded
from dh_grader.formats.worksheets import grade_of
from dh_grader.grading import PartReport, Submission, grade
from dh_grader.submissions import of_one
from dh_grader.submissions.documents import UnusableFileError, pasted_from
from dh_grader.submissions.files import all_handed_in, read_content
from rich.console import Console

from tests.submissions import office_documents as made
from tests.submissions.test_office_files import RIGHT, RRR, grade_files

# --- Texts as students hand them in, with lines around the table that are no rows of it

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


# --- An answer of which hardly anything was read gets no points, and a person gets the reason

HEADERS: Final = ["i", "a", "alpha", "d", "theta"]
TEMPLATE: Final[made.Rows] = [HEADERS, *([str(i), "", "", "", ""] for i in range(1, 5))]
HALF: Final[made.Rows] = [RIGHT[0], *RIGHT[1:3], [""] * 4, [""] * 4]
ZEROS: Final[made.Rows] = [RIGHT[0], *[[0, 0, 0, 0]] * 4]
PHOTO: Final = {"IMG_1.jpg": b"\xff\xd8\xff\0"}
SCAN: Final = {"scan.pdf": b"%PDF-1.4 \0"}


def csv(rows: made.Rows) -> bytes:
    return "\n".join(",".join(map(str, row)) for row in rows).encode()


def web_page(rows: made.Rows) -> bytes:
    lines = ("".join(f"<td>{cell}</td>" for cell in row) for row in rows)
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>".encode()


def drawn(rows: made.Rows, *, box: bool = False) -> bytes:
    """Return a workbook with a picture or a text box in its sheet."""
    written = io.BytesIO()
    book = xlsxwriter.Workbook(written, {"in_memory": True})
    sheet = book.add_worksheet()
    for i, row in enumerate(rows):
        sheet.write_row(i, 0, ["" if cell == "" else cell for cell in row])
    if box:
        sheet.insert_textbox("G2", csv(RIGHT).decode())
    else:
        sheet.insert_image("G2", "x.png", {"image_data": io.BytesIO(PNG)})
    book.close()
    return written.getvalue()


# One white pixel.
PNG: Final = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de"
    "0000000c4944415408d763f8ffff3f0005fe02fedccc59e70000000049454e44ae426082"
)

UNREAD: Final[dict[str, dict[str, bytes]]] = {
    "a template": {"t.xlsx": made.xlsx(TEMPLATE)},
    "a template of text": {"t.csv": csv(TEMPLATE)},
    "a template in a document": {"t.docx": made.docx_table(TEMPLATE)},
    "a template and a photo": {"t.xlsx": made.xlsx(TEMPLATE)} | PHOTO,
    "a template of text and a scan": {"t.csv": csv(TEMPLATE)} | SCAN,
    "a typed template and a photo": {"onlinetext.html": web_page(TEMPLATE)} | PHOTO,
    "a template with a picture": {"t.xlsx": drawn(TEMPLATE)},
    "a template with a text box": {"t.xlsx": drawn(TEMPLATE, box=True)},
    "words only": {"t.txt": b"I hand my answer in on paper.\n"},
    "half a table and a photo": {"t.xlsx": made.xlsx(HALF)} | PHOTO,
    "half a table with a picture": {"t.xlsx": drawn(HALF)},
    "half a table with a text box": {"t.xlsx": drawn(HALF, box=True)},
    "zeros and a photo": {"t.xlsx": made.xlsx(ZEROS)} | PHOTO,
    "a photo": PHOTO,
}  # fmt: skip


@pytest.mark.parametrize("case", UNREAD)
def test_what_was_not_read_is_left_to_a_person_in_every_format(tmp_path: Path, case: str) -> None:
    found = grade_files(tmp_path, UNREAD[case])
    assert not found.is_complete
    [reason] = found.problems
    grade = grade_of(found, "")
    assert (grade.share, grade.reasons) == (None, (reason,))
    # The file of points, the gradebook, and JSON.
    assert written("csv", found).splitlines()[1].split(",")[1] == ""
    assert written("gradebook", found).splitlines()[1].split(",")[1] == ""
    [entry] = json.loads(written("json", found))
    assert entry["error"]
    for name in PHOTO | SCAN:
        assert (name in str(reason)) is (name in UNREAD[case])


@pytest.mark.parametrize("level", FeedbackLevel)
def test_the_level_of_feedback_does_not_decide_who_grades(
    tmp_path: Path, level: FeedbackLevel
) -> None:
    for case in ("a template", "half a table and a photo", "zeros and a photo"):
        folder = tmp_path / case / "class" / "Ada_1_assignsubmission_file"
        folder.mkdir(parents=True)
        for name, content in UNREAD[case].items():
            (folder / name).write_bytes(content)
        [handed] = all_handed_in([folder.parent])
        found = graded(handed, GradingTerms(of_one(RRR, "table"), 0.8, level))
        assert not found.is_complete


def written(name: str, *submissions: GradedSubmission) -> str:
    console = Console(file=io.StringIO(), width=100)
    setting = Setting((submissions[0].files[0].exercise,), console, datetime.now(UTC))
    return b"".join(report_format(name).pieces(submissions, setting)).decode()


READ: Final[dict[str, tuple[dict[str, bytes], float]]] = {
    # Nothing else was handed in, so that what is missing is missing.
    "half a table": ({"t.xlsx": made.xlsx(HALF)}, 3.0),
    "zeros": ({"t.xlsx": made.xlsx(ZEROS)}, 0.0),
    "a right table and a photo": ({"t.xlsx": made.xlsx(RIGHT)} | PHOTO, 8.0),
    "a right table with a picture": ({"t.xlsx": drawn(RIGHT)}, 8.0),
    "a right table and a damaged one": ({"t.csv": csv(RIGHT), "u.docx": b"PK\3\4"}, 8.0),
}  # fmt: skip


@pytest.mark.parametrize("case", READ)
def test_what_was_read_counts_and_files_beside_it_are_named(tmp_path: Path, case: str) -> None:
    files, points = READ[case]
    found = grade_files(tmp_path, files)
    assert (found.points, found.is_complete, found.problems) == (points, True, ())
    others = [name for name in files if not name.startswith("t.")]
    assert [sentence.split(" ")[0] for sentence in found.beside] == others
    [entry] = json.loads(written("json", found))
    assert entry.get("unread", []) == [str(each) for each in found.beside]
    assert grade_of(found, "").has_unread_files is bool(others)


def test_an_empty_file_for_one_of_several_parts_is_left_to_a_person(tmp_path: Path) -> None:
    files = {"table.csv": csv(RIGHT), "pose.csv": b", , , \n, , , \n, , , \n, , , \n"}
    found = in_all_parts(tmp_path, files)
    assert not found.is_complete
    assert "pose.csv" in found.problems[0]


def in_all_parts(folder: Path, files: dict[str, bytes]) -> Any:
    student = folder / "class" / "Ada_1_assignsubmission_file"
    student.mkdir(parents=True)
    for name, content in files.items():
        (student / name).write_bytes(content)
    [handed] = all_handed_in([folder / "class"])
    return graded(handed, GradingTerms(of_one(RRR, None), 0.8))


def test_a_part_without_a_file_is_missing(tmp_path: Path) -> None:
    found = in_all_parts(tmp_path, {"table.csv": csv(RIGHT)})
    assert (found.is_complete, found.problems) == (True, ())


def formula(value: str) -> bytes:
    rows: Sequence[Sequence[str | float]] = [*RIGHT[:2], ["l1", value, 0, "q2"], *RIGHT[3:]]
    return csv(rows)


@pytest.mark.parametrize(
    "value",
    [
        "#NAME?",
        "#REF!",
        "#DIV/0!",
        "#VALUE!",
        "#NUM!",
        "#N/A",
        "#NULL!",
        "#SPILL!",
        "Err:508",
        "#BEZUG!",
        "#WERT!",
        "#NV",
        "#¿NOMBRE?",
        "#¡REF!",
        "#NOM?",
    ],
)
def test_a_formula_that_gave_no_value_is_not_wrong(tmp_path: Path, value: str) -> None:
    found = grade_files(tmp_path, {"t.csv": formula(value)})
    assert not found.is_complete
    [reason] = found.problems
    assert reason == f"t.csv has a formula that gave no value ({value}), so grade it by hand"


def test_a_failed_formula_of_a_workbook_is_not_wrong(tmp_path: Path) -> None:
    rows: made.Rows = [*RIGHT[:2], ["l1", "#NAME?", 0, "q2"], *RIGHT[3:]]
    found = grade_files(tmp_path, {"t.xlsx": made.xlsx(rows)})
    assert "#NAME?" in found.problems[0]


@pytest.mark.parametrize("name", ["t.exe", "t.bin", "t.rar", "t.7z", "t.xlsb"])
def test_a_file_of_an_unknown_kind_is_named_by_its_kind(tmp_path: Path, name: str) -> None:
    found = grade_files(tmp_path, {name: b"MZ\x90\0\3\0"})
    [reason] = found.problems
    assert f".{name.partition('.')[2]}" in reason
    assert "this program" in reason


@pytest.mark.parametrize("name", ["table.xlsm", "table.docm"])
def test_a_file_with_macros_is_read_without_them(tmp_path: Path, name: str) -> None:
    make = made.xlsx if name.endswith(".xlsm") else made.docx_table
    content = io.BytesIO(make(RIGHT))
    with zipfile.ZipFile(content, "a") as archive:
        archive.writestr(f"{'xl' if 'xls' in name else 'word'}/vbaProject.bin", b"\0macro")
    found = grade_files(tmp_path, {name: content.getvalue()})
    assert (found.points, found.problems) == (8, ())
