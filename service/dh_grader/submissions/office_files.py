"""Read the texts and tables in files of office programs, notebooks and web editors.

Each reader returns excerpts: pieces of the file that may be the answer, the likeliest first. This
file knows nothing about robots or parts; `local_grading.py` chooses the excerpt that can be
graded.
All work is bounded: a file whose parts are too large or hostile is refused before it is parsed.
"""

import io
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date, datetime, time, timedelta
from functools import partial
from itertools import groupby, islice
from typing import Any, Final
from xml.etree import ElementTree as ET

from dh_grader.grading.reading.headers import QUANTITIES, is_wordy, read_header
from dh_grader.regex import regex
from dh_grader.submissions.documents import (
    MAX_TAGS,
    Excerpt,
    UnusableFileError,
    around_table,
    local_name,
    notebook_excerpts,
    pasted_from,
    struck_out,
    too_much,
    web_page,
    written_formula,
)
from dh_grader.translations import say

# Bytes of the XML in one file after unpacking. A table of a student needs a hundredth of that.
MAX_XML: Final = 2 * 1024 * 1024
# The most cells of a sheet. A wide table with its title and scratch work has a few hundred.
MAX_CELLS: Final = 10_000
# Records of a workbook of Excel 97: a cell is one, and so are a row, a font and a style.
MAX_RECORDS: Final = 2 * MAX_CELLS
# Bytes of rich text without its pictures, and its braces and backslashes.
MAX_RTF: Final = 512 * 1024
MAX_RTF_SIGNS: Final = 30_000
MAX_ROWS: Final = 500
MAX_COLUMNS: Final = 64
MAX_EXCERPTS: Final = 12
# Documents with tables in tables have about 40.
MAX_DEPTH: Final = 200
MAX_ARCHIVE_ENTRIES: Final = 4_000


SheetRow = Sequence[str]


# --- Archives: a file of an office program is a zip file of XML


