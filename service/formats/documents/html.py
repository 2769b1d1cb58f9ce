"""A page for students: a card for each part, which shows how each entry was read."""

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Final

from service.formats.class_page import class_folder
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.html_templates import html_pieces, style_sheet
from service.formats.shared.messages import SIGNS, VERDICT_NAMES
from service.formats.shared.part_results import part_results
from service.formats.shared.plain_text import points, points_in_words
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import RowReport
from service.regex import regex
from service.translations import Language

STYLE: Final = style_sheet(Path(__file__).with_suffix(".css"))


def page_of(submission: GradedSubmission, language: Language) -> bytes:
    """Return the page of one submission."""
    titles = [file.exercise.title for file in submission.files]
    return b"".join(_page(" · ".join(titles), [submission], language))


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    rest = iter(submissions)
    first = tuple(islice(rest, 2))
    names = [first[0].learner] if len(first) == 1 else []
    title = " · ".join([*names, *(each.title for each in setting.exercises)])
    yield from _page(title, chain(first, rest), setting.language)


def _page(
    title: str, submissions: Iterable[GradedSubmission], language: Language
) -> Iterator[bytes]:
    yield from html_pieces(
        "formats/documents/templates/submissions.html",
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


_MARK: Final = regex(
    rb'<!doctype html>.{0,500}?<meta name="generator" content="DH Grader', re.DOTALL
)

HTML: Final = ReportFormat(
    _pieces, _MARK, for_students=True, shows_entries=True, folder=class_folder(_pieces)
)
