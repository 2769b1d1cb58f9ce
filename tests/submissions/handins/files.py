"""Make the file of an answer in each kind, with the library of a program or by LibreOffice."""

import io
import json
import re
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any, Final

import docx
import numpy as np
import openpyxl
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import InlineFont

from tests.submissions import office_documents as office
from tests.submissions.handins.answers import COLUMNS, Answer, Cells
from tests.submissions.handins.spelling import Typed, typed

Rng = np.random.Generator
_WITHOUT_HEADED: Final = ("deg", "°", "pi", "π", "decimal")
_BEFORE: Final = ("Homework 3", "Ada Lovelace, 20 November")
_AFTER: Final = ("I checked the first row twice.",)


@dataclass(frozen=True)
class Made:
    """The content of a file, or of the file that LibreOffice converts to the ``target``."""

    content: bytes
    ending: str
    # The ending and the filter of LibreOffice, such as ``csv:Text - txt - csv (StarCalc)``.
    target: str = ""


@dataclass(frozen=True)
class Kind:
    """A kind of file. If it is not read, each such file must be listed for grading by hand."""

    name: str
    make: Callable[[Answer, Rng], Made]
    is_read: bool = True
    # Decimal commas: counted apart.
    is_apart: bool = False
    # The program of LibreOffice that writes the file, if one does.
    by_libreoffice: str = ""
    # True if a platform's editor writes the file, and not a student.
    is_editor: bool = False


# --- Spreadsheets ---


def _number(text: str) -> str | float:
    try:
        return float(text) if "." in text else int(text)
    except ValueError:
        return text


def _numbers(typed_answer: Typed) -> list[list[str | float]]:
    return [[_number(cell) for cell in row] for row in typed_answer.rows]


def _xlsx(answer: Answer, rng: Rng) -> Made:
    rows = _numbers(typed(answer, rng))
    title: list[list[str | float]] = [["Name", "Ada Lovelace"], []] if rng.random() < 0.4 else []
    return Made(office.xlsx([*title, *rows]), ".xlsx")


def _xlsx_formatted(answer: Answer, rng: Rng) -> Made:
    return Made(office.xlsx_by_another(_numbers(typed(answer, rng))), ".xlsx")


def _xlsx_indices(answer: Answer, rng: Rng) -> Made:
    """Return a workbook whose indices are lowered, in a font of their own."""
    book = openpyxl.Workbook()
    sheet = book.worksheets[0]
    lowered = InlineFont(vertAlign="subscript")
    for i, row in enumerate(typed(answer, rng).rows):
        for j, text in enumerate(row):
            cell = sheet.cell(i + 2, j + 2)
            found = re.fullmatch(r"([a-zθα]+)_?(\d+)", text)
            if found:
                cell.value = CellRichText(found[1], TextBlock(lowered, found[2]))
            else:
                cell.value = _number(text)
    written = io.BytesIO()
    book.save(written)
    return Made(written.getvalue(), ".xlsx")


def _xlsx_notes(answer: Answer, rng: Rng) -> Made:
    """Return a workbook with scratch work on another sheet and a remark or legend below a table."""
    remarks = [["checked twice"], ["Name", "Ada Lovelace"], ["L", "length of the link"]]
    rows: list[list[str | float]] = [*_numbers(typed(answer, rng)), []]
    rows.append([*remarks[int(rng.integers(3))]])
    names = ["DH", "Scratch"]
    sheets: list[office.Rows] = [rows, [["angles"], [90, 1.5708], [180, 3.1416]]]
    if rng.random() < 0.5:
        names, sheets = names[::-1], sheets[::-1]
    return Made(office.xlsx(*sheets, names=names), ".xlsx")


_FORMULAS: Final = {"pi/2": "PI()/2", "pi": "PI()", "pi/4": "PI()/4", "90": "180/2"}