def open_archive(data: bytes) -> zipfile.ZipFile:
    """Open a zip file. Raises UnusableFileError if it is damaged or has too many entries."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
    except (zipfile.BadZipFile, ValueError, OSError, NotImplementedError) as error:
        raise _damaged() from error
    if len(archive.infolist()) > MAX_ARCHIVE_ENTRIES:
        raise UnusableFileError(say("holds more than {most:,} files", most=MAX_ARCHIVE_ENTRIES))
    return archive


# What ``zipfile`` raises for a damaged or encrypted entry.
UNREADABLE_ARCHIVE: Final = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    OSError,
    NotImplementedError,
    RuntimeError,
)


def unpacked(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    """Return an entry of a zip file with at most ``most`` bytes. Raises UnusableFileError."""
    info = archive.getinfo(name)
    if info.flag_bits & 1:
        raise UnusableFileError(say("is encrypted; hand it in without a password"))
    try:
        # A false size in the directory makes zipfile stop there and report a wrong checksum.
        with archive.open(info) as entry:
            content = entry.read(most + 1)
    except UNREADABLE_ARCHIVE as error:
        raise _damaged() from error
    if len(content) > most:
        raise too_much()
    return content


def _damaged() -> UnusableFileError:
    return UnusableFileError(say("is damaged, or not what its name says"))


class _Package:
    """The XML parts of a file of an office program."""

    def __init__(self, data: bytes, *, may_have_macros: bool = False) -> None:
        # Macros are never read. A file whose name hides them is suspect.
        self._archive = open_archive(data)
        self._left = MAX_XML
        self._tags = MAX_TAGS
        self.names = tuple(self._archive.namelist())
        for name in self.names:
            lowered = name.lower()
            is_macro = "vbaproject" in lowered and not may_have_macros
            if is_macro or lowered.startswith(("basic/", "scripts/")):
                raise UnusableFileError(say("has macros; save it without macros"))
            if "externallinks/" in lowered:
                raise UnusableFileError(
                    say("takes values from other files; save it with its own values")
                )

    def read(self, name: str) -> bytes:
        """Return the XML part with this name. Raises UnusableFileError."""
        if name not in self.names:
            raise _damaged()
        content = unpacked(self._archive, name, self._left)
        self._left -= len(content)
        self._tags -= content.count(b"<")
        if self._tags < 0:
            raise too_much()
        return content

    def parsed(self, name: str) -> ET.Element:
        """Return the root of the XML part with this name. Raises UnusableFileError."""
        return parsed_xml(self.read(name))


def parsed_xml(content: bytes) -> ET.Element:
    """Return the root element of XML without a document type. Raises UnusableFileError."""
    _require_plain(content)
    try:
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError, LookupError) as error:
        raise _damaged() from error
    level = [root]
    for _ in range(MAX_DEPTH):
        level = [child for element in level for child in element]
        if not level:
            return root
    raise _damaged()


def _require_plain(content: bytes) -> None:
    # In UTF-16, the marks of a document type would not be found.
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content or b"\0" in content[:200]:
        raise _damaged()


def _attribute(element: ET.Element, name: str) -> str:
    for key, value in element.attrib.items():
        if key.rpartition("}")[2] == name:
            return value
    return ""


# --- Spreadsheets


def _xlsx(data: bytes, *, may_have_macros: bool = False) -> Iterator[Excerpt]:
    package = _Package(data, may_have_macros=may_have_macros)
    kept = io.BytesIO()
    parts: dict[str, bytes] = {}
    # A copy of only the parts that are read, so that the library meets nothing else.
    with zipfile.ZipFile(kept, "w") as copy:
        for name in package.names:
            if not name.endswith((".xml", ".rels")) or not _OF_SHEETS.match(name):
                continue
            content = package.read(name)
            _require_plain(content)
            if "worksheets/" in name:
                parts[name] = content
                _require_few_cells(content)
                if _WITHOUT_VALUE.search(content):
                    raise UnusableFileError(
                        say(
                            "has formulas without their values; open it in a spreadsheet "
                            "program, and save it there"
                        )
                    )
            if b"strike" in content:
                content = _STRUCK_IN_XLSX.sub(rb"\1~~\2~~", content)
            copy.writestr(name, content)
    # Loaded only if there is such a file.
    from openpyxl import load_workbook

    book = load_workbook(kept, read_only=True, data_only=True, keep_links=False)
    sheets = []
    for sheet in book.worksheets:
        if sheet.sheet_state == "visible":
            sheet.reset_dimensions()
            rows = sheet.iter_rows(max_row=MAX_ROWS, max_col=MAX_COLUMNS)
            content = parts.get(sheet._worksheet_path, b"")
            hidden = _Hidden.of_xlsx(content)
            cells = [list(map(_of_xlsx, row)) for row in rows]
            sheets.append((sheet.title, hidden.without(_filled(cells, _merged_in_xlsx(content)))))
    yield from _of_sheets(
        sheets,
        comments=[*_notes(package, _NOTES_OF_SHEETS)],
        boxes=[*_notes(package, _BOXES_OF_SHEETS)],
    )


def _of_xlsx(cell: Any) -> str:
    if cell.value is None:
        return ""
    text = _with_unit(cell.value, cell.number_format)
    return struck_out(text) if cell.font and cell.font.strike else text


# A piece of a text that is struck out, in the XML of a workbook.
_STRUCK_IN_XLSX: Final = regex(
    rb"(<(?:\w{1,9}:)?rPr>(?:\s{0,9}<[^/<>][^<>]{0,200}>){0,20}?"
    rb"\s{0,9}<(?:\w{1,9}:)?strike(?:\s{1,9}val=[\"'](?:1|true)[\"'])?\s{0,9}/>"
    rb"(?:\s{0,9}<[^/<>][^<>]{0,200}>){0,20}\s{0,9}</(?:\w{1,9}:)?rPr>"
    rb"\s{0,9}<(?:\w{1,9}:)?t(?:\s[^<>]{0,60})?>\s{0,20})([^<>~\s][^<>~]{0,399})(?=</)"
)


# The first row and column of merged cells, and the row and column after the last.
_Area = tuple[int, int, int, int]


def _merged_in_xlsx(content: bytes) -> Iterator[_Area]:
    for found in _MERGED.finditer(content):
        left, top, right, bottom = found.groups()
        yield int(top) - 1, _column_number(left) - 1, int(bottom), _column_number(right)


def _column_number(letters: bytes) -> int:
    number = 0
    for letter in letters:
        number = 26 * number + letter - ord("A") + 1
    return number


_MERGED: Final = regex(
    rb"<(?:\w{1,20}:)?mergeCell\s[^<>]{0,99}?ref=[\"']([A-Z]{1,3})(\d{1,7}):([A-Z]{1,3})(\d{1,7})[\"']"
)


def _filled(rows: Sequence[SheetRow], areas: Iterable[_Area]) -> list[SheetRow]:
    """Return the rows with the value of merged cells in each row and column that they cover.

    People read it so. In several columns, only a number or a formula does: words are a title.
    Merged cells of the headers and above them keep their value in their first cell. Values that
    merged cells cover are not read, because nobody sees them.
    """
    filled = [list(row) for row in rows]
    headers = next((i for i, row in enumerate(rows) if _has_headers(row)), -1)
    left = MAX_CELLS
    for top, first, bottom, last in areas:
        bottom, last = min(bottom, len(filled)), min(last, MAX_COLUMNS)
        left -= max(bottom - top, 0) * max(last - first, 0)
        if left < 0:
            raise too_much()
        value = filled[top][first] if top < len(filled) and first < len(filled[top]) else ""
        is_value = len(value.split()) == 1 and not is_wordy(value)
        is_entry = top > headers and (last - first == 1 or is_value)
        for i in range(top, bottom):
            filled[i] += [""] * (last - len(filled[i]))
            filled[i][first:last] = [value if is_entry else ""] * (last - first)
        if top < bottom and first < last:
            filled[top][first] = value
    return list(filled)


# The fewest headers that make a row the row of headers.
_FEWEST_HEADERS: Final = 2


def _has_headers(row: SheetRow) -> bool:
    found = (read_header(cell) for cell in row if cell)
    known = [header for header in found if header and header.column in QUANTITIES]
    return len(known) >= _FEWEST_HEADERS


_NOTES_OF_SHEETS: Final = regex(r"xl/(?:comments/?[^/]{0,20}|threadedComments/[^/]{1,60})\.xml")
_BOXES_OF_SHEETS: Final = regex(r"xl/drawings/drawing\d{1,4}\.xml")


@dataclass(frozen=True, slots=True)
class _Hidden:
    """The rows and columns of a sheet that nobody sees, counted from 0."""

    rows: frozenset[int]
    columns: frozenset[int]

    @classmethod
    def of_xlsx(cls, content: bytes) -> "_Hidden":
        """Return the hidden rows and columns in the XML of a sheet."""
        rows: set[int] = set()
        columns: set[int] = set()
        for tag in _SIZED.finditer(content):
            if not _HIDDEN_IN_XLSX.search(tag[0]):
                continue
            numbers = {name: int(value) for name, value in _NUMBERED.findall(tag[0])}
            if tag[1] == b"row":
                rows.add(numbers.get(b"r", 0) - 1)
            else:
                first, last = numbers.get(b"min", 1), numbers.get(b"max", 0)
                columns.update(range(first - 1, min(last, MAX_COLUMNS)))
        return cls(frozenset(rows), frozenset(columns))

    def without(self, rows: Sequence[SheetRow]) -> list[SheetRow]:
        """Return the rows that are visible, with their visible cells."""
        if not self.rows and not self.columns:
            return list(rows)
        return [
            [cell for j, cell in enumerate(row) if j not in self.columns]
            for i, row in enumerate(rows)
            if i not in self.rows
        ]


_SIZED: Final = regex(rb"<(?:\w{1,20}:)?(row|col)(?=[ \t\r\n])[^<>]{0,1000}>")
_HIDDEN_IN_XLSX: Final = regex(rb"\shidden=[\"'](?:1|true)[\"']")
_NUMBERED: Final = regex(rb"\s(r|min|max)=[\"'](\d{1,7})[\"']")


def _with_unit(value: object, number_format: str) -> str:
    """Return the text of a cell, with the unit that its number format shows after the number."""
    shown = _shown(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return shown
    found = _SHOWN_UNIT.search(number_format.partition(";")[0])
    return f"{shown}{_UNITS_SHOWN.get(found[1].lower(), found[1])}" if found else shown


# A unit after the digits of a number format: 0"°", 0.0\°, 0" mm".
_SHOWN_UNIT: Final = regex(
    r"[0#?][^;\"]{0,10}?[\"\\]?\s{0,2}(°|deg(?:rees?)?|grad|rad|mm|cm|m)\s{0,2}\"?\s{0,2}\Z",
    re.IGNORECASE,
)
_UNITS_SHOWN: Final = {
    **dict.fromkeys(("deg", "degree", "degrees", "grad"), "°"),
    **{name: f" {name}" for name in ("rad", "mm", "cm", "m")},
}


_OF_SHEETS: Final = regex(
    r"\[Content_Types\]\.xml$|_rels/\.rels$|docProps/(core|app)\.xml$|xl/(_rels/)?workbook\.xml(\.rels)?$|"
    r"xl/(styles|sharedStrings)\.xml$|xl/worksheets/[^/]+\.xml$"
)
_CELL_OF_XLSX: Final = regex(rb"<(?:\w+:)?c[ >/]")
_ROW_OF_XLSX: Final = regex(rb"<(?:\w+:)?row[ >/]")
_WITHOUT_VALUE: Final = regex(rb"</(?:\w+:)?f>\s*(?:<v\s*/>|<v></v>|</(?:\w+:)?c>)")


def _require_few_cells(content: bytes) -> None:
    # A cell has four tags, and a row has two. A sheet has few other tags.
    cells, rows = (len(each.findall(content)) for each in (_CELL_OF_XLSX, _ROW_OF_XLSX))
    others = content.count(b"<") - 4 * cells - 2 * rows
    if max(cells, rows, others) > MAX_CELLS:
        raise too_much()


def _xls(data: bytes) -> Iterator[Excerpt]:
    import xlrd

    if sum(_cells_in_records(data)) > MAX_RECORDS:
        raise too_much()
    book = xlrd.open_workbook(
        file_contents=data, ragged_rows=True, formatting_info=True, logfile=io.StringIO()
    )
    sheets = []
    notes: list[str] = []
    for sheet in book.sheets():
        if sheet.visibility == 0:
            notes += [note.text for note in sheet.cell_note_map.values()]
            if sum(map(sheet.row_len, range(sheet.nrows))) > MAX_CELLS:
                raise too_much()
            rows = [
                [
                    _of_xls(book, cell, sheet.rich_text_runlist_map.get((i, j), ()))
                    for j, cell in enumerate(sheet.row(i)[:MAX_COLUMNS])
                ]
                for i in range(min(sheet.nrows, MAX_ROWS))
            ]
            hidden = _Hidden(
                frozenset(i for i, info in sheet.rowinfo_map.items() if info.hidden),
                frozenset(j for j, info in sheet.colinfo_map.items() if info.hidden),
            )
            areas = [(top, left, below, right) for top, below, left, right in sheet.merged_cells]
            sheets.append((sheet.name, hidden.without(_filled(rows, areas))))
    yield from _of_sheets(sheets, comments=notes)


def _cells_in_records(data: bytes) -> Iterator[int]:
    """Yield the number of cells in each record of a workbook, or 1 for another record.

    Stops after ``MAX_RECORDS``, so that a file of many cells is refused before it is parsed.
    """
    from xlrd.compdoc import SIGNATURE, CompDoc

    position, end = 0, len(data)
    if data.startswith(SIGNATURE):
        streams = CompDoc(data, logfile=io.StringIO())
        for name in ("Workbook", "Book"):
            found, start, length = streams.locate_named_stream(name)
            if found:
                data, position, end = found, start, start + length
                break
    for _ in range(MAX_RECORDS + 1):
        if position + 4 > end:
            return
        kind, length = struct.unpack_from("<HH", data, position)
        yield max(1, (length - 6) // _CELLS_IN_RECORD[kind]) if kind in _CELLS_IN_RECORD else 1
        position += 4 + length


# The bytes of each cell in a record of several numbers or of several blank cells.
_CELLS_IN_RECORD: Final = {0xBD: 6, 0xBE: 2}


def _of_xls(book: Any, cell: Any, fonts: Sequence[tuple[int, int]]) -> str:
    format_ = book.xf_list[cell.xf_index]
    text = _value_of_xls(cell, book.datemode, book.format_map[format_.format_key].format_str)
    for start, font in reversed(fonts):
        if book.font_list[font].struck_out:
            end = next((at for at, _ in fonts if at > start), len(text))
            text = text[:start] + struck_out(text[start:end]) + text[end:]
    return struck_out(text) if text and book.font_list[format_.font_index].struck_out else text


def _value_of_xls(cell: Any, datemode: int, number_format: str) -> str:
    import xlrd

    if cell.ctype == xlrd.XL_CELL_DATE:
        return _shown(xlrd.xldate_as_datetime(cell.value, datemode))
    if cell.ctype == xlrd.XL_CELL_ERROR:
        return str(xlrd.error_text_from_code.get(cell.value, "#N/A"))
    if cell.ctype == xlrd.XL_CELL_BOOLEAN:
        return _shown(bool(cell.value))
    return _with_unit(cell.value, number_format)


def _ods(data: bytes) -> Iterator[Excerpt]:
    root = _Package(data).parsed("content.xml")
    yield from _of_sheets(
        [
            (_attribute(table, "name"), _sheet_of_ods(table, _struck_styles(root)))
            for table in _tables_of_ods(root)
        ],
        comments=_texts_in(root, "annotation"),
        boxes=_texts_in(root, "text-box") + _texts_in(root, "custom-shape"),
    )


def _texts_in(root: ET.Element, name: str) -> list[str]:
    return ["".join(each.itertext()) for each in root.iter() if local_name(each) == name]


def _struck_styles(root: ET.Element) -> frozenset[str]:
    # The names of the styles of cells whose text is struck out.
    return frozenset(
        _attribute(style, "name")
        for style in root.iter()
        if local_name(style) == "style"
        and any(
            _attribute(each, "text-line-through-style") not in ("", "none")
            or _attribute(each, "text-line-through-type") not in ("", "none")
            for each in style
        )
    )


def _tables_of_ods(root: ET.Element) -> Iterator[ET.Element]:
    # A table in another one belongs to it: its rows are read once.
    for each in root:
        if local_name(each) == "table":
            yield each
        else:
            yield from _tables_of_ods(each)


def _sheet_of_ods(table: ET.Element, struck: frozenset[str]) -> list[SheetRow]:
    areas: list[_Area] = []
    return _filled(list(_rows_of_ods(table, struck, areas)), areas)


def _rows_of_ods(
    table: ET.Element, struck: frozenset[str], areas: list[_Area]
) -> Iterator[list[str]]:
    # The merged cells are appended to ``areas``.
    waiting = 0
    found = 0
    for row in table.iter():
        if local_name(row) != "table-row" or _attribute(row, "visibility") in (
            "collapse",
            "filter",
        ):
            continue
        times = _times(row, "number-rows-repeated")
        cells: list[str] = []
        blank = 0
        for cell in row:
            if local_name(cell) not in ("table-cell", "covered-table-cell"):
                continue
            text, repeated = _cell_of_ods(cell, struck), _times(cell, "number-columns-repeated")
            if not text:
                blank += repeated
            elif len(cells) + blank + repeated > MAX_COLUMNS:
                raise too_much()
            else:
                cells += [""] * blank + [text] * repeated
                blank = 0
                rows, columns = (_times(cell, f"number-{each}-spanned") for each in _SPANNED)
                if rows > 1 or columns > 1:
                    top, first = found + waiting, len(cells) - 1
                    areas.append((top, first, top + rows, first + columns))
        if not cells:
            waiting += times
            continue
        found += waiting + times
        if found > MAX_ROWS:
            raise too_much()
        # Empty rows before the next filled row; those at the end are the rest of the sheet.
        yield from ([] for _ in range(waiting))
        yield from (cells for _ in range(times))
        waiting = 0


_SPANNED: Final = ("rows", "columns")


def _times(element: ET.Element, name: str) -> int:
    text = _attribute(element, name)
    return int(text[:9]) if text.isascii() and text.isdigit() else 1


def _cell_of_ods(cell: ET.Element, struck: frozenset[str]) -> str:
    text = _value_of_ods(cell, struck)
    return struck_out(text) if _attribute(cell, "style-name") in struck else text


def _value_of_ods(cell: ET.Element, struck: frozenset[str]) -> str:
    lines = [_paragraph_of_ods(each, struck) for each in cell if local_name(each) == "p"]
    kind = _attribute(cell, "value-type")
    if kind in ("float", "percentage", "currency"):
        try:
            return _with_unit(float(_attribute(cell, "value")), f"0{_unit_of_ods(lines)}")
        except ValueError:
            return _attribute(cell, "value")
    if kind == "date":
        return _as_date(_attribute(cell, "date-value"))
    if kind == "time":
        return _as_date(_attribute(cell, "time-value"))
    return _one_line(" ".join(lines))


def _unit_of_ods(lines: Sequence[str]) -> str:
    # What the cell shows after its number.
    return "".join(lines).lstrip("0123456789.,-+− ")


def _paragraph_of_ods(paragraph: ET.Element, struck: frozenset[str]) -> str:
    pieces = [paragraph.text or ""]
    for each in paragraph:
        text = "".join(each.itertext())
        pieces += [struck_out(text) if _attribute(each, "style-name") in struck else text]
        pieces += [each.tail or ""]
    return "".join(pieces)


def _shown(value: object) -> str:
    """Return the text of a cell: numbers as one would type them, all else on one line."""
    match value:
        case None:
            return ""
        case bool():
            return str(value).upper()
        case float():
            return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
        case datetime() | date() | time() | timedelta():
            return _as_date(str(value))
    return _one_line(str(value))


def _as_date(text: str) -> str:
    # A spreadsheet made a date of a fraction such as 1/2. No reader takes this for a number.
    return f"date({text.removesuffix(' 00:00:00')})"


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _of_sheets(
    sheets: Iterable[tuple[str, Sequence[SheetRow]]],
    *,
    comments: Sequence[str] = (),
    boxes: Sequence[str] = (),
) -> Iterator[Excerpt]:
    # ``comments`` are on cells, and ``boxes`` are texts that lie on a sheet.
    filled = [(name, rows) for name, rows in sheets if any(any(row) for row in rows)]
    notes = tuple(comments)
    for i, (name, rows) in enumerate(filled):
        others = [row for j, (_, other) in enumerate(filled) if j != i for row in other]
        said = [
            each for each in _remarks(others) if len(each.split()) > _MOST_WORDS or "行" in each
        ]
        around = (*_office_files_sentences(rows), *boxes, *said)
        yield Excerpt(_as_table(rows), name, around=around, beside=notes)
    for name, rows in filled:
        blocks = list(_blocks(rows))
        if len(blocks) == 1:
            continue
        for block in blocks:
            if len(block) > 1:
                others = [row for other in blocks if other is not block for row in other]
                around = (*_office_files_sentences(block), *_remarks(others), *boxes)
                yield Excerpt(_as_table(block), name, 1, around, notes)


def _office_files_sentences(rows: Iterable[SheetRow]) -> Iterator[str]:
    # The cells with several words, which are no headers.
    for row in rows:
        for cell in row:
            if len(cell.split()) > _MOST_WORDS and not read_header(cell):
                yield cell


def _remarks(rows: Iterable[SheetRow]) -> Iterator[str]:
    # Rows with few cells are no rows of another table, but may be "Angles: | degrees".
    for row in rows:
        cells = list(filter(None, row))
        yield from (
            [" ".join(cells)] if len(cells) <= _MOST_WORDS else _office_files_sentences([cells])
        )


# The most words of an entry, and the most cells of a remark.
_MOST_WORDS: Final = 2


def _as_table(rows: Sequence[SheetRow]) -> str:
    """Return rows as lines with tabs between the cells, without empty columns on the left."""
    width = max((len(row) for row in rows), default=0)
    full = [[*row, *[""] * (width - len(row))] for row in rows]
    first = next((i for i in range(width) if any(row[i] for row in full)), 0)
    last = max((i for i in range(width) if any(row[i] for row in full)), default=-1) + 1
    return "\n".join("\t".join(row[first:last]) for row in full).strip("\n")


def _blocks(rows: Sequence[SheetRow]) -> Iterator[list[SheetRow]]:
    for is_filled, group in groupby(rows, key=any):
        if is_filled:
            yield list(group)


# --- Documents


def _docx(data: bytes, *, may_have_macros: bool = False) -> Iterator[Excerpt]:
    package = _Package(data, may_have_macros=may_have_macros)
    root = package.parsed("word/document.xml")
    if "word/styles.xml" in package.names:
        _strike_by_style(root, package.parsed("word/styles.xml"))
    lines: list[str] = []
    tables: list[list[SheetRow]] = []
    body = next((each for each in root if local_name(each) == "body"), root)
    _read_blocks(body, lines, tables)
    between = "\n".join(line for line in lines if line.strip())
    boxes = [*_text_boxes(body), *_notes(package, _MARGINS_OF_WORD)]
    notes = tuple(_notes(package, _NOTES_OF_WORD))
    for i, rows in enumerate(tables):
        others = [row for other in (*tables[:i], *tables[i + 1 :]) for row in other]
        around = (*between.splitlines(), *_office_files_sentences(rows), *_remarks(others), *boxes)
        if text := _as_table(rows).strip():
            yield Excerpt(text, around=around, beside=notes)
    if between:
        yield Excerpt(between, level=1 if tables else 0, around=tuple(boxes), beside=notes)


def _strike_by_style(root: ET.Element, styles: ET.Element) -> None:
    """Give each run that is struck out by its style, or by that of its paragraph, this property."""
    struck = _struck_styles_of_word(styles)
    if not struck:
        return
    for paragraph in (each for each in root.iter() if local_name(each) == "p"):
        of_paragraph = _style_of(paragraph, "pPr", "pStyle") in struck
        for run in (each for each in paragraph.iter() if local_name(each) == "r"):
            own = {local_name(each) for part in run for each in part}
            by_style = of_paragraph or _style_of(run, "rPr", "rStyle") in struck
            if by_style and not own & _STRIKES:
                ET.SubElement(ET.SubElement(run, "rPr"), "strike")


_STRIKES: Final = frozenset({"strike", "dstrike"})


def _struck_styles_of_word(styles: ET.Element) -> set[str]:
    # A style has the properties of the style on which it is based, unless it turns them off.
    based: dict[str, str] = {}
    own: dict[str, bool] = {}
    for style in (each for each in styles if local_name(each) == "style"):
        name = _attribute(style, "styleId")
        based[name] = next((_attribute(e, "val") for e in style if local_name(e) == "basedOn"), "")
        if any(local_name(each) in _STRIKES for each in style.iter()):
            own[name] = bool(_STRIKES & _looks(style).keys())
    for _ in range(_MOST_STYLES):
        own |= {name: own[base] for name, base in based.items() if name not in own and base in own}
    return {name for name, is_struck in own.items() if is_struck}


# The most styles that are based on each other.
_MOST_STYLES: Final = 10


def _style_of(element: ET.Element, properties: str, style: str) -> str:
    for part in element:
        if local_name(part) == properties:
            for each in part:
                if local_name(each) == style:
                    return _attribute(each, "val")
    return ""


def _text_boxes(body: ET.Element) -> Iterator[str]:
    for box in body.iter():
        if local_name(box) == "txbxContent":
            yield from (_text_of_word(each) for each in box if local_name(each) == "p")


def _notes(package: _Package, names: re.Pattern[str]) -> Iterator[str]:
    """Yield the texts of comments, footnotes and headers, which are parts of their own."""
    for name in filter(names.fullmatch, package.names):
        for each in package.parsed(name).iter():
            if local_name(each) == "p":
                yield _text_of_word(each)
            elif local_name(each) == "text":
                # A comment of a spreadsheet.
                yield "".join(each.itertext())


_NOTES_OF_WORD: Final = regex(r"word/(?:comments|footnotes|endnotes)\.xml")
_MARGINS_OF_WORD: Final = regex(r"word/(?:header\d*|footer\d*)\.xml")


def _read_blocks(parent: ET.Element, lines: list[str], tables: list[list[SheetRow]]) -> None:
    for element in _blocks_of(parent):
        if local_name(element) == "p":
            lines.extend(_text_of_word(element).split("\n"))
            continue
        tables.append(_table_of_word(element))


def _table_of_word(table: ET.Element) -> list[SheetRow]:
    rows: list[list[str]] = []
    areas: list[_Area] = []
    # The first row, and the columns, of merged cells that a next row may continue.
    begun: dict[int, tuple[int, int]] = {}
    for i, row in enumerate(_children(table, "tr")):
        cells: list[str] = []
        above, begun = begun, {}
        for cell in _children(row, "tc"):
            first = len(cells)
            span, merge = _merging_in_word(cell)
            cells += [_one_line(" ".join(_paragraphs(cell))), *[""] * (span - 1)]
            if len(cells) > MAX_COLUMNS:
                raise too_much()
            if merge == "continue" and first in above:
                begun[first] = above[first]
            elif merge:
                begun[first] = (i, span)
            elif span > 1:
                areas.append((i, first, i + 1, first + span))
        rows.append(cells)
        ended = [(first, each) for first, each in above.items() if begun.get(first) != each]
        areas += [(top, first, i, first + span) for first, (top, span) in ended]
    areas += [(top, first, len(rows), first + span) for first, (top, span) in begun.items()]
    return _filled(rows, areas)


def _merging_in_word(cell: ET.Element) -> tuple[int, str]:
    """Return how many columns a cell covers, and "restart" or "continue" in merged rows."""
    span, merge = 1, ""
    for properties in cell:
        if local_name(properties) == "tcPr":
            for each in properties:
                if local_name(each) == "gridSpan":
                    span = max(1, _times(each, "val"))
                elif local_name(each) == "vMerge":
                    merge = _attribute(each, "val") or "continue"
    return min(span, MAX_COLUMNS + 1), merge


def _blocks_of(parent: ET.Element) -> Iterator[ET.Element]:
    # Paragraphs and tables, also those in content controls and insertions.
    for each in parent:
        if local_name(each) in ("p", "tbl"):
            yield each
        elif local_name(each) in ("sdt", "sdtContent", "ins", "customXml", "smartTag"):
            yield from _blocks_of(each)


def _children(parent: ET.Element, name: str) -> Iterator[ET.Element]:
    for each in parent:
        if local_name(each) == name:
            yield each
        elif local_name(each) in ("sdt", "sdtContent", "ins", "customXml"):
            yield from _children(each, name)


def _paragraphs(cell: ET.Element) -> Iterator[str]:
    for each in _blocks_of(cell):
        if local_name(each) == "p":
            yield _text_of_word(each)
        else:
            # A table in a cell is not an entry that anybody could read.
            yield "(table)"


def _text_of_word(element: ET.Element) -> str:
    """Return the text of a paragraph with its formulas written in one line."""
    name = local_name(element)
    match name:
        case "t":
            return element.text or ""
        case "tab":
            return "\t"
        case "br" | "cr":
            return "\n"
        case "noBreakHyphen":
            return "-"
        case "del" | "instrText" | "rPr" | "pPr" | "footnoteReference" | "AlternateContent":
            return ""
        case "drawing" | "pict" | "object":
            return "(image)"
        case "sym":
            return _symbol(element)
        case "oMath":
            return written_formula(element)
    if name == "r":
        return _run(element)
    return _inside(element)


def _run(element: ET.Element) -> str:
    looks = _looks(element)
    text = _inside(element)
    if "vanish" in looks:
        return ""
    if "strike" in looks or "dstrike" in looks:
        return struck_out(text)
    if looks.get("vertAlign") == "superscript":
        return f"^({text})" if text.strip() not in ("o", "°") else "°"
    return text


def _inside(element: ET.Element) -> str:
    return "".join(map(_text_of_word, element))


def _looks(run: ET.Element) -> Mapping[str, str]:
    # The properties of a run that are not turned off.
    return {
        local_name(each): _attribute(each, "val")
        for properties in run
        if local_name(properties) == "rPr"
        for each in properties
        if _attribute(each, "val") not in ("0", "false", "off", "none")
    }


# Letters of the font "Symbol", which Word puts in by its code.
_SYMBOLS: Final = dict(zip("abgdqjfp-", "αβγδθϕφπ−", strict=True))


def _symbol(element: ET.Element) -> str:
    try:
        letter = chr(int(_attribute(element, "char"), 16) & 0xFF)
    except ValueError:
        return "(symbol)"
    return _SYMBOLS.get(letter, letter if letter.isdigit() else "(symbol)")


def _rtf(data: bytes) -> Iterator[Excerpt]:
    if not data.lstrip().startswith(b"{\\rtf"):
        raise _damaged()
    from striprtf.striprtf import rtf_to_text

    if sum(map(data.count, (b"\\", b"{", b"}"))) > MAX_RTF_SIGNS:
        raise too_much()
    data = b"{".join(
        b"}".join(b"" if _is_picture(piece) else piece for piece in group.split(b"}"))
        for group in data.split(b"{")
    )
    if len(data) > MAX_RTF:
        raise too_much()
    data = _STRUCK_IN_RTF.sub(rb"{~~\1~~}", data)
    text: str = rtf_to_text(data.decode("cp1252", "replace"), errors="replace")  # type: ignore[no-untyped-call]
    table = pasted_from(text, ".md")
    if table != text:
        yield Excerpt(table, around=around_table(text, ".md"))
    yield Excerpt(text, level=1 if table != text else 0)


_STRUCK_IN_RTF: Final = regex(
    rb"\\striked?1?(?![a-z0-9]) ?((?:[^\\{}]|\\(?!striked?0|plain|par|cell)){1,400})"
    rb"(?:\\striked?0)?"
)
# Bytes between braces. With so few other signs beside hexadecimal digits, they are a picture.
_LONG_PIECE: Final = 1_000
_OTHER_SIGNS: Final = 200


def _is_picture(piece: bytes) -> bool:
    if len(piece) < _LONG_PIECE:
        return False
    return len(piece.translate(None, b"0123456789abcdefABCDEF\r\n")) < _OTHER_SIGNS


# --- The face of this file


_READERS: Final[Mapping[str, Callable[[bytes], Iterator[Excerpt]]]] = {
    ".xlsx": _xlsx,
    ".xlsm": partial(_xlsx, may_have_macros=True),
    ".xls": _xls,
    ".ods": _ods,
    ".docx": _docx,
    ".docm": partial(_docx, may_have_macros=True),
    ".rtf": _rtf,
    ".ipynb": notebook_excerpts,
    ".html": web_page,
    ".htm": web_page,
}
OFFICE_ENDINGS: Final = tuple(_READERS)


def excerpts(data: bytes, ending: str) -> tuple[Excerpt, ...]:
    """Return the excerpts of a file with this ending, such as ``.xlsx``.

    Raises UnusableFileError if the file is empty, damaged, too large, encrypted, or has macros.
    """
    try:
        found = tuple(islice(_READERS[ending](data), MAX_EXCERPTS))
    except UnusableFileError:
        raise
    except Exception as error:  # the libraries raise errors of many kinds for a damaged file
        raise _damaged() from error
    if not any(each.text.strip() for each in found):
        raise UnusableFileError(say("is empty"))
    return tuple(
        replace(each, around=_notstruck(each.around), beside=_notstruck(each.beside))
        for each in found
    )


def has_pictures(data: bytes, ending: str) -> bool:
    """True if a file that ``excerpts`` has read holds pictures or drawn boxes."""
    if data.startswith(b"PK"):
        return any(map(_PICTURE_PART.match, open_archive(data).namelist()))
    mark = _PICTURE_MARKS.get(ending)
    return mark is not None and mark in data


# In an archive: the drawings of a workbook (not those of its comments), and pictures.
_PICTURE_PART: Final = regex(
    r"xl/drawings/drawing|(?:xl|word)/(?:media|embeddings)/.|Pictures/.|media/."
)
_PICTURE_MARKS: Final = {
    ".html": b"<img",
    ".htm": b"<img",
    ".rtf": b"\\pict",
    ".ipynb": b"(attachment:",
}


def _notstruck(lines: Iterable[str]) -> tuple[str, ...]:
    return tuple(_STRUCK_TEXT.sub(" ", line) for line in lines)


_STRUCK_TEXT: Final = regex(r"~~[^~\n]{1,400}~~")
