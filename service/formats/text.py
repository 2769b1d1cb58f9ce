"""A report for a person at a terminal: each part as a table, its messages beneath, a total.

Marks, not colours, carry the meaning, so it reads the same in a file or without colour.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from service.formats import GradedFile
from service.grading import (
    Correction,
    Feedback,
    PartReport,
    Place,
    Report,
    RowReport,
    Severity,
    Verdict,
)
from service.grading.feedback import EXPECTED, YOURS
from service.grading.report import messages_of

# The mark of each verdict, and its colour.
_MARKS: Final[Mapping[Verdict, tuple[str, str]]] = {
    Verdict.CORRECT: ("✓", "green"),
    Verdict.PARTIAL: ("~", "yellow"),
    Verdict.INCORRECT: ("✗", "red"),
    Verdict.UNREADABLE: ("?", "magenta"),
    Verdict.MISSING: ("–", "bright_black"),
}
_ASCII: Final = str.maketrans("✓✗–", "+x-")
# Longer lines are hard to read however wide the terminal is.
_WIDEST: Final = 100


def document(graded: Sequence[GradedFile], console: Console) -> bytes:
    """The report on each file, below its name where there are several."""
    with console.capture() as captured:
        for result in graded:
            if result.report is None:
                continue
            if len(graded) > 1:
                console.print(Text(f"== {visible(str(result.file))}", "bold"))
            write(result.report, console)
            if len(graded) > 1:
                console.print()
    return captured.get().encode(console.encoding, "replace")


def write(report: Report, console: Console) -> None:
    """Print the report; a console whose encoding lacks the marks gets plain ASCII for them."""
    _Page(console).report(report)


def visible(text: str) -> str:
    """The text with every control and invisible character replaced: it may come from anyone."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def points(earned: float, most: float) -> str:
    """Points out of the most there are: ``1.5 / 2``, never rounded up to the most."""
    shown = _number(earned)
    if earned < most and shown == _number(most):
        shown = _number(int(earned * 100) / 100)
    return f"{shown} / {_number(most)}"


