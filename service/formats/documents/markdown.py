"""GitHub's Markdown for the summary of a job or a comment on a pull request.

GitHub takes 1 MiB of summary for a step and 65,536 characters of a comment.
"""

from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.markdown_text import escaped, part_details
from service.formats.shared.part_results import part_results
from service.formats.shared.plain_text import percent, points
from service.formats.shared.report_format import ReportFormat, Setting

_HEAD: Final = "| submission | points | score | passed |\n|---|--:|--:|:-:|\n"


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    """Yield a table of all submissions, then the parts of each."""
    details = []
    yield _HEAD.encode()
    for submission in submissions:
        yield _line(submission).encode()
        details.append(_details(submission).encode())
    yield from details


def _line(submission: GradedSubmission) -> str:
    name = escaped(submission.name)
    if not submission.is_graded:
        return f"| {name} | | not graded | ✗ |\n"
    earned = points(submission.points, submission.max_points)
    sign = "✓" if submission.passed else "✗"
    return f"| {name} | {earned} | {percent(submission.score)} | {sign} |\n"


def _details(submission: GradedSubmission) -> str:
    sections = [f"\n### {escaped(submission.name)}\n"]
    for result in part_results(submission):
        earned = points(result.points, result.max_points)
        sections.append(
            f"\n**{escaped(result.name)}:** {result.verdict.value}, {earned} points\n\n"
            f"{part_details(result)}"
        )
    return "".join(sections)


FORMAT: Final = ReportFormat(_pieces, for_students=True)
