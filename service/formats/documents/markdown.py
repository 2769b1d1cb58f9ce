"""GitHub's Markdown for the summary of a job or a comment on a pull request.

GitHub takes 1 MiB of summary for a step and 65,536 characters of a comment.
"""

import re
from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.markdown_text import escaped, part_details
from service.formats.shared.part_results import part_results
from service.formats.shared.plain_text import percent, points
from service.formats.shared.report_format import ReportFormat, Setting
from service.regex import regex
from service.translations import Language, say, told
from service.translations.sentence import Translation

_HEAD: Final = (say("submission"), say("points"), say("score"), say("passed"))
_ALIGNED: Final = "|---|--:|--:|:-:|\n"


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    details = []
    head = " | ".join(told(each, setting.language.translation) for each in _HEAD)
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


_MARK: Final = regex(rb"(?:\| [^|\n]{1,40} ){4}\|\n" + re.escape(_ALIGNED).encode())

MARKDOWN: Final = ReportFormat(_pieces, _MARK, for_students=True)
