"""A value in merged cells is in each row and column that they cover, as people read it."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Final

import docx
import openpyxl
import pytest
import xlwt
from dh_grader.submissions.documents import UnusableFileError
from dh_grader.submissions.office_files import excerpts
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import CoveredTableCell, Table, TableCell, TableRow
from odf.text import P

from tests.submissions.office_documents import Rows, xlsx
from tests.submissions.test_office_files import RIGHT, grade_files

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
