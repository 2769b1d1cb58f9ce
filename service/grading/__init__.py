"""Answers and an exercise in, a report out. Pure: no clock, no disk, no network."""

from service.catalogue import FeedbackLevel
from service.grading.grade import Submission, UnknownPartError, grade
from service.grading.report import (
    CellReport,
    Correction,
    Feedback,
    PartReport,
    Place,
    ReadEntry,
    Report,
    RowReport,
    Severity,
    Verdict,
)

__all__ = [
    "CellReport",
    "Correction",
    "Feedback",
    "FeedbackLevel",
    "PartReport",
    "Place",
    "ReadEntry",
    "Report",
    "RowReport",
    "Severity",
    "Submission",
    "UnknownPartError",
    "Verdict",
    "grade",
]
