"""Test tables in documents of office programs."""

import io
import json
import time
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import date
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import docx
import openpyxl
import pytest
import xlwt
from dh_grader.formats.graded import GradingTerms, graded
from dh_grader.submissions import of_one
from dh_grader.submissions.documents import Excerpt, UnusableFileError, decoded, typed_text
from dh_grader.submissions.files import all_handed_in
from dh_grader.submissions.office_files import OFFICE_ENDINGS, excerpts
from hypothesis import given
from hypothesis import strategies as st
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import CoveredTableCell, Table, TableCell, TableRow
from odf.text import P

from tests.shipped import shipped_exercises
from tests.submissions import office_documents as made
from tests.submissions.office_documents import Rows, xlsx

# --- Files of office programs, notebooks and web editors are read, and hostile ones are refused

RRR: Final = shipped_exercises()["planar-rrr"]
NUMBERS: Final = shipped_exercises()["planar-rr-numbers"]
RIGHT: Final[list[list[str | float]]] = [
    ["a", "alpha", "d", "theta"],
    [0, 0, 0, "q1"],
    ["l1", 0, 0, "q2"],
    ["l2", 0, 0, "q3"],
    ["l3", 0, 0, 0],
]


def grade_files(folder: Path, files: dict[str, bytes], *, exercise: Any = RRR) -> Any:
    """Return the graded submission of the only student of a class."""
    student = folder / "class" / "Ada Byron_1234_assignsubmission_file"
    student.mkdir(parents=True)
    for name, content in files.items():
        (student / name).write_bytes(content)
    [handed] = all_handed_in([folder / "class"])
    return graded(handed, GradingTerms(of_one(exercise, "table"), 0.8))


@pytest.mark.parametrize("kind", made.KINDS)
def test_a_right_table_in_each_kind_of_file_gets_full_marks(tmp_path: Path, kind: str) -> None:
    name, make = made.KINDS[kind]
    found = grade_files(tmp_path, {name: make(RIGHT)})
    assert found.problems == ()
    assert (found.points, found.is_complete) == (8, True)


@pytest.mark.parametrize("kind", made.KINDS)
def test_a_wrong_cell_in_each_kind_of_file_is_found(tmp_path: Path, kind: str) -> None:
    name, make = made.KINDS[kind]
    wrong: made.Rows = [*RIGHT[:2], ["l1", 1.5, 0, "q2"], *RIGHT[3:]]
    found = grade_files(tmp_path, {name: make(wrong)})
    assert 0 < found.points < 8
    [part] = found.files[0].report.parts
    cells = [cell.verdict for row in part.rows for cell in row.cells]
    assert cells.count("incorrect") == 1


@pytest.mark.parametrize("name", ["scan.pdf", "photo.jpg", "IMG_1.HEIC", "notes.pages", "w.doc"])
def test_a_file_for_a_person_is_listed_and_not_zero(tmp_path: Path, name: str) -> None:
    found = grade_files(tmp_path, {name: b"%PDF-1.7 \x89"})
    assert not found.is_complete
    [problem] = found.problems
    assert problem.startswith(f"{name} can only be graded by hand")


def test_a_photo_beside_a_complete_answer_does_not_hold_it_up(tmp_path: Path) -> None:
    found = grade_files(tmp_path, {"table.csv": made.csv(RIGHT), "photo.jpg": b"\xff\xd8"})
    assert (found.points, found.is_complete, found.problems) == (8, True, ())


def test_the_readable_one_of_two_files_is_graded(tmp_path: Path) -> None:
    files = {"onlinetext.html": b"<p>See my file</p>", "hw3.xlsx": made.xlsx(RIGHT)}
    found = grade_files(tmp_path, files)
    assert (found.points, found.is_complete) == (8, True)


