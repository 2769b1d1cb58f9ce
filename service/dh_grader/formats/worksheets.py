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
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import permutations
from pathlib import PurePath
from typing import Final

from dh_grader.formats.graded import GradedSubmission
from dh_grader.formats.texts import number, points, without_formulas
from dh_grader.regex import regex
from dh_grader.translations import Sentence, joined, paragraph, say, say_count

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
# Identifier, status, grade, maximum, whether it can be changed, and the time of the last change.
_FEWEST_COLUMNS: Final = 6
_EXCUSED: Final = "EX"
# The most characters of a username.
_LONGEST_USER: Final = 255
# If more submissions are in no row, one sentence is about all of them, and names a few.
_FEW: Final = 3


class UnusableWorksheetError(ValueError):
    """The file is not a worksheet that can be filled; the text gives the reason."""


class UnfillableWorksheetError(UnusableWorksheetError):
    """The file is a worksheet, but its grades cannot be filled in."""


@dataclass(frozen=True, slots=True)
class Filled:
    """A worksheet with grades, and what is left to do.

    ``grades`` is the number of rows into which a grade was written; ``same`` of those that already
    had the grade of the submission; ``by_hand`` of the submissions that a person must still grade
    or enter.
    ``problems`` are sentences for the tutor. ``kept`` is the number of grades that were in the
    worksheet and differ from the points of the submission.
    """

    content: bytes
    grades: int
    same: int
    by_hand: int
    kept: int
    problems: tuple[str, ...]
    # True if the worksheet has no row for any submission.
    is_foreign: bool


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
    # True if some entries could not be read.
    has_unread_cells: bool = False
    # True if a file beside the answer was not read.
    has_unread_files: bool = False
    # Why a person must grade the submission.
    reasons: tuple[str, ...] = ()


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
        any(file.has_unread_cells for file in submission.files),
        bool(submission.beside),
        submission.problems,
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
    # The numbers of the columns. A submission belongs to the rows that have one of its keys, if
    # ``of_row`` is True, too.
    grade: int
    comment: int | None
    max_points: Callable[[Sequence[_Cell]], str]
    keys: Callable[[Sequence[_Cell]], Iterable[str]]
    wanted: Callable[[str], Iterable[str]]
    rows: list[list[_Cell]]
    # The name of the student in a row; empty if there is none.
    person: Callable[[Sequence[_Cell]], str] = lambda _: ""
    of_row: Callable[[Grade, Sequence[_Cell]], bool] = lambda _, __: True


@dataclass(slots=True)
class _Rows:
    # What was done with the rows so far.
    changes: list[tuple[_Cell, str]] = field(default_factory=list)
    filled: int = 0
    same: int = 0
    comments: int = 0
    replaced: list[str] = field(default_factory=list)
    replaced_comments: list[str] = field(default_factory=list)
    partly_unread: list[Grade] = field(default_factory=list)
    with_unread_files: list[Grade] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    unread: list[Grade] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)


