"""The shape of a submission, as the body of a request or the content of a file."""

from typing import Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, SkipValidation, StrictBool

from service.catalogue import FeedbackLevel, least
from service.catalogue.parts import posted_forms
from service.grading import Submission

# The other limits of a body leave each of so many submissions 4 KiB and 78 lists and objects: all
# answers to an exercise with seven joints take 2 KiB and 52.
MAX_SUBMISSIONS: Final = 64


class GradeRequest(BaseModel):
    """Answers to the parts of one exercise. The grading reads the answers."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    answers: dict[str, Any] = Field(
        description="One answer for each part, by the part's id; a part left out is missing. Its "
        f"form depends on the kind of the part ({posted_forms()}). An entry is a number or a "
        "formula as text; what is written as a table or matrix elsewhere may be pasted as one text."
    )
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="What a bare number means where an angle is asked for."
    )
    feedback: Literal["full", "hints", "verdicts", "score"] | None = Field(
        None,
        description="The most that the report may tell: `full` hints and corrections, `hints` what "
        "to look at, `verdicts` right and wrong and what could not be read, `score` bare marks and "
        "what could not be read. The exercise and the service have ceilings of their own, and the "
        "report says which level it has. Without it, as much as they allow.",
    )
    echo: StrictBool = Field(
        False, description="Whether the report tells how each cell was read, in its `read`."
    )

    def submission(self, ceiling: FeedbackLevel) -> Submission:
        """The same as the grading takes it, with a report that tells no more than ``ceiling``."""
        asked = ceiling if self.feedback is None else FeedbackLevel(self.feedback)
        return Submission(self.answers, self.angle_unit, least(asked, ceiling), self.echo)


class ExerciseSubmission(GradeRequest):
    """Answers to the parts of the exercise that it names."""

    exercise: str = Field(description="The id of the exercise.")


class GradeManyRequest(BaseModel):
    """Submissions of any learners to any exercises.

    Each is checked by itself when its turn comes, so that one with a fault costs no other.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    submissions: list[SkipValidation[ExerciseSubmission]] = Field(
        max_length=MAX_SUBMISSIONS, description="The results have the same order."
    )