def _with_formulas(answer: Answer, rng: Rng) -> bytes:
    # A workbook without the values of its formulas; LibreOffice calculates them.
    rows = typed(answer, rng, ("headed radians", "headed degrees", "pi")).rows
    cells = [[_as_formula(cell) for cell in row] for row in rows]
    return office.xlsx(cells)


def _as_formula(cell: str) -> str | float:
    plain = cell.lstrip("-−–")
    if plain in _FORMULAS:
        return f"={'-' if plain != cell else ''}{_FORMULAS[plain]}"
    return _number(cell)


def _calculated(target: str) -> Callable[[Answer, Rng], Made]:
    def make(answer: Answer, rng: Rng) -> Made:
        return Made(_with_formulas(answer, rng), ".xlsx", target)

    return make


def _xls(answer: Answer, rng: Rng) -> Made:
    return Made(office.xls(_numbers(typed(answer, rng))), ".xls")


def _ods(answer: Answer, rng: Rng) -> Made:
    return Made(office.ods(_numbers(typed(answer, rng))), ".ods")


# --- Documents ---


def _document(typed_answer: Typed, rng: Rng, *, is_equation: bool = False) -> bytes:
    document = docx.Document()
    for text in _BEFORE if rng.random() < 0.6 else ():
        document.add_paragraph(text)
    rows = typed_answer.rows
    table = document.add_table(len(rows), len(rows[0]))
    lowered = rng.random() < 0.5
    for i, (row, cells) in enumerate(zip(rows, table.rows, strict=True)):
        for j, (text, cell) in enumerate(zip(row, cells.cells, strict=True)):
            # LibreOffice 7.4 loses an equation at the beginning of a table.
            in_editor = is_equation and (i, j) != (0, 0)
            _write(cell.paragraphs[0], text, lowered=lowered, is_equation=in_editor)
    for text in _AFTER if rng.random() < 0.6 else ():
        document.add_paragraph(text)
    written = io.BytesIO()
    document.save(written)
    return written.getvalue()


_INDEXED: Final = re.compile(r"([a-zαθ]+)_?(\d+|\{i-1\}|i\b)")


def _write(paragraph: Any, text: str, *, lowered: bool, is_equation: bool) -> None:
    if is_equation:
        paragraph._p.append(_equation(text))
        return
    if not lowered:
        paragraph.add_run(text)
        return
    position = 0
    for found in _INDEXED.finditer(text):
        paragraph.add_run(text[position : found.start()] + found[1])
        paragraph.add_run(found[2].strip("{}")).font.subscript = True
        position = found.end()
    paragraph.add_run(text[position:])


def _equation(text: str) -> Any:
    """Return a text in the equation editor of Word: fractions, indices and degrees."""
    formula = OxmlElement("m:oMath")
    position = 0
    for found in re.finditer(r"([πp]i?)/(\d)|([a-zαθ]+)_?(\d+)|(\d+)°", text):
        _append(formula, text[position : found.start()])
        if found[2]:
            formula.append(_structure("m:f", ("m:num", found[1]), ("m:den", found[2])))
        elif found[4]:
            formula.append(_structure("m:sSub", ("m:e", found[3]), ("m:sub", found[4])))
        else:
            formula.append(_structure("m:sSup", ("m:e", found[5]), ("m:sup", "∘")))
        position = found.end()
    _append(formula, text[position:])
    return formula


def _structure(name: str, *parts: tuple[str, str]) -> Any:
    element = OxmlElement(name)
    for own, text in parts:
        part = OxmlElement(own)
        _append(part, text)
        element.append(part)
    return element


def _append(element: Any, text: str) -> None:
    if text:
        run = OxmlElement("m:r")
        letters = OxmlElement("m:t")
        letters.text = text
        letters.set(qn("xml:space"), "preserve")
        run.append(letters)
        element.append(run)


def _docx(answer: Answer, rng: Rng) -> Made:
    return Made(_document(typed(answer, rng), rng), ".docx")


def _docx_equations(answer: Answer, rng: Rng) -> Made:
    shown = typed(answer, rng, ("°", "pi", "π"))
    return Made(_document(shown, rng, is_equation=True), ".docx")


