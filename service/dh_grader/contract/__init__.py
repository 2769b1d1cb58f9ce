"""The bodies that go over HTTP, besides submissions and reports: what requests and answers have.

This package has pydantic models only. Those of courses, and those of previews and drawings, have
files of their own. What happens to all of them is in ``dh_grader.api``.
"""

from collections.abc import Mapping
from datetime import datetime
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StringConstraints

from dh_grader.catalogue import ExerciseLevel, FeedbackLevel
from dh_grader.catalogue.kinds import AnyShape
from dh_grader.catalogue.schema_fields import Marking
from dh_grader.contract.frames import ToldText
from dh_grader.expressions import Kind
from dh_grader.grading import Report
from dh_grader.hints import STEPS
from dh_grader.kinematics import Convention
from dh_grader.submissions.bodies import GradeRequest

# --- Exercises and generated robots, without their answers


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str = Field(description="The answer kind.")
    points: float


class CatalogueEntry(BaseModel):
    """What the catalogue says about an exercise."""

    id: str
    title: str
    source: str
    level: ExerciseLevel | None = Field(
        None, description="The level: `start`, `basics`, `arms` or `industrial`."
    )
    order: int | None = Field(None, description="The place within the level.")
    minutes: int | None = Field(None, description="The minutes that a student needs.")
    summary: str = Field("", description="One line about the exercise.")
    conventions: list[Convention] = Field(
        [], description="The DH conventions that the parts ask for."
    )
    keywords: list[str] = Field([], description="More words for a search.")


class ExerciseSummary(CatalogueEntry):
    """An exercise in the list."""

    structure: str | None = Field(
        description="The joints in order: R turns, P slides. Null without a robot."
    )
    parts: list[PartSummary]


class ExerciseList(BaseModel):
    """The catalogue."""

    exercises: list[ExerciseSummary]


class SymbolView(BaseModel):
    """A symbol that answers may contain."""

    name: str
    kind: Kind
    unit: str
    description: str
    joint: int | None = Field(None, description="The joint's number if it is a joint variable.")


class PartView(BaseModel):
    """A part without its answer."""

    id: str
    title: str
    prompt: str = Field(description="Markdown, with LaTeX between dollars.")
    prompt_html: str = Field(description="The prompt as HTML and MathML, like `statement_html`.")
    kind: str = Field(description="The answer kind.")
    points: float
    marking: Marking = Field(description="How points are distributed over the cells.")
    follows: str | None = Field(
        None, description="The earlier part that this part follows from; absent if none."
    )
    shape: AnyShape


class ExerciseView(CatalogueEntry):
    """An exercise without its answers."""

    version: str
    structure: str | None = Field(
        None, description="The joints in order: R turns, P slides. Absent without a robot."
    )
    statement: str = Field(description="Markdown, with LaTeX between dollars.")
    statement_html: str = Field(
        description="The statement as HTML and MathML, without scripts, styles and pictures."
    )
    figure: bool = Field(description="True if the exercise has a robot, which `figure.svg` draws.")
    feedback: FeedbackLevel = Field(
        description="The highest feedback level: `full`, `hints`, `verdicts` or `score`."
    )
    symbols: list[SymbolView]
    parts: list[PartView]


class PracticeRobot(BaseModel):
    """A generated robot. Its exercise is found by its id like any other."""

    id: str = Field(description="The id of the exercise.", examples=["practice-2-standard~k3f9"])
    level: int
    convention: Convention
    difficulty: int = Field(
        description="Counted: joints, changes of direction, offsets, sliding joints, free choices, "
        "twists other than 90°."
    )


# --- Problem details (RFC 9457): the body of every unsuccessful response


MEDIA_TYPE: Final = "application/problem+json"
# The prefix of a problem's name in its ``type``.
TYPE_PREFIX: Final = "urn:dh-grader:problem:"


class ProblemType(NamedTuple):
    """A type of problems: its HTTP status, and its meaning in one clause.

    ``is_general`` marks the type of all problems with this status that have no name of their own.
    """

    status: int
    meaning: str
    is_general: bool = False


