"""Grade answers from a program or a notebook, with the exercises of this installation.

``dh_grader.grade`` is the face of this module. It grades like the command ``dh-grader grade`` and
like ``POST /v1/grade``; only the form of the question and of the answer is different.
"""

import html
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path

from dh_grader.catalogue import Exercise, load_exercise, open_catalogue
from dh_grader.formats.documents import page_of, rendered
from dh_grader.formats.graded import GradedFile, GradedSubmission
from dh_grader.formats.local_grading import GradingTerms, report_of, unknown_part
from dh_grader.grading import Report
from dh_grader.settings import load_settings
from dh_grader.submissions.assignment import UnknownPartNameError, of_one
from dh_grader.submissions.bodies import GradeRequest, find_exercise
from dh_grader.translations import LANGUAGES, Language, language_named

# Notebooks show a page in a frame, so that its styles do not change the notebook.
_FRAME = (
    '<iframe title="{title}" srcdoc="{page}" style="width: 100%; height: 32rem; border: 0" '
    "onload=\"this.style.height = this.contentDocument.documentElement.scrollHeight + 'px'\">"
    "</iframe>"
)


@dataclass(frozen=True, slots=True)
class ShownReport(Report):
    """A report that notebooks show as a page."""

    _submission: GradedSubmission = field(repr=False, compare=False)
    _language: Language = field(repr=False, compare=False)

    def to_json(self) -> str:
        """Return the report as JSON, as ``POST /v1/grade`` answers."""
        return rendered(self._report).decode()

    def to_html(self) -> str:
        """Return the report as a page without links to other files, as ``--format html`` writes."""
        return page_of(self._submission, self._language).decode()

    @property
    def _report(self) -> Report:
        [file] = self._submission.files
        assert file.report is not None
        return file.report

    def _repr_html_(self) -> str:
        # Notebooks call this method.
        page, title = map(html.escape, (self.to_html(), self.exercise))
        return _FRAME.format(page=page, title=title)


def report_on(
    exercise: str | Path | Exercise,
    answers: Mapping[str, object],
    angle_unit: str,
    feedback: str,
    language: str,
) -> ShownReport:
    """Return the report that ``dh_grader.grade`` promises."""
    told_in = language_named(language)
    if told_in is None:
        raise ValueError(f"{language!r} is not a language of reports: {', '.join(LANGUAGES)}")
    # The model checks the values, as it does for a request.
    content = {"answers": dict(answers), "angle_unit": angle_unit, "feedback": feedback}
    body = GradeRequest.model_validate({**content, "echo": True})
    assignment = of_one(_exercise_of(exercise))
    terms = GradingTerms(assignment, assignment.pass_mark, language=told_in)
    [assigned], [shown] = assignment.exercises, terms.answered
    if problem := unknown_part(body, assigned):
        raise UnknownPartNameError(problem)
    report = report_of(body, assigned, terms)
    file = GradedFile("", shown, report)
    submission = GradedSubmission("", "", (file,), terms.pass_mark)
    values = {each.name: getattr(report, each.name) for each in fields(Report)}
    return ShownReport(**values, _submission=submission, _language=told_in)


def _exercise_of(named: str | Path | Exercise) -> Exercise:
    if isinstance(named, Exercise):
        return named
    if str(named).endswith(".toml"):
        return load_exercise(Path(named))
    return find_exercise(_installed(), str(named))


@cache
def _installed() -> Mapping[str, Exercise]:
    return open_catalogue(load_settings().exercises_dir, reload=False)