def _lines(typed_answer: Typed, separator: str) -> list[str]:
    return [separator.join(row) for row in typed_answer.rows]


def _docx_lines(answer: Answer, rng: Rng) -> Made:
    separator = str(rng.choice((", ", "\t", " | ")))
    return Made(office.docx_lines(_lines(typed(answer, rng), separator)), ".docx")


def _converted(make: Callable[[Answer, Rng], Made], target: str) -> Callable[[Answer, Rng], Made]:
    return lambda answer, rng: replace(make(answer, rng), target=target)


def _rtf(answer: Answer, rng: Rng) -> Made:
    return Made(office.rtf(typed(answer, rng).rows), ".rtf")


# --- Notebooks and scripts ---


def _notebook_text(answer: Answer, rng: Rng) -> Made:
    shown = office.markdown(_with_header(typed(answer, rng)))
    cells = [("markdown", f"# Homework 3\n\nMy answer:\n\n{shown}\n")]
    if rng.random() < 0.5:
        cells.append(("code", "import numpy as np\nprint(np.pi)"))
    return Made(office.notebook(*cells), ".ipynb")


def _with_header(typed_answer: Typed) -> Cells:
    # Every table of Markdown has a header; above a matrix, it is empty.
    rows = typed_answer.rows
    return rows if typed_answer.has_header else [[""] * len(rows[0]), *rows]


_PRODUCT: Final = re.compile(r"(?<=[\w)]) (?=[\w(])")


def _in_python(cell: str, pi: str) -> str:
    with_pi = re.sub(r"\bpi\b", pi, _PRODUCT.sub("*", cell))
    return re.sub(r"\b(cos|sin)\(", r"np.\1(" if "." in pi else r"\1(", with_pi)


def _python_rows(answer: Answer, rng: Rng, pi: str) -> str:
    rows = typed(answer, rng, ("pi",), is_plain=True).rows
    lines = (f"    [{', '.join(_in_python(cell, pi) for cell in row)}],\n" for row in rows)
    return "[\n" + "".join(lines) + "]"


def _numpy(answer: Answer, rng: Rng) -> str:
    comment = "# a, alpha, d, theta\n" if answer.is_table else ""
    return f"import numpy as np\n\n{comment}DH = np.array({_python_rows(answer, rng, 'np.pi')})\n"


def _sympy(answer: Answer, rng: Rng) -> str:
    words = " ".join(cell for row in answer.cells for cell in row)
    names = sorted(set(re.findall(r"[a-z]+\d+", words)))
    symbols = f"{', '.join(names)} = symbols('{' '.join(names)}')\n"
    rows = _python_rows(answer, rng, "pi")
    return f"from sympy import *\n\n{symbols}\nM = Matrix({rows})\nM\n"


def _pandas(answer: Answer, rng: Rng) -> str:
    if not answer.is_table:
        return _numpy(answer, rng)
    rows = _python_rows(answer, rng, "np.pi")
    quoted = re.sub(r"(?<=[\[ ])([^\[\],\n]+)(?=[\],])", r'"\1"', rows)
    columns = ", ".join(f'"{name}"' for name in COLUMNS)
    return f"import pandas as pd\n\npd.DataFrame({quoted}, columns=[{columns}])\n"


def _notebook_code(write: Callable[[Answer, Rng], str]) -> Callable[[Answer, Rng], Made]:
    def make(answer: Answer, rng: Rng) -> Made:
        cells = [("markdown", "# Homework 3"), ("code", write(answer, rng))]
        if rng.random() < 0.5:
            cells.append(("markdown", "That is all."))
        return Made(office.notebook(*cells), ".ipynb")

    return make


def _notebook_latex(answer: Answer, rng: Rng) -> Made:
    return Made(office.notebook(("markdown", f"$$\n{_in_latex(answer, rng)}\n$$")), ".ipynb")