# All types of problems by name, the general ones first. ``docs/problems.md`` is made from them.
PROBLEM_TYPES: Final[Mapping[str, ProblemType]] = {
    "bad-request": ProblemType(
        400, "the request ended before its body was complete", is_general=True
    ),
    "not-allowed": ProblemType(
        403, "this caller may not do this; `detail` says why", is_general=True
    ),
    "not-found": ProblemType(404, "nothing is at this address", is_general=True),
    "method-not-allowed": ProblemType(
        405,
        "this address does not take the method; the header `Allow` names the methods",
        is_general=True,
    ),
    "too-late": ProblemType(408, "the request did not arrive in time", is_general=True),
    "address-too-long": ProblemType(414, "the address has too many characters", is_general=True),
    "not-json": ProblemType(415, "the body says that it is not JSON", is_general=True),
    "too-many-waiting": ProblemType(
        429,
        "too many requests from this address are waiting; try again after `Retry-After` seconds",
        is_general=True,
    ),
    "headers-too-large": ProblemType(
        431, "the request has too many or too long headers", is_general=True
    ),
    "failed": ProblemType(500, "the service failed; the log has the reason", is_general=True),
    "unavailable": ProblemType(
        503,
        "the service has too much to do, is ending, or lacks something; try again",
        is_general=True,
    ),
    "refused": ProblemType(400, "any other refusal; `status` and `detail` say more"),
    "malformed-request": ProblemType(400, "the bytes are no HTTP request"),
    "malformed-json": ProblemType(400, "the body is no JSON; `errors` has line and column"),
    "body-too-large": ProblemType(413, "the body is larger than 256 KiB"),
    "invalid-request": ProblemType(
        422, "a field or parameter is missing, unknown or invalid; `errors` has each of them"
    ),
    "store-down": ProblemType(
        503, "the database does not respond; try again after `Retry-After` seconds"
    ),
    "busy": ProblemType(503, "other work waits already; try again after `Retry-After` seconds"),
    "key-needed": ProblemType(401, "send a key"),
    "key-not-valid": ProblemType(
        401, "the key or token has expired, was revoked, is misspelt or unknown"
    ),
    "scope-missing": ProblemType(403, "the scopes of the key do not allow this"),
    "other-exercise": ProblemType(403, "the key or token is for other exercises"),
    "other-course": ProblemType(403, "the key or link is for one course"),
    "learner-needed": ProblemType(403, "this needs the link or the token of a learner"),
    "other-learner": ProblemType(403, "the token is for another learner"),
    "solutions-off": ProblemType(403, "the service does not show you model solutions"),
    "attempts-not-shown": ProblemType(403, "the service does not show you recorded attempts"),
    "attempts-not-changed": ProblemType(
        403, "the service does not let you change recorded attempts"
    ),
    "origin-refused": ProblemType(403, "a page of this origin may not record attempts"),
    "metrics-off": ProblemType(403, "the service does not show you metrics"),
    "tokens-not-made": ProblemType(404, "the service needs no keys, so it makes no tokens"),
    "batch-too-large": ProblemType(
        422, "the batch has more submissions than the limit allows at once"
    ),
    "too-often": ProblemType(429, "too many requests; try again after `Retry-After` seconds"),
    "unknown-exercise": ProblemType(404, "there is no exercise with this id"),
    "unknown-part": ProblemType(422, "the exercise has no part with this id"),
    "no-figure": ProblemType(404, "the exercise has no figure"),
    "no-exercises": ProblemType(503, "no exercise can be used, so the service is not ready"),
    "no-hints": ProblemType(403, "reports on this exercise have no messages, so no hints"),
    "no-hint": ProblemType(404, "the report on these answers has no such message or step"),
    "earlier-step-first": ProblemType(403, "take the earlier steps of the hint first"),
    "try-first": ProblemType(403, "hand in another answer before the next step of the hint"),
    "no-practice": ProblemType(403, "an assignment does not let the learner practise now"),
    "hints-have-a-price": ProblemType(
        403, "hints have a price for this learner; take them for a recorded attempt"
    ),
    "solution-not-shown": ProblemType(403, "the model solution is not shown now"),
    "attempts-not-recorded": ProblemType(404, "the service has no database"),
    "unknown-attempt": ProblemType(404, "there is no attempt with this id"),
    "not-open": ProblemType(403, "the exercise or the assignment is not open yet"),
    "closed": ProblemType(403, "the exercise or the assignment is closed"),
    "no-attempts-left": ProblemType(403, "the learner has used all attempts"),
    "idempotency-key-reused": ProblemType(422, "the key belongs to another attempt"),
    "exercise-fails": ProblemType(409, "the exercise file has a fault, so nothing is regraded"),
    "unknown-course": ProblemType(404, "there is no course with this id"),
    "unknown-assignment": ProblemType(404, "the course has no assignment with this id"),
    "unknown-learner": ProblemType(404, "the course has no such learner"),
    "not-assigned": ProblemType(404, "the exercise is not part of the assignment"),
    "has-attempts": ProblemType(409, "attempts are recorded there"),
    "already-there": ProblemType(409, "there is one with this id already"),
    "unusable": ProblemType(422, "the request cannot be used; `detail` says why"),
    "unusable-files": ProblemType(422, "the files of a class cannot be used"),
    "unusable-exercise": ProblemType(422, "the exercise file cannot be used"),
    "unusable-robot": ProblemType(422, "no exercise can be made from the robot"),
    "checks-too-long": ProblemType(422, "the checks of the exercise took too long"),
    "not-saved": ProblemType(409, "the file was not saved"),
}
_GENERAL: Final = {each.status: name for name, each in PROBLEM_TYPES.items() if each.is_general}