def test_two_files_that_differ_are_left_to_a_person(tmp_path: Path) -> None:
    wrong: made.Rows = [*RIGHT[:2], ["l1", 90, 0, "q2"], *RIGHT[3:]]
    found = grade_files(tmp_path, {"a.xlsx": made.xlsx(RIGHT), "b.csv": made.csv(wrong)})
    assert not found.is_complete
    assert found.problems == (
        "a.xlsx, b.csv have answers to table that differ; leave only one of them",
    )


def test_scratch_sheets_and_blocks_beside_the_answer_do_not_matter(tmp_path: Path) -> None:
    title = [["Name", "Ada Byron", "", ""], ["", "", "", ""]]
    sheets = made.xlsx([["notes"], [1]], [*title, *RIGHT], names=["Notes", "DH"])
    assert grade_files(tmp_path, {"hw.xlsx": sheets}).points == 8


@pytest.mark.parametrize("legend", [["l1", "length of link 1"], ["Name", "Ada Byron"], ["done"]])
def test_a_legend_below_a_table_in_a_sheet_is_no_row(tmp_path: Path, legend: list[str]) -> None:
    sheet = made.xlsx([*RIGHT, [], legend])
    assert grade_files(tmp_path, {"hw.xlsx": sheet}).points == 8


def test_a_piece_of_a_sheet_does_not_hide_its_wrong_rows(tmp_path: Path) -> None:
    # The rows below the empty row can be read alone; they earn less.
    rows: made.Rows = [RIGHT[0], [0, 0, 0, "q1 +"], [], *RIGHT[2:]]
    found = grade_files(tmp_path, {"hw.xlsx": made.xlsx(rows)})
    [part] = found.files[0].report.parts
    assert [row.cells[3].verdict for row in part.rows] == ["unreadable", *["correct"] * 3]


def test_two_tables_in_a_sheet_that_differ_are_left_to_a_person(tmp_path: Path) -> None:
    wrong: made.Rows = [*RIGHT[:2], ["l1", 90, 0, "q2"], *RIGHT[3:]]
    found = grade_files(tmp_path, {"hw.xlsx": made.xlsx([*wrong, [], *RIGHT])})
    assert not found.is_complete


def test_sheets_with_the_names_of_parts_answer_these_parts(tmp_path: Path) -> None:
    pose = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    (tmp_path / "hw.xlsx").write_bytes(made.xlsx(RIGHT, pose, names=["Table", "pose"]))
    [handed] = all_handed_in([tmp_path / "hw.xlsx"])
    found = graded(handed, GradingTerms(of_one(RRR), 0.8))
    report = found.files[0].report
    assert report is not None
    table, other = report.parts
    assert (table.points, other.verdict) == (8, "incorrect")


def test_numbers_are_read_as_a_person_sees_them(tmp_path: Path) -> None:
    book = made.xlsx([[1, 0.1, 1.5708, -0.25, 1e-05, 100000000]])
    [excerpt] = excerpts(book, ".xlsx")
    assert excerpt.text == "1\t0.1\t1.5708\t-0.25\t1e-05\t100000000"


def test_a_fraction_that_became_a_date_is_not_a_number(tmp_path: Path) -> None:
    book = openpyxl.load_workbook(io.BytesIO(made.xlsx(RIGHT)))
    book.worksheets[0]["B3"] = date(2026, 2, 1)
    written = io.BytesIO()
    book.save(written)
    found = grade_files(tmp_path, {"table.xlsx": written.getvalue()})
    report = found.files[0].report
    assert report is not None
    cell = report.parts[0].rows[1].cells[1]
    assert (cell.label, cell.verdict) == ("alpha", "unreadable")


def test_a_formula_without_its_value_is_not_an_empty_cell() -> None:
    rows: made.Rows = [*RIGHT[:2], ["l1", "=PI()/2", 0, "q2"], *RIGHT[3:]]
    with pytest.raises(UnusableFileError, match="formulas without their values"):
        excerpts(made.xlsx(rows), ".xlsx")


WORD: Final = (
    '<w:document xmlns:w="w" xmlns:m="m"><w:body><w:tbl><w:tr>{cells}</w:tr></w:tbl></w:body>'
    "</w:document>"
)


