"""Answers and an exercise in, a report out. Pure: no clock, no disk, no network."""

from service.grading.feedback import FeedbackLevel
from service.grading.grade import Submission, UnknownPartError, grade
from service.grading.report import (
    CellReport,
    Feedback,
    PartReport,
    Report,
    RowReport,
    Severity,
    Verdict,
)

__all__ = [
    "CellReport",
    "Feedback",
    "FeedbackLevel",
    "PartReport",
    "Report",
    "RowReport",
    "Severity",
    "Submission",
    "UnknownPartError",
    "Verdict",
    "grade",
]
