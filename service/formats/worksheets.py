"""Fill grades into the file that a learning platform gave, and leave all else byte for byte.

The platform imports the file again, so nothing but grades and comments may change: not the quotes,
the line ends, the encoding, unknown columns, or students who handed nothing in. Columns are found
by their contents and places, because Moodle writes the headings in the language of the user.

Sources: Moodle, ``mod/assign/gradingtable.php`` and ``mod/assign/feedback/offline``; Canvas,
``lib/gradebook_exporter.rb`` and ``lib/gradebook_importer.rb``; D2L, "Importing grades";
Blackboard, "Upload or download grades".
"""

import codecs
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import PurePath
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.plain_text import number, points
from service.formats.shared.spreadsheet import without_formulas
from service.regex import regex
from service.translations import Sentence, say, say_count

# Bytes.
MAX_WORKSHEET: Final = 16 * 1024 * 1024

_BOMS: Final = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_SEPARATORS: Final = (",", ";", "\t")
_NUMBER: Final = regex(r"\d+(?:[.,]\d+)?")
# "Participant 1234", "Teilnehmer/in1234", "参与人1234".
_PARTICIPANT: Final = regex(r"\D*\D(\d+)")
# Moodle writes dates in the language of the user, and "-" for no date.
_DATE: Final = regex(r"-|(?=.*\b(?:19|20)\d\d(?!\d))(?=.*\d[:.h]\d\d).*", re.DOTALL)
_CANVAS_COLUMN: Final = regex(r".*\(\d+\)", re.DOTALL)
_BRIGHTSPACE_COLUMN: Final = regex(r".* Points Grade <.*MaxPoints:([\d.,]+).*>", re.DOTALL)
_BLACKBOARD_COLUMN: Final = regex(r".*\[[^\]\d]*([\d.,]+)[^\]]*\]\s*\|\s*\d+(?:_\d+)*", re.DOTALL)
_EXCUSED: Final = "EX"
# The most students that one sentence names.
_MOST_NAMES: Final = 40


class UnusableWorksheetError(ValueError):
    """The file is not a worksheet that can be filled; the text gives the reason."""


@dataclass(frozen=True, slots=True)
class Grade:
    """The result of a submission for a worksheet."""

    name: str
    learner: str
    # A share of the maximum points, 0..1; None if a person must grade the submission.
    share: float | None
    points: float
    max_points: float
    comment: str


def grade_of(submission: GradedSubmission, comment: str) -> Grade:
    """Return the result of a submission, with a comment for the student."""
    share = submission.points / submission.max_points if submission.is_complete else None
    return Grade(
        submission.name,
        submission.learner,
        share,
        submission.points,
        submission.max_points,
        comment,
    )


@dataclass(frozen=True, slots=True)
class _Cell:
    # The place in the text, with the quotation marks.
    start: int
    end: int
    value: str
    is_quoted: bool


@dataclass(frozen=True, slots=True)
class _Layout:
    # The numbers of the columns; ``of_row`` is True if the submission belongs to the row.
    grade: int
    comment: int | None
    max_points: Callable[[Sequence[_Cell]], str]
    of_row: Callable[[Grade, Sequence[_Cell]], bool]
    rows: list[list[_Cell]]


