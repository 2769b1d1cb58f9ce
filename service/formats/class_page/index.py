"""The index of a class: scores, success, slips, identical mistakes, and all submissions.

It is for tutors. It has no script: what is long is folded by the browser itself.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element

from service.formats.class_page.overview import Overview, SubmissionLine
from service.formats.class_page.scores import scores
from service.formats.class_page.slips import identical_mistakes, misconceptions, unreadable_texts
from service.formats.class_page.success import success
from service.formats.class_page.words import link, note, plural, section
from service.formats.shared.html_page import CLOSING, opening, style_sheet, written
from service.formats.shared.markup import element
from service.formats.shared.messages import SIGNS
from service.formats.shared.plain_text import percent
from service.grading import Verdict

INDEX: Final = "index.html"
STYLE: Final = style_sheet(Path(__file__).with_name("index.css"))


def index(overview: Overview) -> Iterator[bytes]:
    """The index piece by piece."""
    yield opening(f"Class overview · {_title(overview)}", STYLE)
    yield b"<main>\n"
    yield written(_head(overview)) + b"\n"
    for each in _sections(overview):
        yield written(each) + b"\n"
    yield written(_footer(overview)) + b"\n</main>\n"
    yield CLOSING


def _sections(overview: Overview) -> Iterator[Element]:
    yield scores(overview)
    yield success(overview)
    yield misconceptions(overview)
    yield unreadable_texts(overview)
    yield identical_mistakes(overview)
    yield _ungraded(overview)
    yield _submissions(overview)


_CONTENTS: Final = (
    ("scores", "Scores"),
    ("success", "Success"),
    ("misconceptions", "Misconceptions"),
    ("unreadable", "Could not be read"),
    ("identical", "Identical mistakes"),
    ("ungraded", "Not graded"),
    ("submissions", "Submissions"),
)


def _title(overview: Overview) -> str:
    if len(overview.exercises) == 1:
        return next(iter(overview.exercises.values())).title
    return plural(len(overview.exercises), "exercise")


def _head(overview: Overview) -> Element:
    sources = dict.fromkeys(each.source for each in overview.exercises.values())
    entries = [element("li", element("a", words, href=f"#{name}")) for name, words in _CONTENTS]
    return element(
        "header",
        element("p", "Class overview", class_="kicker"),
        element("h1", _title(overview)),
        *(note(source) for source in sources),
        element("nav", element("ul", *entries), aria_label="Sections"),
    )


def _ungraded(overview: Overview) -> Element:
    """The submissions that could not be graded or read, with the reason."""
    rows = [
        element(
            "tr",
            element("th", link(overview, line), scope="row"),
            element("td", reason, class_="reason"),
            element("td", f"counts {line.points} points" if line.is_graded else "is left out"),
        )
        for line in overview.ungraded
        for reason in line.problems or ["Nothing in it could be read."]
    ]
    if not rows:
        return section("ungraded", "Not graded", note("Everything was graded."))
    table = _table(dict.fromkeys(("submission", "reason", "in the scores"), ""), rows)
    return section("ungraded", "Not graded or not readable", table)


def _submissions(overview: Overview) -> Element:
    rows = [_line(overview, line) for line in overview.lines]
    heads = {"submission": "", "points": "figure spare", "score": "figure", "result": ""}
    return section("submissions", "Submissions", _table(heads, rows))


def _line(overview: Overview, line: SubmissionLine) -> Element:
    name = element("th", link(overview, line), scope="row")
    if not line.is_graded:
        blanks = [element("td", "–", class_="figure spare"), element("td", "–", class_="figure")]
        return element("tr", name, *blanks, _result(Verdict.UNREADABLE, "not graded"))
    result = (Verdict.CORRECT, "passed") if line.passed else (Verdict.INCORRECT, "not passed")
    points = element("td", line.points, class_="figure spare")
    score = element("td", percent(line.score), class_="figure")
    return element("tr", name, points, score, _result(*result))


def _result(verdict: Verdict, words: str) -> Element:
    sign = element("span", SIGNS[verdict], class_="sign", aria_hidden="true")
    return element("td", element("span", sign, f" {words}", class_=f"badge {verdict.value}"))


def _table(heads: Mapping[str, str], rows: Sequence[Element]) -> Element:
    """A table as wide as the page; ``heads`` are the names and classes of its columns."""
    cells = (element("th", name, scope="col", class_=kind) for name, kind in heads.items())
    head = element("tr", *cells)
    table = element("table", element("thead", head), element("tbody", *rows), class_="wide")
    return element("div", table, class_="card cells", tabindex="0")


def _footer(overview: Overview) -> Element:
    told = "Made on this machine; nothing was sent anywhere. This page names students: keep it to "
    told += "yourself, and hand back the pages in the folder beside it."
    footer = element("footer", element("p", told))
    if overview.graders:
        graders = ", ".join(sorted(overview.graders))
        footer.append(element("p", f"Graded by DH Grader {graders}."))
    return footer
