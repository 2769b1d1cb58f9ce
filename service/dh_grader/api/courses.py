"""The routes of courses: for tutors who run them, and for learners who hand in.

The rules of courses are in ``dh_grader.courses``, those of attempts in ``dh_grader.store``.
"""

import json
from collections.abc import Collection
from datetime import UTC, datetime
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final

from fastapi import APIRouter, Path, Query, Request, Response

from dh_grader.access import Caller
from dh_grader.api.document import posting
from dh_grader.api.grading import SolvedExercises, hint_for
from dh_grader.api.grading_gates import solution_not_shown
from dh_grader.api.http import (
    NO_STORE,
    AttemptId,
    Catalogue,
    ExerciseId,
    Monitor,
    ProblemError,
    arrived_at,
    exercise_or_404,
    in_languages,
    invalid,
    language_of,
    message_of,
    private,
    private_json,
    read_body,
    require_exercise,
    require_parts,
    run_in_turns,
    told_json,
)
from dh_grader.api.permissions import Access, access_problem
from dh_grader.api.recording import (
    IDEMPOTENCY_KEY,
    AssignmentId,
    AttemptTerms,
    CourseId,
    Recorder,
    changing,
    course_problem,
    not_recorded,
    read,
    reading,
    service_address,
    unknown_attempt,
    write,
)
from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import (
    AttemptHintRequest,
    AttemptRequest,
    AttemptResponse,
    Hint,
    HintRequest,
    Learner,
)
from dh_grader.contract.courses import (
    AddedLearners,
    AssignmentChange,
    Course,
    CourseAssignment,
    CourseAssignmentList,
    CourseChange,
    CourseList,
    CourseName,
    DealRequest,
    DeletedData,
    DeletionRequest,
    Extension,
    Gradebook,
    GradebookFormat,
    HandInRequest,
    LearnerList,
    LearnersRequest,
    LearnerVariant,
    LearnerVariants,
    LinkList,
    LinksRequest,
    MissingList,
    NewAssignment,
    NewCourse,
    NewLearner,
    OwnCourses,
    PlatformScores,
    RemovalRequest,
    RevokedLinks,
    RevokeLinksRequest,
    SendAgainRequest,
    SentAgain,
)
from dh_grader.courses import (
    CourseError,
    links_need_a_secret,
    read_class_list,
    unknown_learner,
)
from dh_grader.solutions import ModelSolution
from dh_grader.store import AttemptRefusedError, ruling
from dh_grader.submissions.bodies import GradeRequest
from dh_grader.translations import say

if TYPE_CHECKING:
    from sqlalchemy import Connection, Row

    from dh_grader.courses.assignments import LearnerTerms
    from dh_grader.store import Standing
    from dh_grader.store.attempt_store import AttemptStore


# --- For tutors: courses and their learners