def of_word(*cells: str) -> str:
    """Return the text of a table in a document, with these formulas in its cells."""
    inner = "".join(f"<w:tc><w:p>{cell}</w:p></w:tc>" for cell in cells)
    content = made.zipped({"word/document.xml": WORD.format(cells=inner).encode()})
    return excerpts(content, ".docx")[0].text


def test_formulas_of_the_equation_editor_are_written_in_a_line() -> None:
    def t(text: str) -> str:
        return f"<m:r><m:t>{text}</m:t></m:r>"

    sub = f"<m:sSub><m:e>{t('θ')}</m:e><m:sub>{t('1')}</m:sub></m:sSub>"
    fraction = f"<m:f><m:num>{t('π')}</m:num><m:den>{t('2')}</m:den></m:f>"
    root = f"<m:rad><m:radPr/><m:deg/><m:e>{t('2')}</m:e></m:rad>"
    power = f"<m:sSup><m:e>{t('90')}</m:e><m:sup>{t('∘')}</m:sup></m:sSup>"
    sine = f"<m:func><m:fName>{t('sin')}</m:fName><m:e>{sub}</m:e></m:func>"
    row = f"<m:mr><m:e>{t('1')}</m:e><m:e>{t('0')}</m:e></m:mr>"
    matrix = f"<m:d><m:dPr/><m:e><m:m>{row}{row}</m:m></m:e></m:d>"
    cells = [f"<m:oMath>{each}</m:oMath>" for each in (sub, fraction, root, power, sine, matrix)]
    assert of_word(*cells) == "θ_1\t(π)/(2)\tsqrt(2)\t90°\tsin(θ_1)\t[[1, 0], [1, 0]]"


def test_what_has_no_text_in_a_document_is_not_an_empty_cell() -> None:
    sum_of = "<m:oMath><m:nary><m:e><m:r><m:t>x</m:t></m:r></m:e></m:nary></m:oMath>"
    image = "<w:r><w:drawing/></w:r>"
    raised = '<w:r><w:rPr><w:vertAlign w:val="superscript"/></w:rPr><w:t>2</w:t></w:r>'
    deleted = "<w:del><w:r><w:delText>5</w:delText></w:r></w:del><w:r><w:t>l1</w:t></w:r>"
    plain = "<w:r><w:t>q</w:t></w:r>"
    found = of_word(sum_of, image, plain + raised, deleted)
    assert found == "(formula)\t(image)\tq^(2)\tl1"


@pytest.mark.parametrize(
    ("page", "lines"),
    [
        ("<p>0, 0</p><p>1, 2</p>", "0, 0\n1, 2"),
        ("0,&nbsp;0<br>1,&#160;2<br />", "0, 0\n1, 2"),
        ("<div>q<sub>1</sub></div><div>x<sup>2</sup> 90<sup>o</sup></div>", "q1\nx^(2) 90°"),
        ("<p>a &lt; b &amp; &theta;1</p>", "a < b & θ1"),
        ("<pre>A = [1 2\n3 4]</pre>", "A = [1 2\n3 4]"),
        ("<style>p {}</style><!-- x --><ul><li>1</li><li>2</li></ul>", "1\n2"),
        ("l1 < 3 and q1 > 2", "l1 < 3 and q1 > 2"),
        ("<head><style>p { x > y }\n<!-- a -->\n</style></head><p>1</p>", "1"),
        ("<!-- [if gte mso 9]><xml><p>9</p></xml> --><p>1<!-- 2 --></p>", "1"),
        ("<style>p<p>1</p><!-- 2", "p\n1\n<!-- 2"),
    ],
)
def test_typed_lines_are_the_lines_of_the_editor(page: str, lines: str) -> None:
    assert typed_text(page) == lines


STYLES: Final = """
    p { font-size: 1 } a:hover + b { c: d; e: f;  }
    <!-- a comment } -->
"""


