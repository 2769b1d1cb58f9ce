"""Submissions, over HTTP or as files: read strictly, checked, their exercise found."""

from service.submissions.body import FeedbackName, GradeRequest
from service.submissions.lookup import UnknownExerciseError, find_exercise, nearest
from service.submissions.strict_json import (
    MAX_BODY_SIZE,
    MAX_DEPTH,
    MalformedError,
    nested_deeper,
    read_json,
)

__all__ = [
    "MAX_BODY_SIZE",
    "MAX_DEPTH",
    "FeedbackName",
    "GradeRequest",
    "MalformedError",
    "UnknownExerciseError",
    "find_exercise",
    "nearest",
    "nested_deeper",
    "read_json",
]
