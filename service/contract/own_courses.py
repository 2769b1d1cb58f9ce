"""The bodies of routes for learners: hand-ins, and the learner's own courses and attempts."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, Field, StringConstraints

from service.contract.attempts import Attempt, Learner, TakenHint
from service.contract.courses import AssignmentState
from service.submissions.body import GradeRequest


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
