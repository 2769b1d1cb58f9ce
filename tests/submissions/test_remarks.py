"""A sentence beside a table that may change its meaning; nobody but a person can apply it."""

import io
import json
import tomllib
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import docx
import openpyxl
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.formats.graded import GradedFile, GradingTerms, graded
from dh_grader.grading import Submission, grade
from dh_grader.submissions import of_one
from dh_grader.submissions.documents import changing_remark
from dh_grader.submissions.files import all_handed_in
from odf.office import Annotation
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import Table, TableCell, TableRow
from odf.text import P

from tests.submissions import office_documents as office

HEAD = ("a", "alpha", "d", "theta")
DEGREES = (
    HEAD, ("a1", "0", "0", "theta1"), ("a2", "180", "0", "theta2"), ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
)  # fmt: skip
RADIANS = tuple(tuple(cell.replace("180", "pi") for cell in row) for row in DEGREES)

Rows = tuple[tuple[str, ...], ...]


def markdown(rows: Rows, said: str) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|---|---|---|---|", *lines[1:], "", said, ""])


def latex(rows: Rows, said: str) -> str:
    body = " \\\\\n".join(" & ".join(row) for row in rows)
    return f"% {said}\n\\begin{{tabular}}{{cccc}}\n{body}\n\\end{{tabular}}\nName\n"


def web_page(rows: Rows, said: str) -> str:
    cells = "".join("<tr><td>" + "</td><td>".join(row) + "</td></tr>" for row in rows)
    return f"<p>Hello</p><table>{cells}</table><p>{said}</p>"


def notebook(rows: Rows, said: str) -> str:
    cells = [
        {"cell_type": "markdown", "metadata": {}, "source": [text]}
        for text in (said, markdown(rows, ""))
    ]
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


def rich_text(rows: Rows, said: str) -> str:
    cells = "".join("".join(rf"\intbl {cell}\cell " for cell in row) + r"\row " for row in rows)
    return rf"{{\rtf1\ansi {said}\par {cells}}}"


def word(rows: Rows, said: str) -> bytes:
    document = docx.Document()
    document.add_paragraph(said)
    table = document.add_table(rows=0, cols=4)
    for row in rows:
        for cell, text in zip(table.add_row().cells, row, strict=True):
            cell.text = text
    return saved(document)


def workbook(rows: Rows, said: str) -> bytes:
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.active["G3"] = said
    return saved(book)


def below(rows: Rows, said: str) -> bytes:
    book = openpyxl.Workbook()
    for row in (*rows, (), (said,)):
        book.active.append(row)
    return saved(book)


def saved(document: object) -> bytes:
    content = io.BytesIO()
    document.save(content)  # type: ignore[attr-defined]
    return content.getvalue()


WRITERS: Mapping[str, Callable[[Rows, str], str | bytes]] = {
    "table.md": markdown, "table.tex": latex, "table.html": web_page, "table.ipynb": notebook,
    "table.rtf": rich_text, "table.docx": word, "table.xlsx": workbook, "below.xlsx": below,
}  # fmt: skip


def problem(folder: Path, scara: Exercise, name: str, rows: Rows, said: str) -> tuple[str, float]:
    """Return the problem of a file with a sentence beside the table, and its points."""
    content = WRITERS[name](rows, said)
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    [handed] = all_handed_in([file])
    found = graded(handed, GradingTerms(of_one(scara, "table"), 0.8))
    return "; ".join(found.problems), found.points


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize(
    "said",
    [
        "All angles are in degrees.", "Alle Winkel in Grad.", "a and d are swapped",
        "Sorry, row 4 is wrong.", "Korrektur: in Zeile 4 muss d = d4 stehen.",
    ],
)  # fmt: skip
def test_a_sentence_that_may_change_the_table_is_left_to_a_person(
    name: str,
    said: str,
    tmp_path: Path,
    catalogue: Mapping[str, Exercise],
) -> None:
    found, _ = problem(tmp_path, catalogue["scara"], name, DEGREES, said)
    assert "grade it by hand" in found
    assert said in found


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize(
    "said",
    [
        "DH table of the SCARA robot", "Anna Schmidt, Matrikelnummer 1234567",
        "The angles of the joints are variable.", "Lengths in m, angles in rad",
        "All angles are in degrees.", "The robot has four degrees of freedom.",
        "The z axis is turned by 180 degrees.", "Each row of the table must be filled in.",
        "The table should be in the standard convention.", "Inverse kinematics of the SCARA",
        "The joint variables theta1 and theta2 must be named.",
    ],
)  # fmt: skip
def test_other_prose_changes_nothing(
    name: str,
    said: str,
    tmp_path: Path,
    catalogue: Mapping[str, Exercise],
) -> None:
    assert problem(tmp_path, catalogue["scara"], name, RADIANS, said) == ("", 8)


