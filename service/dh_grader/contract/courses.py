"""The bodies of courses: learners, assignments, links, scores, and what a learner sees.

Their rules are in ``dh_grader.courses``, but for what a single body must hold.
"""

import re
from datetime import date, datetime, time
from functools import partial
from typing import Annotated, Final, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictBool, StringConstraints

from dh_grader.catalogue import FeedbackLevel
from dh_grader.catalogue.schema_fields import HintPrices
from dh_grader.contract import Attempt, Learner, TakenHint
from dh_grader.regex import regex
from dh_grader.submissions.bodies import GradeRequest
from dh_grader.translations import say

# --- Courses with learners, assignments, links and the gradebook


MOST_LEARNERS: Final = 5000
MOST_EXERCISES: Final = 100
LONGEST_LINK_DAYS: Final = 730

Practice = Literal["open", "after", "none"]
ShowSolution = Literal["never", "after_full", "after_due"]
AssignmentState = Literal["not_open", "open", "late", "closed"]
GradebookFormat = Literal["json", "csv", "moodle", "canvas", "xlsx"]

CourseName = Annotated[
    str,
    StringConstraints(max_length=64, pattern=r"^[a-z0-9]+(-[a-z0-9]+)*$"),
    Field(description="Small letters, digits and hyphens, such as `robotics-2026`."),
]
_Line = Annotated[str, StringConstraints(min_length=1, max_length=200, strip_whitespace=True)]
_Email = Annotated[str, StringConstraints(max_length=254, pattern=r"^[^@\s,;]+@[^@\s,;]+$")]
_Zone = Annotated[
    str,
    StringConstraints(min_length=1, max_length=64),
    Field(description="The IANA name of the time zone, such as `Europe/Berlin`."),
]
_DAY: Final = regex(r"\d{4}-\d\d-\d\d")
_MOMENT: Final = regex(
    rf"{_DAY.pattern}[T ]\d\d:\d\d(:\d\d(\.\d+)?)?(Z|[+-]\d\d:\d\d)?", re.IGNORECASE
)


def _moment(written: object, of_day: time) -> object:
    # ``of_day`` is the time of a date without a time. Other forms are refused: Python reads
    # 20261201, and pydantic reads a number as seconds since 1970.
    if written is None or isinstance(written, datetime):
        return written
    if isinstance(written, date):
        return datetime.combine(written, of_day)
    try:
        if isinstance(written, str):
            text = written.strip()
            if _DAY.fullmatch(text):
                return datetime.combine(date.fromisoformat(text), of_day)
            if _MOMENT.fullmatch(text):
                return datetime.fromisoformat(text.upper())
    except ValueError:
        pass  # Such as February 30.
    raise ValueError(
        say("This must be a date, such as 2026-12-01, or a date with a time: 2026-12-01 23:59.")
    )


_IN_ZONE: Final = "With its time zone, or, without one, in the time zone of the course."
CourseStart = Annotated[
    datetime,
    BeforeValidator(partial(_moment, of_day=time.min)),
    Field(description=f"{_IN_ZONE} A date without a time is the start of the day.", strict=False),
]
CourseEnd = Annotated[
    datetime,
    BeforeValidator(partial(_moment, of_day=time(23, 59, 59))),
    Field(description=f"{_IN_ZONE} A date without a time is 23:59:59.", strict=False),
]


class _Request(BaseModel):
    model_config = ConfigDict(extra="forbid")


class NewCourse(_Request):
    """A new course."""

    id: CourseName
    title: _Line
    zone: _Zone


class CourseChange(_Request):
    """The fields of a course that change."""

    title: _Line | None = Field(None, description="The new title.")
    zone: _Zone | None = Field(None, description="The new time zone. Dates stay the same moments.")


class Course(BaseModel):
    """A course."""

    id: str
    title: str
    zone: str
    learners: int = Field(description="The number of learners.")
    assignments: list[str] = Field(description="The ids of the assignments, in order.")


class CourseList(BaseModel):
    """The courses that the caller may see."""

    courses: list[Course]


class NewLearner(_Request):
    """A learner to add to a course, or to change."""

    learner: Learner | None = Field(
        None,
        description="The learner's id in attempts. By default that of the learner with this "
        "e-mail address, or else a new random one.",
    )
    name: _Line
    family_name: _Line | None = Field(
        None, description="The family name, by which lists are sorted. Default: the name."
    )
    email: _Email | None = Field(None, description="The e-mail address.")


