"""A report for the terminal: each part as a table with its messages, and a total.

Signs carry the meaning, so the report can also be read without colours.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, islice
from typing import Final

from rich.console import Console, RenderableType
from rich.segment import Segments
from rich.text import Text

from service.formats.shared.aligned import AlignedColumn, AlignedTable, StyledText
from service.formats.shared.class_summary import ClassSummary, pass_line, result_line
from service.formats.shared.graded import GradedSubmission, is_answered
from service.formats.shared.messages import (
    POINTS,
    ROW,
    SIGNS,
    VERDICT_NAMES,
    Message,
    marks,
    messages,
)
from service.formats.shared.plain_text import percent, points, points_in_words, visible
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import PartReport, Report, Severity, Verdict
from service.regex import regex
from service.translations import say, told
from service.translations.sentence import Translation

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


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
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
_MARK: Final = regex(
    rb"(?:== [^\n]*\n)?[^\s()]{1,60} \([a-z_]{1,40}\): \S"
    rb"|(?:[^\n]*\n){0,200}?[^\n]{1,60} [\d.]+ / [\d.]+ +[\d.]+ %   \S"
)

TEXT: Final = ReportFormat(_pieces, _MARK, is_stream=True)
