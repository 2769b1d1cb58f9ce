"""Grade answers to an exercise, without clock, disk or network."""

from dh_grader.catalogue import FeedbackLevel
from dh_grader.grading.grade import (
    GradedAnswers,
    Submission,
    UnknownPartError,
    grade,
    graded_answers,
    is_all_right,
    report_on_part,
)
from dh_grader.grading.report import (
    CellReport,
    Correction,
    Feedback,
    LittleWorth,
    LostPoints,
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
    "GradedAnswers",
    "LittleWorth",
    "LostPoints",
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
    "graded_answers",
    "is_all_right",
    "report_on_part",
]