def test_styles_and_scripts_of_a_web_page_are_not_read(tmp_path: Path) -> None:
    rows = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in RIGHT)
    head = f"<head><title>T {{</title><style>{STYLES}</style></head>"
    page = f"<html>{head}<body><script>if (a < b) {{</script><table>{rows}</table></body></html>"
    assert grade_files(tmp_path, {"table.html": page.encode()}).points == 8


def test_json_that_was_typed_into_an_editor_is_the_json_of_an_answer(tmp_path: Path) -> None:
    answers = json.dumps({"answers": {"table": RIGHT[1:]}})
    page = f"<p>{answers.replace(chr(34), '&quot;')}</p>".encode()
    assert grade_files(tmp_path, {"onlinetext.html": page}).points == 8


def test_a_notebook_is_not_the_json_of_an_answer(tmp_path: Path) -> None:
    content = made.notebook(("code", made.python_list(RIGHT)))
    assert grade_files(tmp_path, {"table.json": content}).points == 8


def test_a_class_in_a_zip_file_is_graded_like_its_folder(tmp_path: Path) -> None:
    names = {
        "Ada Byron_1234_assignsubmission_file/hw.xlsx": made.xlsx(RIGHT),
        "Ben Okri_1235_assignsubmission_file/deep/table.zip": made.zipped(
            {"table.csv": made.csv(RIGHT)}
        ),
        "Cy Young_1236_assignsubmission_file/scan.pdf": b"%PDF",
        "__MACOSX/Cy/._scan.pdf": b"x",
    }
    (tmp_path / "all.zip").write_bytes(made.zipped(names))
    terms = GradingTerms(of_one(RRR, "table"), 0.8)
    found = [graded(each, terms) for each in all_handed_in([tmp_path / "all.zip"])]
    assert [each.learner for each in found] == [f"Participant {n}" for n in (1234, 1235, 1236)]
    assert [each.points for each in found] == [8, 8, 0]
    assert [each.is_complete for each in found] == [True, True, False]


# --- Hostile files ---


def xlsx_with(sheet: bytes, extra: dict[str, bytes] | None = None) -> bytes:
    """Return a workbook whose sheet is replaced, with extra parts."""
    written = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(made.xlsx(RIGHT))) as source,
        zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as target,
    ):
        for name in source.namelist():
            is_sheet = name == "xl/worksheets/sheet1.xml"
            target.writestr(name, sheet if is_sheet and sheet else source.read(name))
        for name, content in (extra or {}).items():
            target.writestr(name, content)
    return written.getvalue()


