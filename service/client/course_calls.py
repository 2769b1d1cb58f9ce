"""The calls of the service for courses."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar
from urllib.parse import quote, urlencode

from pydantic import BaseModel, TypeAdapter

from service.client.calls import HttpCall
from service.contract.attempts import AttemptResponse
from service.contract.courses import (
    AddedLearners,
    AssignmentChange,
    Course,
    CourseAssignment,
    CourseAssignmentList,
    CourseChange,
    CourseList,
    DealRequest,
    DeletedData,
    DeletionRequest,
    Extension,
    Gradebook,
    GradebookFormat,
    LearnerList,
    LearnersRequest,
    LearnerVariant,
    LearnerVariants,
    LinkList,
    LinksRequest,
    MissingList,
    NewAssignment,
    NewCourse,
    RemovalRequest,
    RevokedLinks,
    RevokeLinksRequest,
)
from service.contract.own_courses import HandInRequest, OwnCourses
from service.contract.scores import PlatformScores, SendAgainRequest, SentAgain
from service.contract.tutoring import RegradeAnswer, RegradeRequest
from service.solutions import ModelSolution

M = TypeVar("M", bound=BaseModel)


def courses() -> HttpCall[CourseList]:
    """Return the courses that the key may see."""
    return HttpCall("v1/courses", CourseList.model_validate_json)


def create_course(new: NewCourse) -> HttpCall[Course]:
    """Create a course."""
    return _sending("v1/courses", new, Course)


def course(course_id: str) -> HttpCall[Course]:
    """Return a course."""
    return HttpCall(_path(course_id), Course.model_validate_json)


def change_course(course: str, change: CourseChange) -> HttpCall[Course]:
    """Change the title or the time zone of a course."""
    return _sending(_path(course), change, Course)


def delete_course(course: str, wanted: DeletionRequest) -> HttpCall[DeletedData]:
    """Delete a course; without ``apply``, only return what would be deleted."""
    return _sending(_path(course, "delete"), wanted, DeletedData)


def delete_assignment(
    course: str, assignment: str, wanted: DeletionRequest
) -> HttpCall[DeletedData]:
    """Delete an assignment; without ``apply``, only return what would be deleted."""
    return _sending(_path(course, "assignments", assignment, "delete"), wanted, DeletedData)


def remove_learner(course: str, wanted: RemovalRequest) -> HttpCall[DeletedData]:
    """Remove a learner; without ``apply``, only return what would be deleted."""
    return _sending(_path(course, "learners", "remove"), wanted, DeletedData)


def learners(course: str) -> HttpCall[LearnerList]:
    """Return the learners of a course."""
    return HttpCall(_path(course, "learners"), LearnerList.model_validate_json)


def add_learners(course: str, new: LearnersRequest) -> HttpCall[AddedLearners]:
    """Add learners, or a class list in CSV; return all learners of the course."""
    return _sending(_path(course, "learners"), new, AddedLearners)


def links(course: str, wanted: LinksRequest) -> HttpCall[LinkList]:
    """Return the personal links of learners, and make missing ones."""
    return _sending(_path(course, "links"), wanted, LinkList)


def revoke_links(course: str, wanted: RevokeLinksRequest) -> HttpCall[RevokedLinks]:
    """Revoke personal links."""
    return _sending(_path(course, "links", "revoke"), wanted, RevokedLinks)


def assignments(course: str) -> HttpCall[CourseAssignmentList]:
    """Return the assignments of a course."""
    return HttpCall(_path(course, "assignments"), CourseAssignmentList.model_validate_json)


def assignment(course: str, assignment_id: str) -> HttpCall[CourseAssignment]:
    """Return an assignment with its extensions."""
    path = _path(course, "assignments", assignment_id)
    return HttpCall(path, CourseAssignment.model_validate_json)


def create_assignment(course: str, new: NewAssignment) -> HttpCall[CourseAssignment]:
    """Add an assignment to a course."""
    return _sending(_path(course, "assignments"), new, CourseAssignment)


def change_assignment(
    course: str, assignment: str, change: AssignmentChange
) -> HttpCall[CourseAssignment]:
    """Change the given fields of an assignment; None removes a date or a limit."""
    return _sending(_path(course, "assignments", assignment), change, CourseAssignment)


def extend(course: str, assignment: str, extension: Extension) -> HttpCall[CourseAssignment]:
    """Change the dates or the limit of attempts of an assignment for one learner."""
    path = _path(course, "assignments", assignment, "extensions")
    return _sending(path, extension, CourseAssignment)


def variants(course: str, assignment: str, learner: str) -> HttpCall[LearnerVariants]:
    """Return a learner's variants of the exercises in an assignment."""
    path = _path(course, "assignments", assignment, "variants") + _query(learner=learner)
    return HttpCall(path, LearnerVariants.model_validate_json)


