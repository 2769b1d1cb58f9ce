"""The texts that formats share: safe short texts, CSV, HTML, Markdown, messages, summaries."""

import base64
import csv
import hashlib
import io
import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial, reduce
from itertools import chain, count, groupby
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

from markupsafe import Markup, escape
from rich.cells import cell_len, set_cell_size
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.segment import Segment, Segments
from rich.text import Text

from dh_grader import typeset as typeset_typeset
from dh_grader.formats.graded import AnsweredPart, GradedFile, GradedSubmission, is_mostly_unread
from dh_grader.grading import Correction, Feedback, PartReport, Place, RowReport, Severity, Verdict
from dh_grader.grading.report import (
    EXPECTED,
    NO_ANSWER,
    NOT_READ,
    YOURS,
    messages_of,
    rounded_points,
)
from dh_grader.regex import regex
from dh_grader.statistics import ClassStatistics, CountedSlip
from dh_grader.translations import (
    ENGLISH,
    Language,
    Sentence,
    Translation,
    paragraph,
    say,
    say_count,
    told,
)

if TYPE_CHECKING:
    from jinja2 import Environment


# --- Untrusted texts, and numbers, as short text that is safe to print


# Builds read commands in the output of programs: GitHub `::` at the start of a line and `##[`
# anywhere, Azure `##vso[`, TeamCity `##teamcity[`. No formula has these signs twice in a row.
_COMMAND: Final = regex(r"(?<=([:#]))(?=\1)")
# Spaces at which no line breaks, as French has them before a colon. Python calls them unprintable.
_UNBROKEN: Final = "\u00a0\u202f"


def visible(text: str) -> str:
    """Return the text in one line, without invisible characters."""
    if not text.isprintable():
        text = "".join(
            c if c.isprintable() or c in _UNBROKEN else "\N{REPLACEMENT CHARACTER}" for c in text
        )
    return _COMMAND.sub(" ", text)


def code_pieces(text: str) -> list[tuple[str, bool]]:
    """Divide a text at its backticks; each piece has True if it is code."""
    pieces = visible(text).split("`")
    if len(pieces) % 2 == 0:
        # With an odd number of backticks, nothing is code.
        return [(visible(text), False)]
    return [(piece, bool(i % 2)) for i, piece in enumerate(pieces) if piece]


def shortened(text: str, most: int) -> str:
    """Return the text, cut to at most ``most`` characters."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def first_lines(
    lines: Iterable[str], most: int, translation: Translation | None = None
) -> Iterator[str]:
    """Yield the first ``most`` lines, then a line with the number of omitted lines."""
    left = 0
    for i, line in enumerate(lines):
        if i < most:
            yield line
        else:
            left += 1
    if left:
        yield told(say("… and {count} more", count=left), translation)


def points_in_words(earned: float, most: float, translation: Translation | None = None) -> str:
    """Return points with their unit, such as ``1.5 / 2 points``."""
    return told(say("{points} points", points=points(earned, most)), translation)


def points(earned: float, most: float) -> str:
    """Return points such as ``1.5 / 2``. The points are never rounded up to the maximum."""
    shown = number(earned)
    if earned < most and shown == number(most):
        shown = number(int(earned * 100) / 100)
    return f"{shown} / {number(most)}"


def percent(score: float) -> str:
    """Return a score, 0..1, in per cent, such as ``87.5 %``, rounded down."""
    return f"{int(score * 1000 + 1e-6) / 10:g} %"


def whole_percent(share: float) -> str:
    """Return a fraction, 0..1, in whole per cent. Only 1 is ``100 %``."""
    return f"{min(int(share * 100 + 0.5), 99) if share < 1 else 100} %"


def whole_score(score: float) -> str:
    """Return a score, 0..1, in whole per cent, such as ``87 %``, rounded down."""
    return f"{int(score * 100 + 1e-6)} %"


def number(value: float) -> str:
    """Return a number with at most two decimals."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


# --- Lines of comma-separated values (RFC 4180, UTF-8) that no spreadsheet reads as formulas