class Worksheet:
    """The file of a platform, with places for grades and comments."""

    def __init__(self, content: bytes, column: str | None = None) -> None:
        """Read a file. Raises UnusableWorksheetError.

        ``column`` is the heading of the column to fill, if there are several.
        """
        self._text, self._encoding = _decoded(content)
        self._separator, table = _table(self._text)
        self._layout = _layout(table, column)
        filled = [cells[self._layout.grade].value for cells in self._layout.rows]
        most = [self._layout.max_points(cells) for cells in self._layout.rows]
        self._has_comma = any("," in value and _NUMBER.fullmatch(value) for value in filled + most)

    def filled(self, grades: Iterable[Grade]) -> tuple[bytes, list[Sentence]]:
        """Return the file with the grades, and a sentence about each grade that is not in it."""
        layout = self._layout
        problems: list[Sentence] = []
        grade_of_row: dict[int, Grade] = {}
        twice: set[int] = set()
        for grade in grades:
            found = [i for i, cells in enumerate(layout.rows) if layout.of_row(grade, cells)]
            if len(found) != 1:
                problems.append(_unmatched(grade, found))
            elif found[0] in grade_of_row:
                twice.add(found[0])
                problems.append(_shared_row(grade))
            else:
                grade_of_row[found[0]] = grade
        problems += [_shared_row(grade_of_row.pop(i)) for i in twice]
        changes: list[tuple[_Cell, str]] = []
        unread = [grade for grade in grade_of_row.values() if grade.share is None]
        for i, grade in grade_of_row.items():
            cells = layout.rows[i]
            if grade.share is None:
                continue
            if cells[layout.grade].value.strip().upper() == _EXCUSED:
                problems.append(_excused(grade))
                continue
            changes.append((cells[layout.grade], self._written(grade, layout.max_points(cells))))
            if layout.comment is not None:
                changes.append((cells[layout.comment], without_formulas(grade.comment)))
        return self._changed(changes), [*problems, *([_by_hand(unread)] if unread else [])]

    def _written(self, grade: Grade, most: str) -> str:
        maximum = _value(most) if most else grade.max_points
        if grade.share is None:
            raise ValueError("a submission that is not graded has no points")
        # Never rounded up to the maximum.
        shown = points(grade.share * maximum, maximum).partition(" / ")[0]
        return shown.replace(".", ",") if self._has_comma else shown

    def _changed(self, changes: Iterable[tuple[_Cell, str]]) -> bytes:
        pieces = []
        end = 0
        for cell, value in sorted(changes, key=lambda change: change[0].start):
            pieces += [self._text[end : cell.start], self._quoted(value, cell)]
            end = cell.end
        pieces.append(self._text[end:])
        return "".join(pieces).encode(self._encoding)

    def _quoted(self, value: str, cell: _Cell) -> str:
        if cell.is_quoted or any(sign in value for sign in (self._separator, '"', "\n", "\r")):
            return '"{}"'.format(value.replace('"', '""'))
        return value


