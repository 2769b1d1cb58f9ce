"""The distribution of scores: key figures and a histogram."""

from collections.abc import Sequence
from typing import Final
from xml.etree.ElementTree import Element

from service.formats.class_page.overview import Overview
from service.formats.class_page.words import note, section
from service.formats.shared.markup import Child, element
from service.formats.shared.plain_text import percent, whole_percent
from service.statistics import ScoreBin, ScoreDistribution

_HEIGHT: Final = 100.0


def scores(overview: Overview) -> Element:
    """The section on scores."""
    counted = overview.statistics.scores
    content = [_figures(overview, counted)]
    if counted.count:
        content.append(_histogram(counted.bins, overview.pass_mark))
    else:
        content.append(note("Nothing was graded."))
    return section("scores", "Scores", *content)


def _figures(overview: Overview, counted: ScoreDistribution) -> Element:
    left = len(overview.lines) - counted.count
    graded = "all graded" if not left else f"{left:,} not graded"
    figures = [_figure("Submissions", f"{len(overview.lines):,}", graded)]
    if counted.count:
        passed = f"{counted.passed:,} of {counted.count:,}"
        figures += [
            _figure("Mean score", percent(counted.mean), "of those graded"),
            _figure("Median score", percent(counted.median), "of those graded"),
            _figure("Passed", whole_percent(counted.passed / counted.count), passed),
        ]
    return element("dl", *figures, class_="figures")


def _figure(name: str, value: str, remark: str) -> Element:
    told = [element("dd", value, class_="value"), element("dd", remark, class_="quiet")]
    return element("div", element("dt", name), *told, class_="card")


def _histogram(bins: Sequence[ScoreBin], pass_mark: float) -> Element:
    highest = max(each.count for each in bins)
    spoken = "; ".join(f"{_span(each)}: {each.count}" for each in bins)
    columns = [_column(each, highest) for each in bins]
    plot = element("div", *columns, _mark(pass_mark), class_="plot", aria_hidden="true")
    chart = element("div", plot, role="img", aria_label=f"Number of submissions by score. {spoken}")
    return element("figure", chart, _caption(pass_mark), class_="card histogram")


def _column(each: ScoreBin, highest: int) -> Element:
    """A column: those who passed stand on those who did not."""
    tall, below = (_HEIGHT * n / highest for n in (each.count, each.count - each.passed))
    edges = [element("span", f"{each.low * 100:.0f}", class_="edge")]
    if each.high == 1:
        edges.append(element("span", "100", class_="edge last"))
    pieces = [_piece(_HEIGHT - below, below, "below"), _piece(_HEIGHT - tall, tall - below, "over")]
    shape = {"viewBox": f"0 0 1 {_HEIGHT:g}", "preserveAspectRatio": "none"}
    return element(
        "div",
        element("span", str(each.count) if each.count else "", class_="count"),
        element("svg", *(piece for piece in pieces if piece.get("height") != "0.00"), **shape),
        *edges,
        class_="column",
    )


def _piece(top: float, height: float, side: str) -> Element:
    return element("rect", class_=side, y=f"{top:.2f}", width="1", height=f"{height:.2f}")


def _mark(pass_mark: float) -> Element:
    """A line across the plot at the pass mark."""
    x = f"{pass_mark * 100:.2f}"
    line = element("line", x1=x, x2=x, y1="0", y2="1")
    shape = {"viewBox": "0 0 100 1", "preserveAspectRatio": "none"}
    return element("svg", line, class_="mark", **shape)


def _caption(pass_mark: float) -> Element:
    entries: list[Child] = [
        "Submissions by score in %. ",
        *_entry("over", f"passed ({percent(pass_mark)} and more)"),
        *_entry("below", "not passed"),
    ]
    return element("figcaption", *entries, class_="quiet")


def _entry(side: str, words: str) -> list[Child]:
    swatch = element("span", class_=f"swatch {side}", aria_hidden="true")
    return [element("span", swatch, words, class_="entry-of-legend")]


def _span(each: ScoreBin) -> str:
    until = "to" if each.high == 1 else "to under"
    return f"{each.low * 100:.0f} {until} {each.high * 100:.0f} %"
