"""Grade the submission of one student on this machine."""

import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby

from dh_grader.catalogue import Exercise, in_language
from dh_grader.formats.graded import (
    AnsweredExercise,
    GradedFile,
    GradedSubmission,
    answered,
    report_in,
)
from dh_grader.grading import FeedbackLevel, PartReport, Report, Submission, Verdict, grade
from dh_grader.grading.report import was_read_in_full
from dh_grader.submissions import AssignedExercise, Assignment, SetExercise
from dh_grader.submissions.answers import ExerciseAnswers, answers_in, of_file
from dh_grader.submissions.bodies import GradeRequest, nearest
from dh_grader.submissions.documents import Excerpt, UnusableFileError
from dh_grader.submissions.files import HandedIn
from dh_grader.translations import ENGLISH, Language, joined, say, told

_LONGEST_NAME = 60


@dataclass(frozen=True, slots=True)
class GradingTerms:
    """The assignment to grade, and the options of the reports.

    ``feedback`` is the level of detail; if None, the submission chooses it. ``echo`` adds to a
    report how each entry was read.
    """

    # With ``for_students``, the exercise limits the level that the submission chooses.

    assignment: Assignment
    pass_mark: float
    feedback: FeedbackLevel | None = None
    for_students: bool = False
    echo: bool = False
    language: Language = ENGLISH

    @property
    def answered(self) -> tuple[AnsweredExercise, ...]:
        """The assigned exercises, with texts in ``language``."""
        return tuple(
            answered(self._told(assigned.exercise), assigned.worth)
            for assigned in self.assignment.exercises
        )

    def _told(self, exercise: SetExercise) -> SetExercise:
        return in_language(exercise, self.language) if isinstance(exercise, Exercise) else exercise

    def submission(self, body: GradeRequest, assigned: AssignedExercise) -> Submission:
        """Return ``body`` as a submission for the grader, with the chosen feedback level."""
        most = self.assignment.ceiling(assigned) if self.for_students else FeedbackLevel.FULL
        submission = body.submission(most)
        feedback = submission.feedback if self.feedback is None else self.feedback
        return replace(submission, feedback=feedback, echo=self.echo or submission.echo)


# A function that returns the report on answers to an exercise and "", or None and a problem.
ReportOn = Callable[[GradeRequest, AssignedExercise, GradingTerms], tuple[Report | None, str]]


def unknown_part(body: GradeRequest, assigned: AssignedExercise) -> str:
    """Return an error message if the answers name an unknown part of the exercise, else ""."""
    known = [part.id for part in assigned.exercise.parts]
    unknown = next((part for part in body.answers if part not in known), None)
    if unknown is None:
        return ""
    meant = nearest(unknown, known)
    name, exercise, listed = unknown[:_LONGEST_NAME], assigned.exercise.id, ", ".join(known)
    if meant is None:
        return say(
            "answers {part!r}, but {exercise} has only {parts}",
            part=name,
            exercise=exercise,
            parts=listed,
        )
    return say(
        "answers {part!r}, but {exercise} has only {parts}. Did you mean {meant}?",
        part=name,
        exercise=exercise,
        parts=listed,
        meant=meant,
    )


def report_of(body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms) -> Report:
    """Return the report on answers, in the language of the terms. Raises UnknownPartError."""
    report = grade(_own_exercise(assigned), terms.submission(body, assigned))
    return report_in(report, terms.language)


def _own_exercise(assigned: AssignedExercise) -> Exercise:
    exercise = assigned.exercise
    if not isinstance(exercise, Exercise):
        raise TypeError(f"{exercise.id} is an exercise of a server, and cannot be graded here")
    return exercise


def report_here(
    body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms
) -> tuple[Report | None, str]:
    """Grade answers on this machine; return a report and "", or None and an error message."""
    _own_exercise(assigned)
    if problem := unknown_part(body, assigned):
        return None, problem
    try:
        return report_of(body, assigned, terms), ""
    except Exception as error:  # noqa: BLE001 - a fault of the program affects only this submission
        place = traceback.extract_tb(error.__traceback__)[-1]
        return None, say(
            "cannot be graded because of a fault in the program; please report it: {error} in "
            "{place}, line {line}",
            error=type(error).__name__,
            place=place.name,
            line=place.lineno or 0,
        )


