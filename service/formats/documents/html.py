"""A page to hand back: a card for each part, with the entries in their cells as they were read."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element

from service.formats.class_page import class_folder
from service.formats.shared.graded import GradedFile, GradedSubmission
from service.formats.shared.html_page import CLOSING, opening, style_sheet, written
from service.formats.shared.markup import Child, element
from service.formats.shared.messages import SIGNS, Message
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import code_pieces, percent, points, whole_score
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import CellReport, RowReport, Severity, Verdict

STYLE: Final = style_sheet(Path(__file__).with_suffix(".css"))


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    rest = iter(submissions)
    first = tuple(islice(rest, 2))
    names = [first[0].learner] if len(first) == 1 else []
    yield opening(" · ".join([*names, *(each.title for each in setting.exercises)]), STYLE)
    for submission in chain(first, rest):
        yield written(_article(submission)) + b"\n"
    yield CLOSING


def _article(submission: GradedSubmission) -> Element:
    """One submission; those of several exercises have a heading for each."""
    results = part_results(submission)
    article = element("article", _head(submission))
    for file in submission.files:
        if len(submission.files) > 1:
            article.append(element("h2", file.exercise.title))
        if file.report is None:
            problem = element("p", file.problem, class_="problem")
            article.append(element("section", problem, class_="card"))
        else:
            article.extend(_card(each) for each in results if each.file is file)
    article.append(_footer(submission))
    return article


def _head(submission: GradedSubmission) -> Element:
    titles = element("div")
    if len(submission.files) == 1:
        exercise = submission.files[0].exercise
        titles.append(element("p", exercise.title, class_="kicker"))
        titles.append(element("h1", submission.learner))
        titles.append(element("p", exercise.source, class_="quiet"))
    else:
        titles.append(element("h1", submission.learner))
    return element("header", titles, _total(submission), class_="head")


def _total(submission: GradedSubmission) -> Element:
    if not submission.is_graded:
        badge = element("span", "Not graded", class_="badge unreadable")
        return element("div", badge, class_="total")
    passed = submission.passed
    colour = Verdict.CORRECT if passed else Verdict.INCORRECT
    told = element("span", "Passed" if passed else "Not passed", class_=f"badge {colour.value}")
    earned = f"{points(submission.points, submission.max_points)} points"
    words = element("div", element("strong", earned), told)
    return element("div", _ring(submission.score, passed=passed), words, class_="total")


def _ring(score: float, *, passed: bool) -> Element:
    """The score as an arc, which begins at the top."""
    whole = {"cx": "18", "cy": "18", "r": "15.9155", "stroke_width": "3.2"}  # round: 100
    arc = f"{score * 100:.1f} 100"
    turned = "rotate(-90 18 18)"
    middle = {"x": "18", "y": "21.2", "text_anchor": "middle"}
    drawn = [element("circle", **whole)]
    if score > 0:
        earned = {"class_": "earned", "stroke_dasharray": arc, "transform": turned}
        drawn.append(element("circle", **whole, **earned))
    drawn.append(element("text", whole_score(score), **middle))
    name = {"role": "img", "aria_label": percent(score), "viewBox": "0 0 36 36"}
    return element("svg", *drawn, class_="ring" if passed else "ring below", **name)


def _card(result: PartResult) -> Element:
    verdict = result.verdict.value
    header = element(
        "header",
        element("h3", result.part.title),
        element("span", verdict, class_=f"badge {verdict}"),
        element("span", points(result.points, result.max_points), class_="points"),
    )
    card = element("section", header, class_="card")
    report = result.report
    if report and report.rows:
        card.append(element("div", _table(result, report.rows), class_="cells"))
    items = [_item(message) for message in result.messages()]
    if report and report.follow_through:
        items.insert(0, _note("Counted with your own earlier answer."))
    if items:
        card.append(element("ul", *items, class_="messages"))
    return card


def _table(result: PartResult, rows: Sequence[RowReport]) -> Element:
    labels = [cell.label for cell in max((row.cells for row in rows), key=len)]
    heads = (element("th", label, scope="col") for label in ["row", *labels, "points"])
    head = element("tr", *heads)
    body = element("tbody", *(_row(row, len(labels), result.row_points(row)) for row in rows))
    return element("table", element("thead", head), body)


def _row(row: RowReport, width: int, earned: str) -> Element:
    blanks = [element("td")] * (width - len(row.cells))
    return element(
        "tr",
        element("th", row.label, scope="row"),
        *map(_cell, row.cells),
        *blanks,
        element("td", earned, class_="row-points"),
    )


def _cell(cell: CellReport) -> Element:
    verdict = cell.verdict.value
    sign = element("span", SIGNS[cell.verdict], class_="sign", title=verdict)
    entry = [element("span", cell.read.text, class_="entry")] if cell.read else []
    return element("td", element("div", sign, *entry, class_="cell"), class_=verdict)


def _item(message: Message) -> Element:
    colour = message.verdict.value if message.severity is Severity.ERROR else "note"
    badge = element("span", message.label, class_=f"badge {colour}")
    return element("li", badge, element("p", *_sentence(message)))


def _sentence(message: Message) -> Iterator[Child]:
    if message.places:
        yield element("strong", f"{message.places}:")
        yield " "
    for piece, is_code in code_pieces(message.text):
        yield element("code", piece) if is_code else piece
    if message.offers:
        yield f" {message.offers}"
    if message.example:
        yield " "
        yield element("span", message.example, class_="quiet")


def _note(text: str) -> Element:
    return element("li", element("span", "note", class_="badge note"), element("p", text))


def _footer(submission: GradedSubmission) -> Element:
    legend = [
        element("li", element("span", SIGNS[verdict], class_="sign"), verdict.value)
        for verdict in Verdict
    ]
    graded = [_origin(file) for file in submission.files if file.report]
    return element("footer", element("ul", *legend), *graded)


def _origin(file: GradedFile) -> Element:
    assert file.report is not None
    exercise = f"{file.report.exercise}, version {file.report.version}"
    told = f"{file.file} for {exercise}, graded by DH Grader {file.report.grader}"
    return element("p", told)


FORMAT: Final = ReportFormat(
    _pieces, for_students=True, shows_entries=True, folder=class_folder(_pieces)
)