def rolls_routes(store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes with which tutors set up courses."""
    router = APIRouter(prefix="/v1/courses", tags=["courses"])

    @router.get(
        "",
        operation_id="listCourses",
        summary="List the courses",
        response_description="The courses, the newest first.",
        **reading(CourseList),
    )
    async def list_courses(request: Request) -> Response:
        """List all courses, or, with a key of a course, this one; for tutors."""
        from dh_grader.courses import roll

        only = access.caller(request).course
        return private(CourseList(courses=await read(store, lambda it: roll.all_courses(it, only))))

    @router.post(
        "",
        operation_id="createCourse",
        summary="Create a course",
        response_description="The course.",
        **changing(NewCourse, Course, HTTPStatus.CONFLICT, success=HTTPStatus.CREATED),
    )
    async def create_course(request: Request) -> Response:
        """Create a course; for tutors of all courses."""
        from dh_grader.courses import roll

        body = await read_body(NewCourse, request)
        now = datetime.now(UTC)
        return private(
            await write(store, lambda it: roll.add_course(it, body, now)), HTTPStatus.CREATED
        )

    @router.get(
        "/{course_id}",
        operation_id="getCourse",
        summary="Show a course",
        response_description="The course.",
        **reading(Course),
    )
    async def show_course(course_id: CourseId) -> Response:
        """Show a course; for tutors of the course."""
        from dh_grader.courses import roll

        return private(await read(store, lambda it: roll.course(it, course_id)))

    @router.post(
        "/{course_id}",
        operation_id="changeCourse",
        summary="Change a course",
        response_description="The course.",
        **changing(CourseChange, Course),
    )
    async def change_course(request: Request, course_id: CourseId) -> Response:
        """Change the title or the time zone of a course; for tutors of the course."""
        from dh_grader.courses import roll

        body = await read_body(CourseChange, request)
        return private(await write(store, lambda it: roll.change_course(it, course_id, body)))

    @router.get(
        "/{course_id}/learners",
        operation_id="listLearners",
        summary="List the learners of a course",
        response_description="The learners, by name.",
        **reading(LearnerList),
    )
    async def list_learners(course_id: CourseId) -> Response:
        """List the learners of a course; for tutors of the course."""
        return private(await read(store, partial(_learners, course_id)))

    @router.post(
        "/{course_id}/learners",
        operation_id="addLearners",
        summary="Add learners to a course",
        response_description="All learners of the course, by name.",
        **changing(LearnersRequest, AddedLearners),
    )
    async def add_learners(request: Request, course_id: CourseId) -> Response:
        """Add learners, or a class list in CSV; for tutors of the course.

        A learner who is there already gets the new name and e-mail address. Nobody is removed.
        """
        from dh_grader.courses import roll

        new = _new_learners(await read_body(LearnersRequest, request))

        def work(connection: "Connection") -> AddedLearners:
            added = roll.add_learners(connection, course_id, new)
            learners = _learners(course_id, connection).learners
            return AddedLearners(learners=learners, listed=len(new), added=added)

        return private(await write(store, work))

    return router


def _learners(course_id: str, connection: "Connection") -> LearnerList:
    from dh_grader.courses import roll

    return LearnerList(learners=roll.learners(connection, course_id, datetime.now(UTC)))


def _new_learners(body: LearnersRequest) -> list[NewLearner]:
    if (body.learners is None) == (body.csv is None):
        message = say("Send either learners or csv.")
        raise invalid([{"type": "either", "loc": (), "msg": message}])
    if body.csv is None:
        return body.learners or []
    try:
        return read_class_list(body.csv)
    except CourseError as error:
        raise course_problem(error) from error


# --- For tutors: assignments, and extensions (changed dates for single learners)


def assignments_routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes with which tutors create and change assignments."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.get(
        "/assignments",
        operation_id="listAssignments",
        summary="List the assignments of a course",
        response_description="The assignments, in the order in which they were added.",
        **reading(CourseAssignmentList),
    )
    async def list_assignments(course_id: CourseId) -> Response:
        """List the assignments of a course; for tutors of the course."""
        from dh_grader.courses.assignments import assignments_of

        found = await read(store, lambda it: assignments_of(it, course_id))
        return private(CourseAssignmentList(assignments=found))

    @router.post(
        "/assignments",
        operation_id="createAssignment",
        summary="Add an assignment to a course",
        response_description="The assignment.",
        **changing(
            NewAssignment, CourseAssignment, HTTPStatus.CONFLICT, success=HTTPStatus.CREATED
        ),
    )
    async def create_assignment(request: Request, course_id: CourseId) -> Response:
        """Add an assignment; for tutors of the course."""
        from dh_grader.courses.assignments import add_assignment, pin_choices

        body = await read_body(NewAssignment, request)

        def add(connection: "Connection") -> CourseAssignment:
            added = add_assignment(connection, course_id, body, catalogue.keys())
            pin_choices(connection, course_id, body.id, catalogue)
            return added

        return private(await write(store, add), HTTPStatus.CREATED)

    @router.get(
        "/assignments/{assignment_id}",
        operation_id="getAssignment",
        summary="Show an assignment",
        response_description="The assignment.",
        **reading(CourseAssignment),
    )
    async def show_assignment(course_id: CourseId, assignment_id: AssignmentId) -> Response:
        """Show an assignment with its extensions; for tutors of the course."""
        from dh_grader.courses.assignments import assignment_of

        return private(await read(store, lambda it: assignment_of(it, course_id, assignment_id)))

    @router.post(
        "/assignments/{assignment_id}",
        operation_id="changeAssignment",
        summary="Change an assignment",
        response_description="The assignment.",
        **changing(AssignmentChange, CourseAssignment),
    )
    async def change_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Change the given fields of an assignment; for tutors of the course.

        With a later due date, attempts that are not late any more get all their points. An
        earlier due date makes no recorded attempt late.
        """
        from dh_grader.courses import assignments

        body = await read_body(AssignmentChange, request)

        def change(connection: "Connection") -> CourseAssignment:
            known = catalogue.keys()
            changed = assignments.change_assignment(
                connection, course_id, assignment_id, body, known
            )
            renew = body.renew_variants
            assignments.pin_choices(connection, course_id, assignment_id, catalogue, renew=renew)
            return changed

        return private(await write(store, change))

    @router.post(
        "/assignments/{assignment_id}/extensions",
        operation_id="extendAssignment",
        summary="Give a learner other dates or another limit",
        response_description="The assignment with its extensions.",
        **changing(Extension, CourseAssignment),
    )
    async def extend_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Give one learner other dates or another limit; for tutors of the course.

        It replaces an earlier extension of the learner. Without dates and limit, it removes it.
        """
        from dh_grader.courses.assignments import extend

        body = await read_body(Extension, request)
        return private(await write(store, lambda it: extend(it, course_id, assignment_id, body)))

    @router.get(
        "/assignments/{assignment_id}/variants",
        operation_id="listVariants",
        summary="Show the variants of a learner",
        response_description="The variants of the learner in the assignment.",
        **reading(LearnerVariants),
    )
    async def list_variants(
        course_id: CourseId,
        assignment_id: AssignmentId,
        learner: Annotated[Learner, Query(description="The learner.")],
    ) -> Response:
        """Show which variant a learner has of each exercise; for tutors of the course."""
        from dh_grader.courses.assignments import learner_variants

        found = await read(
            store, lambda it: learner_variants(it, course_id, assignment_id, learner, catalogue)
        )
        return private(LearnerVariants(learner=learner, variants=found))

    @router.post(
        "/assignments/{assignment_id}/variants",
        operation_id="dealVariant",
        summary="Give a learner another variant",
        response_description="The new variant.",
        **changing(DealRequest, LearnerVariant),
    )
    async def deal_variant(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Give a learner another variant of an exercise; for tutors of the course.

        Earlier attempts keep their points, and count as before.
        """
        from dh_grader.courses.assignments import deal_again

        body = await read_body(DealRequest, request)
        exercise = require_exercise(catalogue, body.exercise)
        dealt = await write(
            store,
            lambda it: deal_again(it, course_id, assignment_id, body.learner, exercise),
        )
        return private(dealt)

    return router


# --- For tutors: the personal links with which learners open their courses


def links_routes(store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes with which tutors create and revoke personal links."""
    router = APIRouter(prefix="/v1/courses", tags=["courses"])

    @router.post(
        "/{course_id}/links",
        operation_id="createLinks",
        summary="Make personal links",
        response_description="The links, by the names of the learners.",
        **changing(LinksRequest, LinkList),
    )
    async def create_links(request: Request, course_id: CourseId) -> Response:
        """Return the personal links of learners; for tutors of the course.

        A learner without a valid link gets a new one, and so does every learner with `renew`. The
        links begin with the setting `DH_GRADER_PUBLIC_URL`, or else with the address of this
        request.
        The part after `#` is a key: the learner's page sends it in the header
        `Authorization: Bearer`, and browsers never send it otherwise.
        """
        from dh_grader.courses.roll import issue_links

        body = await read_body(LinksRequest, request)
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            raise course_problem(links_need_a_secret())
        known, address, now = secret, service_address(request), datetime.now(UTC)
        return private(
            LinkList(
                links=await write(
                    store, lambda it: issue_links(it, course_id, body, known, address, now)
                )
            )
        )

    @router.post(
        "/{course_id}/links/revoke",
        operation_id="revokeLinks",
        summary="End personal links",
        response_description="The number of ended links.",
        **changing(RevokeLinksRequest, RevokedLinks),
    )
    async def end_links(request: Request, course_id: CourseId) -> Response:
        """End the personal links of learners, within seconds; for tutors of the course."""
        from dh_grader.courses.roll import revoke_links

        body = await read_body(RevokeLinksRequest, request)
        now = datetime.now(UTC)
        count = await write(store, lambda it: revoke_links(it, course_id, body.learners, now))
        return private(RevokedLinks(revoked=count))

    return router


# --- For tutors: the gradebook, missing hand-ins, and a course as one learner sees it


_CSV: Final[dict[str, Any]] = {"schema": {"type": "string"}}
_WORKBOOK: Final = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


def gradebook_routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes with which tutors see the work of a class."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.get(
        "/assignments/{assignment_id}/missing",
        operation_id="listMissing",
        summary="List learners who have not handed in",
        response_description="The learners, by name.",
        **reading(MissingList),
    )
    async def list_missing(course_id: CourseId, assignment_id: AssignmentId) -> Response:
        """List who has not handed in which exercises; for tutors of the course."""
        from dh_grader.courses.gradebook import missing

        found = await read(store, lambda it: missing(it, course_id, assignment_id))
        return private(MissingList(missing=found))

    gradebook_options = reading(Gradebook)
    gradebook_options["responses"][200] = {
        "content": {"text/csv": _CSV, _WORKBOOK: {"schema": {"type": "string", "format": "binary"}}}
    }

    @router.get(
        "/gradebook",
        operation_id="getGradebook",
        summary="Show the gradebook of a course",
        response_description="The gradebook, as JSON, CSV or a workbook.",
        **gradebook_options,
    )
    async def show_gradebook(
        course_id: CourseId,
        assignment: Annotated[CourseName | None, Query(description="Only this assignment.")] = None,
        form: Annotated[
            GradebookFormat,
            Query(
                alias="format",
                description="`json`, `csv`, CSV with the headings that `moodle` or `canvas` "
                "imports, or `xlsx`: a workbook with the points and the hand-ins.",
            ),
        ] = "json",
    ) -> Response:
        """Show the points that count, of each learner at each exercise; for tutors."""
        from dh_grader.courses.gradebook import gradebook, gradebook_workbook, written_gradebook

        if form == "xlsx":
            content = await read(store, lambda it: gradebook_workbook(it, course_id, assignment))
            return Response(content, HTTPStatus.OK, _file(course_id, form), _WORKBOOK)
        book = await read(store, lambda it: gradebook(it, course_id, assignment))
        if form == "json":
            # Null means that nothing was handed in.
            return private_json(book.model_dump_json())
        content = b"".join(written_gradebook(book, form))
        return Response(content, HTTPStatus.OK, _file(course_id, "csv"), "text/csv; charset=utf-8")

    @router.get(
        # An id may have a slash.
        "/learners/{learner:path}/view",
        operation_id="getLearnerView",
        summary="Show what a learner sees",
        response_description="The course as the learner sees it.",
        **reading(OwnCourses),
    )
    async def show_learner_view(
        course_id: CourseId, learner: Annotated[Learner, Path(description="The id of a learner.")]
    ) -> Response:
        """Show a course as one of its learners sees it; for tutors of the course."""
        from dh_grader.courses.gradebook import own_view

        now = datetime.now(UTC)
        view = await read(store, lambda it: own_view(it, learner, course_id, catalogue, now))
        if not view.courses:
            raise course_problem(unknown_learner(learner))
        return private(view)

    return router


def _file(course_id: str, ending: str) -> dict[str, str]:
    attachment = f'attachment; filename="gradebook-{course_id}.{ending}"'
    return {**NO_STORE, "Content-Disposition": attachment}


# --- For tutors: list the scores sent to learning platforms, and send them again


def scores_routes(store: "AttemptStore | None") -> APIRouter:
    """Return the routes for scores at learning platforms."""
    router = APIRouter(prefix="/v1/courses/{course_id}/scores", tags=["courses"])

    @router.get(
        "",
        operation_id="listScores",
        summary="List the scores that go to platforms",
        response_description="The scores, by assignment and name.",
        **in_languages(reading(PlatformScores)),
    )
    async def list_scores(
        request: Request,
        course_id: CourseId,
        assignment: Annotated[
            CourseName | None, Query(description="Only those of this assignment.")
        ] = None,
        learner: Annotated[Learner | None, Query(description="Only those of this learner.")] = None,
        failed: Annotated[
            bool, Query(description="Only those that were refused, or tried in vain.")
        ] = False,
    ) -> Response:
        """List what was sent to the platforms from which the course is launched; for tutors."""
        from dh_grader.lti.outbox import scores_of

        wanted = SendAgainRequest(assignment=assignment, learner=learner, failed=failed)
        language = language_of(request)
        found = await read(store, lambda it: scores_of(it, course_id, wanted, language))
        content = PlatformScores(scores=found).model_dump_json(exclude_none=True)
        return told_json(content, language, headers=NO_STORE)

    @router.post(
        "/send",
        operation_id="sendScores",
        summary="Send scores to platforms again",
        response_description="How many scores are sent again.",
        **changing(SendAgainRequest, SentAgain),
    )
    async def send_scores(request: Request, course_id: CourseId) -> Response:
        """Send scores again, also those that the platforms have already; for tutors."""
        from dh_grader.lti.outbox import send_again

        body, now = await read_body(SendAgainRequest, request), datetime.now(UTC)
        queued = await write(store, lambda it: send_again(it, course_id, body, now))
        return private(SentAgain(queued=queued))

    return router


# --- For tutors: delete courses and assignments, and remove learners


def deletion_routes(store: "AttemptStore | None") -> APIRouter:
    """Return the routes that delete courses, assignments and learners."""
    router = APIRouter(prefix="/v1/courses/{course_id}", tags=["courses"])

    @router.post(
        "/delete",
        operation_id="deleteCourse",
        summary="Delete a course",
        response_description="What is deleted, or would be.",
        **changing(DeletionRequest, DeletedData, HTTPStatus.CONFLICT),
    )
    async def delete_course(request: Request, course_id: CourseId) -> Response:
        """Delete a course, and end its keys and links; for tutors of all courses.

        A course with recorded attempts is deleted only with `with_attempts`.
        """
        from dh_grader.courses import assignments

        body, now = await read_body(DeletionRequest, request), datetime.now(UTC)
        return private(
            await write(store, lambda it: assignments.delete_course(it, course_id, body, now))
        )

    @router.post(
        "/assignments/{assignment_id}/delete",
        operation_id="deleteAssignment",
        summary="Delete an assignment",
        response_description="What is deleted, or would be.",
        **changing(DeletionRequest, DeletedData, HTTPStatus.CONFLICT),
    )
    async def delete_assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Delete an assignment and its extensions; for tutors of the course.

        An assignment with recorded attempts is deleted only with `with_attempts`.
        """
        from dh_grader.courses import assignments

        body = await read_body(DeletionRequest, request)
        return private(
            await write(
                store, lambda it: assignments.delete_assignment(it, course_id, assignment_id, body)
            )
        )

    @router.post(
        "/learners/remove",
        operation_id="removeLearner",
        summary="Remove a learner from a course",
        response_description="What is deleted, or would be.",
        **changing(RemovalRequest, DeletedData),
    )
    async def remove_learner(request: Request, course_id: CourseId) -> Response:
        """Remove a learner, and end the learner's links; for tutors of the course.

        Without `with_attempts` the attempts stay, and count again if the learner comes back.
        """
        from dh_grader.courses import assignments

        body, now = await read_body(RemovalRequest, request), datetime.now(UTC)
        return private(
            await write(store, lambda it: assignments.remove_learner(it, course_id, body, now))
        )

    return router


# --- For learners: show assignments, hand in answers, and show solutions


def handing_in_routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    monitor: Monitor | None = None,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the routes for learners; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["courses"])
    solutions = SolvedExercises()

    @router.get(
        "/me",
        operation_id="getOwnView",
        summary="Show a learner's own courses",
        response_description="The assignments, the attempts that are left, and the points.",
        **in_languages(reading(OwnCourses)),
    )
    async def show_own_view(request: Request) -> Response:
        """Show the assignments and attempts of the learner with this link or token.

        The titles of exercises are in the reader's language.
        """
        from dh_grader.courses.gradebook import own_view

        caller = access.caller(request)
        learner, now = _learner(caller, None), datetime.now(UTC)
        language = language_of(request)
        view = await read(
            store, lambda it: own_view(it, learner, caller.course, catalogue, now, language)
        )
        content = view.model_dump_json(exclude_none=True)
        return told_json(content, language, headers=NO_STORE)

    @router.post(
        "/courses/{course_id}/assignments/{assignment_id}/attempts",
        operation_id="handIn",
        summary="Hand in an exercise of an assignment",
        response_description="The recorded attempt and its report.",
        **in_languages(changing(HandInRequest, AttemptResponse, success=HTTPStatus.CREATED)),
    )
    async def hand_in(
        request: Request,
        course_id: CourseId,
        assignment_id: AssignmentId,
        idempotency_key: Annotated[str, IDEMPOTENCY_KEY],
    ) -> Response:
        """Grade answers and record them in an assignment, once for each idempotency key.

        The assignment says how attempts are limited and how much their reports say. An attempt
        that is answered with 201 is not lost, whatever happens to the service.
        """
        access.require_allowed_origin(request, origins)
        if store is None:
            raise not_recorded()
        body = await read_body(HandInRequest, request)
        caller = access.caller(request)
        learner = _learner(caller, body.learner)
        named = exercise_or_404(catalogue, body.exercise)
        require_parts(named, ((part, ("answers", part)) for part in body.answers))
        now = arrived_at(request)
        place = (course_id, assignment_id, named)
        begun = partial(_begun, place, learner, caller.owner, idempotency_key)
        # Not by the threads that read: there a hand-in would wait for the queries of tutors.
        found = await write(store, begun)
        if isinstance(found, CourseError):
            raise course_problem(found)
        terms, own, seed, before = found
        exercise = _variant(own, seed)
        # Its fields have been validated.
        attempt = AttemptRequest.model_construct(
            (body.model_fields_set - {"exercise"}) | {"learner"},
            **{name: getattr(body, name) for name in GradeRequest.model_fields},
            learner=learner,
        )
        level = partial(terms.feedback_at, exercise)
        return await Recorder(store, feedback, monitor).answer(
            request,
            exercise,
            attempt,
            AttemptTerms(terms.rules, level, terms.number),
            caller.owner,
            idempotency_key,
            (now, before),
        )

    @router.get(
        "/courses/{course_id}/assignments/{assignment_id}/solutions/{exercise_id}",
        operation_id="getAssignedSolution",
        summary="Show a learner the solution of an exercise",
        response_description="The model solution.",
        **reading(ModelSolution),
    )
    async def show_assigned_solution(
        request: Request,
        course_id: CourseId,
        assignment_id: AssignmentId,
        exercise_id: ExerciseId,
    ) -> Response:
        """Show a learner the model solution, once the assignment allows it."""
        from dh_grader.courses.assignments import assigned
        from dh_grader.courses.gradebook import has_full_marks

        learner = _learner(access.caller(request), None)
        named = exercise_or_404(catalogue, exercise_id)
        terms, exercise = await read(
            store, lambda it: assigned(it, course_id, assignment_id, learner, named)
        )
        is_full = await read(
            store, lambda it: has_full_marks(it, learner, terms.number, exercise.id)
        )
        if not terms.shows_solution(datetime.now(UTC), is_full=is_full):
            raise solution_not_shown(say("The assignment does not show you this solution now."))
        return await solutions.answer(exercise)

    return router


def _begun(
    place: tuple[str, str, Exercise],
    learner: str,
    owner: str,
    idempotency_key: str,
    connection: "Connection",
) -> "tuple[LearnerTerms, Exercise, str | None, Standing] | CourseError":
    # A CourseError is returned, not raised, because the transaction contains the work of other
    # requests, too.
    from dh_grader.courses.assignments import assigned_seed, needs_choices, pin_choices
    from dh_grader.store.attempts import standing

    course, assignment, exercise = place
    try:
        terms, own, seed = assigned_seed(connection, course, assignment, learner, exercise)
        if needs_choices(terms, exercise):
            pin_choices(connection, course, assignment, {exercise.id: exercise})
    except CourseError as error:
        return error
    number = terms.number
    counted = standing(connection, exercise.id, learner, owner, idempotency_key, number)
    return terms, own, seed, counted


def _variant(exercise: Exercise, seed: str | None) -> Exercise:
    from dh_grader.courses.assignments import variant_for

    try:
        return variant_for(exercise, seed)
    except CourseError as error:
        raise course_problem(error) from None


def _learner(caller: Caller, named: str | None) -> str:
    if caller.learner is not None:
        if named not in (None, caller.learner):
            raise access_problem("other-learner")
        return caller.learner
    if named is None:
        raise access_problem("learner-needed")
    return named


# --- For learners: hints on recorded attempts
#
# A hint has several steps. The service records each step that a learner takes. A step may have a
# price, which reduces the points of later attempts.


def paid_hints_routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the route for hints; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.post(
        "/attempts/{attempt_id}/hints",
        operation_id="takeHint",
        summary="Take a hint for a message of a recorded report",
        response_description="One step of the hint.",
        **in_languages(
            posting(
                AttemptHintRequest,
                Hint,
                None,
                HTTPStatus.FORBIDDEN,
                HTTPStatus.NOT_FOUND,
                HTTPStatus.SERVICE_UNAVAILABLE,
            )
        ),
    )
    async def take_hint(request: Request, attempt_id: AttemptId) -> Response:
        """Return a step of the hint for a message of this attempt, and record that it was taken.

        Its price reduces the points of the learner's later attempts at the exercise. The same step
        costs nothing again. Before the next step, the learner hands in another answer.
        """
        from dh_grader.store.attempts import HintStepOf, attempt_with_course, hint_refusal, take
        from dh_grader.store.regrades import attempted_exercise

        access.require_allowed_origin(request, origins)
        if store is None:
            raise not_recorded()
        body = await read_body(AttemptHintRequest, request)
        row = await read(store, lambda it: attempt_with_course(it, attempt_id))
        if row is None or not _may_use(access.caller(request), row):
            raise unknown_attempt()
        named = exercise_or_404(catalogue, row.exercise)
        rules, prices, counted = await read(store, partial(_terms, row, named))
        now = arrived_at(request)
        try:
            ruling(rules, counted, now)
        except AttemptRefusedError as error:
            raise _refused(error.name, message_of(error)) from error
        exercise = attempted_exercise(named, row)
        if prices is None or exercise is None:
            raise _refused("no-hints", say("Recorded attempts at this exercise have no hints."))
        wanted = HintStepOf(body.part, body.code, body.row or "", body.cell or "", body.step)
        refused = await read(store, lambda it: hint_refusal(it, row, wanted))
        if refused is not None:
            raise _refused(refused.name, message_of(refused))
        hint = await run_in_turns(request, partial(_hint, exercise, row, body, feedback))
        refused = await write(store, lambda it: take(it, attempt_id, wanted, prices, now))
        if refused is not None:
            raise _refused(refused.name, message_of(refused))
        language = language_of(request)
        content = hint.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language, headers=NO_STORE)

    return router