TABLE = "i, a, alpha, d, theta\n1, 0.3, {alpha}, 0, q1\n2, 0.2, 0, 0, q2\n"


@pytest.mark.parametrize(
    ("table", "said", "unit", "changes"),
    [
        (TABLE.format(alpha="90"), "angles in degrees", "m", True),
        (TABLE.format(alpha="pi/2"), "angles in degrees", "m", False),
        (TABLE.format(alpha="1.5708"), "Lengths in m, angles in rad", "m", False),
        (TABLE.format(alpha="0"), "lengths in metres", "m", False),
        (TABLE.format(alpha="0"), "lengths in centimetres", "m", True),
        (TABLE.format(alpha="0"), "lengths in centimetres", None, True),
        (TABLE.format(alpha="90").replace("alpha", "alpha [deg]"), "in degrees", "m", False),
        ("0, 90, 0, q1\n0.2, 0, 0, q2", "in degrees", "m", True),
        ("0, pi/2, 0, q1\n0.2, 0, 0, q2", "in degrees", "m", False),
        ("[cos(q1), 0; 0, 1]", "in degrees", "m", False),
        ("l1, 0, 0, q1 + 90\n0, 0, 0, q2", "角度的单位是度。", "m", True),
        ("l1, 90°, 0, q1\n0, 0, 0, q2", "Les angles sont en degrés.", "m", False),
    ],
)
def test_a_unit_concerns_numbers_without_a_unit(
    table: str, said: str, unit: str | None, changes: bool
) -> None:
    assert bool(changing_remark(table, [said], unit)) is changes


@pytest.mark.parametrize("remark", ["a and d are swapped", "Row 4 is wrong.", "第4行写错了"])
@pytest.mark.parametrize(
    "text", ["{remark}\n\n{table}", "{table}\n\n{remark}", "# {remark}\nDH = [{rows}]"]
)
def test_a_correction_in_a_pasted_text_is_refused(
    remark: str, text: str, catalogue: Mapping[str, Exercise]
) -> None:
    table = "\n".join(", ".join(row) for row in RADIANS)
    rows = ", ".join(f"[{', '.join(row)}]" for row in RADIANS[1:])
    answer = text.format(remark=remark, table=table, rows=rows)
    report = grade(catalogue["scara"], Submission({"table": answer})).parts[0]
    assert "text_around" in [each.code for each in report.feedback]


# --- Many sentences: each that changes the table is found, and no other ---