def deal_variant(course: str, assignment: str, wanted: DealRequest) -> HttpCall[LearnerVariant]:
    """Replace a learner's variant of an exercise by a new variant."""
    return _sending(_path(course, "assignments", assignment, "variants"), wanted, LearnerVariant)


def missing(course: str, assignment: str) -> HttpCall[MissingList]:
    """Return the learners who have not handed in all exercises of an assignment."""
    path = _path(course, "assignments", assignment, "missing")
    return HttpCall(path, MissingList.model_validate_json)


def scores(
    course: str,
    assignment: str | None = None,
    learner: str | None = None,
    *,
    failed: bool = False,
) -> HttpCall[PlatformScores]:
    """Return the scores that go to learning platforms."""
    given = {"assignment": assignment, "learner": learner, "failed": "true" if failed else None}
    query = urlencode({name: value for name, value in given.items() if value is not None})
    return HttpCall(f"{_path(course, 'scores')}?{query}", PlatformScores.model_validate_json)


def send_scores(course: str, wanted: SendAgainRequest) -> HttpCall[SentAgain]:
    """Send scores to learning platforms again."""
    return _sending(_path(course, "scores", "send"), wanted, SentAgain)


def gradebook(course: str, assignment: str | None = None) -> HttpCall[Gradebook]:
    """Return the gradebook of a course, or of one ``assignment``."""
    path = _path(course, "gradebook") + _query(assignment=assignment)
    return HttpCall(path, Gradebook.model_validate_json)


def gradebook_file(
    course: str, form: GradebookFormat, assignment: str | None = None
) -> HttpCall[bytes]:
    """Return the gradebook as a file: ``csv``, ``moodle``, ``canvas`` or ``xlsx``."""
    path = _path(course, "gradebook") + _query(assignment=assignment, format=form)
    return HttpCall(path, bytes)


def learner_view(course: str, learner: str) -> HttpCall[OwnCourses]:
    """Return a course as one of its learners sees it."""
    return HttpCall(_path(course, "learners", learner, "view"), OwnCourses.model_validate_json)


def assigned_solution(course: str, assignment: str, exercise: str) -> HttpCall[ModelSolution]:
    """Return the solution of an exercise; the client's key must be a learner's link or token."""
    path = _path(course, "assignments", assignment, "solutions", exercise)
    return HttpCall(path, _solution)


def regrade(
    exercise: str,
    *,
    course: str | None = None,
    apply: bool = False,
    force: bool = False,
    cursor: str | None = None,
) -> HttpCall[RegradeAnswer]:
    """Regrade some attempts at an exercise.

    Repeat the call with ``next`` of the result as ``cursor``, until ``next`` is None.
    """
    body = RegradeRequest(apply=apply, force=force, cursor=cursor)
    path = f"v1/exercises/{quote(exercise, safe='')}/regrade{_query(course=course)}"
    return _sending(path, body, RegradeAnswer)


def hand_in(
    course: str,
    assignment: str,
    exercise: str,
    answers: Mapping[str, Any],
    *,
    learner: str | None = None,
    idempotency_key: str | None = None,
) -> HttpCall[AttemptResponse]:
    """Hand in answers; return the attempt and its report.

    Calls with the same ``idempotency_key`` are one attempt.
    """
    given = {"exercise": exercise, "answers": dict(answers), "learner": learner}
    body = HandInRequest.model_validate(
        {name: value for name, value in given.items() if value is not None}
    )
    call = _sending(_path(course, "assignments", assignment, "attempts"), body, AttemptResponse)
    return call if idempotency_key is None else replace(call, idempotency_key=idempotency_key)


def own_courses() -> HttpCall[OwnCourses]:
    """Return the learner's courses; the client's key must be a learner's link or token."""
    return HttpCall("v1/me", OwnCourses.model_validate_json)


_solution = TypeAdapter(ModelSolution).validate_json


def _path(course: str, *rest: str) -> str:
    names = (quote(each, safe="").replace(".", "%2E") for each in (course, *rest))
    return "/".join(("v1/courses", *names))


def _query(**given: str | None) -> str:
    query = urlencode({name: value for name, value in given.items() if value is not None})
    return f"?{query}" if query else ""


def _sending(path: str, body: BaseModel, model: type[M]) -> HttpCall[M]:
    read: Callable[[bytes], M] = model.model_validate_json
    return HttpCall(path, read, body.model_dump_json(exclude_unset=True).encode())