class LearnersRequest(_Request):
    """Learners to add: one by one, or a class list."""

    learners: Annotated[list[NewLearner], Field(max_length=MOST_LEARNERS)] | None = Field(
        None, description="The learners."
    )
    csv: str | None = Field(
        None, description="A class list, as Moodle or Canvas export it, or written by hand."
    )


class CourseLearner(BaseModel):
    """A learner of a course."""

    learner: str
    name: str
    email: str | None = Field(None, description="The e-mail address, if it is known.")
    link_until: datetime | None = Field(
        None, description="When the personal link expires; absent if there is no valid link."
    )


class LearnerList(BaseModel):
    """The learners of a course, by name."""

    learners: list[CourseLearner]


class AddedLearners(LearnerList):
    """The learners of a course after some were added, by name."""

    listed: int = Field(description="The number of learners in the request.")
    added: int = Field(description="The number of them that are new in the course.")


class LinksRequest(_Request):
    """A request for personal links."""

    learners: Annotated[list[Learner], Field(min_length=1, max_length=MOST_LEARNERS)] | None = (
        Field(None, description="The learners. By default all learners of the course.")
    )
    renew: bool = Field(
        False, description="If true, make new links, and end the old ones, also lost ones."
    )
    days: int = Field(
        200, ge=1, le=LONGEST_LINK_DAYS, description="How long new links are valid, in days."
    )


class RevokeLinksRequest(_Request):
    """A request to end personal links."""

    learners: Annotated[list[Learner], Field(min_length=1, max_length=MOST_LEARNERS)] | None = (
        Field(None, description="The learners. By default all learners of the course.")
    )


class RevokedLinks(BaseModel):
    """The number of links that were ended."""

    revoked: int


class PersonalLink(BaseModel):
    """The personal link of a learner. Whoever has it acts as this learner."""

    learner: str
    name: str
    email: str | None = Field(None, description="The e-mail address, if it is known.")
    link: str
    expires_at: datetime


class LinkList(BaseModel):
    """Personal links."""

    links: list[PersonalLink]


class AssignedPoints(_Request):
    """An exercise of an assignment, and its points there."""

    exercise: Annotated[str, StringConstraints(min_length=1, max_length=100)]
    points: Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]


_Exercises = Annotated[list[AssignedPoints], Field(min_length=1, max_length=MOST_EXERCISES)]
_Limit = Annotated[int, Field(ge=1, le=10_000)]
_Feedback = Annotated[list[FeedbackLevel], Field(min_length=1, max_length=100)]


class AssignmentChange(_Request):
    """The fields of an assignment that change.

    Null removes a date, the limit, the feedback or the prices of hints.
    """

    title: _Line | None = Field(None, description="The title.")
    exercises: _Exercises | None = Field(None, description="The exercises and their points.")
    opens: CourseStart | None = Field(None, description="From when on attempts are accepted.")
    due: CourseEnd | None = Field(None, description="Until when an attempt earns all its points.")
    closes: CourseEnd | None = Field(
        None, description="Until when late attempts are accepted. Default: none after `due`."
    )
    limit: _Limit | None = Field(
        None, description="The most attempts of each learner at each exercise."
    )
    late_worth: Annotated[float, Field(ge=0, le=1)] | None = Field(
        None, description="The share of its points that a late attempt earns. Default: 0.5."
    )
    feedback: _Feedback | None = Field(
        None,
        description="The most that the reports say, one level for each attempt. Default: that of "
        "each exercise.",
    )
    practice: Practice | None = Field(
        None,
        description="Whether learners may have answers graded that are not recorded: always, "
        "after full marks or the due date, or never. Default: `none` if attempts are limited or "
        "`feedback` has several levels, else `open`.",
    )
    solution: ShowSolution | None = Field(
        None,
        description="When a learner sees the solution: never, after full marks, or when no more "
        "attempts are accepted. Default: `never`.",
    )
    variants: bool | None = Field(
        None,
        description="Whether each learner gets a variant of their own of each exercise that has "
        "variants. Default: false. If it becomes false, all learners get the same exercise.",
    )
    renew_variants: bool = Field(
        False,
        description="True deals the variants by the choices that `[vary]` has now in the exercise "
        "files. Learners may get other numbers; their attempts stay as they are.",
    )
    hint_prices: HintPrices | None = Field(
        None,
        description="The price of the three steps of a hint, as shares of the points of the "
        "exercise. Default: that of each exercise; without any, attempts have no hints.",
    )