# Some spreadsheets run a cell with such a beginning as a formula (OWASP, "CSV Injection"). Where a
# comma is the decimal sign, they also end a cell at a semicolon, whatever quotes are around it.
_FORMULA: Final = regex(r"""(?:^|(?<=;))(?=[\s"]*[=+\-@＝＋－＠])""")

# The headings of a list of grades, as Moodle names them.
GRADEBOOK_HEAD: Final = ("Identifier", "Grade", "Maximum Grade", "Feedback comments")


def line(cells: Iterable[str | float | None]) -> bytes:
    """Return one line of cells; a text that looks like a formula gets a leading apostrophe."""
    written = io.StringIO(newline="")
    csv.writer(written, lineterminator="\r\n").writerow([_cell(cell) for cell in cells])
    return written.getvalue().encode()


def _cell(value: str | float | None) -> str:
    if value is None:
        return ""
    return without_formulas(value) if isinstance(value, str) else number(value)


def without_formulas(text: str) -> str:
    """Return the text in one line, with an apostrophe before all that looks like a formula."""
    return _FORMULA.sub("'", visible(text))


# --- HTML from Jinja2 templates, which are named by their path below ``service/``
#
# Only HTML that the service itself made (``own_html``) is not escaped. Each language has its own
# Jinja2 environment.


_PACKAGE: Final = Path(__file__).parents[1]
_SHARED_STYLE: Final = Path(__file__).with_name("templates") / "report.css"


@dataclass(frozen=True, slots=True)
class StyleSheet:
    """The CSS to print in a page, and its hash for the page's Content-Security-Policy."""

    html: Markup
    hash: str


def html(template: str, /, *, language: Language = ENGLISH, **values: object) -> bytes:
    """Fill in a template in a language; return the document in UTF-8."""
    return environment(language).get_template(template).render(values).encode()


def html_pieces(
    template: str, /, *, language: Language = ENGLISH, **values: object
) -> Iterator[bytes]:
    """Fill in a template in a language, piece by piece. Values may be iterators."""
    for piece in environment(language).get_template(template).generate(values):
        yield piece.encode()


def own_html(text: str) -> Markup:
    """Mark a text as HTML of the service itself, which templates do not escape."""
    return Markup(text)


def style_sheet(file: Path) -> StyleSheet:
    """Return the style sheet of all reports, followed by the style in ``file``."""
    style = _SHARED_STYLE.read_text(encoding="utf-8") + file.read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return StyleSheet(own_html(style), f"sha256-{digest}")


def lines(text: str) -> Markup:
    """Return the text as HTML with its line breaks, without invisible characters."""
    return escape("\n".join(map(visible, text.split("\n"))))


def typeset(text: object, symbols: Container[str] = ()) -> Markup:
    """Return the text as HTML, with its symbols as MathML."""
    return own_html(typeset_typeset.typeset(visible(str(text)), symbols))


def in_unicode(text: str, symbols: Container[str] = ()) -> str:
    """Return the text with its symbols in Unicode, for the title of a page."""
    return typeset_typeset.in_unicode(text, symbols)


def formula(text: str) -> Markup:
    """Return a formula as MathML, or as plain text if it is unreadable."""
    return own_html(typeset_typeset.formula(visible(text)))


@cache
def environment(language: Language = ENGLISH) -> "Environment":
    """Return the Jinja2 environment of a language, which keeps its compiled templates."""
    # Imported here, so that a program that writes no HTML starts without it.
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(_PACKAGE),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=partial(_finalize, language),
        extensions=["jinja2.ext.i18n"],
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        auto_reload=False,
        cache_size=-1,
    )
    functions = (
        code_pieces,
        formula,
        lines,
        number,
        percent,
        whole_percent,
        whole_score,
    )
    made.filters |= {each.__name__: each for each in functions}
    made.filters |= {
        "in_unicode": _telling(in_unicode, language),
        "typeset": _telling(typeset, language),
    }
    # A `{% trans %}` is one line, and its values are named.
    made.policies["ext.i18n.trimmed"] = True
    made.newstyle_gettext = True  # type: ignore[attr-defined]
    made.globals |= {
        "_": partial(_text, language),
        "gettext": partial(_markup, language),
        "ngettext": partial(_counted_markup, language),
        "language": language,
    }
    return made


