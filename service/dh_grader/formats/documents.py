"""Formats to read or to keep: text, Markdown, JSON, JSON lines, HTML, gradebook, CSV."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Final

from pydantic import TypeAdapter
from rich.console import Console, RenderableType
from rich.segment import Segments
from rich.text import Text

from dh_grader.formats import texts
from dh_grader.formats.class_page import class_folder
from dh_grader.formats.graded import (
    GradedFile,
    GradedSubmission,
    ReportFormat,
    Setting,
    is_answered,
    printable,
)
from dh_grader.formats.texts import (
    POINTS,
    ROW,
    SIGNS,
    VERDICT_NAMES,
    AlignedColumn,
    AlignedTable,
    ClassSummary,
    Message,
    PartResult,
    StyledText,
    escaped,
    html_pieces,
    marks,
    messages,
    part_details,
    part_results,
    pass_line,
    percent,
    points,
    points_in_words,
    result_line,
    style_sheet,
    visible,
)
from dh_grader.grading import PartReport, Report, RowReport, Severity, Verdict
from dh_grader.grading.report import messages_of
from dh_grader.regex import regex
from dh_grader.translations import Language, Translation, joined, say, told

# --- A report for the terminal: each part as a table with its messages, and a total
#
# Signs carry the meaning, so the report can also be read without colours.


_COLOURS: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: "green",
    Verdict.PARTIAL: "yellow",
    Verdict.INCORRECT: "red",
    Verdict.UNREADABLE: "magenta",
    Verdict.MISSING: "bright_black",
}
# More submissions than this get one line each instead of a report.
_IN_FULL: Final = 8
_ASCII: Final = str.maketrans("✓✗–", "+x-")
_ASCII_MARKS: Final = str.maketrans({"−": "-", "α": "alpha", "θ": "theta"})
# Longer lines are hard to read however wide the terminal is.
_WIDEST: Final = 100
_INDENT: Final = 2
# Translators: the heading of a table that shows how entries were read.
_READ: Final = say("read")
_FOLLOWED: Final = say("counted with your own earlier answer")
_BLANK: Final[StyledText] = ("", "")


def _text_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    rest = iter(submissions)
    first = tuple(islice(rest, _IN_FULL + 1))
    are_several = len(first) > 1 or any(len(each.files) > 1 for each in first)
    translation = setting.language.translation
    summary = ClassSummary(translation)
    console = setting.console
    for submission in chain(first, rest):
        summary.add(submission)
        with console.capture() as captured:
            if len(first) > _IN_FULL:
                console.print(result_line(submission, translation), soft_wrap=True)
            else:
                _write_submission(submission, console, translation, are_several=are_several)
        yield captured.get().encode(console.encoding, "replace")
    if len(first) > 1:
        with console.capture() as captured:
            if len(first) > _IN_FULL:
                console.print()
            for line in summary.lines():
                _print_indented(line, console)
        yield captured.get().encode(console.encoding, "replace")


def _write_submission(
    submission: GradedSubmission,
    console: Console,
    translation: Translation | None,
    *,
    are_several: bool,
) -> None:
    for file in submission.files:
        if file.report is None:
            continue
        if are_several:
            console.print(Text(f"== {visible(file.file or file.exercise.id)}", "bold"))
        write(file.report, console, translation)
        if len(submission.files) > 1:
            console.print()
    if len(submission.files) > 1:
        total = points_in_words(submission.points, submission.max_points, translation)
        console.print(Text(f"{visible(submission.name)}: {total}, {percent(submission.score)}"))
    if submission.is_graded:
        console.print(pass_line(submission, translation))
        if are_several:
            console.print()


def _print_indented(line: Text, console: Console) -> None:
    width = min(console.width, _WIDEST)
    if line.cell_len <= width:
        console.print(line)
        return
    indent = " " * 6
    first, *more = line.wrap(console, width - len(indent))
    console.print(first, width=width)
    for each in more:
        console.print(Text.assemble(indent, each), width=width)


def write(report: Report, console: Console, translation: Translation | None = None) -> None:
    """Print the report; replace signs that the console's encoding lacks by ASCII."""
    _Page(console, translation).report(report)


