"""The pydantic models of a submission, as the body of a request or the content of a file."""

from typing import Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, SkipValidation, StrictBool

from service.catalogue import FeedbackLevel, least
from service.catalogue.parts import posted_forms
from service.grading import Submission

# With this number, the other limits of a body leave each submission 4 KiB and 78 lists and objects.
# All answers to an exercise with seven joints need 2 KiB and 52.
MAX_SUBMISSIONS: Final = 64


class GradeRequest(BaseModel):
    """Answers to the parts of one exercise. The grader parses them."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    answers: dict[str, Any] = Field(
        description="The answers by part id; other parts are missing. The form of an answer "
        f"depends on the kind of the part ({posted_forms()}). An entry is a number or a formula as "
        "text. A table or matrix may also be pasted as one text."
    )
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )
    feedback: Literal["full", "hints", "verdicts", "score"] | None = Field(
        None,
        description="The highest feedback level: `full` hints and corrections, `hints` hints "
        "without values, `verdicts` right and wrong entries, `score` only marks. All levels name "
        "unreadable entries. The exercise and the service may limit the level; the report names "
        "its level. Default: the highest that they allow.",
    )
    echo: StrictBool = Field(
        False, description="If true, the report shows how each cell was read, in its `read`."
    )

    def submission(self, ceiling: FeedbackLevel) -> Submission:
        """Return the submission for the grader, with at most the feedback level ``ceiling``."""
        asked = ceiling if self.feedback is None else FeedbackLevel(self.feedback)
        return Submission(self.answers, self.angle_unit, least(asked, ceiling), self.echo)


class ExerciseSubmission(GradeRequest):
    """Answers to the parts of one exercise, with the exercise's id."""

    exercise: str = Field(description="The id of the exercise.")


class GradeManyRequest(BaseModel):
    """Submissions of any learners to any exercises.

    Each is validated separately, so that an invalid one does not affect the others.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    submissions: list[SkipValidation[ExerciseSubmission]] = Field(
        max_length=MAX_SUBMISSIONS, description="The submissions; the results have their order."
    )