def general_name(status: int) -> str:
    """Return the name of the type of a problem that has no name of its own."""
    return _GENERAL.get(status) or ("refused" if status < 500 else "failed")


class Reason(BaseModel):
    """One of the reasons of a problem."""

    detail: str
    pointer: str | None = Field(
        None, description="The place in the body as a JSON pointer (RFC 6901), or the parameter."
    )
    line: int | None = None
    column: int | None = None


class ProblemDocument(BaseModel):
    """RFC 9457 problem details."""

    type: str = Field(
        description="A stable URN for programs, such as `urn:dh-grader:problem:not-found`; "
        "docs/problems.md lists all of them."
    )
    title: str
    status: int
    detail: str
    instance: str = Field(description="The path of the request.")
    request_id: str | None = Field(
        None, description="The id of the request, also in the header X-Request-ID and in the log."
    )
    errors: list[Reason] | None = None


# --- Grading, hints, and alternatives to a correct table


_Label = Annotated[str, Field(max_length=40)]


class HintRequest(GradeRequest):
    """Answers, a message of their report, and the step of its hint."""

    part: _Label = Field(description="The id of the part that the message is on.")
    code: _Label = Field(description="The code of the message.")
    row: _Label | None = Field(
        None, description="The row of the message or of one of its places; absent if it has none."
    )
    cell: _Label | None = Field(
        None, description="The cell of the message or of one of its places; absent if it has none."
    )
    step: Annotated[int, Field(strict=True, ge=1, le=STEPS)] = Field(
        description="1: what to look at. 2: the rule, with its picture. 3: the rule on this row."
    )


class Hint(BaseModel):
    """One step of a hint."""

    step: int
    steps: int = Field(description="The number of steps of each hint.")
    title: ToldText = Field(description="The name of the rule.")
    text: ToldText
    picture: str | None = Field(
        None,
        description="The path of the picture of the rule, an SVG, from the address of the service. "
        "`text` says the same in words. Absent in other steps, and if the rule has no picture.",
    )
    lesson: str | None = Field(
        None,
        description="The path of the page that explains the rule, from the address of the service. "
        "Absent in other steps, and if no page does.",
    )


_Formula = Annotated[str, Field(max_length=200)]


class TableRow(BaseModel):
    """A row of a table: the formulas of its cells."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    a: _Formula
    alpha: _Formula
    d: _Formula
    theta: _Formula


class ChoicesRequest(BaseModel):
    """A right table of the robot."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    part: _Label = Field(description="The id of the part that the table answers.")
    rows: Annotated[list[TableRow], Field(max_length=12)]
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )


class ValidTable(BaseModel):
    """A correct table that differs from the submitted one in one frame."""

    change: ToldText = Field(description="What is different in it, as a sentence.")
    rows: list[TableRow]


class FrameChoices(BaseModel):
    """At most three alternatives to a correct table; none if the frames are given."""

    choices: list[ValidTable]


class GradeResult(BaseModel):
    """The report on one submission, or a problem."""

    report: Report | None = None
    problem: ProblemDocument | None = Field(
        None,
        description="The problem that the submission would get in a request of its own; `instance` "
        "is its place in this request.",
    )


class GradeManyResponse(BaseModel):
    """The results in the order of the submissions."""

    results: list[GradeResult]


# --- New and recorded attempts


# Characters that are invisible or look alike in a list (Unicode: controls, format characters, all
# spaces except U+0020, default ignorables, private use, specials).
_INVISIBLE: Final = (
    r"\u0000-\u001f\u007f-\u00a0\u00ad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890-\u0891\u08e2"
    r"\u115f-\u1160\u1680\u17b4-\u17b5\u180b-\u180f\u2000-\u200f\u2028-\u202f\u205f-\u206f\u2800"
    r"\u3000\u3164\ue000-\uf8ff\ufe00-\ufe0f\ufeff\uffa0\ufff0-\uffff"
)
# Programs may compile the documented pattern without the flag "u" of JavaScript, which then does
# not understand characters above U+FFFF. So the document has the pattern without them.
_ABOVE: Final = (
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a"
    "\U000e0000-\U0010ffff"
)


def _words(but: str) -> str:
    return f"^[^ {but}]+( [^ {but}]+)*$"


# Words separated by single spaces, so that two different learners never look alike.
Learner = Annotated[
    str,
    StringConstraints(min_length=1, max_length=200, pattern=_words(_INVISIBLE + _ABOVE)),
    Field(
        description="The learner, as the course identifies them; preferably an opaque id instead "
        "of a name. The service only tests it for equality.",
        json_schema_extra={"pattern": _words(_INVISIBLE)},
    ),
]


HintLabel = Annotated[str, StringConstraints(max_length=40, pattern=r"^[^\x00]+$")]


class AttemptRequest(GradeRequest):
    """Answers to an exercise, to be recorded."""

    learner: Learner


class Attempt(BaseModel):
    """A recorded attempt."""

    id: str
    exercise: str
    learner: str
    ordinal: int | None = Field(
        None,
        description="The number of the attempt among the learner's counted attempts, from 1. "
        "Absent if nothing could be read: such an attempt does not count.",
    )
    at: datetime
    is_late: bool
    points: float = Field(
        description="The report's points, reduced by the price of hints and for a late attempt."
    )
    max_points: float
    hint_points: float | None = Field(
        None,
        description="The points that the hints cost that the learner took before this attempt; "
        "absent if they cost nothing.",
    )


class AttemptResponse(BaseModel):
    """The recorded attempt and its report."""

    attempt: Attempt
    report: Report


class AttemptSummary(Attempt):
    """A recorded attempt in a tutor's list."""

    awarded: float | None = Field(
        None, description="The points that a tutor has given instead, if any."
    )
    version: str = Field(description="The version of the exercise that graded the attempt.")
    grader: str = Field(description="The version of the program that graded the attempt.")
    variant: str | None = Field(
        None, description="The seed of the variant, for tutors; absent for an exercise without."
    )


class AttemptList(BaseModel):
    """Recorded attempts, the newest first."""

    attempts: list[AttemptSummary]
    next: str | None = Field(
        None, description="The `cursor` of the next page; absent on the last page."
    )


class AttemptOverride(BaseModel):
    """Points that a tutor has given instead of the report's."""

    points: float | None = Field(
        None, description="The new points; absent if an earlier override was withdrawn."
    )
    reason: str
    author: str
    at: datetime


