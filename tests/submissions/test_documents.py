"""Test documents that students hand in."""

import io
from collections.abc import Callable, Mapping
from pathlib import Path

import docx
import openpyxl
import pytest
import xlwt
from dh_grader.catalogue import Exercise
from dh_grader.formats.graded import GradingTerms, graded
from dh_grader.grading import Submission, Verdict, grade
from dh_grader.submissions import of_one
from dh_grader.submissions.documents import UnusableFileError, pasted_from
from dh_grader.submissions.files import MAX_TOML_DOTS, MAX_TOML_SIZE, all_handed_in, read_content
from docx.enum.style import WD_STYLE_TYPE
from odf.opendocument import OpenDocumentSpreadsheet
from odf.style import Style, TextProperties
from odf.table import Table, TableCell, TableRow
from odf.text import P
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import InlineFont
from openpyxl.comments import Comment
from openpyxl.styles import Font

TABULAR = "\\begin{tabular}{cc}\n$a$ & $d$ \\\\ 0 & 1\n\\end{tabular}"
BARS = "| a | d |\n|---|---|\n| 0 | 1 |"
MATRIX = "DH = [a1 0 0 q1;\n      a2 0 0 q2]"


@pytest.mark.parametrize(
    ("text", "suffix", "pasted"),
    [
        (f"\\documentclass{{article}}\\begin{{document}}Hi\n{TABULAR}\nBye", ".tex", TABULAR),
        (f"# Homework\n\n{BARS}\n\nDone.", ".md", BARS),
        ("Matrix:\n```python\n[[1, 0],\n [0, 1]]\n```\nDone", ".md", "[[1, 0],\n [0, 1]]"),
        (TABULAR, ".tex", TABULAR),
        (
            (f"clear; clc;\nsyms q1 a1 real\nq2 = sym('q2');\n{MATRIX};  % a alpha d theta\n"
            "T = eye(4);\nfor i = 1:2\n  T = T * A(DH(i, :));\nend\ndisp(T)"),
            ".m", MATRIX,
        ),
        ('"a1 c1"\r\n\r\n"-d3"\r\n', ".csv", "a1 c1\n-d3"),
        # The values of its variables precede the matrix.
        (
            f"b = 2; a1 = 0.4; % m\nq1 = pi/2\n{MATRIX};\ndisp(DH)",
            ".m", f"a1 = 0.4\nq1 = pi/2\n{MATRIX}",
        ),
    ],
)  # fmt: skip
def test_text_around_a_table_is_removed(text: str, suffix: str, pasted: str) -> None:
    assert pasted_from(text, suffix).lstrip("\n") == pasted


@pytest.mark.parametrize(
    ("text", "suffix", "line"),
    [
        (f"\\documentclass{{article}}\n\nHi\n{TABULAR}\nBye", ".tex", 4),
        (f"# Homework\n\n{BARS}\n\nDone.", ".md", 3),
        (f"clear; clc;\n\na1 = 0.4;\n\n\n{MATRIX};", ".m", 6),
    ],
)
def test_lines_keep_their_numbers(text: str, suffix: str, line: int) -> None:
    pasted = pasted_from(text, suffix).splitlines()
    assert pasted[line - 1] == text.splitlines()[line - 1]


@pytest.mark.parametrize(
    ("text", "suffix"),
    [
        (f"{TABULAR} and {TABULAR}", ".tex"),
        ("\\begin{tabular}" * 10_000, ".tex"),
        (f"{BARS}\n\n{BARS}", ".md"),
        ("a, d\n0, 1", ".md"),
        (f"x\n{BARS}\n\ny", ".csv"),
        # The last row does not belong to another table.
        (f"{BARS}\nand\n| 2 | 3 |", ".md"),
        ('"a1","a2"\n"0","1"', ".csv"),
        ('"a1"\na2', ".csv"),
        (f"{MATRIX};\nB = [1 2; 3 4];", ".m"),
        # The matrix is changed later, or its variables have other values.
        (f"{MATRIX};\nDH(1, 3) = d1;", ".m"),
        (f"{MATRIX};\nDH = DH * 2;", ".m"),
        (f"q1 = [0 1];\n{MATRIX};", ".m"),
        (f"[q1, q2] = deal(0, 1);\n{MATRIX};", ".m"),
        ("A = [", ".m"),
        ("A = [0]\n" * 10_000, ".m"),
    ],
)
def test_a_text_without_exactly_one_table_is_unchanged(text: str, suffix: str) -> None:
    assert pasted_from(text, suffix) == text


