"""The errors of courses."""

from typing import Literal

from service.translations import say

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
    """A request about a course is refused; ``name`` is a code for programs."""

    def __init__(self, name: CourseFault, message: str) -> None:
        self.name = name
        super().__init__(message)


def unknown_course(course: str) -> CourseError:
    """Return the error for an unknown course id."""
    return CourseError("unknown-course", say("There is no course {course}.", course=course))


def unknown_learner(learner: str) -> CourseError:
    """Return the error for a learner who is not in the course."""
    message = say("The course has no learner {learner}.", learner=learner)
    return CourseError("unknown-learner", message)


def unknown_assignment(assignment: str) -> CourseError:
    """Return the error for an assignment that the course does not have."""
    message = say("The course has no assignment {assignment}.", assignment=assignment)
    return CourseError("unknown-assignment", message)


def links_need_a_secret() -> CourseError:
    """Return the error for a service without a secret to sign links."""
    message = say("Personal links need a secret: set DH_GRADER_SECRET.")
    return CourseError("unusable", message)