def _finalize(language: Language, value: object) -> str:
    if isinstance(value, Markup):
        return value
    return visible(_told(value, language))


def _told(value: object, language: Language) -> str:
    return told(value, language.translation) if isinstance(value, str) else str(value)


def _telling(shown: Callable[..., str], language: Language) -> Callable[..., str]:
    def filtered(text: object, symbols: Container[str] = ()) -> str:
        return shown(_told(text, language), symbols)

    return filtered


def _text(language: Language, text: str, /, **values: object) -> Markup:
    return _filled(escape(_translated(language, text)), language, values)


def _markup(language: Language, text: str, /, **values: object) -> Markup:
    return _filled(_translated(language, text), language, values)


def _counted_markup(
    language: Language, one: str, many: str, count: int, /, **values: object
) -> Markup:
    translation = language.translation
    if translation is None:
        chosen = one if count == 1 else many
    else:
        chosen = translation.ngettext(one, many, count)
    return _filled(chosen, language, {"num": count, **values})


def _translated(language: Language, text: str) -> str:
    return language.translation.gettext(text) if language.translation else text


def _filled(text: str, language: Language, values: Mapping[str, object]) -> Markup:
    return own_html(text) % {name: _finalize(language, each) for name, each in values.items()}


# --- The messages of a report as text: their places, corrections and counterexamples


# The sign of each verdict.
SIGNS: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: "✓",
    Verdict.PARTIAL: "~",
    Verdict.INCORRECT: "✗",
    Verdict.UNREADABLE: "?",
    Verdict.MISSING: "–",
}

# The names of verdicts and severities in reports.
VERDICT_NAMES: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: say("correct"),
    Verdict.PARTIAL: say("partial"),
    Verdict.INCORRECT: say("incorrect"),
    Verdict.UNREADABLE: say("unreadable"),
    Verdict.MISSING: say("missing"),
}
PASSED: Final = say("Passed")
NOT_PASSED: Final = say("Not passed")
NOT_GRADED: Final = say("Not graded")
# The headings of the first and the last column of a table.
ROW: Final = say("row")
POINTS: Final = say("points")
_SEVERITY_NAMES: Final[Mapping[Severity, str]] = {
    Severity.WARNING: say("warning"),
    Severity.HINT: say("hint"),
    Severity.INFO: say("info"),
}

_RESULTS: Final = (YOURS, EXPECTED)

# A message, its places, and the verdict there.
_Placed = tuple[Feedback, tuple[Place, ...], Verdict]


@dataclass(frozen=True, slots=True)
class Message:
    """A message in the parts that a reader sees; each part is one line of text."""

    severity: Severity
    # The verdict on the place of the message.
    verdict: Verdict
    # For an error, the sign of the verdict; otherwise the name of the severity.
    label: str
    # The rows and cells; may be empty.
    places: str
    text: str
    # What to write instead; may be empty.
    offers: str
    # A counterexample; may be empty.
    example: str

    @property
    def line(self) -> str:
        """Return the whole message in one line, such as ``row 2 alpha: …``."""
        pieces = (f"{self.places}:" if self.places else "", self.text, self.offers, self.example)
        return " ".join(filter(None, pieces))


def total_points(submission: GradedSubmission) -> str:
    """Return the points and the score of a submission as a sentence."""
    return say(
        "{points} points, {score}.",
        points=points(submission.points, submission.max_points),
        score=percent(submission.score),
    )


def messages(part: PartReport, translation: Translation | None = None) -> Iterator[Message]:
    """Yield the messages on a part, its rows and its cells, in a language; None is English."""
    if part.verdict is Verdict.MISSING and not part.feedback and not part.rows:
        nothing = Feedback("missing", Severity.ERROR, say("Nothing was handed in."))
        yield _message(nothing, (), Verdict.MISSING, (), translation)
    for feedback, places, verdict in _once_for_each_row(messages_of(part)):
        yield _message(feedback, places, verdict, part.rows, translation)