SHEET: Final = (
    b'<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
)
CELL: Final = b'<c r="A1"><v>1</v></c>'
LAUGHS: Final = (
    b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
)
BILLION: Final = "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in pairwise("abcdefghij"))
BILLION_LAUGHS: Final = f'<!DOCTYPE a [<!ENTITY a "ha">{BILLION}]><a>&j;</a>'
OUTSIDE: Final = b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]>'
WORD_START: Final = b'<w:document xmlns:w="w"><w:body>'
MILLION: Final = 1_000_000
ODS_LAUGHS: Final = LAUGHS + b"<x>&b;</x>"
ODS: Final = (
    '<x xmlns:t="t" xmlns:o="o" xmlns:p="p"><t:table><t:table-row t:number-rows-repeated="{rows}">'
    '<t:table-cell t:number-columns-repeated="{columns}" o:value-type="float" o:value="1"/>'
    "</t:table-row></t:table></x>"
)
# Made when they are read, because they are large.
HOSTILE: Final[Mapping[str, Callable[[], bytes]]] = {
    "no zip.xlsx": lambda: b"PK\x03\x04" + bytes(100),
    "zeros.xlsx": lambda: xlsx_with(SHEET + bytes(50_000_000)),
    "a million cells.xlsx": lambda: xlsx_with(SHEET + b"<row>" + CELL * 1_000_000 + b"</row>"),
    "entities.xlsx": lambda: xlsx_with(LAUGHS + SHEET + b"</sheetData></worksheet>"),
    "laughs in texts.xlsx": lambda: xlsx_with(
        b"", {"xl/sharedStrings.xml": BILLION_LAUGHS.encode()}
    ),
    "laughs in styles.xlsx": lambda: xlsx_with(
        b"", {"xl/worksheets/s2.xml": BILLION_LAUGHS.encode()}
    ),
    "deep.xlsx": lambda: xlsx_with(SHEET + b"<a>" * 100_000),
    "a million rows.xlsx": lambda: xlsx_with(
        SHEET + b"<row/>" * 300_000 + b"</sheetData></worksheet>"
    ),
    "other tags.xlsx": lambda: xlsx_with(SHEET + b"<a/>" * 50_000 + b"</sheetData></worksheet>"),
    "macros.xlsx": lambda: xlsx_with(b"", {"xl/vbaProject.bin": b"x"}),
    "links.xlsx": lambda: xlsx_with(b"", {"xl/externalLinks/externalLink1.xml": b"<x/>"}),
    "cut.xlsx": lambda: made.xlsx(RIGHT)[:-200],
    "noise.xls": lambda: b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(range(256)) * 20,
    "entities.ods": lambda: made.zipped({"content.xml": ODS_LAUGHS}),
    "wide.ods": lambda: made.zipped({"content.xml": ODS.format(rows=1, columns=10**8).encode()}),
    "long.ods": lambda: made.zipped({"content.xml": ODS.format(rows=10**8, columns=9).encode()}),
    "a million cells.ods": lambda: made.zipped(
        {"content.xml": b"<x>" + b"<c/>" * 500_000 + b"</x>"}
    ),
    "tables in tables.ods": lambda: made.zipped(
        {"content.xml": b"<x>" + b"<table>" * 150 + b"<table-row/>" * 50_000 + b"</table>" * 150}
    ),
    "entities.docx": lambda: made.zipped({"word/document.xml": ODS_LAUGHS}),
    "laughs.docx": lambda: made.zipped({"word/document.xml": BILLION_LAUGHS.encode()}),
    "laughs in UTF-16.docx": lambda: made.zipped(
        {"word/document.xml": BILLION_LAUGHS.encode("utf-16")}
    ),
    "outside.docx": lambda: made.zipped({"word/document.xml": OUTSIDE + b"<a>&b;</a>"}),
    "macros.docx": lambda: made.zipped({"word/document.xml": b"<w/>", "word/vbaProject.bin": b"x"}),
    "a million cells.docx": lambda: made.zipped(
        {"word/document.xml": WORD_START + b"<w:p/>" * 300_000 + b"</w:body></w:document>"}
    ),
    "deep.docx": lambda: made.zipped({"word/document.xml": b"<w>" * 100_000}),
    "deep and closed.docx": lambda: made.zipped(
        {"word/document.xml": b"<w>" * 29_000 + b"</w>" * 29_000}
    ),
    "deep.ipynb": lambda: b'{"nbformat": 4, "cells": ' + b"[" * 100_000,
    "wrong.ipynb": lambda: b'{"nbformat": 4, "cells": [{"cell_type": 1, "source": {"a": 1}}]}',
    "open.rtf": lambda: b"{\\rtf1" + b"{" * 25_000,
    "a million cells.rtf": lambda: b"{\\rtf1" + b"\\intbl 1\\cell " * 500_000 + b"}",
    "braces.rtf": lambda: b"{\\rtf1" + b"{}" * 3 * MILLION + b"}",
    "nearly a picture.rtf": lambda: b"{\\rtf1 " + (b"a" * 399 + b"g") * 20_000 + b"}",
    "not.rtf": lambda: b"a, b",
    "empty.html": lambda: b"<p>&nbsp;</p>",
    "a million cells.html": lambda: b"<table><tr>" + b"<td>1" * MILLION,
    "deep.html": lambda: b"<div>" * MILLION,
    "entities.html": lambda: b"&lt;" * MILLION,
    "openings.html": lambda: b"<" * 8 * MILLION,
    "a million cells.ipynb": lambda: b'{"nbformat": 4, "cells": [' + b"1, " * MILLION + b"1]}",
}