class NewAssignment(AssignmentChange):
    """A new assignment."""

    id: CourseName
    title: _Line = Field(description="The title.")
    exercises: _Exercises = Field(description="The exercises and their points.")


class Extension(_Request):
    """Other dates or another limit for one learner; without any of them, the usual ones again."""

    learner: Learner
    due: CourseEnd | None = Field(None, description="The learner's due date.")
    closes: CourseEnd | None = Field(None, description="Until when late attempts are accepted.")
    limit: _Limit | None = Field(None, description="The most attempts at each exercise.")


class CourseAssignment(BaseModel):
    """An assignment. Dates are in the time zone of the course."""

    id: str
    title: str
    exercises: list[AssignedPoints]
    opens: datetime | None = Field(None, description="From when on attempts are accepted.")
    due: datetime | None = Field(None, description="Until when an attempt earns all its points.")
    closes: datetime | None = Field(None, description="Until when late attempts are accepted.")
    limit: int | None = Field(None, description="The most attempts at each exercise.")
    late_worth: float
    feedback: list[FeedbackLevel] | None = Field(
        None, description="The level of each attempt; absent for that of each exercise."
    )
    practice: Practice
    solution: ShowSolution
    variants: bool = Field(description="True if each learner gets a variant of their own.")
    hint_prices: list[float] | None = Field(
        None, description="The price of each step of a hint; absent for that of each exercise."
    )
    extensions: list[Extension] = Field(description="The learners with other dates or limits.")


class CourseAssignmentList(BaseModel):
    """The assignments of a course, in the order in which they were added."""

    assignments: list[CourseAssignment]


class LearnerVariant(BaseModel):
    """A learner's variant of an exercise in an assignment, for tutors."""

    exercise: str
    variant: str = Field(description="The id of the variant: `<exercise>~<seed>`.")
    seed: str
    deals: int = Field(description="The number of this deal; 1 is the learner's first variant.")
    values: dict[str, str] | None = Field(
        None,
        description="The values of `[vary]`, if the exercise file has other choices than when the "
        "assignment got its variants: the learner still has these, and `variant` shows others.",
    )


class LearnerVariants(BaseModel):
    """The variants of a learner in an assignment."""

    learner: str
    variants: list[LearnerVariant]


class DealRequest(_Request):
    """A request for another variant of an exercise for a learner."""

    learner: Learner
    exercise: Annotated[str, StringConstraints(min_length=1, max_length=100)]


class GradebookColumn(BaseModel):
    """An exercise of an assignment, and its points."""

    assignment: str
    exercise: str
    points: float


class GradebookRow(BaseModel):
    """A learner's points, one entry for each column; null if nothing was handed in."""

    learner: str
    name: str
    email: str | None = Field(None, description="The e-mail address, if it is known.")
    points: list[float | None]
    total: float


class Gradebook(BaseModel):
    """The points that count: of each learner and exercise the best attempt, late ones reduced."""

    course: str
    columns: list[GradebookColumn]
    rows: list[GradebookRow]


class MissingLearner(BaseModel):
    """A learner who has not handed in some exercises."""

    learner: str
    name: str
    email: str | None = Field(None, description="The e-mail address, if it is known.")
    exercises: list[str]
    due: datetime | None = Field(None, description="The due date of this learner.")
    closes: datetime | None = Field(
        None, description="Until when late attempts of this learner are accepted."
    )


class MissingList(BaseModel):
    """The learners who have not handed in all exercises of an assignment."""

    missing: list[MissingLearner]


class DeletionRequest(_Request):
    """A request to delete a course or an assignment."""

    apply: Annotated[
        StrictBool, Field(description="If true, delete; otherwise only say what would be deleted.")
    ] = False
    with_attempts: Annotated[
        StrictBool,
        Field(description="If true, delete the attempts, too, with their answers and reports."),
    ] = False


