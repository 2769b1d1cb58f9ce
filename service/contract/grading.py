"""The results of grading many submissions at once."""

from pydantic import BaseModel, Field

from service.contract.problems import ProblemDocument
from service.grading import Report


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