# A file is refused within 0.1 s of processor time on an idle machine. Other processes share the
# caches of a busy machine, so that the same work takes up to three times as long there.
MOST_SECONDS: Final = 0.1 * 3


def seconds_to_read(content: bytes, ending: str) -> tuple[float, tuple[Excerpt, ...]]:
    """Return the shortest processor time of three readings, and what is read."""
    took = []
    found: tuple[Excerpt, ...] = ()
    for _ in range(3):
        start = time.process_time()
        with suppress(UnusableFileError):
            found = excerpts(content, ending)
        took.append(time.process_time() - start)
    return min(took), found


# The first reading of a kind loads its library, which is not timed.
FIRST: Final[dict[str, Callable[..., bytes]]] = {
    ".xlsx": made.xlsx,
    ".xls": made.xls,
    ".rtf": made.rtf,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_at_once(name: str) -> None:
    ending = f".{name.rpartition('.')[2]}"
    if ending in FIRST:
        excerpts(FIRST[ending](RIGHT), ending)
    seconds, found = seconds_to_read(HOSTILE[name](), ending)
    assert found == () or name == "open.rtf"
    assert seconds < MOST_SECONDS


@pytest.mark.long
def test_a_sheet_of_a_gigabyte_of_zeros_is_refused_at_once(tmp_path: Path) -> None:
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        with archive.open("xl/worksheets/sheet1.xml", "w", force_zip64=True) as sheet:
            for _ in range(1_000):
                sheet.write(bytes(MILLION))
        archive.writestr("[Content_Types].xml", b"<x/>")
    seconds, found = seconds_to_read(written.getvalue(), ".xlsx")
    assert found == ()
    assert seconds < MOST_SECONDS
    graded_file = grade_files(tmp_path, {"table.xlsx": written.getvalue()})
    assert not graded_file.is_complete
    assert "table.xlsx holds more than a hand-in needs" in graded_file.problems[0]


@pytest.mark.long
def test_a_workbook_of_excel_97_with_many_cells_is_refused_at_once() -> None:
    excerpts(made.xls(RIGHT), ".xls")
    seconds, found = seconds_to_read(made.xls([[1.5] * 8] * 20_000), ".xls")
    assert found == ()
    assert seconds < MOST_SECONDS


@pytest.mark.parametrize("name", ["table.xlsx", "table.docx", "table.xltm"])
def test_a_file_with_macros_by_its_name_is_left_to_a_person(tmp_path: Path, name: str) -> None:
    found = grade_files(tmp_path, {name: xlsx_with(b"", {"xl/vbaProject.bin": b"x"})})
    assert not found.is_complete
    assert found.problems[0].startswith(f"{name} ")


def test_zip_files_in_zip_files_are_unpacked_to_a_limit(tmp_path: Path) -> None:
    content = made.zipped({"table.csv": made.csv(RIGHT)})
    assert grade_files(tmp_path / "1", {"one.zip": made.zipped({"in.zip": content})}).points == 8
    for _ in range(4):
        content = made.zipped({f"{i}.zip": content for i in range(10)})
    student = tmp_path / "2" / "class" / "anna"
    student.mkdir(parents=True)
    (student / "many.zip").write_bytes(content)
    [handed] = all_handed_in([tmp_path / "2" / "class"])
    took = []
    for _ in range(3):
        start = time.process_time()
        handed.files()
        took.append(time.process_time() - start)
    assert all(file.name.endswith(".zip") for file in handed.files())
    assert min(took) < MOST_SECONDS


def test_a_picture_in_rich_text_does_not_hide_the_table(tmp_path: Path) -> None:
    picture = b"{\\pict\\pngblip\\picw100\\pich100\n" + b"0123456789abcdef\n" * 100_000 + b"}"
    content = made.rtf(RIGHT)
    assert grade_files(tmp_path, {"t.rtf": content[:-1] + picture + b"}"}).points == 8
    seconds, found = seconds_to_read(content[:-1] + picture + b"}", ".rtf")
    assert found
    assert seconds < MOST_SECONDS


def test_two_cells_in_far_corners_cost_no_memory() -> None:
    book = openpyxl.Workbook()
    book.worksheets[0]["A1"] = 1
    book.worksheets[0]["XFD1048576"] = 2
    written = io.BytesIO()
    book.save(written)
    [excerpt] = excerpts(written.getvalue(), ".xlsx")
    assert excerpt.text == "1"


@given(st.binary(max_size=300), st.sampled_from(OFFICE_ENDINGS))
def test_any_bytes_are_read_or_refused(data: bytes, ending: str) -> None:
    try:
        found = excerpts(data, ending)
    except UnusableFileError:
        return
    assert any(each.text.strip() for each in found)


@pytest.mark.parametrize(
    ("encoding", "text"),
    [
        ("gb18030", "连杆长度,扭转角,偏距,关节角"), ("gb18030", "0, α, 0, θ1"),
        ("gb18030", "a2, 180°, 0, q2"), ("mac_roman", "a2, 180°, 0, q2"),
        ("mac_roman", "Länge, Winkel"), ("mac_roman", "0, π/2, 0, q1"),
        ("cp1251", "Длина, угол"), ("cp850", "a2, 180°, 0, q2"), ("cp437", "0, -90°, d1, q1"),
    ],
)  # fmt: skip
def test_text_in_another_encoding_is_not_guessed(encoding: str, text: str) -> None:
    with pytest.raises(UnusableFileError, match="save it as UTF-8"):
        decoded(f"a, b, c\n{text}\n".encode(encoding))


@pytest.mark.parametrize(
    "text",
    [
        "Länge, Größe, Übung, théta [°]", "180°, ±90°, l²/2, µ", "“a” – „b“…", "¡Hola! ¿qué?",
        "Ødegård, Žižek, Tomáš, Œuvre", "§ 5, 10 €", "mañana — «très»", "2 øvelser, 3 ører",
    ],
)  # fmt: skip
def test_text_in_windows_1252_is_read(text: str) -> None:
    assert decoded(text.encode("cp1252")) == text


# --- A value in merged cells is in each row and column that they cover, as people read it

# The first row and column, and the last.
Area = tuple[int, int, int, int]
# The zeros of α and d, below the headers, and those of d and θ in the last row.
ZEROS: Final[list[Area]] = [(1, 1, 3, 1), (1, 2, 3, 2), (4, 1, 4, 3)]


def covered(areas: list[Area]) -> set[tuple[int, int]]:
    return {
        (i, j)
        for top, left, bottom, right in areas
        for i in range(top, bottom + 1)
        for j in range(left, right + 1)
        if (i, j) != (top, left)
    }


def xlsx_merged(rows: Rows, areas: list[Area]) -> bytes:
    book = openpyxl.load_workbook(io.BytesIO(xlsx(rows)))
    for top, left, bottom, right in areas:
        book.active.merge_cells(None, top + 1, left + 1, bottom + 1, right + 1)
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def xls_merged(rows: Rows, areas: list[Area]) -> bytes:
    book = xlwt.Workbook()
    sheet = book.add_sheet("Sheet1")
    firsts = {(top, left): (bottom, right) for top, left, bottom, right in areas}
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            if (i, j) in firsts:
                bottom, right = firsts[i, j]
                sheet.write_merge(i, bottom, j, right, cell)
            elif (i, j) not in covered(areas):
                sheet.write(i, j, cell)
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def ods_merged(rows: Rows, areas: list[Area]) -> bytes:
    book = OpenDocumentSpreadsheet()
    table = Table(name="Sheet1")
    firsts = {(top, left): (bottom, right) for top, left, bottom, right in areas}
    for i, row in enumerate(rows):
        line = TableRow()
        for j, cell in enumerate(row):
            if (i, j) in covered(areas):
                line.addElement(CoveredTableCell())
                continue
            bottom, right = firsts.get((i, j), (i, j))
            entry = TableCell(
                valuetype="string",
                numberrowsspanned=bottom - i + 1,
                numbercolumnsspanned=right - j + 1,
            )
            entry.addElement(P(text=str(cell)))
            line.addElement(entry)
        table.addElement(line)
    book.spreadsheet.addElement(table)
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def docx_merged(rows: Rows, areas: list[Area]) -> bytes:
    document = docx.Document()
    table = document.add_table(len(rows), len(rows[0]))
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            if (i, j) not in covered(areas):
                table.cell(i, j).text = str(cell)
    for top, left, bottom, right in areas:
        table.cell(top, left).merge(table.cell(bottom, right))
    written = io.BytesIO()
    document.save(written)
    return written.getvalue()


MADE: Final[dict[str, Callable[[Rows, list[Area]], bytes]]] = {
    ".xlsx": xlsx_merged,
    ".xls": xls_merged,
    ".ods": ods_merged,
    ".docx": docx_merged,
}


@pytest.mark.parametrize("ending", MADE)
def test_a_value_in_merged_cells_is_in_each_of_them(tmp_path: Path, ending: str) -> None:
    found = grade_files(tmp_path, {f"table{ending}": MADE[ending](RIGHT, ZEROS)})
    assert (found.problems, found.points) == ((), 8)


@pytest.mark.parametrize("ending", MADE)
def test_a_wrong_value_in_merged_cells_is_wrong_in_each(tmp_path: Path, ending: str) -> None:
    wrong: Rows = [*RIGHT[:1], [0, 1.5, 0, "q1"], *RIGHT[2:]]
    found = grade_files(tmp_path, {f"table{ending}": MADE[ending](wrong, ZEROS[:2])})
    [part] = found.files[0].report.parts
    verdicts = [[cell.verdict for cell in row.cells][1] for row in part.rows]
    assert verdicts == ["incorrect", "incorrect", "incorrect", "correct"]


@pytest.mark.parametrize("ending", MADE)
def test_a_title_in_merged_cells_is_no_value(tmp_path: Path, ending: str) -> None:
    titled: Rows = [["Table", "", "", ""], *RIGHT]
    content = MADE[ending](titled, [(0, 0, 0, 3), *((a + 1, b, c + 1, d) for a, b, c, d in ZEROS)])
    assert excerpts(content, ending)[0].text.splitlines()[0].split() == ["Table"]
    found = grade_files(tmp_path, {f"table{ending}": content})
    assert (found.problems, found.points) == ((), 8)


def test_headers_in_merged_cells_stay_one_row(tmp_path: Path) -> None:
    rows: Rows = [["a", "alpha", "d", "theta"], ["", "(rad)", "", "(rad)"], *RIGHT[1:]]
    content = xlsx_merged(rows, [(0, 0, 1, 0), (0, 2, 1, 2)])
    found = grade_files(tmp_path, {"table.xlsx": content})
    assert (found.problems, found.points) == ((), 8)


def test_a_sheet_with_many_merged_cells_is_refused_at_once() -> None:
    # Each of the areas has all cells that a sheet may have.
    book = openpyxl.load_workbook(io.BytesIO(xlsx([*RIGHT, *[["1"]] * 490])))
    for _ in range(2_000):
        book.active.merged_cells.ranges.add(openpyxl.worksheet.merge.MergedCellRange(
            book.active, f"A{len(book.active.merged_cells.ranges) + 1}:BL500",
        ))  # fmt: skip
        if len(book.active.merged_cells.ranges) >= 400:
            break
    written = io.BytesIO()
    book.save(written)
    with pytest.raises(UnusableFileError, match="more than a hand-in needs"):
        excerpts(written.getvalue(), ".xlsx")
