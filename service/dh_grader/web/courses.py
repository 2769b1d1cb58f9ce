"""The pages on which tutors manage courses, and their routes; the roster of a platform.

The pages send their forms to the routes of ``api/courses.py``; only links and the roster have
routes here. The rules of courses are in ``dh_grader.courses``.
"""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final, NamedTuple
from urllib.parse import parse_qs

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from dh_grader.api.http import NO_STORE, Catalogue, language_of, message_of, validated
from dh_grader.api.recording import (
    AssignmentId,
    CourseId,
    course_problem,
    read,
    service_address,
    write,
)
from dh_grader.catalogue import in_language
from dh_grader.contract import Learner
from dh_grader.contract.courses import (
    Course,
    CourseAssignment,
    CourseLearner,
    Gradebook,
    LearnerVariant,
    LinksRequest,
    MissingLearner,
    OwnCourse,
    PlatformScore,
    SendAgainRequest,
)
from dh_grader.courses import (
    CourseError,
    links_need_a_secret,
    told_apart,
    unknown_learner,
    with_own_dates,
)
from dh_grader.translations import Language, say, told
from dh_grader.web.pages import FORM_HEADERS, Assets, form_fields, page, page_answer
from dh_grader.web.tutor import Tutoring

if TYPE_CHECKING:
    from sqlalchemy import Connection, Row

    from dh_grader.lti.handed_files import MissingReport
    from dh_grader.lti.roster import RosterChange


# --- The routes of the pages on which tutors manage their courses


class CourseState(NamedTuple):
    """A course with its learners and assignments.

    ``handed_in`` has the number of learners with a readable attempt, by assignment id. ``roster``
    is a database row, or None if the learning platform gives no list of the course's members.
    ``reports`` are the reports on files that did not reach the platform.
    """

    course: Course
    learners: Sequence[CourseLearner]
    assignments: Sequence[CourseAssignment]
    handed_in: dict[str, int]
    roster: "Row[Any] | None"
    reports: "Sequence[MissingReport]" = ()


def course_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages on which tutors manage their courses."""
    router = APIRouter(include_in_schema=False)
    router.include_router(_set_up_routes(catalogue, assets, tutoring))
    router.include_router(_learner_routes(catalogue, assets, tutoring))
    router.include_router(roster_routes(assets, tutoring))
    return router


def _set_up_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.get("")
    async def courses(request: Request) -> Response:
        """Return the page with all courses that the tutor may see, perhaps one."""
        from dh_grader.courses import roll

        only = access.caller(request).course
        found = await read(store, lambda it: roll.all_courses(it, only))
        shown = courses_page(found, assets, language_of(request), creates=only is None)
        return _answer(request, shown)

    @router.get("/{course_id}")
    async def course(request: Request, course_id: CourseId) -> Response:
        """Return the page of a course."""
        language = language_of(request)
        state = await read(store, lambda it: _state(it, course_id, language))
        drawn = course_page(
            state,
            catalogue,
            assets,
            language,
            has_secret=access.keys is not None and access.keys.secret is not None,
            has_keys=bool(access.caller(request).key_id),
            deletes=access.caller(request).course is None,
        )
        return _answer(request, drawn)

    @router.get("/{course_id}/assignments/{assignment_id}")
    async def assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Return the page of an assignment."""
        from dh_grader.courses.assignments import assignment_of
        from dh_grader.courses.gradebook import gradebook, missing
        from dh_grader.lti.outbox import scores_of

        language = language_of(request)

        def drawn(connection: "Connection") -> bytes:
            return assignment_page(
                _state(connection, course_id, language),
                assignment_of(connection, course_id, assignment_id),
                missing(connection, course_id, assignment_id),
                gradebook(connection, course_id, assignment_id),
                scores_of(
                    connection, course_id, SendAgainRequest(assignment=assignment_id), language
                ),
                catalogue,
                assets,
                language,
            )

        return _answer(request, await read(store, drawn))

    return router


