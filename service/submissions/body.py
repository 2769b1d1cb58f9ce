"""The shape of a submission, as the body of a request or the content of a file."""

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.catalogue.parts import posted_forms
from service.grading import FeedbackLevel, Submission

FeedbackName = Literal["full", "verdicts", "score"]


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
    feedback: FeedbackName = Field(
        "full",
        description="`full` tells the correction, `verdicts` what to look at, "
        "`score` only the marks and what could not be read.",
    )

    def submission(self) -> Submission:
        """The same as the grading takes it."""
        return Submission(self.answers, self.angle_unit, FeedbackLevel(self.feedback))