def _may_use(caller: Caller, row: "Row[Any]") -> bool:
    return (
        caller.reaches(row.exercise)
        and caller.course in (None, row.course)
        and caller.learner in (None, row.learner)
    )


def _terms(
    row: "Row[Any]", exercise: Exercise, connection: "Connection"
) -> tuple[AttemptsSpec, list[float] | None, int]:
    from dh_grader.courses.assignments import terms_of
    from dh_grader.store.attempts import standing

    counted = standing(connection, row.exercise, row.learner, "", None, row.assignment).counted
    if row.assignment is None:
        return exercise.attempts, exercise.attempts.hint_prices, counted
    terms = terms_of(connection, row.course, row.in_assignment, row.learner)
    return terms.rules, terms.hint_prices(exercise), counted


def _hint(
    exercise: Exercise, row: "Row[Any]", body: AttemptHintRequest, most: FeedbackLevel
) -> Hint:
    submission = GradeRequest.model_validate_json(row.submission)
    asked = HintRequest.model_construct(
        **{name: getattr(submission, name) for name in GradeRequest.model_fields},
        **body.model_dump(),
    )
    # The report may have said less than the exercise allows.
    told = FeedbackLevel(json.loads(row.report)["feedback"])
    return hint_for(exercise, asked, least(most, told))


def _refused(name: str, detail: str) -> ProblemError:
    return ProblemError(HTTPStatus.FORBIDDEN, detail, name, say("The hint is not given"))
