"""The index of a class, for tutors: scores, success, identical mistakes, and all submissions."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Final

from service.formats.class_page.overview import Overview
from service.formats.shared.html_templates import html_pieces, style_sheet
from service.formats.shared.messages import SIGNS, places_in_words
from service.formats.shared.part_results import LONGEST
from service.formats.shared.plain_text import shortened
from service.grading import Place, Verdict
from service.statistics import CountedSlip, ScoreBin, Share
from service.statistics.success import columns
from service.translations import Language, say, say_count

INDEX: Final = "index.html"
STYLE: Final = style_sheet(Path(__file__).with_name("index.css"))
# The shares at which a cell gets the next colour. The cell also shows the number.
_BANDS: Final = (0.0, 0.25, 0.5, 0.75, 0.9)


def index(overview: Overview, language: Language) -> Iterator[bytes]:
    """Yield the index in a language, piece by piece."""
    return html_pieces(
        "formats/class_page/templates/index.html",
        language=language,
        style=STYLE,
        title=_title(overview),
        overview=overview,
        sources=dict.fromkeys(each.source for each in overview.exercises.values()),
        titles=_part_titles(overview),
        bands=list(pairwise(f"{edge * 100:.0f}" for edge in (*_BANDS, 1.0))),
        band_of=_band_of,
        bars_of=_bars_of,
        columns_of=columns,
        grouped="{:,}".format,
        place_of=_place_of,
        untold=_untold,
        wrong_cells=_wrong_cells,
        sentence_of=_sentence_of,
        signs=SIGNS,
        span_of=_span_of,
        verdicts=Verdict,
    )


def _title(overview: Overview) -> str:
    if len(overview.exercises) == 1:
        return next(iter(overview.exercises.values())).title
    count = len(overview.exercises)
    return say_count("1 exercise", "{number} exercises", count=count, number=f"{count:,}")


def _part_titles(overview: Overview) -> Mapping[tuple[str, str], str]:
    has_several = len(overview.exercises) > 1
    return {
        (each.id, part.id): f"{each.title}: {part.title}" if has_several else part.title
        for each in overview.exercises.values()
        for part in each.parts
    }


def _untold(count: int) -> str:
    return say_count(
        "1 report without misconceptions, because of the feedback level. To see them, grade again "
        "with --feedback full.",
        "{number} reports without misconceptions, because of the feedback level. To see them, "
        "grade again with --feedback full.",
        count=count,
        number=f"{count:,}",
    )


def _wrong_cells(count: int) -> str:
    return say_count("1 wrong cell", "{number} wrong cells", count=count, number=f"{count:,}")


def _place_of(row: str, cell: str) -> str:
    return places_in_words([Place(row, cell)])


def _sentence_of(slip: CountedSlip) -> str:
    return shortened(slip.sentence, LONGEST)


def _band_of(share: Share) -> str:
    if share.value is None:
        return "share-none"
    return f"share{sum(share.value >= low for low in _BANDS) - 1}"


def _span_of(each: ScoreBin) -> str:
    low, high = f"{each.low * 100:.0f}", f"{each.high * 100:.0f}"
    if each.high == 1:
        return say("{low} to {high} %", low=low, high=high)
    return say("{low} to under {high} %", low=low, high=high)


def _bars_of(each: ScoreBin, highest: int) -> Iterator[tuple[str, str, str]]:
    tall, below = (100 * n / highest for n in (each.count, each.count - each.passed))
    for side, top, height in (("below", 100 - below, below), ("over", 100 - tall, tall - below)):
        if each.count and f"{height:.2f}" != "0.00":
            yield side, f"{top:.2f}", f"{height:.2f}"