def _once_for_each_row(found: Iterable[_Placed]) -> Iterator[_Placed]:
    # If neighbouring cells of a row have the same message, tell it once.
    def same(each: _Placed) -> object:
        feedback, places, verdict = each
        is_on_a_cell = len(places) == 1 and places[0].cell is not None
        return feedback, verdict, places[0].row if is_on_a_cell else places

    for _, group in groupby(found, same):
        first, *more = group
        feedback, places, verdict = first
        yield feedback, (*places, *chain.from_iterable(each[1] for each in more)), verdict


def marks(
    part: PartReport, weight: float = 1.0, translation: Translation | None = None
) -> list[str]:
    """Return lines about lost points and their places, such as ``−0.5: α in row 2``."""
    lost = [
        f"−{number(each.points * weight)}: {told(each.message, translation)}"
        for each in part.lost
        # A message already reports missing and unreadable answers.
        if each.code not in (NO_ANSWER, NOT_READ)
    ]
    notes = [told(part.little_worth.message, translation)] if part.little_worth else []
    return [visible(line) for line in filter(None, ["; ".join(lost), *notes])]


def _message(
    feedback: Feedback,
    places: Iterable[Place],
    verdict: Verdict,
    rows: Sequence[RowReport],
    translation: Translation | None,
) -> Message:
    text = told(feedback.message, translation)
    question = told(_suggestion(feedback), translation)
    # A message may already ask whether the repaired text was meant.
    offers = paragraph("" if question in text else question, _correction(feedback, rows))
    return Message(
        severity=feedback.severity,
        verdict=verdict,
        label=told(_SEVERITY_NAMES.get(feedback.severity, SIGNS[verdict]), translation),
        places=visible(told(places_in_words(places, rows), translation)),
        text=visible(text),
        offers=visible(told(offers, translation)),
        example=visible(told(_counterexample(feedback.values or {}), translation)),
    )


def places_in_words(places: Iterable[Place], rows: Sequence[RowReport] = ()) -> str:
    """Return places in words, such as ``row 1 d, theta; rows 2, 3``.

    ``rows`` are the rows of the part.
    """
    complete = {row.label: [cell.label for cell in row.cells] for row in rows}
    cells: dict[str, list[str]] = {}
    for place in places:
        named = cells.setdefault(place.row, [])
        if place.cell is not None:
            named.append(place.cell)
    alike: dict[tuple[str, ...], list[str]] = {}
    for row, named in cells.items():
        columns = () if len(named) > 1 and named == complete.get(row) else tuple(named)
        alike.setdefault(columns, []).append(row)
    said = [_rows_and_columns(labels, columns) for columns, labels in alike.items()]
    if not said:
        return ""
    return reduce(lambda one, other: say("{one}; {other}", one=one, other=other), said)


def _rows_and_columns(rows: Sequence[str], columns: Sequence[str]) -> Sentence:
    named = ", ".join(rows)
    if not columns:
        return say_count("row {rows}", "rows {rows}", count=len(rows), rows=named)
    # Translators: {columns} is a list of names, or such as "columns 1, 3".
    return say_count(
        "row {rows} {columns}",
        "rows {rows} {columns}",
        count=len(rows),
        rows=named,
        columns=_columns(columns),
    )


def _columns(labels: Sequence[str]) -> str:
    named = ", ".join(labels)
    if not labels[0].isdigit():
        return named
    return say_count("column {columns}", "columns {columns}", count=len(labels), columns=named)


def _suggestion(feedback: Feedback) -> str:
    if feedback.suggestion is None:
        return ""
    return say("Did you mean {suggestion}?", suggestion=feedback.suggestion)


def _correction(feedback: Feedback, rows: Sequence[RowReport]) -> str:
    found = [] if feedback.correction is None else [_in_words(feedback.correction)]
    at: dict[Correction, list[Place]] = {}
    for place in feedback.places or ():
        if place.correction is not None:
            at.setdefault(place.correction, []).append(place)
    placed = [
        say(
            "{places}: {correction}",
            places=places_in_words(places, rows),
            correction=_in_words(correction),
        )
        for correction, places in at.items()
    ]
    return paragraph(*found, *placed)