class RemovalRequest(DeletionRequest):
    """A request to remove a learner from a course."""

    learner: Learner


class DeletedData(BaseModel):
    """The numbers of what a deletion deletes; `deleted` is true after it was done."""

    deleted: bool
    assignments: int
    learners: int
    extensions: int
    keys: int = Field(description="The valid keys and personal links that end.")
    attempts: int = Field(
        description="The recorded attempts. They are deleted only with `with_attempts`."
    )


# --- Scores that are sent to learning platforms


ScoreState = Literal["waiting", "sent", "refused"]


class PlatformScore(BaseModel):
    """The score of a learner in an assignment, at one link of a platform."""

    learner: str
    name: str = Field(description="The name of the learner in the course.")
    assignment: str
    link: str = Field(description="The title of the link at the platform.")
    state: ScoreState = Field(description="Whether the platform has the score of now.")
    sent_points: float | None = Field(None, description="The points that the platform has.")
    sent_at: datetime | None = Field(None, description="When it was sent.")
    max_points: float
    tries: int = Field(description="How often it was tried since it was sent last.")
    next_try_at: datetime | None = Field(None, description="When a waiting score is sent.")
    problem: str | None = Field(None, description="Why it was not sent, or was refused.")


class PlatformScores(BaseModel):
    """The scores of a course that go to platforms."""

    scores: list[PlatformScore]


class SendAgainRequest(BaseModel):
    """Which scores to send again."""

    model_config = ConfigDict(extra="forbid")

    assignment: CourseName | None = Field(None, description="Only those of this assignment.")
    learner: Learner | None = Field(None, description="Only those of this learner.")
    failed: bool = Field(False, description="Only those that were refused, or tried in vain.")


class SentAgain(BaseModel):
    """How many scores are sent again."""

    queued: int


# --- For learners: hand-ins, and the learner's own courses and attempts


class HandInRequest(GradeRequest):
    """Answers to an exercise of an assignment, to be recorded."""

    exercise: Annotated[str, StringConstraints(min_length=1, max_length=100)]
    learner: Learner | None = Field(
        None, description="The learner. With a token or link of a learner, it may be left out."
    )


class OwnAttempt(Attempt):
    """One of the learner's attempts in an assignment."""

    counts: bool = Field(description="True if this attempt counts.")


class OwnExercise(BaseModel):
    """The learner's state at one exercise of an assignment."""

    exercise: str
    title: str
    is_missing: bool = Field(
        False, description="True if the service does not have the exercise at the moment."
    )
    points: float = Field(description="The points of the exercise in the assignment.")
    earned: float | None = Field(
        None, description="The points of the attempt that counts, of these points."
    )
    best: float | None = Field(
        None, description="The points of the best attempt before any deduction for lateness."
    )
    attempts_left: int | None = Field(None, description="Absent if attempts are not limited.")
    may_practise: bool = Field(description="True if answers may be graded without being recorded.")
    shows_solution: bool = Field(description="True if the learner may see the solution now.")
    hint_prices: list[float] | None = Field(
        None,
        description="The price of each step of a hint, as a share of the points; absent if "
        "attempts have no hints.",
    )
    hints: list[TakenHint] = Field([], description="The hints that the learner took.")
    attempts: list[OwnAttempt] = Field(description="The learner's attempts, oldest first.")


class OwnAssignment(BaseModel):
    """An assignment as one learner sees it. Dates are in the time zone of the course."""

    id: str
    title: str
    state: AssignmentState
    opens: datetime | None = Field(None, description="From when on attempts are accepted.")
    due: datetime | None = Field(None, description="The learner's due date.")
    closes: datetime | None = Field(None, description="Until when late attempts are accepted.")
    late_worth: float
    limit: int | None = Field(None, description="The learner's most attempts at each exercise.")
    is_extended: bool = Field(description="True if this learner has other dates or limits.")
    exercises: list[OwnExercise]


class OwnCourse(BaseModel):
    """A course as one learner sees it."""

    id: str
    title: str
    zone: str
    name: str = Field(description="The name of the learner.")
    assignments: list[OwnAssignment]


class OwnCourses(BaseModel):
    """The courses of one learner."""

    learner: str
    now: datetime = Field(description="The time of the service.")
    courses: list[OwnCourse]