def _learner_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.get("/{course_id}/gradebook")
    async def book(request: Request, course_id: CourseId) -> Response:
        """Return the page of the gradebook."""
        from dh_grader.courses import roll

        found = await read(store, lambda it: roll.course(it, course_id))
        return _answer(request, gradebook_page(found, assets, language_of(request)))

    @router.get("/{course_id}/learner")
    async def learner(
        request: Request, course_id: CourseId, learner: Annotated[Learner, Query()]
    ) -> Response:
        """Return the page of a learner."""
        # The id is in the query, because it may have a slash.
        from dh_grader.courses.assignments import learner_variants
        from dh_grader.courses.gradebook import own_view
        from dh_grader.lti.handed_files import missing_reports
        from dh_grader.lti.outbox import scores_of

        now, language = datetime.now(UTC), language_of(request)

        def drawn(connection: "Connection") -> bytes:
            view = own_view(connection, learner, course_id, catalogue, now, language)
            if not view.courses:
                raise unknown_learner(learner)
            [own] = view.courses
            variants = {
                each.id: learner_variants(connection, course_id, each.id, learner, catalogue)
                for each in own.assignments
            }
            wanted = SendAgainRequest(learner=learner)
            scores = scores_of(connection, course_id, wanted, language)
            reports = missing_reports(connection, course_id, language, learner)
            return learner_page(own, learner, variants, scores, reports, now, assets, language)

        return _answer(request, await read(store, drawn))

    @router.post("/{course_id}/links.csv")
    async def links(request: Request, course_id: CourseId) -> Response:
        """Return a CSV file with the links of all learners, or with a new link of one learner."""
        from dh_grader.courses.roll import issue_links, written_links

        fields = parse_qs((await request.body()).decode(errors="replace"))
        one = fields.get("learner")
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            raise course_problem(links_need_a_secret())
        wanted = validated(LinksRequest, {"learners": one, "renew": one is not None})
        known = secret
        base, now = service_address(request), datetime.now(UTC)
        found = await write(store, lambda it: issue_links(it, course_id, wanted, known, base, now))
        attachment = f'attachment; filename="links-{course_id}.csv"'
        headers = {**NO_STORE, "Content-Disposition": attachment}
        content = b"".join(written_links(found))
        return Response(content, HTTPStatus.OK, headers, "text/csv; charset=utf-8")

    return router


def _answer(request: Request, content: bytes) -> Response:
    return page_answer(request, content, FORM_HEADERS)


def _state(connection: "Connection", course_id: str, language: Language) -> CourseState:
    """Return all data that the page of a course shows. Raises CourseError."""
    from dh_grader.courses import roll
    from dh_grader.courses.assignments import assignments_of
    from dh_grader.courses.gradebook import handed_in
    from dh_grader.lti.handed_files import missing_reports
    from dh_grader.lti.roster import roster_context

    roster = roster_context(connection, course_id)
    return CourseState(
        roll.course(connection, course_id),
        roll.learners(connection, course_id, datetime.now(UTC)),
        assignments_of(connection, course_id),
        handed_in(connection, course_id),
        roster,
        missing_reports(connection, course_id, language),
    )


# --- The pages of courses as HTML


# The number of groups in the distribution of points.
_GROUPS: Final = 10


class PointsGroup(NamedTuple):
    """The number of learners whose percentage of the points is from ``start`` to below ``end``."""

    start: int
    end: int
    learners: int


def courses_page(
    courses: Sequence[Course], assets: Assets, language: Language, *, creates: bool
) -> bytes:
    """Return the page with the list of courses; ``creates`` adds a form for a new course."""
    scripts = ["course_forms.js"]
    return _page("courses", assets, language, "../", scripts, courses=courses, creates=creates)


def course_page(
    state: CourseState,
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
    *,
    has_secret: bool,
    has_keys: bool,
    deletes: bool,
) -> bytes:
    """Return the page of a course, with a button to delete the course if ``deletes`` is True."""
    return _page(
        "course",
        assets,
        language,
        "../../",
        ["course_forms.js", "deletion.js", "learner_filter.js"],
        **state._asdict(),
        catalogue=_in_language(catalogue, language),
        has_secret=has_secret,
        has_keys=has_keys,
        deletes=deletes,
        shown=_shown,
    )