def graded(
    handed: HandedIn, terms: GradingTerms, report_on: ReportOn = report_here
) -> GradedSubmission:
    """Grade a submission; return a report or an error message for each exercise."""
    answers = answers_in(handed, terms.assignment, partial(_readable_excerpt, terms, report_on))
    files = tuple(
        _graded_file(each, assigned, shown, terms, report_on)
        for each, assigned, shown in zip(
            answers, terms.assignment.exercises, terms.answered, strict=True
        )
    )
    return GradedSubmission(handed.name, handed.learner, files, terms.pass_mark, handed.person)


def _readable_excerpt(
    terms: GradingTerms,
    report_on: ReportOn,
    assigned: AssignedExercise,
    part: str,
    excerpts: Sequence[Excerpt],
) -> str:
    """Return the text of the excerpt that can be graded as this part.

    Raises UnusableFileError if several excerpts of one level can be graded and earn different
    points: no program knows which one the student means.
    """
    whole: tuple[PartReport, str] | None = None
    for _, group in groupby(sorted(excerpts, key=lambda it: it.level), key=lambda it: it.level):
        graded = [
            (report, excerpt.text)
            for excerpt in group
            if (report := _part_report(excerpt.text, part, assigned, terms, report_on))
        ]
        if whole is not None:
            # A legend beside a table belongs to the whole sheet, but not to one of its blocks.
            graded = [each for each in graded if _is_better_piece(*each, *whole)]
        if len({report.points for report, _ in graded}) > 1:
            raise UnusableFileError(
                say(
                    "has several answers to {part}, which differ; leave only one of them",
                    part=part,
                )
            )
        if graded and (whole is not None or was_read_in_full(graded[0][0])):
            return graded[0][1]
        if graded:
            whole = graded[0]
    return excerpts[0].text if whole is None else whole[1]


def _is_better_piece(report: PartReport, text: str, whole: PartReport, whole_text: str) -> bool:
    # True if a piece of a text has nothing unreadable, and earns more than all of the text.
    is_piece = set(text.split()) <= set(whole_text.split())
    return is_piece and was_read_in_full(report) and report.points > whole.points


def _part_report(
    text: str, part: str, assigned: AssignedExercise, terms: GradingTerms, report_on: ReportOn
) -> PartReport | None:
    # The report on a text as the answer to a part, if the text can be read.
    report, _ = report_on(GradeRequest(answers={part: text}), assigned, terms)
    found = next((each for each in report.parts if each.part == part), None) if report else None
    is_read = found is not None and found.verdict not in (Verdict.UNREADABLE, Verdict.MISSING)
    return found if is_read else None


def _graded_file(
    answers: ExerciseAnswers,
    assigned: AssignedExercise,
    shown: AnsweredExercise,
    terms: GradingTerms,
    report_on: ReportOn,
) -> GradedFile:
    report, problem = None, ""
    full_report = None
    if answers.body is not None:
        report, problem = report_on(answers.body, assigned, terms)
        if report and report.feedback is FeedbackLevel.SCORE:
            # Only the rows show how much was read.
            with_rows = replace(terms, feedback=FeedbackLevel.VERDICTS, for_students=False)
            full_report, _ = report_on(answers.body, assigned, with_rows)
        if problem:
            problem = of_file(answers.names[0] if answers.names else assigned.exercise.id, problem)
    problems = joined("; ", list(filter(None, (answers.problem, problem))))
    translation = terms.language.translation
    unread = {name: told(each, translation) for name, each in answers.unread.items()}
    return GradedFile(
        answers.file,
        shown,
        report,
        told(problems, translation),
        answers.names,
        unread,
        answers.parts,
        answers.with_pictures,
        full_report,
    )