def _in_words(correction: Correction) -> str:
    if correction.latex is None:
        return correction.text
    return say("It should be {formula}.", formula=correction.text)


def _counterexample(values: Mapping[str, float | str]) -> str:
    at = ", ".join(f"{name} = {value}" for name, value in values.items() if name not in _RESULTS)
    yours, right = str(values.get(YOURS, "")), str(values.get(EXPECTED, ""))
    if not yours:
        return say("(with {values})", values=at) if at else ""
    if not right:
        if not at:
            return say("(yours gives {yours})", yours=yours)
        return say("(with {values}, yours gives {yours})", values=at, yours=yours)
    if not at:
        return say("(yours gives {yours}, not {right})", yours=yours, right=right)
    return say(
        "(with {values}, yours gives {yours}, not {right})", values=at, yours=yours, right=right
    )


# --- The results of a submission, part by part; platforms show each as a test


# Platforms limit a result: an annotation to 64 KB, a whole result to 1 MB.
MESSAGES_TOLD: Final = 30
LONGEST: Final = 600


@dataclass(frozen=True, slots=True)
class PartResult:
    """The result of one part (question) of an assigned exercise."""

    # One line, unique in the submission.
    name: str
    file: GradedFile
    part: AnsweredPart
    # None if the file could not be graded.
    report: PartReport | None
    language: Language = ENGLISH

    @property
    def points(self) -> float:
        """Return the points earned, on the scale of the submission."""
        return rounded_points(self.report.points * self.file.weight) if self.report else 0.0

    @property
    def max_points(self) -> float:
        """Return the maximum points, on the scale of the submission."""
        return rounded_points(self.part.points * self.file.weight)

    @property
    def passed(self) -> bool:
        """True if all points were earned."""
        return self.points >= self.max_points

    @property
    def verdict(self) -> Verdict:
        """Return the verdict on the part; without a report, the part is unreadable."""
        return self.report.verdict if self.report else Verdict.UNREADABLE

    @property
    def points_in_words(self) -> str:
        """Return the points earned and the maximum points, such as ``1.5 / 2 points``."""
        return points_in_words(self.points, self.max_points, self.language.translation)

    @property
    def is_unread(self) -> bool:
        """True if so much of the part could not be read that its points say too little."""
        return self.report is None or is_mostly_unread(self.report)

    @property
    def verdict_name(self) -> str:
        """Return the name of the verdict."""
        return told(VERDICT_NAMES[self.verdict], self.language.translation)

    def row_points(self, row: RowReport) -> str:
        """Return the points of a row as text."""
        weight = self.file.weight
        return points(row.points * weight, row.max_points * weight)

    def messages(self) -> Iterator[Message]:
        """Return the messages on the part."""
        return messages(self.report, self.language.translation) if self.report else iter(())

    def marks(self) -> list[str]:
        """Return lines with the lost points and their places."""
        translation = self.language.translation
        lines = marks(self.report, self.file.weight, translation) if self.report else []
        return [shortened(line, LONGEST) for line in lines]

    def message_lines(self) -> list[str]:
        """Return a line for each message; their length and number are limited."""
        if self.report is None:
            return [shortened(visible(self.file.problem), LONGEST)]
        lines = (shortened(f"{each.label} {each.line}", LONGEST) for each in self.messages())
        return list(first_lines(lines, MESSAGES_TOLD, self.language.translation))

    def lines(self) -> list[str]:
        """Return all lines: first the messages, then the lost points."""
        return [*self.message_lines(), *self.marks()]


def part_results(submission: GradedSubmission, language: Language) -> list[PartResult]:
    """Return the result of each part of each exercise of the submission, in order."""
    distinct = distinct_names()
    has_several = len(submission.files) > 1
    return [
        PartResult(
            distinct(_title(part, file) if has_several else part.title),
            file,
            part,
            report,
            language,
        )
        for file in submission.files
        for part, report in _reports(file)
    ]