SCARA = (
    HEAD, ("a1", "0", "0", "θ1"), ("a2", "180°", "0", "θ2"), ("0", "0", "d3", "0"),
    ("0", "0", "d4", "θ4"),
)  # fmt: skip
SENTENCES = tomllib.loads((Path(__file__).parent / "remarks.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("key", "changes"), [("changes", True), ("harmless", False)])
def test_sentences_around_a_table(key: str, changes: bool) -> None:
    table = "\n".join("\t".join(row) for row in SCARA)
    wrong = [s for s in SENTENCES[key] if bool(changing_remark(table, [s], "m")) is not changes]
    assert wrong == []
    assert len(SENTENCES[key]) >= 100


@pytest.mark.parametrize(("key", "changes"), [("cell_changes", True), ("cell_harmless", False)])
def test_remarks_on_a_cell(key: str, changes: bool) -> None:
    table = "\n".join("\t".join(row) for row in SCARA)
    found = {s: changing_remark(table, [], "m", beside=[s]) for s in SENTENCES[key]}
    assert [s for s, said in found.items() if bool(said) is not changes] == []


@pytest.mark.parametrize(
    ("said", "changes"),
    [
        ("α2 = 180°", False), ("α2 = π, because z2 points down", False), ("α2 = 0", True),
        ("In row 2, alpha is 0.", True), ("In row 2, alpha is 180 degrees.", False),
        ("d4 is negative", True), ("a1 is positive", False), ("θ3 = 0", False),
        ("In der letzten Zeile ist a = 0", False), ("The twist of link 1 is pi/2", True),
        ("θ1 = 30°, θ2 = 45° in the figure", False), ("a1 = 0.4 m, a2 = 0.3 m", False),
        ("第2行 α=180°", False), ("第2行 α=0", True),
    ],
)  # fmt: skip
def test_a_value_in_a_sentence_is_compared_with_the_cell(said: str, changes: bool) -> None:
    table = "\n".join("\t".join((label, *row)) for label, row in zip("i1234", SCARA, strict=True))
    assert bool(changing_remark(table, [said], "m")) is changes


def test_a_value_is_compared_in_the_row_that_an_index_of_the_modified_convention_means() -> None:
    table = "a_{i-1}, alpha_{i-1}, d_i, theta_i\n0, 0, 0, q1\nl1, 90°, 0, q2"
    assert changing_remark(table, ["alpha1 = 90°"], "m") == ""
    assert changing_remark(table, ["alpha1 = 0"], "m") == "alpha1 = 0"


def test_a_long_sentence_is_read_to_its_end() -> None:
    said = "and then the arm moves on, " * 60 + "but row 3 is wrong"
    assert changing_remark("a, b", [said], "m")


# --- The places from which words come ---

REMARKED = tuple(
    (*row, said) for row, said in zip(RADIANS, ("comment", "", "wrong sign", "", ""), strict=True)
)


def comment_of_word() -> bytes:
    document = docx.Document(io.BytesIO(word(RADIANS, "Homework 3")))
    runs = document.tables[0].cell(2, 1).paragraphs[0].runs
    document.add_comment(runs, text="must be 0", author="Ada")
    return saved(document)


def footnote_of_table() -> bytes:
    return word(RADIANS, "¹ the sign of row 2 is reversed")


def comment_of_sheet() -> bytes:
    book = openpyxl.load_workbook(io.BytesIO(workbook(RADIANS, "")))
    book.active["B3"].comment = openpyxl.comments.Comment("should be 0, sorry", "Ada")
    return saved(book)


def column_of_sheet() -> bytes:
    book = openpyxl.Workbook()
    for row, said in zip(RADIANS, ("Bemerkung", "", "muss 0 sein", "", ""), strict=True):
        book.active.append([*row, said])
    return saved(book)


def other_sheet() -> bytes:
    book = openpyxl.load_workbook(io.BytesIO(workbook(RADIANS, "")))
    book.create_sheet("Notes").append(["In row 2, alpha must be 0"])
    return saved(book)


def box_on_sheet() -> bytes:
    drawing = (
        '<xdr:wsDr xmlns:xdr="x" xmlns:a="a"><xdr:sp><xdr:txBody><a:p><a:r><a:t>'
        "In row 2, alpha must be 0</a:t></a:r></a:p></xdr:txBody></xdr:sp></xdr:wsDr>"
    )
    content = io.BytesIO(workbook(RADIANS, ""))
    with zipfile.ZipFile(content, "a") as archive:
        archive.writestr("xl/drawings/drawing1.xml", drawing)
    return content.getvalue()


def annotation_of_ods() -> bytes:
    document = OpenDocumentSpreadsheet()
    sheet = Table(name="DH")
    document.spreadsheet.addElement(sheet)
    for i, row in enumerate(RADIANS):
        line = TableRow()
        sheet.addElement(line)
        for j, text in enumerate(row):
            cell = TableCell(valuetype="string")
            cell.addElement(P(text=text))
            if (i, j) == (2, 1):
                note = Annotation()
                note.addElement(P(text="falsch, hier 0"))
                cell.addElement(note)
            line.addElement(cell)
    content = io.BytesIO()
    document.save(content)
    return content.getvalue()


PLACES: Mapping[str, Callable[[], bytes]] = {
    "comment.docx": comment_of_word, "note.docx": footnote_of_table,
    "comment.xlsx": comment_of_sheet,
    "column.xlsx": column_of_sheet, "sheet.xlsx": other_sheet, "box.xlsx": box_on_sheet,
    "note.ods": annotation_of_ods,
    "beside.xlsx": lambda: workbook(RADIANS, "<-- falsch!"),
    "column.csv": lambda: "\n".join(", ".join(row) for row in REMARKED).encode(),
    "column.md": lambda: (
        markdown(REMARKED, "").replace("|---|---|---|---|", "|---|---|---|---|---|").encode()
    ),
    "below.csv": lambda: (
        "\n".join(", ".join(row) for row in RADIANS) + "\n\nalpha2 is 0\n"
    ).encode(),
    "program.m": lambda: (
        b"% a, alpha, d, theta\nDH = [a1 0 0 theta1;\n a2 pi 0 theta2; % must be 0\n"
        b" 0 0 d3 0;\n 0 0 d4 theta4];\n"
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PLACES)
def test_a_remark_is_found_where_it_stands(
    name: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    found = graded_files({name: PLACES[name]()}, tmp_path, catalogue["scara"])
    assert found.report is None or not found.report.gradable
    assert found.points == 0
    if not name.startswith(("below", "program")):
        assert "grade it by hand" in found.problem


def graded_files(files: Mapping[str, bytes], folder: Path, exercise: Exercise) -> GradedFile:
    """Return the result of a student's folder with these files, as Moodle names it."""
    place = folder / "Ada Byron_1234_assignsubmission_file"
    place.mkdir()
    for name, content in files.items():
        (place / name).write_bytes(content)
    [handed] = all_handed_in([folder])
    [file] = graded(handed, GradingTerms(of_one(exercise, "table"), 0.8)).files
    return file


BESIDE: Mapping[str, str] = {
    "onlinetext.html": "<p>{said}</p>", "note.txt": "{said}", "README.txt": "Hello\n{said}",
    "README": "{said}", "notes.md": "# Notes\n\n{said}\n", "letter.docx": "{said}",
}  # fmt: skip


def beside(name: str, said: str) -> bytes:
    text = BESIDE[name].format(said=said)
    if not name.endswith(".docx"):
        return text.encode()
    document = docx.Document()
    document.add_paragraph(text)
    return saved(document)


@pytest.mark.parametrize("name", BESIDE)
@pytest.mark.parametrize(
    "said",
    [
        "All my angles are in degrees.", "Winkel in Grad",
        "In row 2, alpha should be 0 and not what I wrote in the file.",
        "I uploaded the wrong file, please do not grade it.", "Correction: in row 2, alpha is 0",
    ],
)  # fmt: skip
def test_a_note_beside_the_file_may_change_it(
    name: str, said: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    files = {"table.xlsx": below(DEGREES, ""), name: beside(name, said)}
    found = graded_files(files, tmp_path, catalogue["scara"])
    assert said in found.problem
    assert found.problem.startswith(name)
    assert found.report is None


@pytest.mark.parametrize("name", BESIDE)
@pytest.mark.parametrize(
    "said",
    [
        "Here is my table.", "All my angles are in radians.", "Sorry for the late hand-in!",
        "α2 = 180° because z2 points down", "My first upload was the wrong file.",
    ],
)  # fmt: skip
def test_another_note_beside_the_file_changes_nothing(
    name: str, said: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    files = {"table.xlsx": below(RADIANS, ""), name: beside(name, said)}
    found = graded_files(files, tmp_path, catalogue["scara"])
    assert found.points == 8


def test_the_readme_of_a_repository_is_not_the_student_s(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    place = tmp_path / "homework-ada"
    place.mkdir()
    (place / "table.xlsx").write_bytes(below(RADIANS, ""))
    (place / "README.md").write_text("In row 2, alpha must be 0 or pi.")
    [handed] = all_handed_in([tmp_path])
    [file] = graded(handed, GradingTerms(of_one(catalogue["scara"], "table"), 0.8)).files
    assert file.points == 8


def test_the_comments_of_a_receipt_are_notes(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    stem = "HW1_ada_attempt_2026-10-03-16-05-33"
    (tmp_path / f"{stem}_table.xlsx").write_bytes(below(RADIANS, ""))
    (tmp_path / f"{stem}.txt").write_text(
        "Name: Ada (ada)\nAssignment: HW1\n\nSubmission Field:\n"
        "There is no student submission text data for this assignment.\n\n"
        "Comments:\nplease ignore row 3\n\nFiles:\n\tOriginal filename: table.xlsx\n"
    )
    [handed] = all_handed_in([tmp_path])
    [file] = graded(handed, GradingTerms(of_one(catalogue["scara"], "table"), 0.8)).files
    assert "please ignore row 3" in file.problem


# --- A notebook whose later cell changes the table ---

CELL = (
    "# a, alpha, d, theta\nDH = [" + ", ".join(f"[{', '.join(row)}]" for row in RADIANS[1:]) + "]"
)


@pytest.mark.parametrize(
    "later",
    [
        "DH[1][1] = 0", "DH[1, 1] = 0", "DH = DH[::-1]", "DH.append([0, 0, 0, 0])", "DH.pop()",
        "del DH[3]", "DH[1][1] += pi", "for r in DH:\n    r[1] = 0", "DH[0], DH[1] = DH[1], DH[0]",
        "DH = np.array(DH); DH[:, 1] *= -1", "row = DH[1]\nrow[1] = 0", "random.shuffle(DH)",
        "DH = np.deg2rad(DH)", "exec('DH[1][1] = 0')", "np.negative(DH, out=DH)",
    ],
)  # fmt: skip
def test_a_later_cell_that_changes_the_table_is_left_to_a_person(
    later: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    for name, content in (
        ("table.ipynb", office.notebook(("code", CELL), ("code", later))),
        ("table.py", f"{CELL}\n{later}\n".encode()),
    ):
        folder = tmp_path / name
        folder.mkdir()
        found = graded_files({name: content}, folder, catalogue["scara"])
        assert found.points == 0
        assert found.report is None or not found.report.gradable


@pytest.mark.parametrize(
    "later",
    [
        "print(DH)", "DH", "T = fk(DH)", "len(DH)", "A1 = dh(*DH[0])", "display(DH)",
        "for a, alpha, d, theta in DH:\n    T = T @ A(a, alpha, d, theta)",
        "for i, row in enumerate(DH):\n    T = T @ dh(*row)", "DH = np.array(DH, dtype=float)",
        "for i in range(4):\n    a, alpha, d, theta = DH[i]\n    T = T @ A(a, alpha, d, theta)",
        "df = pd.DataFrame(DH, columns=['a', 'alpha', 'd', 'theta'])\ndf", "plt.plot(x, y)",
    ],
)  # fmt: skip
def test_a_later_cell_that_uses_the_table_changes_nothing(
    later: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    content = office.notebook(("code", CELL), ("code", later))
    found = graded_files({"table.ipynb": content}, tmp_path, catalogue["scara"])
    assert found.points == 8


def test_a_function_that_converts_degrees_tells_the_unit_of_the_table(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    table = CELL.replace("pi", "180")
    content = office.notebook(("code", "def f(t):\n    return np.deg2rad(t)"), ("code", table))
    found = graded_files({"table.ipynb": content}, tmp_path, catalogue["scara"])
    assert "deg2rad" in found.problem