# --- Files that would take long to parse are refused


@pytest.mark.parametrize(
    "content",
    [
        # A key of 120,000 dots took more memory than the machine had.
        "a" + ".a" * MAX_TOML_DOTS + ".a = 1",
        "\n".join(f"a{i} = 1" for i in range(MAX_TOML_SIZE // 8)),
    ],
    ids=["dots", "keys"],
)
def test_toml_over_a_limit_is_refused(content: str) -> None:
    with pytest.raises(UnusableFileError, match="is more TOML than 64 KiB or 2,000 dots"):
        read_content(content.encode(), "answers.toml")


def test_toml_within_the_limits_is_read() -> None:
    cells = ", ".join(["1.5"] * (MAX_TOML_DOTS - 1))
    content = read_content(f"[answers]\ntable = [{cells}]".encode(), "answers.toml")
    assert content.value == {"answers": {"table": [1.5] * (MAX_TOML_DOTS - 1)}}


# --- Struck-out and hidden cells, and units that only a number format shows

HEAD = ("a", "alpha", "d", "theta")
ROWS = (
    ("a1", "0", "0", "theta1"), ("a2", "180°", "0", "theta2"), ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
)  # fmt: skip
STRUCK = ("0", "90", "0", "theta2")


def result(folder: Path, scara: Exercise, name: str, content: bytes) -> tuple[str, float]:
    """Return the verdict on a file, or its problem, and its points."""
    (folder / name).write_bytes(content)
    [handed] = all_handed_in([folder / name])
    [file] = graded(handed, GradingTerms(of_one(scara, "table"), 0.8)).files
    return (file.report.parts[0].verdict if file.report else file.problem), file.points


def saved(document: object) -> bytes:
    content = io.BytesIO()
    document.save(content)  # type: ignore[attr-defined]
    return content.getvalue()


def word() -> bytes:
    document = docx.Document()
    table = document.add_table(rows=0, cols=4)
    for row in (HEAD, *ROWS):
        for cell, text in zip(table.add_row().cells, row, strict=True):
            cell.text = text
    table.rows[1].cells[0].paragraphs[0].insert_paragraph_before().add_run("0").font.strike = True
    return saved(document)


def hidden_word() -> bytes:
    document = docx.Document(io.BytesIO(word()))
    for paragraph in document.tables[0].rows[1].cells[0].paragraphs[:1]:
        paragraph.runs[0].font.strike = False
        paragraph.runs[0].font.hidden = True
    return saved(document)


def workbook(change: Callable[[openpyxl.worksheet.worksheet.Worksheet], None]) -> bytes:
    book = openpyxl.Workbook()
    for row in (HEAD, *ROWS):
        book.active.append(row)
    change(book.active)
    return saved(book)


def struck_row(sheet: openpyxl.worksheet.worksheet.Worksheet) -> None:
    sheet.insert_rows(3)
    for j, text in enumerate(STRUCK, 1):
        sheet.cell(3, j, text).font = Font(strike=True)


def hidden_row(sheet: openpyxl.worksheet.worksheet.Worksheet) -> None:
    sheet.insert_rows(3)
    for j, text in enumerate(STRUCK, 1):
        sheet.cell(3, j, text)
    sheet.row_dimensions[3].hidden = True


def hidden_column(sheet: openpyxl.worksheet.worksheet.Worksheet) -> None:
    sheet.insert_cols(2)
    for i in range(1, 6):
        sheet.cell(i, 2, "alpha" if i == 1 else "90")
    sheet.column_dimensions["B"].hidden = True


def degrees_by_format(sheet: openpyxl.worksheet.worksheet.Worksheet) -> None:
    sheet["B3"] = 180
    sheet["B3"].number_format = '0"°"'


def commented(sheet: openpyxl.worksheet.worksheet.Worksheet) -> None:
    sheet["B3"].comment = Comment("Sorry, row 4 is wrong.", "Anna")


def old_workbook(change: str) -> bytes:
    book = xlwt.Workbook()
    sheet = book.add_sheet("DH")
    rows: list[tuple[str | float, ...]] = [HEAD, *ROWS]
    styles = {1: xlwt.easyxf("font: struck_out on")} if change == "struck" else {}
    if change == "hidden":
        rows.insert(1, STRUCK)
        sheet.row(1).hidden = True
    for i, row in enumerate(rows):
        for j, text in enumerate(row):
            sheet.write(i, j, text, *filter(None, [styles.get(i)]))
    if change == "degrees":
        sheet = book.add_sheet("Other")
        book._Workbook__worksheets.pop(0)
        for i, row in enumerate(rows):
            for j, text in enumerate(row):
                style = [xlwt.easyxf(num_format_str='0"°"')] if text == "180°" else []
                sheet.write(i, j, 180 if style else text, *style)
    return saved(book)


def open_document() -> bytes:
    document = OpenDocumentSpreadsheet()
    style = Style(name="struck", family="table-cell")
    style.addElement(TextProperties(textlinethroughstyle="solid"))
    document.automaticstyles.addElement(style)
    table = Table(name="DH")
    for row in (HEAD, ROWS[0], STRUCK, *ROWS[1:]):
        added = TableRow()
        for text in row:
            looks = {"stylename": style} if row == STRUCK else {}
            cell = TableCell(valuetype="string", **looks)
            cell.addElement(P(text=text))
            added.addElement(cell)
        table.addElement(added)
    document.spreadsheet.addElement(table)
    return saved(document)


def rich_text() -> bytes:
    cells = "".join(
        "".join(rf"\intbl {cell}\cell ".replace("°", r"\'b0") for cell in row) + r"\row "
        for row in (HEAD, *ROWS)
    )
    return rf"{{\rtf1\ansi {cells}}}".replace("a1", r"\strike 0\strike0 a1").encode()


def text(change: str) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in (HEAD, *ROWS)]
    return "\n".join([lines[0], "|---|---|---|---|", *lines[1:]]).replace("a1", f"{change} a1")


def page(change: str) -> bytes:
    cells = "".join(
        "<tr><td>" + "</td><td>".join(row) + "</td></tr>" for row in (HEAD, *ROWS)
    ).replace("a1", f"{change} a1")
    return f"<table>{cells}</table>".encode()


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("table.docx", word()),
        ("table.xlsx", workbook(struck_row)),
        ("table.xls", old_workbook("struck")),
        ("table.ods", open_document()),
        ("table.rtf", rich_text()),
        ("table.md", text("~~0~~").encode()),
        ("table.txt", text("~~0~~").encode()),
        ("table.html", page('<span style="text-decoration: line-through;">0</span>')),
        ("table.html", page("<s>0</s>")),
        ("table.html", page("<del>0</del>")),
        ("table.html", b"<p>a, alpha, d, theta</p><p><s>0</s> a1, 0, 0, theta1</p>"),
    ],
)
def test_struck_out_text_is_left_to_a_person(
    name: str, content: bytes, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    verdict, _ = result(tmp_path, catalogue["scara"], name, content)
    assert verdict == Verdict.UNREADABLE


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("table.docx", hidden_word()),
        ("table.xlsx", workbook(hidden_row)),
        ("table.xlsx", workbook(hidden_column)),
        ("table.xls", old_workbook("hidden")),
        # The format shows the unit.
        ("table.xlsx", workbook(degrees_by_format)),
        ("table.xls", old_workbook("degrees")),
    ],
)
def test_cells_are_read_as_they_are_seen(
    name: str, content: bytes, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    assert result(tmp_path, catalogue["scara"], name, content) == (Verdict.CORRECT, 8)


def test_the_comment_of_a_cell_may_correct_the_table(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    found, _ = result(tmp_path, catalogue["scara"], "table.xlsx", workbook(commented))
    assert "grade it by hand: “Sorry, row 4 is wrong.”" in found


def test_pasted_text_that_is_struck_out_says_so(catalogue: Mapping[str, Exercise]) -> None:
    report = grade(catalogue["scara"], Submission({"table": text("~~0~~")})).parts[0]
    [found] = report.feedback
    assert (found.code, found.message) == (
        "unread_tag",
        "Line 3: Struck-out text cannot be read. Delete it.",
    )


def half_struck_xlsx() -> bytes:
    """Return a workbook in which LibreOffice and Excel show a struck 45° before 180°."""
    book = openpyxl.Workbook()
    for row in (HEAD, *ROWS):
        book.active.append(row)
    struck = TextBlock(InlineFont(b=True, strike=True), "45° ")
    book.active["B3"] = CellRichText(struck, "180°")
    return saved(book)


def half_struck_xls() -> bytes:
    book = xlwt.Workbook()
    sheet = book.add_sheet("DH")
    struck = xlwt.Font()
    struck.struck_out = True
    for i, row in enumerate((HEAD, *ROWS)):
        for j, text in enumerate(row):
            if text == "180°":
                sheet.write_rich_text(i, j, [("45 ", struck), (text, xlwt.Font())])
            else:
                sheet.write(i, j, text)
    return saved(book)


def struck_by_style(*, of_paragraph: bool = False) -> bytes:
    document = docx.Document()
    styles = document.styles
    kind = WD_STYLE_TYPE.PARAGRAPH if of_paragraph else WD_STYLE_TYPE.CHARACTER
    styles.add_style("Old", kind).font.strike = True
    styles.add_style("Older", kind).base_style = styles["Old"]
    table = document.add_table(rows=0, cols=4)
    for row in (HEAD, *ROWS):
        for cell, text in zip(table.add_row().cells, row, strict=True):
            cell.text = text
    cell = table.rows[2].cells[1]
    if of_paragraph:
        cell.add_paragraph("45°", style="Older")
    else:
        cell.paragraphs[0].add_run(" 45°").style = "Older"
    return saved(document)


@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("half.xlsx", half_struck_xlsx), ("half.xls", half_struck_xls),
        ("style.docx", struck_by_style),
        ("paragraph.docx", lambda: struck_by_style(of_paragraph=True)),
    ],
)  # fmt: skip
def test_a_piece_of_a_cell_that_is_struck_out_is_not_read(
    name: str, make: Callable[[], bytes], tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    assert result(tmp_path, catalogue["scara"], name, make())[0] == Verdict.UNREADABLE


@pytest.mark.parametrize("command", ["sout", "cancel", "bcancel", "xcancel", "xout", "st"])
def test_text_that_latex_strikes_out_is_refused(
    command: str, catalogue: Mapping[str, Exercise]
) -> None:
    rows = [" & ".join(row) for row in (HEAD, *ROWS)]
    rows[2] = f"a2 & \\{command}{{0}} $180^\\circ$ & 0 & theta2"
    text = "\\begin{tabular}{cccc}\n" + " \\\\\n".join(rows) + "\n\\end{tabular}"
    report = grade(catalogue["scara"], Submission({"table": text})).parts[0]
    assert [each.code for each in report.feedback] == ["unread_tag"]
