"""A report for the terminal: each part as a table with its messages, and a total.

Signs carry the meaning, so the report can also be read without colours.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import Final, Literal

from rich.cells import cell_len, set_cell_size
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.segment import Segment, Segments
from rich.text import Text

from dh_grader.formats.graded import GradedSubmission, ReportFormat, Setting, is_answered
from dh_grader.formats.texts import (
    NOT_PASSED,
    PASSED,
    POINTS,
    ROW,
    SIGNS,
    VERDICT_NAMES,
    Message,
    marks,
    messages,
    percent,
    points,
    points_in_words,
    shortened,
    visible,
    whole_percent,
)
from dh_grader.grading import PartReport, Report, Severity, Verdict
from dh_grader.regex import regex
from dh_grader.statistics import ClassStatistics, CountedSlip
from dh_grader.translations import Translation, say, told

# A text and its style.
StyledText = tuple[str, str]

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

    def _table(self, part: PartReport) -> "AlignedTable":
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

    def _read(self, part: PartReport) -> "AlignedTable":
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


# --- A summary of a class in a few lines: how many passed, and the most frequent mistakes


_SLIPS: Final = 10
_UNREAD: Final = 5
_LONGEST: Final = 300
_NOT_GRADED: Final = say("not graded")
_PASSED: Final = say("passed")
_NOT_PASSED: Final = say("not passed")


def result_line(submission: GradedSubmission, translation: Translation | None) -> Text:
    """Return a line about one submission."""
    name = visible(submission.name)
    words = [told(each, translation) for each in (_NOT_GRADED, _PASSED, _NOT_PASSED)]
    width = max(map(cell_len, words))
    not_graded, passed, not_passed = (set_cell_size(each, width) for each in words)
    if not submission.is_complete:
        # The name is at the end, because it may be long.
        return Text.assemble((not_graded, "magenta"), " " * 23, name)
    verdict = (passed, "green") if submission.passed else (not_passed, "red")
    earned = points(submission.points, submission.max_points)
    return Text.assemble(verdict, f"  {earned:>13}  {percent(submission.score):>7}   ", name)


def pass_line(submission: GradedSubmission, translation: Translation | None) -> Text:
    """Return a line that says whether the submission reaches the pass mark."""
    passed = submission.passed
    style, verdict = ("bold green", PASSED) if passed else ("bold red", NOT_PASSED)
    mark = percent(submission.pass_mark)
    shown = told(
        say("{verdict}: the pass mark is {share}.", verdict=verdict, share=mark), translation
    )
    line = Text(shown)
    line.highlight_words([told(verdict, translation)], style)
    return line


class ClassSummary:
    """Counts submissions one by one, and summarizes them in a few lines."""

    def __init__(self, translation: Translation | None = None) -> None:
        self._translation = translation
        self._statistics = ClassStatistics()
        self._count = 0
        self._pass_mark = 0.0

    def add(self, submission: GradedSubmission) -> None:
        """Count a submission."""
        self._count += 1
        self._pass_mark = submission.pass_mark
        if submission.is_complete:
            self._statistics.scores.add(submission.score, passed=submission.passed)
        for file in submission.files:
            if file.report:
                self._statistics.add(self._count, file.report)

    def lines(self) -> Iterator[Text]:
        """Yield the lines of the summary."""
        scores, slips = self._statistics.scores, self._statistics.slips
        graded = say(
            "{passed} of {graded} graded passed (pass mark {share})",
            passed=f"{scores.passed:,}",
            graded=f"{scores.count:,}",
            share=percent(self._pass_mark),
        )
        if scores.count < self._count:
            others = f"{self._count - scores.count:,}"
            graded = say("{graded}, {others} not graded", graded=graded, others=others)
        submissions = say("{submissions} submissions: ", submissions=f"{self._count:,}")
        yield Text.assemble((self._told(submissions), "bold"), self._told(graded))
        if scores.count:
            mean, median = whole_percent(scores.mean), whole_percent(scores.median)
            line = say("Mean score {mean}, median {median}", mean=mean, median=median)
            yield Text(self._told(line))
        yield from self._listed(say("Commonest slips"), slips.counted()[:_SLIPS])
        yield from self._listed(
            say("What could not be read most often"), slips.counted(unreadable=True)[:_UNREAD]
        )

    def _told(self, text: str) -> str:
        return told(text, self._translation)

    def _listed(self, heading: str, slips: Sequence[CountedSlip]) -> Iterator[Text]:
        if slips:
            yield Text()
            yield Text(self._told(heading), "bold")
        for slip in slips:
            parts = ", ".join(dict.fromkeys(part for _, part in slip.parts))
            place = say("({name} in {parts})", name=slip.slip_code, parts=visible(parts))
            sentence = shortened(visible(slip.sentence), _LONGEST)
            yield Text.assemble(f"{slip.count:>4,}  {sentence} ", (self._told(place), "dim"))


# --- Tables of short texts with aligned columns, for a terminal


_GAP: Final = 2


@dataclass(frozen=True, slots=True)
class AlignedColumn:
    """A column of a table: its heading, and the alignment of its cells."""

    heading: str
    justify: Literal["left", "center", "right"] = "left"

    def filled(self, text: str, width: int) -> str:
        """Return the text, padded with blanks."""
        missing = width - cell_len(text)
        before = {"left": 0, "center": missing // 2, "right": missing}[self.justify]
        return " " * before + text + " " * (missing - before)


@dataclass(frozen=True, slots=True)
class AlignedTable:
    """A table of short texts without lines; each row has a cell for each column."""

    columns: Sequence[AlignedColumn]
    rows: Sequence[Sequence[StyledText]]
    heading_style: str = "dim"

    def on(self, console: Console, width: int, indent: int) -> RenderableType:
        """Return the table to print, with ``indent`` blanks before each line.

        If the table is wider than ``width``, its columns become narrower.
        """
        texts = zip(*((text for text, _ in row) for row in self.rows), strict=True)
        widths = [
            max(map(cell_len, {column.heading, *cells}))
            for column, cells in zip(self.columns, texts, strict=True)
        ]
        if indent + sum(widths) + _GAP * (len(widths) - 1) > width:
            return Padding(self._narrowed(), (0, 0, 0, indent), expand=False)
        # Rich's own tables take ten times as long, because they measure each cell several times.
        headings = [(column.heading, self.heading_style) for column in self.columns]
        segments = []
        for line, gap_style in ((headings, self.heading_style), *((row, "") for row in self.rows)):
            gap = Segment(" " * _GAP, console.get_style(gap_style))
            segments.append(Segment(" " * indent))
            for column, cell_width, (text, style) in zip(self.columns, widths, line, strict=True):
                filled = column.filled(text, cell_width)
                segments += (Segment(filled, console.get_style(style)), gap)
            segments[-1] = Segment.line()
        return Segments(segments)

    def _narrowed(self) -> RenderableType:
        # It takes long to load, and few tables are too wide.
        from rich.table import Table

        table = Table(
            box=None,
            pad_edge=False,
            padding=(0, _GAP, 0, 0),
            header_style=self.heading_style,
        )
        for column in self.columns:
            table.add_column(
                column.heading, justify=column.justify, no_wrap=column.justify == "right"
            )
        for row in self.rows:
            table.add_row(*(Text(*cell) for cell in row))
        return table