def _decoded(content: bytes) -> tuple[str, str]:
    if len(content) > MAX_WORKSHEET:
        raise UnusableWorksheetError(say("is larger than {most} KiB", most=MAX_WORKSHEET // 1024))
    marked = next((name for bom, name in _BOMS if content.startswith(bom)), None)
    for name in (marked,) if marked else ("utf-8", "cp1252"):
        try:
            text = content.decode(name)
        except UnicodeDecodeError:
            continue
        if "\0" not in text and text.encode(name) == content:
            return text, name
    raise UnusableWorksheetError(
        say("is no text; export the grades as a file of comma-separated values (.csv)")
    )


def _table(text: str) -> tuple[str, list[list[_Cell]]]:
    # The separator is the one that divides the first line into most cells.
    first = text.split("\n", 1)[0]
    separator = max(_SEPARATORS, key=lambda sign: sum(map(len, _rows(first, sign))))
    rows = _rows(text, separator)
    if not rows or len(rows[0]) < 3:
        raise UnusableWorksheetError(_unknown())
    return separator, rows


def _rows(text: str, separator: str) -> list[list[_Cell]]:
    # Rows of cells as RFC 4180 has them. A byte-order mark belongs to no cell.
    rows: list[list[_Cell]] = []
    row: list[_Cell] = []
    plain = re.compile(rf"[^{re.escape(separator)}\r\n]*")
    quoted = re.compile(r'"((?:[^"]|"")*)"')
    i = 1 if text.startswith("\ufeff") else 0
    while i < len(text) or row:
        found = quoted.match(text, i)
        after = text[found.end() : found.end() + 1] if found else ""
        if found and after in (separator, "\r", "\n", ""):
            row.append(_Cell(i, found.end(), found[1].replace('""', '"'), is_quoted=True))
            i = found.end()
        else:
            bare = plain.match(text, i)
            end = bare.end() if bare else i
            row.append(_Cell(i, end, text[i:end], is_quoted=False))
            i = end
        if i < len(text) and text[i] == separator:
            i += 1
            continue
        i += 2 if text.startswith("\r\n", i) else 1
        rows.append(row)
        row = []
    return rows


def _layout(table: list[list[_Cell]], column: str | None) -> _Layout:
    head = [cell.value.strip() for cell in table[0]]
    # Empty lines, and lines that lack cells, are no students.
    rows = [row for row in table[1:] if len(row) == len(head)]
    if any(row[0].value.strip() == "Points Possible" for row in rows):
        return _canvas(head, rows, column)
    if any(_BRIGHTSPACE_COLUMN.fullmatch(each) for each in head):
        return _brightspace(head, rows, column)
    if any(_BLACKBOARD_COLUMN.fullmatch(each) for each in head):
        return _blackboard(head, rows, column)
    return _moodle(head, rows)


def _canvas(head: Sequence[str], rows: list[list[_Cell]], column: str | None) -> _Layout:
    if "ID" not in head[:3]:
        raise UnusableWorksheetError(_unknown())
    own = head.index("ID")
    grade = _chosen(head, _CANVAS_COLUMN, column)
    possible = next(row for row in rows if row[0].value.strip() == "Points Possible")
    most = possible[grade].value.strip()
    if not _NUMBER.fullmatch(most) or not _value(most):
        raise UnusableWorksheetError(_no_maximum(head[grade]))
    # The rows of students have an id; other rows, such as "Manual Posting", have none.
    students = [row for row in rows if row[own].value.strip()]
    return _Layout(
        grade,
        None,
        lambda _: most,
        lambda each, cells: cells[own].value.strip() == each.learner,
        students,
    )


def _brightspace(head: Sequence[str], rows: list[list[_Cell]], column: str | None) -> _Layout:
    grade = _chosen(head, _BRIGHTSPACE_COLUMN, column)
    found = _BRIGHTSPACE_COLUMN.fullmatch(head[grade])
    texts = [i for i in range(len(head)) if "<" not in head[i]][:6]

    def of_row(each: Grade, cells: Sequence[_Cell]) -> bool:
        values = [cells[i].value.strip() for i in texts if cells[i].value.strip() not in ("", "#")]
        if each.learner in [value.removeprefix("#") for value in values]:
            return True
        # The export of submissions has no number of the gradebook, only the names.
        names = (_compared(one + other) for one, other in permutations(values, 2))
        return _compared(each.learner) in names

    return _Layout(grade, None, lambda _: found[1] if found else "", of_row, rows)


def _blackboard(head: Sequence[str], rows: list[list[_Cell]], column: str | None) -> _Layout:
    grade = _chosen(head, _BLACKBOARD_COLUMN, column)
    found = _BLACKBOARD_COLUMN.fullmatch(head[grade])

    def of_row(each: Grade, cells: Sequence[_Cell]) -> bool:
        # The columns are last name, first name, username. The name of the assignment and the
        # username may contain "_", so "a_lee" may also be the user "lee": both rows are found.
        user = cells[2].value.strip()
        return user == each.learner or user.endswith(f"_{each.learner}")

    return _Layout(grade, None, lambda _: found[1] if found else "", of_row, rows)


def _chosen(head: Sequence[str], pattern: re.Pattern[str], column: str | None) -> int:
    found = [i for i, each in enumerate(head) if pattern.fullmatch(each)]
    if column is not None:
        found = [i for i in found if head[i] == column] or [
            i for i in found if head[i].startswith(column)
        ]
    if len(found) == 1:
        return found[0]
    known = ", ".join(each for each in head if pattern.fullmatch(each))
    raise UnusableWorksheetError(
        say("has several columns for grades; name one with --column: {columns}", columns=known)
        if len(found) != 0
        else say("has no such column for grades; its columns are {columns}", columns=known)
    )


def _moodle(head: Sequence[str], rows: list[list[_Cell]]) -> _Layout:
    columns = [[row[i].value.strip() for row in rows] for i in range(len(head))]
    if not rows or not all(map(_PARTICIPANT.fullmatch, columns[0])):
        raise UnusableWorksheetError(_unknown())
    # Identifier, (full name, …), status, (…), grade, maximum, (…), can be changed, …
    most = [
        i
        for i in range(3, len(head) - 1)
        if _is_maximum(columns[i])
        and all(not value or _NUMBER.fullmatch(value) for value in columns[i - 1])
        and not all(_NUMBER.fullmatch(value) for value in columns[i + 1])
    ]
    if not most:
        raise UnusableWorksheetError(_no_maximum(", ".join(head)))
    grade = most[0] - 1
    dates = [i for i in range(most[0] + 1, len(head)) if all(map(_DATE.fullmatch, columns[i]))]
    if not dates:
        raise UnusableWorksheetError(
            say(
                "has no column with the time at which a grade was last modified; Moodle refuses "
                "the file without this column"
            )
        )
    comment = dates[-1] + 1 if dates[-1] + 1 < len(head) else None
    # With anonymous submissions, the column of names is missing: the second column is the status.
    has_names = grade > 2

    def of_row(each: Grade, cells: Sequence[_Cell]) -> bool:
        participant = _PARTICIPANT.fullmatch(cells[0].value.strip())
        own = _PARTICIPANT.fullmatch(each.learner)
        if participant is None or own is None or participant[1] != own[1]:
            return False
        # A group has a number of its own, which may be the number of another student.
        name = _compared(PurePath(each.name).name.partition(f"_{own[1]}")[0])
        known = (_compared(cells[1].value), _compared(cells[0].value.rstrip("0123456789")))
        return not has_names or not name or name in known or name == _compared(cells[0].value)

    return _Layout(grade, comment, lambda cells: cells[most[0]].value.strip(), of_row, rows)


def _is_maximum(values: Sequence[str]) -> bool:
    return (
        len(set(values)) == 1 and _NUMBER.fullmatch(values[0]) is not None and _value(values[0]) > 0
    )


def _value(text: str) -> float:
    return float(text.replace(",", "."))


def _compared(name: str) -> str:
    return "".join(c for c in name.casefold() if c.isalnum())


def _unknown() -> Sentence:
    return say(
        "is no worksheet of Moodle and no gradebook of Canvas, Brightspace or Blackboard; give the "
        "file as the platform wrote it"
    )


def _no_maximum(columns: str) -> Sentence:
    return say("has no column with the maximum points; there are {columns}", columns=columns)


def _unmatched(grade: Grade, found: Sequence[int]) -> Sentence:
    if found:
        return say(
            "{name} fits {count} rows of the worksheet. Enter {points} points by hand.",
            name=grade.name,
            count=len(found),
            points=_told_points(grade),
        )
    return say(
        "{name} is in no row of the worksheet. Enter {points} points by hand.",
        name=grade.name,
        points=_told_points(grade),
    )


def _shared_row(grade: Grade) -> Sentence:
    return say(
        "{name} fits a row of the worksheet that another submission fits, too. Enter {points} "
        "points by hand.",
        name=grade.name,
        points=_told_points(grade),
    )


def _by_hand(grades: Sequence[Grade]) -> Sentence:
    # The report says what could not be read in each.
    names = [PurePath(grade.name).name for grade in grades]
    return say_count(
        "{count} row of the worksheet stays as it was, because something in the submission could "
        "not be read. Grade it by hand: {names}.",
        "{count} rows of the worksheet stay as they were, because something in the submissions "
        "could not be read. Grade them by hand: {names}.",
        count=len(grades),
        names=", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else ""),
    )


def _excused(grade: Grade) -> Sentence:
    return say("{name} is from an excused student. The row stays as it was.", name=grade.name)


def _told_points(grade: Grade) -> str:
    return "?" if grade.share is None else f"{number(grade.points)} / {number(grade.max_points)}"