class EarlierReport(BaseModel):
    """A report that a regrade has replaced."""

    replaced_at: datetime
    version: str
    grader: str
    points: float
    max_points: float
    report: Report


class AttemptHintRequest(BaseModel):
    """A message of the report on a recorded attempt, and the step of its hint."""

    model_config = ConfigDict(extra="forbid")

    part: HintLabel = Field(description="The id of the part that the message is on.")
    code: HintLabel = Field(description="The code of the message.")
    row: HintLabel | None = Field(None, description="The row of the message or of its place.")
    cell: HintLabel | None = Field(None, description="The cell of the message or of its place.")
    step: Annotated[int, Field(strict=True, ge=1, le=3)] = Field(
        description="The next step, or one that the learner has taken: it costs nothing again."
    )


class TakenHint(BaseModel):
    """A step of a hint that a learner took at a recorded attempt."""

    attempt: str = Field(description="The id of the attempt with the message.")
    part: str
    code: str
    row: str | None = Field(None, description="The row of the message, if it has one.")
    cell: str | None = Field(None, description="The cell of the message, if it has one.")
    step: int
    price: float = Field(description="The share of the points of the exercise that it costs.")
    at: datetime


class AttemptDetail(BaseModel):
    """A recorded attempt with its answers and all its reports."""

    attempt: AttemptSummary
    submission: dict[str, Any] = Field(description="The request body without the learner.")
    report: Report
    overrides: list[AttemptOverride] = Field(description="The overrides, oldest first.")
    earlier_reports: list[EarlierReport] = Field(description="The old reports, oldest first.")
    hints: list[TakenHint] = Field(
        [], description="The hints that the learner took before this attempt, oldest first."
    )


# --- Requests of tutors: change recorded attempts, and get tokens for learners


# The longest validity, which limits the damage of a lost token. A course page renews its token.
LONGEST_MINUTES: Final = 8 * 60

_ExerciseId = Annotated[str, StringConstraints(min_length=1, max_length=100)]
_Apply = Annotated[
    StrictBool, Field(description="If true, apply the change; otherwise only preview it.")
]
_Line = StringConstraints(
    strip_whitespace=True, min_length=1, pattern=r"^[^\x00-\x1f\x7f\u2028\u2029]+$"
)


class OverrideRequest(BaseModel):
    """Points that override those of an attempt's report."""

    model_config = ConfigDict(extra="forbid")

    points: Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)] | None = Field(
        None,
        description="The new points, from 0 to `max_points`. Omit them to withdraw an earlier "
        "override.",
    )
    reason: Annotated[str, _Line, Field(max_length=1000)] = Field(
        description="The reason in one line. The learner does not see it."
    )
    author: Annotated[str, _Line, Field(max_length=150)] | None = Field(
        None, description="The author of the override. The id of the key is always recorded."
    )


