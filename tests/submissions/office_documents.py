"""Make files of office programs, notebooks and web editors by the libraries of these programs."""

import io
import json
import zipfile
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import Final

import docx
import openpyxl
import xlsxwriter
import xlwt
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import Table, TableCell, TableRow
from odf.text import P

Rows = Sequence[Sequence[str | float]]


def xlsx(*sheets: Rows, names: Sequence[str] = ()) -> bytes:
    """Return a workbook as openpyxl writes it, with one sheet for each table."""
    book = openpyxl.Workbook()
    book.remove(book.worksheets[0])
    for i, rows in enumerate(sheets):
        sheet = book.create_sheet(names[i] if names else f"Sheet{i + 1}")
        for row in rows:
            sheet.append([None if cell == "" else cell for cell in row])
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def xlsx_by_another(rows: Rows) -> bytes:
    """Return a workbook as XlsxWriter writes it, with formats and a table that begins in C4."""
    written = io.BytesIO()
    book = xlsxwriter.Workbook(written)
    sheet = book.add_worksheet("Tabelle1")
    bold = book.add_format({"bold": True, "border": 1})
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            sheet.write(i + 3, j + 2, cell, bold if i == 0 else None)
    book.close()
    return written.getvalue()


def xls(rows: Rows) -> bytes:
    """Return a workbook in the format of Excel 97."""
    book = xlwt.Workbook()
    sheet = book.add_sheet("Sheet1")
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            sheet.write(i, j, cell)
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def ods(rows: Rows) -> bytes:
    """Return a spreadsheet of OpenDocument; like LibreOffice, it fills the sheet with blanks."""
    book = OpenDocumentSpreadsheet()
    table = Table(name="Sheet1")
    for row in rows:
        line = TableRow()
        for cell in row:
            kind = {"valuetype": "string"}
            if not isinstance(cell, str):
                kind = {"valuetype": "float", "value": str(cell)}
            entry = TableCell(**kind)
            entry.addElement(P(text=str(cell)))
            line.addElement(entry)
        line.addElement(TableCell(numbercolumnsrepeated=16_000))
        table.addElement(line)
    rest = TableRow(numberrowsrepeated=1_000_000)
    rest.addElement(TableCell(numbercolumnsrepeated=16_384))
    table.addElement(rest)
    book.spreadsheet.addElement(table)
    written = io.BytesIO()
    book.save(written)
    return written.getvalue()


def docx_table(rows: Rows, before: Sequence[str] = (), after: Sequence[str] = ()) -> bytes:
    """Return a document with a table between paragraphs, as python-docx writes it."""
    document = docx.Document()
    for text in before:
        document.add_paragraph(text)
    table = document.add_table(0, len(rows[0]))
    for row in rows:
        for cell, value in zip(table.add_row().cells, row, strict=True):
            cell.text = str(value)
    for text in after:
        document.add_paragraph(text)
    return _saved(document)


def docx_lines(lines: Sequence[str]) -> bytes:
    """Return a document of paragraphs."""
    document = docx.Document()
    for line in lines:
        document.add_paragraph(line)
    return _saved(document)


def _saved(document: "docx.document.Document") -> bytes:
    written = io.BytesIO()
    document.save(written)
    return written.getvalue()


def rtf(rows: Rows) -> bytes:
    """Return a document in rich text as WordPad writes it: Greek letters as numbers."""
    lines = []
    for row in rows:
        widths = "".join(f"\\cellx{1500 * (i + 1)}" for i in range(len(row)))
        cells = "".join(f"\\intbl {_in_rtf(str(cell))}\\cell" for cell in row)
        lines.append(f"\\trowd{widths}{cells}\\row\n")
    head = "{\\rtf1\\ansi\\ansicpg1252\\deff0{\\fonttbl{\\f0\\fswiss Arial;}}"
    head += "\\viewkind4\\uc1\\pard\\f0 "
    return (head + "".join(lines) + "\\pard\\par\n}").encode("ascii")


def _in_rtf(text: str) -> str:
    return "".join(c if ord(c) < 128 and c not in "\\{}" else f"\\u{ord(c)}?" for c in text)