def _number(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")


class _Page:
    """One report on one console."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._width = min(console.width, _WIDEST)
        self._ascii = not _can_write("✓✗–", console.encoding)

    def report(self, report: Report) -> None:
        for part in report.parts:
            self._part(part)
        # Not rounded up to a mark that was not reached.
        percent = int(report.score * 1000 + 1e-6) / 10
        total = f"{points(report.points, report.max_points)} points, {percent:g} %"
        self._print(Text.assemble((f"Total for {visible(report.exercise)}: ", "bold"), total))
        if not report.gradable:
            self._print(Text("Nothing in this submission could be read."))
        if any(part.rows for part in report.parts):
            signs = [Verdict.CORRECT, Verdict.INCORRECT, Verdict.UNREADABLE, Verdict.MISSING]
            messages = (message for part in report.parts for message in _messages(part))
            # The mark of an error in a part or row that is right elsewhere.
            if any(
                each.severity is Severity.ERROR and verdict is Verdict.PARTIAL
                for _, each, verdict in messages
            ):
                signs.insert(1, Verdict.PARTIAL)
            legend = "   ".join(f"{self._mark(verdict)} {verdict}" for verdict in signs)
            self._print(Text(legend, "dim"))

    def _part(self, part: PartReport) -> None:
        self._print(
            Text.assemble(
                (visible(part.part), "bold"),
                f" ({part.kind}): ",
                (part.verdict.value, _MARKS[part.verdict][1]),
                f", {points(part.points, part.max_points)} points",
                ", counted with your own earlier answer" if part.follow_through else "",
            )
        )
        if part.rows:
            self._print(Padding(self._table(part), (0, 0, 0, 2), expand=False))
        if any(cell.read for row in part.rows for cell in row.cells):
            self._print(Padding(self._read(part), (0, 0, 0, 2), expand=False))
        for places, message, verdict in _messages(part):
            self._message(places, message, verdict, part.rows)
        self._print(Text())

    def _table(self, part: PartReport) -> Table:
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
        table.add_column("row")
        widest = max((row.cells for row in part.rows), key=len)
        for cell in widest:
            table.add_column(cell.label, justify="center")
        table.add_column("points", justify="right", no_wrap=True)
        for row in part.rows:
            marks = [self._mark(cell.verdict) for cell in row.cells]
            blanks = [Text()] * (len(widest) - len(marks))
            table.add_row(row.label, *marks, *blanks, points(row.points, row.max_points))
        return table

    def _read(self, part: PartReport) -> Table:
        """The entries as they were understood."""
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), style="dim")
        table.add_column("read")
        for cell in max((row.cells for row in part.rows), key=len):
            table.add_column(cell.label)
        for row in part.rows:
            read = (visible(cell.read.text) if cell.read else "" for cell in row.cells)
            table.add_row(row.label, *map(Text, read))
        return table

    def _message(
        self, places: str, message: Feedback, verdict: Verdict, rows: Sequence[RowReport]
    ) -> None:
        """A message, its lines beneath each other to the right of its mark."""
        costs = message.severity is Severity.ERROR
        mark = self._mark(verdict) if costs else Text(message.severity.value, "cyan")
        text = Text.assemble((f"{places}: " if places else "", "bold"), visible(message.message))
        for offered in filter(None, (_suggestion(message), _correction(message, rows))):
            text.append(f" {visible(offered)}")
        if message.values:
            text.append(f" {_counterexample(message.values)}", "dim")
        grid = Table.grid(padding=(0, 1))
        grid.add_column(no_wrap=True)
        grid.add_column()
        grid.add_row(mark, text)
        self._print(Padding(grid, (0, 0, 0, 2), expand=False))

    def _mark(self, verdict: Verdict) -> Text:
        sign, style = _MARKS[verdict]
        return Text(sign.translate(_ASCII) if self._ascii else sign, style)

    def _print(self, what: Text | Padding) -> None:
        self._console.print(what, width=self._width)


def _messages(part: PartReport) -> Iterator[tuple[str, Feedback, Verdict]]:
    """The part's messages with their places and the verdict there."""
    if part.verdict is Verdict.MISSING and not part.feedback and not part.rows:
        nothing = Feedback("missing", Severity.ERROR, "Nothing was handed in.")
        yield "", nothing, Verdict.MISSING
    for message, places, verdict in messages_of(part):
        yield _places(places, part.rows), message, verdict


def _places(places: Iterable[Place], rows: Sequence[RowReport]) -> str:
    """The places in few words: ``row 1 d, theta; rows 2, 3``."""
    complete = {row.label: [cell.label for cell in row.cells] for row in rows}
    cells: dict[str, list[str]] = {}
    for place in places:
        named = cells.setdefault(place.row, [])
        if place.cell is not None:
            named.append(place.cell)
    alike: dict[tuple[str, ...], list[str]] = {}
    for row, named in cells.items():
        columns = () if len(named) > 1 and named == complete.get(row) else tuple(named)
        alike.setdefault(columns, []).append(visible(row))
    return "; ".join(
        f"row{'s' if len(labels) > 1 else ''} {', '.join(labels)}{_columns(columns)}"
        for columns, labels in alike.items()
    )


def _suggestion(message: Feedback) -> str:
    """The repaired text as a question, unless the message asks it itself."""
    question = f"Did you mean {message.suggestion}?"
    return "" if message.suggestion is None or question in message.message else question


def _correction(message: Feedback, rows: Sequence[RowReport]) -> str:
    """The instruction, or the right entry in a sentence: the one, or one for each place."""
    found = [] if message.correction is None else [_told(message.correction)]
    at: dict[Correction, list[Place]] = {}
    for place in message.places or ():
        if place.correction is not None:
            at.setdefault(place.correction, []).append(place)
    told = [f"{_places(places, rows)}: {_told(correction)}" for correction, places in at.items()]
    return " ".join([*found, *told])


def _told(correction: Correction) -> str:
    return correction.text if correction.latex is None else f"It should be {correction.text}."


def _columns(labels: Sequence[str]) -> str:
    if not labels:
        return ""
    noun = "" if not labels[0].isdigit() else "column " if len(labels) == 1 else "columns "
    return f" {noun}{visible(', '.join(labels))}"


def _counterexample(values: Mapping[str, float | str]) -> str:
    """``(with q1 = 0.4, yours gives 1.2, not 0.9)``, from the values of one sample."""
    given = [f"{name} = {value}" for name, value in values.items() if name not in (YOURS, EXPECTED)]
    at = f"with {', '.join(given)}" if given else ""
    yours = f"yours gives {values[YOURS]}" if YOURS in values else ""
    right = f"not {values[EXPECTED]}" if EXPECTED in values else ""
    return visible(f"({', '.join(filter(None, [at, yours, right]))})")


def _can_write(text: str, encoding: str) -> bool:
    try:
        text.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return True
