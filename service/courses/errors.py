"""The errors of courses."""

from typing import Literal

CourseFault = Literal[
    "unknown-course",
    "unknown-assignment",
    "unknown-learner",
    "not-assigned",
    "already-there",
    "has-attempts",
    "unusable",
]


class CourseError(Exception):
    """What is asked for a course cannot be done. The message says why; ``name`` is for programs."""

    def __init__(self, name: CourseFault, message: str) -> None:
        self.name = name
        super().__init__(message)