class _Page:
    def __init__(self, console: Console, translation: Translation | None) -> None:
        self._console = console
        self._translation = translation
        self._width = min(console.width, _WIDEST)
        self._ascii = not _can_write("✓✗–", console.encoding)

    def report(self, report: Report) -> None:
        for part in report.parts:
            self._part(part)
        of = say("Total for {exercise}: ", exercise=visible(report.exercise))
        total = points_in_words(report.points, report.max_points, self._translation)
        shown = f"{total}, {percent(report.score)}"
        self._print(Text.assemble((self._told(of), "bold"), shown))
        if not report.gradable:
            unread = say("Nothing in this submission could be read.")
            nothing = unread if is_answered(report) else say("It is not answered.")
            self._print(Text(self._told(nothing)))
        if any(part.rows for part in report.parts):
            signs = [Verdict.CORRECT, Verdict.INCORRECT, Verdict.UNREADABLE, Verdict.MISSING]
            # An error in a partly right part or row has this mark.
            if any(
                each.severity is Severity.ERROR and each.verdict is Verdict.PARTIAL
                for part in report.parts
                for each in messages(part, self._translation)
            ):
                signs.insert(1, Verdict.PARTIAL)
            legend = "   ".join(f"{self._mark(each)[0]} {self._verdict(each)}" for each in signs)
            self._print(Text(legend, "dim"))

    def _part(self, part: PartReport) -> None:
        self._print(
            Text.assemble(
                (visible(part.part), "bold"),
                f" ({part.kind}): ",
                (self._verdict(part.verdict), _COLOURS[part.verdict]),
                f", {points_in_words(part.points, part.max_points, self._translation)}",
                f", {self._told(_FOLLOWED)}" if part.follow_through else "",
            )
        )
        if part.rows:
            self._print(self._table(part).on(self._console, self._width, _INDENT))
        if any(cell.read for row in part.rows for cell in row.cells):
            self._print(self._read(part).on(self._console, self._width, _INDENT))
        lines = [
            line for message in messages(part, self._translation) for line in self._message(message)
        ]
        lines += [
            line
            for text in marks(part, translation=self._translation)
            for line in self._marks(text)
        ]
        self._console.print(_as_they_are(lines, self._console))

    def _table(self, part: PartReport) -> AlignedTable:
        widest = max((row.cells for row in part.rows), key=len)
        columns = [AlignedColumn(cell.label, "center") for cell in widest]
        rows = [
            [
                (row.label, ""),
                *(self._mark(cell.verdict) for cell in row.cells),
                *[_BLANK] * (len(widest) - len(row.cells)),
                (points(row.points, row.max_points), ""),
            ]
            for row in part.rows
        ]
        return AlignedTable(
            [
                AlignedColumn(self._told(ROW)),
                *columns,
                AlignedColumn(self._told(POINTS), "right"),
            ],
            rows,
        )

    def _read(self, part: PartReport) -> AlignedTable:
        widest = max((row.cells for row in part.rows), key=len)
        columns = [
            AlignedColumn(self._told(_READ)),
            *(AlignedColumn(cell.label) for cell in widest),
        ]
        rows = [
            [
                (row.label, ""),
                *((visible(cell.read.text) if cell.read else "", "") for cell in row.cells),
                *[_BLANK] * (len(widest) - len(row.cells)),
            ]
            for row in part.rows
        ]
        return AlignedTable(columns, rows, "bold")

    def _message(self, message: Message) -> Iterator[Text]:
        costs = message.severity is Severity.ERROR
        mark = self._mark(message.verdict) if costs else (message.label, "cyan")
        places = f"{message.places}: " if message.places else ""
        text = Text.assemble((places, "bold"), message.text)
        if message.offers:
            text.append(f" {message.offers}")
        if message.example:
            text.append(f" {message.example}", "dim")
        # A Rich table of two columns looks the same but takes four times as long.
        first = Text.assemble("  ", mark, " ")
        lines = text.wrap(self._console, self._width - first.cell_len)
        yield Text.assemble(first, *lines[:1])
        for line in lines[1:]:
            yield Text.assemble(" " * first.cell_len, line)

    def _marks(self, text: str) -> Iterator[Text]:
        shown = Text(text.translate(_ASCII_MARKS) if self._ascii else text)
        for line in shown.wrap(self._console, self._width - 2 * _INDENT):
            yield Text.assemble(" " * 2 * _INDENT, line)

    def _mark(self, verdict: Verdict) -> StyledText:
        sign = SIGNS[verdict]
        return (sign.translate(_ASCII) if self._ascii else sign), _COLOURS[verdict]

    def _told(self, text: str) -> str:
        return told(text, self._translation)

    def _verdict(self, verdict: Verdict) -> str:
        return self._told(VERDICT_NAMES[verdict])

    def _print(self, what: RenderableType) -> None:
        self._console.print(what, width=self._width)


