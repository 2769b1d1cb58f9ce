"""A typed client of the service, with and without ``await``, and its exceptions.

GraderClientError         a call failed
├── RequestRefusedError     the service answered with an error
├── ServerUnreachableError  there was no complete response
└── UnexpectedAnswerError   the response is not from a DH Grader
"""

# This package loads httpx: import it where it is needed.

from service.catalogue import FeedbackLevel
from service.client.clients import AsyncGraderClient, GraderClient
from service.client.errors import (
    GraderClientError,
    RequestRefusedError,
    ServerUnreachableError,
    UnexpectedAnswerError,
)
from service.client.retries import Retries
from service.contract.exercises import ExerciseSummary, ExerciseView
from service.contract.grading import GradeResult
from service.contract.preview import PreviewAnswer
from service.grading import Report
from service.submissions.body import ExerciseSubmission

__all__ = [
    "AsyncGraderClient",
    "ExerciseSubmission",
    "ExerciseSummary",
    "ExerciseView",
    "FeedbackLevel",
    "GradeResult",
    "GraderClient",
    "GraderClientError",
    "PreviewAnswer",
    "Report",
    "RequestRefusedError",
    "Retries",
    "ServerUnreachableError",
    "UnexpectedAnswerError",
]