def _title(part: AnsweredPart, file: GradedFile) -> str:
    return f"{file.exercise.title}: {part.title}"


def _reports(file: GradedFile) -> Iterator[tuple[AnsweredPart, PartReport | None]]:
    reports = {report.part: report for report in (file.report.parts if file.report else ())}
    return ((part, reports.get(part.id)) for part in file.exercise.parts)


def distinct_names() -> Callable[[str], str]:
    """Return a function that replaces invisible characters in names, and numbers repeated names."""
    used: set[str] = set()

    def distinct(name: str) -> str:
        shown = visible(name)
        numbered = (f"{shown} ({i})" for i in count(2))
        free = next(each for each in chain([shown], numbered) if each not in used)
        used.add(free)
        return free

    return distinct


# --- Untrusted texts as GitHub's Markdown, which is also safe in similar kinds of Markdown


# A character reference is plain text in every dialect; backslashes escape different characters in
# different dialects. The point of `www.` and the colon of `://` would start a link.
_MARKUP: Final = regex(
    r"[\\`*\[\]<>|~$&]|(?<!\w)_|_(?!\w)|#(?=\w)|(?<=www)\.|:(?=/)", re.IGNORECASE
)
# GitHub looks for mentions and issues in the rendered text. An invisible character hides them.
_MENTION: Final = regex(r"@(?=\w)|&#35;(?=\d)")
_ROWS: Final = 40


def escaped(text: str) -> str:
    """Return Markdown that shows exactly this text, in a line or in the cell of a table."""
    references = _MARKUP.sub(lambda sign: f"&#{ord(sign[0])};", visible(text))
    return _MENTION.sub(lambda sign: f"{sign[0]}&#8203;", references)


def sentence(text: str) -> str:
    """Return the text of a message as Markdown; text between backticks becomes code."""
    # Code contains no markup, and no backtick that could end it early.
    told = (f"`{piece}`" if is_code else escaped(piece) for piece, is_code in code_pieces(text))
    # Separate two adjacent pieces of code, which would be read as one.
    return "".join(told).replace("``", "` `")


def part_details(result: PartResult) -> str:
    """Return a part as Markdown: a table with a sign for each cell, and a list of messages."""
    report, translation = result.report, result.language.translation
    if report is None:
        return f"- {escaped(shortened(result.file.problem, LONGEST))}\n"
    blocks = [_table(result, report.rows)] if report.rows else []
    items = list(first_lines(map(_item, result.messages()), MESSAGES_TOLD, translation))
    if items := [*items, *map(escaped, result.marks())]:
        blocks.append("".join(f"- {item}\n" for item in items))
    return "\n".join(blocks)


def _table(result: PartResult, rows: Sequence[RowReport]) -> str:
    widest = max((row.cells for row in rows), key=len)
    translation = result.language.translation
    row_head, points_head = told(ROW, translation), told(POINTS, translation)
    head = [row_head, *(cell.label for cell in widest), points_head]
    lines = [_line(head), "|---|" + ":-:|" * len(widest) + "--:|\n"]
    for row in rows[:_ROWS]:
        signs = [SIGNS[cell.verdict] for cell in row.cells]
        blanks = [""] * (len(widest) - len(signs))
        lines.append(_line([row.label, *signs, *blanks, result.row_points(row)]))
    if len(rows) > _ROWS:
        lines.append(_line(["…", *[""] * (len(widest) + 1)]))
    return "".join(lines)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(map(escaped, cells))} |\n"


def _item(message: Message) -> str:
    pieces = _pieces(message)
    return " ".join(filter(None, pieces))


def _pieces(message: Message) -> Iterator[str]:
    yield message.label
    yield f"**{escaped(message.places)}:**" if message.places else ""
    yield sentence(shortened(message.text, LONGEST))
    yield escaped(shortened(message.offers, LONGEST))
    yield escaped(shortened(message.example, LONGEST))


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

# A text and its style.
StyledText = tuple[str, str]


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