class Worksheet:
    """The file of a platform, with places for grades and comments."""

    def __init__(self, content: bytes, column: str | None = None) -> None:
        """Read a file. Raises UnusableWorksheetError.

        ``column`` is the heading of the column to fill, if there are several.
        """
        self.content = content
        self._text, self._encoding = _decoded(content)
        self._separator, table = _table(self._text)
        self._layout = _layout(table, column)
        self._rows_of_key: dict[str, list[int]] = {}
        for i, cells in enumerate(self._layout.rows):
            for key in set(self._layout.keys(cells)):
                self._rows_of_key.setdefault(key, []).append(i)
        most = [self._layout.max_points(cells) for cells in self._layout.rows]
        grades = [cells[self._layout.grade].value for cells in self._layout.rows]
        told = [value for value in most if "." in value or "," in value] or grades
        self._has_comma = any("," in value and _NUMBER.fullmatch(value) for value in told)

    def person(self, name: str, learner: str) -> str:
        """Return the student's name in the row of a submission, or an empty text."""
        found = self._rows_of(Grade(name, learner, None, 0.0, 0.0, ""))
        return self._layout.person(self._layout.rows[found[0]]).strip() if len(found) == 1 else ""

    def filled(self, grades: Iterable[Grade], *, replaces: bool = False) -> Filled:
        """Return the worksheet with the grades.

        A grade or comment that is already in the worksheet stays, unless ``replaces`` is True.
        """
        grade_of_row, absent, unclear = self._matched(grades)
        problems = list(unclear)
        is_foreign = bool(absent) and not grade_of_row and not problems
        problems += _in_no_row(absent, is_foreign=is_foreign)
        rows = _Rows()
        for i, grade in grade_of_row.items():
            self._fill(rows, self._layout.rows[i], grade, replaces=replaces)
        problems += [*rows.problems, *_kept(rows.kept), *_kept_comments(rows.comments)]
        problems += [*_replaced(rows.replaced), *_replaced_comments(rows.replaced_comments)]
        problems += _partly_unread(rows.partly_unread)
        problems += _with_unread_files(rows.with_unread_files)
        problems += _by_hand(rows.unread)
        content = self._changed(rows.changes)
        return Filled(
            content,
            rows.filled,
            rows.same,
            len(rows.unread) + len(unclear) + len(absent),
            len(rows.kept),
            tuple(problems),
            is_foreign,
        )

    def _matched(
        self, grades: Iterable[Grade]
    ) -> tuple[Mapping[int, Grade], Sequence[Grade], list[str]]:
        # The grade of each row, the grades without a row, and sentences about unclear rows.
        found: dict[int, list[Grade]] = {}
        absent: list[Grade] = []
        problems: list[str] = []
        for grade in grades:
            rows = self._rows_of(grade)
            if len(rows) == 1:
                found.setdefault(rows[0], []).append(grade)
            elif rows:
                problems.append(_ambiguous(grade, len(rows)))
            else:
                absent.append(grade)
        for several in found.values():
            if len(several) > 1:
                problems += map(_shared_row, several)
        return {i: own[0] for i, own in found.items() if len(own) == 1}, absent, problems

    def _fill(self, rows: "_Rows", cells: Sequence[_Cell], grade: Grade, *, replaces: bool) -> None:
        cell = cells[self._layout.grade]
        before = cell.value.strip()
        has_grade = _NUMBER.fullmatch(before) is not None
        if grade.share is None:
            # If a person has entered a grade, nothing is left to do.
            rows.unread += [] if has_grade else [grade]
            return
        if before.upper() == _EXCUSED:
            rows.problems.append(_excused(grade))
            return
        written = self._written(grade, self._layout.max_points(cells))
        is_same = has_grade and _value(before) == _value(written)
        if has_grade and not is_same and not replaces:
            rows.kept.append(f"{_short(grade)} ({before} / {written})")
            return
        if grade.has_unread_cells:
            rows.partly_unread.append(grade)
        if grade.has_unread_files:
            rows.with_unread_files.append(grade)
        if is_same:
            rows.same += 1
        else:
            rows.filled += 1
            rows.changes.append((cell, written))
        if has_grade and not is_same:
            rows.replaced.append(f"{_short(grade)} ({before} → {written})")
        self._fill_comment(rows, cells, grade, replaces=replaces)

    def _fill_comment(
        self, rows: "_Rows", cells: Sequence[_Cell], grade: Grade, *, replaces: bool
    ) -> None:
        if self._layout.comment is None:
            return
        comment, told = cells[self._layout.comment], without_formulas(grade.comment)
        has_comment = bool(comment.value.strip())
        if comment.value == told:
            return
        if has_comment and not replaces:
            rows.comments += 1
            return
        rows.changes.append((comment, told))
        if has_comment:
            rows.replaced_comments.append(_short(grade))

    def _rows_of(self, grade: Grade) -> list[int]:
        layout = self._layout
        found = {i for key in layout.wanted(grade.learner) for i in self._rows_of_key.get(key, ())}
        return [i for i in sorted(found) if layout.of_row(grade, layout.rows[i])]

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
    if not rows:
        raise UnusableWorksheetError(say("has only a heading, and no row of a student"))
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
        raise UnfillableWorksheetError(_no_maximum(head[grade]))
    # The rows of students have an id; other rows, such as "Manual Posting", have none.
    students = [row for row in rows if row[own].value.strip()]
    return _Layout(
        grade,
        None,
        lambda _: most,
        lambda cells: [cells[own].value.strip()],
        lambda learner: [learner],
        students,
        lambda cells: cells[0].value,
    )


def _brightspace(head: Sequence[str], rows: list[list[_Cell]], column: str | None) -> _Layout:
    grade = _chosen(head, _BRIGHTSPACE_COLUMN, column)
    found = _BRIGHTSPACE_COLUMN.fullmatch(head[grade])
    texts = [i for i in range(len(head)) if "<" not in head[i]][:6]

    def keys(cells: Sequence[_Cell]) -> Iterator[str]:
        values = [cells[i].value.strip() for i in texts if cells[i].value.strip() not in ("", "#")]
        yield from (value.removeprefix("#") for value in values)
        # The export of submissions has no number of the gradebook, only the names.
        yield from (_compared(one + other) for one, other in permutations(values, 2))

    return _Layout(
        grade,
        None,
        lambda _: found[1] if found else "",
        keys,
        lambda learner: [learner, _compared(learner)],
        rows,
    )