def _in_latex(answer: Answer, rng: Rng) -> str:
    rows = typed(answer, rng, ("pi",)).rows
    names = "array" if answer.is_table else "bmatrix"
    columns = f"{{{'c' * len(rows[0])}}}" if answer.is_table else ""
    lines = " \\\\\n".join(" & ".join(map(_latex, row)) for row in rows)
    return f"\\begin{{{names}}}{columns}\n{lines}\n\\end{{{names}}}"


def _latex(cell: str) -> str:
    cell = re.sub(r"(?:(\d)\*)?pi/(\d)", r"\\frac{\1\\pi}{\2}", cell)
    cell = re.sub(r"(?<!\\)\b(alpha|theta|pi|cos|sin)(?=[\d_(\b ]|$)", r"\\\1", cell)
    cell = re.sub(r"([α]|θ)", lambda it: {"α": r"\alpha", "θ": r"\theta"}[it[1]], cell)
    cell = re.sub(r"(?<=[a-z])(\d)\b", r"_\1", cell)
    return cell.replace("−", "-").replace("–", "-").replace("#", r"\#")


def _tex(answer: Answer, rng: Rng) -> Made:
    body = _in_latex(answer, rng)
    page = f"\\documentclass{{article}}\n\\begin{{document}}\n\\[\n{body}\n\\]\n\\end{{document}}\n"
    return Made(page.encode(), ".tex")


def _python(answer: Answer, rng: Rng) -> Made:
    return Made((_numpy if rng.random() < 0.5 else _sympy)(answer, rng).encode(), ".py")


def _matlab(answer: Answer, rng: Rng) -> Made:
    rows = typed(answer, rng, ("pi",), is_plain=True).rows
    lines = ";\n      ".join(", ".join(_PRODUCT.sub("*", cell) for cell in row) for row in rows)
    comment = "% a, alpha, d, theta\n" if answer.is_table else ""
    return Made(f"clear all\n{comment}M = [ {lines} ];\n".encode(), ".m")


# --- Texts ---


def _markdown(answer: Answer, rng: Rng) -> Made:
    return Made(office.markdown(_with_header(typed(answer, rng))).encode(), ".md")


def _separated(
    separators: Sequence[str], encodings: Sequence[str], ending: str
) -> Callable[[Answer, Rng], Made]:
    def make(answer: Answer, rng: Rng) -> Made:
        separator, encoding = str(rng.choice(separators)), str(rng.choice(encodings))
        end = str(rng.choice(("\n", "\r\n")))
        text = end.join(_lines(typed(answer, rng), separator)) + end * int(rng.integers(3))
        if encoding == "cp1252":
            # This encoding has no Greek letters and no minus sign.
            signs = {"θ": "theta", "α": "alpha", "π": "pi", "−": "-"}
            text = "".join(signs.get(sign, sign) for sign in text)
        return Made(text.encode(encoding), ending)

    return make