def notebook(*cells: tuple[str, str], printed: str = "") -> bytes:
    """Return a Jupyter notebook with cells of a kind and a source."""
    written = []
    for kind, source in cells:
        cell: dict[str, object] = {
            "cell_type": kind, "metadata": {}, "source": source.splitlines(keepends=True),
        }  # fmt: skip
        if kind == "code":
            cell |= {"execution_count": 1, "outputs": []}
        written.append(cell)
    if printed:
        written[-1]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": [printed]}]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return json.dumps(
        {"cells": written, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    ).encode()


def csv(rows: Rows, separator: str = ",", encoding: str = "utf-8") -> bytes:
    """Return rows as lines with a separator between the cells."""
    return "\r\n".join(separator.join(map(str, row)) for row in rows).encode(encoding)


def markdown(rows: Rows) -> str:
    """Return a table in Markdown."""
    lines = [f"| {' | '.join(map(str, row))} |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])


def python_list(rows: Rows) -> str:
    """Return the rows below the header as a list in a Python script."""
    lines = (f"    [{', '.join(map(str, row))}],\n" for row in rows[1:])
    return f"import numpy as np\n\ndh = np.array([\n{''.join(lines)}])\n"


# The web pages that the editors of platforms make of typed lines.


def moodle_text(rows: Rows) -> bytes:
    """Return lines as Moodle's editor sends them, a paragraph each, in the page of its export."""
    lines = "".join(f'<p dir="ltr" style="text-align: left;">{_html(row)}</p>' for row in rows)
    head = '<!DOCTYPE html><html><head><title>a</title><meta charset="utf-8"></head>'
    return f"{head}<body>{lines}</body></html>".encode()


def canvas_text(rows: Rows) -> bytes:
    """Return lines as the editor of Canvas sends them, with line breaks in one paragraph."""
    lines = "<br />".join(map(_html, rows))
    return f"<html><head><title>x</title></head><body><p>{lines}</p></body></html>".encode()


def brightspace_text(rows: Rows) -> bytes:
    """Return lines as the editor of Brightspace sends them."""
    lines = "".join(f"<div><span>{_html(row)}</span></div>\n" for row in rows)
    return f"<div>{lines}<p>&nbsp;</p></div>".encode()


def _html(row: Sequence[str | float]) -> str:
    return ",&nbsp;".join(escape(str(cell)) for cell in row)


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return a zip file."""
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return written.getvalue()


# Every kind of file that holds a table: the name of the file, and the function that makes it.
KINDS: Final[Mapping[str, tuple[str, Callable[[Rows], bytes]]]] = {
    "xlsx": ("table.xlsx", xlsx),
    "xlsx by another program": ("table.xlsx", xlsx_by_another),
    "xls": ("table.xls", xls),
    "ods": ("table.ods", ods),
    "docx": ("table.docx", docx_table),
    "docx with texts": (
        "table.docx",
        lambda rows: docx_table(rows, ["Homework 3", "Ada Byron"], ["I checked it twice."]),
    ),
    "docx of lines": (
        "table.docx",
        lambda rows: docx_lines([", ".join(map(str, row)) for row in rows]),
    ),
    "rtf": ("table.rtf", rtf),
    "notebook, Markdown": ("table.ipynb", lambda rows: notebook(("markdown", markdown(rows)))),
    "notebook, code": ("table.ipynb", lambda rows: notebook(("code", python_list(rows)))),
    "notebook, both": (
        "table.ipynb",
        lambda rows: notebook(
            ("markdown", "# Homework 3\n\nMy table:"), ("code", python_list(rows))
        ),
    ),
    "notebook, printed": (
        "table.ipynb",
        lambda rows: notebook(
            ("code", "print(table())"), printed="\n".join(",".join(map(str, row)) for row in rows)
        ),
    ),
    "CSV": ("table.csv", csv),
    "TSV": ("table.tsv", lambda rows: csv(rows, "\t")),
    "CSV in Windows-1252": ("table.csv", lambda rows: csv([["Lösung"], *rows], ",", "cp1252")),
    "CSV in UTF-16": ("table.csv", lambda rows: csv(rows, "\t", "utf-16")),
    "semicolons": ("table.csv", lambda rows: csv(rows, ";")),
    "Moodle's editor": ("onlinetext.html", moodle_text),
    "Canvas' editor": ("byronada_1234_text.html", canvas_text),
    "Brightspace's editor": ("answer.html", brightspace_text),
    "zip": ("hand-in.zip", lambda rows: zipped({"table.csv": csv(rows)})),
    "zip with a folder": ("hw.zip", lambda rows: zipped({"hw/table.xlsx": xlsx(rows)})),
}
