"""The calls for courses; see ``calls``."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar
from urllib.parse import quote

from pydantic import BaseModel

from service.client.calls import HttpCall
from service.contract.attempts import AttemptResponse
from service.contract.courses import (
    AssignmentChange,
    Course,
    CourseAssignment,
    CourseAssignmentList,
    CourseList,
    Extension,
    Gradebook,
    HandInRequest,
    LearnerList,
    LearnersRequest,
    LinkList,
    LinksRequest,
    MissingList,
    NewAssignment,
    NewCourse,
    OwnCourses,
    RevokedLinks,
    RevokeLinksRequest,
)

M = TypeVar("M", bound=BaseModel)


def courses() -> HttpCall[CourseList]:
    """Return the courses that the key may see."""
    return HttpCall("v1/courses", CourseList.model_validate_json)


def create_course(new: NewCourse) -> HttpCall[Course]:
    """Create a course."""
    return _sending("v1/courses", new, Course)


def learners(course: str) -> HttpCall[LearnerList]:
    """Return the learners of a course."""
    return HttpCall(_path(course, "learners"), LearnerList.model_validate_json)


def add_learners(course: str, new: LearnersRequest) -> HttpCall[LearnerList]:
    """Add learners, or a class list in CSV; return all learners."""
    return _sending(_path(course, "learners"), new, LearnerList)


def links(course: str, wanted: LinksRequest) -> HttpCall[LinkList]:
    """Return the personal links of learners; make those that are absent or to be renewed."""
    return _sending(_path(course, "links"), wanted, LinkList)


def revoke_links(course: str, wanted: RevokeLinksRequest) -> HttpCall[RevokedLinks]:
    """End personal links."""
    return _sending(_path(course, "links", "revoke"), wanted, RevokedLinks)


def assignments(course: str) -> HttpCall[CourseAssignmentList]:
    """Return the assignments of a course."""
    return HttpCall(_path(course, "assignments"), CourseAssignmentList.model_validate_json)


def create_assignment(course: str, new: NewAssignment) -> HttpCall[CourseAssignment]:
    """Add an assignment to a course."""
    return _sending(_path(course, "assignments"), new, CourseAssignment)


def change_assignment(
    course: str, assignment: str, change: AssignmentChange
) -> HttpCall[CourseAssignment]:
    """Change the fields of an assignment that are set; None removes a date or a limit."""
    return _sending(_path(course, "assignments", assignment), change, CourseAssignment)


def extend(course: str, assignment: str, extension: Extension) -> HttpCall[CourseAssignment]:
    """Give a learner other dates or another limit."""
    path = _path(course, "assignments", assignment, "extensions")
    return _sending(path, extension, CourseAssignment)


def missing(course: str, assignment: str) -> HttpCall[MissingList]:
    """Return the learners who have not handed in."""
    path = _path(course, "assignments", assignment, "missing")
    return HttpCall(path, MissingList.model_validate_json)


def gradebook(course: str) -> HttpCall[Gradebook]:
    """Return the points that count, of each learner at each exercise."""
    return HttpCall(_path(course, "gradebook"), Gradebook.model_validate_json)


def hand_in(
    course: str,
    assignment: str,
    exercise: str,
    answers: Mapping[str, Any],
    *,
    learner: str | None = None,
    idempotency_key: str | None = None,
) -> HttpCall[AttemptResponse]:
    """Hand in answers; return the attempt and its report. Retries are recorded once.

    Calls with the same ``idempotency_key`` are one attempt. By default, each call is a new one.
    """
    given = {"exercise": exercise, "answers": dict(answers), "learner": learner}
    body = HandInRequest.model_validate(
        {name: value for name, value in given.items() if value is not None}
    )
    call = _sending(_path(course, "assignments", assignment, "attempts"), body, AttemptResponse)
    return call if idempotency_key is None else replace(call, idempotency_key=idempotency_key)


def own_courses() -> HttpCall[OwnCourses]:
    """Return the courses of the learner whose link or token is the key."""
    return HttpCall("v1/me", OwnCourses.model_validate_json)


def _path(course: str, *rest: str) -> str:
    names = (quote(each, safe="").replace(".", "%2E") for each in (course, *rest))
    return "/".join(("v1/courses", *names))


def _sending(path: str, body: BaseModel, model: type[M]) -> HttpCall[M]:
    read: Callable[[bytes], M] = model.model_validate_json
    return HttpCall(path, read, body.model_dump_json(exclude_unset=True).encode())