def _as_they_are(lines: Iterable[Text], console: Console) -> Segments:
    # Printing each line separately takes five times as long.
    return Segments(segment for line in [*lines, Text()] for segment in line.render(console, "\n"))


def _can_write(text: str, encoding: str) -> bool:
    try:
        text.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return True


# The first line of a report on a part, or a line of a class: ``passed   8 / 8   100 %   anna``.
_TEXT_MARK: Final = regex(
    rb"(?:== [^\n]*\n)?[^\s()]{1,60} \([a-z_]{1,40}\): \S"
    rb"|(?:[^\n]*\n){0,200}?[^\n]{1,60} [\d.]+ / [\d.]+ +[\d.]+ %   \S"
)

TEXT: Final = ReportFormat(_text_pieces, _TEXT_MARK, is_stream=True)


# --- GitHub's Markdown for the summary of a job or a comment on a pull request
#
# GitHub takes 1 MiB of summary for a step and 65,536 characters of a comment.


_MARKDOWN_HEAD: Final = (say("submission"), say("points"), say("score"), say("passed"))
_ALIGNED: Final = "|---|--:|--:|:-:|\n"


def _markdown_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    details = []
    head = " | ".join(told(each, setting.language.translation) for each in _MARKDOWN_HEAD)
    yield f"| {head} |\n{_ALIGNED}".encode()
    for submission in submissions:
        yield _line(submission, setting.language.translation).encode()
        details.append(_details(submission, setting.language).encode())
    yield from details


def _line(submission: GradedSubmission, translation: Translation | None) -> str:
    name = escaped(submission.name)
    if not submission.is_complete:
        return f"| {name} | | {told(say('not graded'), translation)} | ✗ |\n"
    earned = points(submission.points, submission.max_points)
    sign = "✓" if submission.passed else "✗"
    return f"| {name} | {earned} | {percent(submission.score)} | {sign} |\n"


def _details(submission: GradedSubmission, language: Language) -> str:
    sections = [f"\n### {escaped(submission.name)}\n"]
    sections += (
        f"\n**{escaped(result.name)}:** {result.verdict_name}, {result.points_in_words}\n\n"
        f"{part_details(result)}"
        for result in part_results(submission, language)
    )
    return "".join(sections)


_MARKDOWN_MARK: Final = regex(rb"(?:\| [^|\n]{1,40} ){4}\|\n" + re.escape(_ALIGNED).encode())

MARKDOWN: Final = ReportFormat(_markdown_pieces, _MARKDOWN_MARK, for_students=True)


# --- Reports as a JSON list with one entry for each file