def assignment_page(
    state: CourseState,
    chosen: CourseAssignment,
    missing: Sequence[MissingLearner],
    book: Gradebook,
    scores: Sequence[PlatformScore],
    catalogue: Catalogue,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return the page of an assignment: its fields, extensions, missing hand-ins and points."""
    names = told_apart(state.learners)
    place_of = {learner: i for i, learner in enumerate(names)}
    given = sorted(chosen.extensions, key=lambda it: place_of.get(it.learner, len(names)))
    return _page(
        "assignment",
        assets,
        language,
        "../../../../",
        ["course_forms.js", "deletion.js"],
        course=state.course,
        learners=state.learners,
        names=names,
        assignment=chosen,
        extension_of={each.learner: each for each in given},
        extensions=[with_own_dates(chosen, each) for each in given],
        missing=missing,
        groups=distribution(book),
        columns=_columns(book),
        scores=scores,
        catalogue=_in_language(catalogue, language),
        shown=_shown,
    )


def gradebook_page(course: Course, assets: Assets, language: Language) -> bytes:
    """Return the page of a course's gradebook, which a script fills."""
    return _page("gradebook", assets, language, "../../../", ["gradebook.js"], course=course)


def learner_page(
    course: OwnCourse,
    learner: str,
    variants: Mapping[str, Sequence[LearnerVariant]],
    scores: Sequence[PlatformScore],
    reports: "Sequence[MissingReport]",
    now: datetime,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return a tutor's page about one learner of a course.

    The page has the learner's results, variants (by assignment), scores and personal link, and the
    ``reports`` on handed-in files that did not reach the platform.
    """
    return _page(
        "learner",
        assets,
        language,
        "../../../",
        ["course_forms.js", "deletion.js"],
        course=course,
        learner=learner,
        variants=variants,
        scores=scores,
        reports=reports,
        now=now,
        shown=_shown,
    )


def roster_page(
    course: Course,
    change: "RosterChange | None",
    message: str,
    assets: Assets,
    language: Language,
) -> bytes:
    """Return the page that says how the roster (the platform's list of members) has changed.

    The page may also say why the roster could not be read.
    """
    values = {"course": course, "change": change, "message": message}
    return _page("roster", assets, language, "../../../", [], **values)


def distribution(book: Gradebook) -> list[PointsGroup]:
    """Count the learners with attempts in each group of similar points."""
    most = sum(each.points for each in book.columns)
    counts = [0] * _GROUPS
    for row in book.rows:
        if any(points is not None for points in row.points):
            # Rounded, because points are sums of floats.
            group = int(round(_GROUPS * row.total / most, 6)) if most else 0
            counts[min(group, _GROUPS - 1)] += 1
    width = 100 // _GROUPS
    return [PointsGroup(i * width, (i + 1) * width, count) for i, count in enumerate(counts)]


def _columns(book: Gradebook) -> list[tuple[str, float, int, float | None]]:
    # Return for each exercise its id, the possible points, the number of learners with an attempt,
    # and the mean of their points.
    found = []
    for i, column in enumerate(book.columns):
        earned = [row.points[i] for row in book.rows if row.points[i] is not None]
        mean = sum(each or 0.0 for each in earned) / len(earned) if earned else None
        found.append((column.exercise, column.points, len(earned), mean))
    return found


def _shown(when: datetime | None) -> str:
    """Return a date in the course's time zone as text, or a dash."""
    return f"{when:%Y-%m-%d %H:%M}" if when is not None else "–"


def _in_language(catalogue: Catalogue, language: Language) -> Catalogue:
    return {name: in_language(each, language) for name, each in catalogue.items()}


def _page(
    name: str,
    assets: Assets,
    language: Language,
    root: str,
    scripts: Sequence[str],
    **values: Any,
) -> bytes:
    return page(
        f"web/templates/courses/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css", "records.css", "courses.css"],
        language=language,
        tutor=True,
        **values,
    )


# --- The route that reads a course's roster, the platform's list of its members (LTI)


def roster_routes(assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the route that reads a roster (a platform's list of members)."""
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.post("/{course_id}/roster")
    async def roster(request: Request, course_id: CourseId) -> Response:
        """Read the platform's list of members, and return the page with the changes."""
        from dh_grader.courses import roll
        from dh_grader.lti.roster import RosterError, ask_for_roster, enrol_members, read_roster

        shows_names = "names" in await form_fields(request)
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            message = say("Rosters need a secret: set DH_GRADER_SECRET.")
            raise course_problem(CourseError("unusable", message))
        known, now, language = secret, datetime.now(UTC), language_of(request)
        course = await read(store, lambda it: roll.course(it, course_id))
        try:
            asked = await write(store, lambda it: ask_for_roster(it, course_id, known, now))
        except RosterError as error:
            raise course_problem(CourseError("unusable", message_of(error))) from error
        try:
            members = await tutoring.platforms.run(
                asked.registration.id, lambda: read_roster(asked)
            )
        except RosterError as error:
            content = roster_page(
                course, None, told(message_of(error), language.translation), assets, language
            )
            return page_answer(request, content, FORM_HEADERS, HTTPStatus.BAD_GATEWAY)
        change = await write(
            store, lambda it: enrol_members(it, asked, members, known, shows_names=shows_names)
        )
        content = roster_page(course, change, "", assets, language)
        return page_answer(request, content, FORM_HEADERS)

    return router