def _blanks(answer: Answer, rng: Rng) -> Made:
    rows = [[cell.replace(" ", "") for cell in row] for row in typed(answer, rng).rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = (
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )
    return Made("\n".join(lines).encode(), ".txt")


def _json(answer: Answer, rng: Rng) -> Made:
    content = json.dumps({"answers": {answer.part: answer.as_json()}})
    return Made(content.encode(str(rng.choice(("utf-8", "utf-8-sig")))), ".json")


def _toml(answer: Answer, rng: Rng) -> Made:
    return Made(f"answers.{answer.part} = {json.dumps(answer.cells)}\n".encode(), ".toml")


_EDITORS: Final = {
    "Moodle": office.moodle_text,
    "Canvas": office.canvas_text,
    "Brightspace": office.brightspace_text,
}


def _editor(name: str) -> Callable[[Answer, Rng], Made]:
    return lambda answer, rng: Made(_EDITORS[name](typed(answer, rng).rows), ".html")


def _editor_table(answer: Answer, rng: Rng) -> Made:
    """Return a table as an editor inserts it, with empty paragraphs around it."""
    rows = ""
    for row in typed(answer, rng).rows:
        cells = "".join(f'<td style="width: 20%">{escape(cell)}</td>' for cell in row)
        rows += f"<tr>{cells}</tr>\n"
    page = f"<p>My answer:&nbsp;</p><table border='1'><tbody>\n{rows}</tbody></table><p>&nbsp;</p>"
    return Made(page.encode(), ".html")


# --- Archives ---


def _zip(answer: Answer, rng: Rng) -> Made:
    """Return a zip file as Windows or macOS makes it, with folders and files of the system."""
    inner = _PLAIN[int(rng.integers(len(_PLAIN)))](answer, rng)
    name = f"Homework 3/{answer.part}{inner.ending}"
    files = {name: inner.content}
    if rng.random() < 0.5:
        files |= {f"__MACOSX/Homework 3/._{answer.part}{inner.ending}": b"\0\5\x16\7\0\2"}
        files |= {"Homework 3/.DS_Store": b"\0\0\0\1Bud1"}
    if rng.random() < 0.3:
        files = {"hand-in/inner.zip": office.zipped(files)}
    return Made(office.zipped(files), ".zip")


_PLAIN: Final = (_xlsx, _docx, _markdown, _separated((",",), ("utf-8",), ".csv"), _notebook_text)


# --- Files that no program reads ---


def _png(_: Answer, rng: Rng) -> Made:
    """Return a photo of 64 × 64 grey pixels."""
    rows = b"".join(b"\0" + rng.integers(0, 256, 64, np.uint8).tobytes() for _ in range(64))
    head = (64).to_bytes(4, "big") * 2 + b"\x08\0\0\0\0"
    blocks = ((b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    written = b"".join(
        len(data).to_bytes(4, "big") + name + data + zlib.crc32(name + data).to_bytes(4, "big")
        for name, data in blocks
    )
    return Made(b"\x89PNG\r\n\x1a\n" + written, ".png")


def _jpg(_: Answer, rng: Rng) -> Made:
    return Made(b"\xff\xd8\xff\xe0\0\x10JFIF\0" + rng.bytes(500), ".jpg")


def _empty(_: Answer, rng: Rng) -> Made:
    ending = str(rng.choice((".csv", ".xlsx", ".docx", ".txt", ".json", ".ipynb", ".rtf", ".zip")))
    return Made(b"", ending)


def _blank(_: Answer, rng: Rng) -> Made:
    return (
        Made(office.xlsx([[""]]), ".xlsx"),
        Made(office.docx_lines([""]), ".docx"),
        Made(b"<p>&nbsp;</p>", ".html"),
        Made(office.notebook(("code", "")), ".ipynb"),
        Made(office.zipped({"folder/": b""}), ".zip"),
        Made(b"\r\n \r\n", ".txt"),
    )[int(rng.integers(6))]


def _words(_: Answer, rng: Rng) -> Made:
    text = "Please see the paper that I gave to Anna in class."
    return (
        Made(text.encode(), ".txt"),
        Made(office.docx_lines([text]), ".docx"),
        Made(f"<p>{text}</p>".encode(), ".html"),
        Made(office.xlsx([[text]]), ".xlsx"),
    )[int(rng.integers(4))]


# --- Decimal commas ---


def _comma(text: str) -> str:
    return re.sub(r"(?<=\d)\.(?=\d)", ",", text)


def _decimal_commas(answer: Answer, rng: Rng) -> Made:
    shown = typed(answer, rng, _WITHOUT_HEADED)
    rows = [[_comma(cell) for cell in row] for row in shown.rows]
    commas = Typed(rows, shown.has_header, shown.is_table)
    return (
        Made("\r\n".join(_lines(commas, ";")).encode(), ".csv"),
        Made("\n".join(_lines(commas, "\t")).encode(), ".txt"),
        Made(office.xlsx(rows), ".xlsx"),
        Made(_document(commas, rng), ".docx"),
    )[int(rng.integers(4))]


_UTF_8: Final = ("utf-8", "utf-8-sig")
KINDS: Final = (
    Kind("xlsx, openpyxl", _xlsx),
    Kind("xlsx, XlsxWriter", _xlsx_formatted),
    Kind("xlsx, lowered indices", _xlsx_indices),
    Kind("xlsx, two sheets", _xlsx_notes),
    Kind("xlsx, LibreOffice", _calculated("xlsx"), by_libreoffice="Calc"),
    Kind("xls, xlwt", _xls),
    Kind("xls, LibreOffice", _calculated("xls"), by_libreoffice="Calc"),
    Kind("ods, odfpy", _ods),
    Kind("ods, LibreOffice", _calculated("ods"), by_libreoffice="Calc"),
    Kind(
        "csv, LibreOffice",
        _calculated("csv:Text - txt - csv (StarCalc):44,34,76,1"),
        by_libreoffice="Calc",
    ),
    Kind("html of a sheet, LibreOffice", _calculated("html"), by_libreoffice="Calc"),
    Kind("docx, python-docx", _docx),
    Kind("docx, equations", _docx_equations),
    Kind("docx, lines", _docx_lines),
    Kind("docx, LibreOffice", _converted(_docx, "docx"), by_libreoffice="Writer"),
    Kind(
        "docx, equations, LibreOffice", _converted(_docx_equations, "docx"), by_libreoffice="Math"
    ),
    Kind("rtf, WordPad", _rtf),
    Kind("rtf, LibreOffice", _converted(_docx, "rtf"), by_libreoffice="Writer"),
    Kind("rtf of lines, LibreOffice", _converted(_docx_lines, "rtf"), by_libreoffice="Writer"),
    Kind("html of a document, LibreOffice", _converted(_docx, "html"), by_libreoffice="Writer"),
    Kind("ipynb, Markdown", _notebook_text),
    Kind("ipynb, NumPy", _notebook_code(_numpy)),
    Kind("ipynb, SymPy", _notebook_code(_sympy)),
    Kind("ipynb, pandas", _notebook_code(_pandas)),
    Kind("ipynb, LaTeX", _notebook_latex),
    Kind("csv, commas", _separated((",", ", "), (*_UTF_8, "cp1252"), ".csv")),
    Kind("csv, semicolons", _separated((";", "; "), (*_UTF_8, "cp1252"), ".csv")),
    Kind("csv, UTF-16", _separated((",", ";", "\t"), ("utf-16",), ".csv")),
    Kind("tsv", _separated(("\t",), (*_UTF_8, "utf-16"), ".tsv")),
    Kind("txt, separated", _separated((", ", ";", "\t", " | "), (*_UTF_8, "utf-16"), ".txt")),
    Kind("txt, Windows-1252", _separated((", ", ";", "\t", " | "), ("cp1252",), ".txt")),
    Kind("txt, blanks", _blanks),
    Kind("md", _markdown),
    Kind("tex", _tex),
    Kind("m", _matlab),
    Kind("py", _python),
    Kind("json", _json),
    Kind("toml", _toml),
    Kind("editor of Moodle", _editor("Moodle"), is_editor=True),
    Kind("editor of Canvas", _editor("Canvas"), is_editor=True),
    Kind("editor of Brightspace", _editor("Brightspace"), is_editor=True),
    Kind("table in an editor", _editor_table, is_editor=True),
    Kind("zip", _zip),
    Kind("pdf, LibreOffice", _converted(_docx, "pdf"), is_read=False, by_libreoffice="Writer"),
    Kind("odt, LibreOffice", _converted(_docx, "odt"), is_read=False, by_libreoffice="Writer"),
    Kind("doc, LibreOffice", _converted(_docx, "doc"), is_read=False, by_libreoffice="Writer"),
    Kind("png", _png, is_read=False),
    Kind("jpg", _jpg, is_read=False),
    Kind("empty file", _empty, is_read=False),
    Kind("blank file", _blank, is_read=False),
    Kind("words only", _words, is_read=False),
    Kind("decimal commas", _decimal_commas, is_apart=True),
)