class ForgetRequest(BaseModel):
    """A request to delete all records of a learner."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    apply: _Apply = False


class ForgottenData(BaseModel):
    """The number of records of a learner; `deleted` is true after they were deleted."""

    learner: str
    deleted: bool
    attempts: int
    earlier_reports: int
    overrides: int = Field(description="Points that tutors gave or withdrew.")
    courses: int = Field(description="The courses in which the learner is.")
    erased: bool | None = Field(
        None,
        description="True if the deleted data is no longer in SQLite's files. If false, another "
        "program is reading the database; the service overwrites the data within a minute after "
        "that program has ended. Absent if nothing was to be deleted, and with PostgreSQL.",
    )


class RegradeRequest(BaseModel):
    """A request for one step of a regrade."""

    model_config = ConfigDict(extra="forbid")

    apply: _Apply = False
    force: StrictBool = Field(
        False, description="Apply the change although the exercise fails its check."
    )
    cursor: Annotated[str, Field(max_length=60)] | None = Field(
        None, description="The `next` of the previous step; omit it in the first step."
    )


class CountedChange(BaseModel):
    """The points of an attempt in its assignment, as the gradebook has them."""

    before: float = Field(description="The old points.")
    after: float = Field(description="The new points.")
    max_points: float = Field(description="The points of the exercise in the assignment.")
    awarded: float | None = Field(
        None, description="The points that a tutor gave instead, if any: they stay and count."
    )


class AttemptChange(BaseModel):
    """An attempt whose points or results change. Its points are those of the exercise file."""

    id: str
    learner: str
    ordinal: int | None = None
    before: float = Field(description="The old points.")
    after: float = Field(description="The new points.")
    max_points: float
    awarded: float | None = Field(
        None, description="The points that a tutor gave instead, if any: they stay and count."
    )
    reasons: list[str] = Field(
        description="The parts whose results change. Empty if only the points for a late attempt "
        "change."
    )
    counted: CountedChange | None = Field(
        None, description="The same points in the assignment, if one sets the exercise."
    )


class RegradeAnswer(BaseModel):
    """The result of one step of a regrade."""

    applied: bool
    regraded: int = Field(description="The number of attempts in this step.")
    left: int = Field(description="The number of attempts left after this step.")
    changes: list[AttemptChange] = Field(description="The attempts of this step that change.")
    failures: list[str] | None = Field(
        None,
        description="Why the exercise fails `dh-grader exercises check`; in the first step, if it "
        "does.",
    )
    next: str | None = Field(
        None, description="The `cursor` of the next step; absent after the last step."
    )


class TokenRequest(BaseModel):
    """A request for a token of a learner."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    exercises: Annotated[list[_ExerciseId], Field(min_length=1, max_length=64)] | None = Field(
        None, description="The exercises of the token. Default: all exercises of the key."
    )
    minutes: int = Field(60, ge=1, le=LONGEST_MINUTES, description="The validity in minutes.")


class TokenResponse(BaseModel):
    """A token, for the header `Authorization: Bearer`."""

    token: str
    learner: str
    expires_at: datetime


# --- Statistics of an exercise


class ShareCorrect(BaseModel):
    """The number of answers and of right answers."""

    answered: int = Field(description="The number of answers, including unreadable ones.")
    correct: int
    share: float | None = Field(None, description="correct / answered; absent without answers.")


class CellFigures(ShareCorrect):
    """The figures of a cell in all attempts."""

    label: str


class RowFigures(ShareCorrect):
    """The figures of a row in all attempts. A row is right if all its cells are."""

    label: str
    cells: list[CellFigures]


class PartFigures(ShareCorrect):
    """The figures of a part in all attempts."""

    part: str
    rows: list[RowFigures]


class MisconceptionFigures(BaseModel):
    """The figures of a message code in a part."""

    part: str
    code: str
    sentence: ToldText | None = Field(
        None,
        description="The message in one of these reports; absent if the report has no messages.",
    )
    attempts: int = Field(description="The number of attempts with this code.")
    by_day: dict[str, int] = Field(description="The number of these attempts by day, in UTC.")
    by_attempt: list[int] = Field(
        [],
        description="The number of learners with this code in their first attempt, in their "
        "second one, and so on. `learners_by_attempt` has the numbers of all learners.",
    )


class HintFigures(BaseModel):
    """How often learners took the hints for the messages of a code, at recorded attempts."""

    part: str
    code: str
    taken: list[int] = Field(description="The number of times for each of the three steps.")


class IdenticalAnswers(BaseModel):
    """Exactly equal wrong answers of several learners. They do not prove that anybody copied."""

    learners: int
    attempts: int
    wrong: list[str] = Field(description="The wrong places: part/row/cell.")
    among: list[str] = Field(description="The first of these learners, in alphabetical order.")


class ExerciseStatistics(BaseModel):
    """The statistics of the attempts at an exercise."""

    exercise: str
    attempts: int
    learners: int
    parts: list[PartFigures]
    misconceptions: list[MisconceptionFigures] = Field(description="The most common ones first.")
    learners_by_attempt: list[int] = Field(
        [],
        description="The number of learners who made a first attempt, a second one, and so on.",
    )
    hints: list[HintFigures] = Field([], description="The hints most often taken first.")
    identical: list[IdenticalAnswers] = Field(description="The largest groups first.")
