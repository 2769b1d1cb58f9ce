"""The results of grading many submissions at once."""

from pydantic import BaseModel, Field

from service.contract.problems import ProblemDocument
from service.grading import Report


class GradeResult(BaseModel):
    """The report on one submission, or the problem because of which there is none."""

    report: Report | None = None
    problem: ProblemDocument | None = Field(
        None,
        description="What the submission alone would have been refused with; `instance` is its "
        "place in the request.",
    )


class GradeManyResponse(BaseModel):
    """One result for each submission, in their order."""

    results: list[GradeResult]