def _blackboard(head: Sequence[str], rows: list[list[_Cell]], column: str | None) -> _Layout:
    grade = _chosen(head, _BLACKBOARD_COLUMN, column)
    found = _BLACKBOARD_COLUMN.fullmatch(head[grade])

    def keys(cells: Sequence[_Cell]) -> Iterator[str]:
        # The columns are last name, first name, username. The name of the assignment and the
        # username may contain "_", so "a_lee" may also be the user "lee": both rows are found.
        steps = cells[2].value.strip()[:_LONGEST_USER].split("_")
        return ("_".join(steps[i:]) for i in range(len(steps)))

    def person(cells: Sequence[_Cell]) -> str:
        return f"{cells[1].value} {cells[0].value}"

    return _Layout(
        grade,
        None,
        lambda _: found[1] if found else "",
        keys,
        lambda learner: [learner],
        rows,
        person,
    )


def _chosen(head: Sequence[str], pattern: re.Pattern[str], column: str | None) -> int:
    found = [i for i, each in enumerate(head) if pattern.fullmatch(each)]
    if column is not None:
        found = [i for i in found if head[i] == column] or [
            i for i in found if head[i].startswith(column)
        ]
    if len(found) == 1:
        return found[0]
    known = ", ".join(each for each in head if pattern.fullmatch(each))
    raise UnfillableWorksheetError(
        say("has several columns for grades; name one of them (--column): {columns}", columns=known)
        if len(found) != 0
        else say("has no such column for grades; its columns are {columns}", columns=known)
    )


def _moodle(head: Sequence[str], rows: list[list[_Cell]]) -> _Layout:
    columns = [[row[i].value.strip() for row in rows] for i in range(len(head))]
    # A table of joints also has rows such as "Joint 1", but fewer columns.
    if len(head) < _FEWEST_COLUMNS or not all(map(_PARTICIPANT.fullmatch, columns[0])):
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
        scale = next((found[0] for found in columns[3:] if _is_scale(found)), None)
        is_moodle = any(all(map(_DATE.fullmatch, found)) for found in columns[3:])
        unusable = UnfillableWorksheetError if is_moodle else UnusableWorksheetError
        raise unusable(
            _no_maximum(", ".join(head))
            if scale is None
            else say(
                "is for grades by a scale ({scale}), and the program gives points. Enter the "
                "grades by hand, or choose points in the settings of the assignment",
                scale=scale,
            )
        )
    grade = most[0] - 1
    spellings = dict.fromkeys(columns[most[0]])
    if len({value.replace(",", ".") != value for value in spellings}) > 1:
        raise UnfillableWorksheetError(
            say(
                "has the maximum points in several spellings ({spellings}), so that its decimal "
                "sign is unclear. Download it again, and do not save it in a spreadsheet program",
                spellings=", ".join(spellings),
            )
        )
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
        # A group has a number of its own, which may be the number of another student.
        [number] = _number_of(each.learner)
        name = _compared(PurePath(each.name).name.partition(f"_{number}")[0])
        participant = cells[0].value
        known = (cells[1].value, participant.rstrip("0123456789"), participant)
        return not has_names or not name or any(_is_name(name, cell) for cell in known)

    def person(cells: Sequence[_Cell]) -> str:
        return cells[1].value if has_names else ""

    return _Layout(
        grade,
        comment,
        lambda cells: cells[most[0]].value.strip(),
        lambda cells: _number_of(cells[0].value.strip()),
        _number_of,
        rows,
        person,
        of_row,
    )


def _number_of(participant: str) -> list[str]:
    found = _PARTICIPANT.fullmatch(participant)
    return [found[1]] if found else []


def _is_maximum(values: Sequence[str]) -> bool:
    if not all(map(_NUMBER.fullmatch, values)):
        return False
    found = set(map(_value, values))
    return len(found) == 1 and found.pop() > 0


def _is_scale(values: Sequence[str]) -> bool:
    # Moodle writes all words of the scale into each row: "Not yet, Good, Very good".
    words = values[0].split(",")
    return len(set(values)) == 1 and len(words) > 1 and not _DATE.fullmatch(values[0])


def _value(text: str) -> float:
    return float(text.replace(",", "."))


def _compared(name: str) -> str:
    return "".join(c for c in name.casefold() if c.isalnum())


def _is_name(compared: str, cell: str) -> bool:
    # A spreadsheet program that saves in Windows-1252 writes a question mark for the letters that
    # are missing there: "Nguy?n".
    letters = "".join(c for c in cell.casefold() if c.isalnum() or c == "?")
    return len(letters) == len(compared) and all(
        a in ("?", b) for a, b in zip(letters, compared, strict=True)
    )


def _unknown() -> Sentence:
    return say(
        "is no worksheet of Moodle and no gradebook of Canvas, Brightspace or Blackboard; give the "
        "file as the platform wrote it"
    )


