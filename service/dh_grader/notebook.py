"""Grade answers from a program or a notebook, with the exercises of this installation.

``dh_grader.grade`` is the face of this module. It grades like the command ``dh-grader grade`` and
like ``POST /v1/grade``; only the form of the question and of the answer is different.
"""

import html
import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path

from dh_grader.catalogue import Exercise, load_exercise, open_catalogue
from dh_grader.formats.documents import page_of, rendered
from dh_grader.formats.graded import (
    GradedFile,
    GradedSubmission,
    GradingTerms,
    report_of,
    unknown_part,
)
from dh_grader.grading import FeedbackLevel, Report
from dh_grader.settings import load_settings
from dh_grader.submissions import UnknownPartNameError, of_one
from dh_grader.submissions.bodies import GradeRequest, find_exercise, read_json
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
    feedback: str | None,
    language: str,
) -> ShownReport:
    """Return the report that ``dh_grader.grade`` promises."""
    told_in = language_named(language)
    if told_in is None:
        raise ValueError(f"{language!r} is not a language of reports: {', '.join(LANGUAGES)}")
    # Read as the body of a request, with the same limits. A value that JSON lacks is a TypeError.
    asked = {"answers": dict(answers), "angle_unit": angle_unit, "feedback": feedback, "echo": True}
    body = GradeRequest.model_validate(read_json(json.dumps(asked).encode()))
    assignment = of_one(_exercise_of(exercise))
    # A caller who names a level has the exercise at hand, so that only the default is limited.
    level = None if body.feedback is None else FeedbackLevel(body.feedback)
    terms = GradingTerms(assignment, assignment.pass_mark, level, True, language=told_in)
    [assigned], [shown] = assignment.exercises, terms.answered
    if problem := unknown_part(body, assigned):
        raise UnknownPartNameError(problem)
    report = report_of(body, assigned, terms)
    file = GradedFile("", shown, report, names=("dh_grader.grade",))
    submission = GradedSubmission(shown.id, shown.id, (file,), terms.pass_mark)
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