_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """Return the report as UTF-8 JSON without the fields that are None."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)


def read_report(content: bytes) -> Report:
    """Parse a report from the JSON that ``rendered`` made. Raises pydantic.ValidationError."""
    return _REPORT.validate_json(content)


def entries(submissions: Iterable[GradedSubmission]) -> Iterator[bytes]:
    """Yield a line of JSON for each file, with its report, its error, or both."""
    for submission in submissions:
        for file in submission.files:
            yield printable(_entry(submission, file))


def _entry(submission: GradedSubmission, file: GradedFile) -> bytes:
    head: dict[str, str | bool | list[str]] = {
        "submission": _encodable(submission.name),
        "file": _encodable(file.file),
        "exercise": file.exercise.id,
        "passed": submission.passed,
    }
    if file.by_hand:
        head["error"] = _encodable(file.by_hand)
    if file.beside:
        head["unread"] = [_encodable(each) for each in file.beside]
    if file.report is None:
        return json.dumps(head).encode()
    return json.dumps(head).encode()[:-1] + b', "report": %b}' % rendered(file.report)


def _encodable(text: str) -> str:
    # Names of files may have bytes that are not UTF-8.
    return text.encode("utf-8", "replace").decode()


def _json_pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    opening = b"[\n"
    for entry in entries(submissions):
        yield opening + entry
        opening = b",\n"
    yield b"[]\n" if opening == b"[\n" else b"\n]\n"


JSON: Final = ReportFormat(_json_pieces, regex(rb'\[\n\{"submission": "'))


# --- Reports as JSON lines: one line for each file, written as soon as the file is graded


def _jsonl_pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    for entry in entries(submissions):
        yield entry + b"\n"


# A shard begins with its number.
_JSONL_MARK: Final = regex(rb'\{"submission": "|\{"shard": \d+, "shards": ')

JSONL: Final = ReportFormat(_jsonl_pieces, _JSONL_MARK, is_stream=True)


# --- A page for students: a card for each part, which shows how each entry was read


STYLE: Final = style_sheet(Path(__file__).with_name("templates") / "html.css")


def page_of(submission: GradedSubmission, language: Language) -> bytes:
    """Return the page of one submission."""
    titles = [file.exercise.title for file in submission.files]
    return b"".join(_page(" · ".join(titles), [submission], language))


def _html_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    rest = iter(submissions)
    first = tuple(islice(rest, 2))
    names = [first[0].learner] if len(first) == 1 else []
    title = " · ".join([*names, *(each.title for each in setting.exercises)])
    yield from _page(title, chain(first, rest), setting.language)


def _page(
    title: str, submissions: Iterable[GradedSubmission], language: Language
) -> Iterator[bytes]:
    yield from html_pieces(
        "formats/templates/submissions.html",
        language=language,
        title=title,
        style=STYLE,
        submissions=submissions,
        columns_of=_columns_of,
        part_results=partial(part_results, language=language),
        points=points,
        points_in_words=partial(points_in_words, translation=language.translation),
        verdict_names=VERDICT_NAMES,
        signs=SIGNS,
    )


def _columns_of(rows: Sequence[RowReport]) -> list[str]:
    return [cell.label for cell in max((row.cells for row in rows), key=len)]


_HTML_MARK: Final = regex(
    rb'<!doctype html>.{0,500}?<meta name="generator" content="DH Grader', re.DOTALL
)

HTML: Final = ReportFormat(
    _html_pieces,
    _HTML_MARK,
    for_students=True,
    shows_entries=True,
    folder=class_folder(_html_pieces),
)


# --- Grades for the gradebook of a course: one line for each learner, with Moodle's headings


def _gradebook_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    yield texts.line(texts.GRADEBOOK_HEAD)
    for submission in submissions:
        yield texts.line(_gradebook_cells(submission, setting))


def _gradebook_cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    return [
        submission.learner,
        # On import, an empty grade keeps the old grade. What was not read does not count as 0.
        submission.points if submission.is_complete else None,
        submission.max_points,
        comment(submission, setting.language),
    ]


def comment(submission: GradedSubmission, language: Language) -> str:
    """Return the points of each part in one line."""
    results = part_results(submission, language)
    return "; ".join(f"{each.name}: {_earned(each, language)}" for each in results)


def _earned(result: PartResult, language: Language) -> str:
    if result.report is None:
        return result.file.problem
    if result.is_unread:
        return told(say("could not be read"), language.translation)
    shown = points(result.points, result.max_points)
    # Beside the grade of a worksheet, which has the decimal sign of its language.
    return shown.replace(".", ",") if language.code in _WITH_DECIMAL_COMMA else shown


_WITH_DECIMAL_COMMA: Final = frozenset({"de", "es", "fr"})

_GRADEBOOK_MARK: Final = regex(re.escape(",".join(texts.GRADEBOOK_HEAD)).encode() + b"\r?\n")

GRADEBOOK: Final = ReportFormat(_gradebook_pieces, _GRADEBOOK_MARK)


# --- Points as comma-separated values: a line for each submission, a column for each part


_CSV_HEAD: Final = ("submission", "points", "max_points", "score", "passed", "problem", "messages")
# Messages that cost points or may name a slip. Notes and hints are not listed.
_COUNTED: Final = (Severity.ERROR, Severity.WARNING)


def _csv_pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    columns = [f"{each.id}.{part.id}" for each in setting.exercises for part in each.parts]
    yield texts.line([*_CSV_HEAD, *columns])
    for submission in submissions:
        yield texts.line(_csv_cells(submission, setting))


def _csv_cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    is_complete = submission.is_complete
    results = part_results(submission, setting.language)
    # If something was not graded, the points are empty.
    return [
        submission.name,
        submission.points if is_complete else None,
        submission.max_points,
        _share(submission.score) if is_complete else None,
        "yes" if submission.passed else "no",
        told(joined("; ", submission.problems), setting.language.translation),
        " ".join(code for each in results if each.report for code in _codes(each.report)),
        *(None if each.is_unread else each.points for each in results),
    ]


def _share(score: float) -> str:
    # A share of 1 needs more decimals than points.
    return f"{score:.6f}".rstrip("0").rstrip(".")


def _codes(part: PartReport) -> list[str]:
    found = (message.code for message, _, _ in messages_of(part) if message.severity in _COUNTED)
    return [f"{part.part}.{code}" for code in dict.fromkeys(found)]


CSV: Final = ReportFormat(_csv_pieces, regex(re.escape(",".join(_CSV_HEAD)).encode()))