def _no_maximum(columns: str) -> Sentence:
    return say("has no column with the maximum points; there are {columns}", columns=columns)


def is_worksheet(start: bytes) -> bool:
    """True if a worksheet or a gradebook of a platform begins with these bytes."""
    # The last line may be cut off. In UTF-16, a line ends with two bytes.
    is_utf_16 = start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    lines = start if is_utf_16 else start[: start.rfind(b"\n") + 1]
    try:
        Worksheet(lines)
    except UnfillableWorksheetError:
        return True
    except UnusableWorksheetError:
        return False
    return True


def _ambiguous(grade: Grade, count: int) -> str:
    return _left(
        grade,
        say("{name} fits {count} rows of the worksheet.", name=grade.name, count=count),
    )


def _shared_row(grade: Grade) -> str:
    return _left(
        grade,
        say(
            "{name} fits a row of the worksheet that another submission fits, too.", name=grade.name
        ),
    )


def _left(grade: Grade, reason: Sentence) -> str:
    # What was not read has no points that a person could enter.
    if grade.share is None:
        return paragraph(reason, say("Grade it by hand."))
    shown = f"{number(grade.points)} / {number(grade.max_points)}"
    return paragraph(reason, say("Enter {points} points by hand.", points=shown))


def _in_no_row(grades: Sequence[Grade], *, is_foreign: bool) -> list[str]:
    if len(grades) <= _FEW:
        return [
            _left(each, say("{name} is in no row of the worksheet.", name=each.name))
            for each in grades
        ]
    names = ", ".join(map(_short, grades[:_FEW]))
    count = len(grades)
    if is_foreign:
        return [
            say(
                "None of the {count} submissions is in the worksheet ({names}, …). It may be that "
                "of another course.",
                count=count,
                names=names,
            )
        ]
    return [
        say(
            "{count} submissions are in no row of the worksheet ({names}, …). Enter their points "
            "by hand.",
            count=count,
            names=names,
        )
    ]


def _kept(grades: Sequence[str]) -> list[Sentence]:
    if not grades:
        return []
    return [
        say_count(
            "{count} row of the worksheet already had another grade, which stays (grade in the "
            "worksheet / grade of the program): {grades}.",
            "{count} rows of the worksheet already had other grades, which stay (grade in the "
            "worksheet / grade of the program): {grades}.",
            count=len(grades),
            grades=", ".join(grades),
        )
    ]


def _kept_comments(count: int) -> list[Sentence]:
    if not count:
        return []
    return [
        say_count(
            "{count} comment that was already in the worksheet stays.",
            "{count} comments that were already in the worksheet stay.",
            count=count,
        )
    ]


def _replaced(grades: Sequence[str]) -> list[Sentence]:
    if not grades:
        return []
    return [
        say_count(
            "{count} grade in the worksheet is replaced (old → new): {grades}.",
            "{count} grades in the worksheet are replaced (old → new): {grades}.",
            count=len(grades),
            grades=", ".join(grades),
        )
    ]


def _replaced_comments(names: Sequence[str]) -> list[Sentence]:
    if not names:
        return []
    return [
        say_count(
            "{count} comment in the worksheet is replaced: {names}.",
            "{count} comments in the worksheet are replaced: {names}.",
            count=len(names),
            names=", ".join(names),
        )
    ]


def _partly_unread(grades: Sequence[Grade]) -> list[Sentence]:
    if not grades:
        return []
    return [
        say_count(
            "{count} submission has entries that could not be read, and earned no points for "
            "them: {names}.",
            "{count} submissions have entries that could not be read, and earned no points for "
            "them: {names}.",
            count=len(grades),
            names=", ".join(map(_short, grades)),
        )
    ]


def _with_unread_files(grades: Sequence[Grade]) -> list[Sentence]:
    if not grades:
        return []
    return [
        say_count(
            "{count} submission was graded, and also has a file that was not read, such as a "
            "photo. Look at it: {names}.",
            "{count} submissions were graded, and also have files that were not read, such as "
            "photos. Look at them: {names}.",
            count=len(grades),
            names=", ".join(map(_short, grades)),
        )
    ]


def _by_hand(grades: Sequence[Grade]) -> list[Sentence]:
    if not grades:
        return []
    return [
        say_count(
            "{count} row of the worksheet stays as it was, because something in the submission "
            "could not be read. Grade it by hand:",
            "{count} rows of the worksheet stay as they were, because something in the submissions "
            "could not be read. Grade them by hand:",
            count=len(grades),
        ),
        *(joined(": ", [_short(each), joined("; ", each.reasons)]) for each in grades),
    ]


def _short(grade: Grade) -> str:
    return PurePath(grade.name).name


def _excused(grade: Grade) -> Sentence:
    return say("{name} is from an excused student. The row stays as it was.", name=grade.name)
