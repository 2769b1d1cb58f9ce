"""The pages of courses as HTML."""

# Scripts send their forms to the routes of the service.

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from service.api.http.lookup import Catalogue
from service.catalogue import in_language
from service.contract.courses import (
    Course,
    CourseAssignment,
    CourseLearner,
    Gradebook,
    LearnerVariant,
    MissingLearner,
)
from service.contract.own_courses import OwnCourse
from service.contract.scores import PlatformScore
from service.courses.names import told_apart
from service.courses.times import with_own_dates
from service.translations import Language
from service.web.assets import Assets
from service.web.pages import page

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Row

    from service.lti.handed_files.overview import MissingReport
    from service.lti.roster.enrolment import RosterChange

# The number of groups in the distribution of points.
_GROUPS: Final = 10


class CourseState(NamedTuple):
    """A course with its learners and assignments.

    ``handed_in`` has the number of learners with a readable attempt, by assignment id. ``roster``
    is None if the learning platform gives no list of the course's members.
    """

    # Otherwise it is a database row. ``reports`` are the reports on files that did not reach the
    # platform.

    course: Course
    learners: Sequence[CourseLearner]
    assignments: Sequence[CourseAssignment]
    handed_in: dict[str, int]
    roster: "Row[Any] | None"
    reports: "Sequence[MissingReport]" = ()


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

    The page has the learner's results, variants, scores and personal link.
    """
    # ``reports`` are the reports on handed-in files that did not reach the platform. ``variants``
    # has the learner's variants by assignment.
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
    """Count the learners in each group of similar points."""
    # Learners without attempts are left out.
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
    # Return a tuple for each exercise.
    # It has the exercise's id, the possible points, the number of learners with an attempt, and the
    # mean of their points.
    found = []
    for i, column in enumerate(book.columns):
        earned = [row.points[i] for row in book.rows if row.points[i] is not None]
        mean = sum(each or 0.0 for each in earned) / len(earned) if earned else None
        found.append((column.exercise, column.points, len(earned), mean))
    return found


def _shown(when: datetime | None) -> str:
    """Return a date as text, or a dash."""
    # The date is already in the course's time zone.
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
        f"web/courses/templates/{name}.html",
        assets,
        root,
        ["page.js", *scripts],
        styles=["tutor.css", "records.css", "courses.css"],
        language=language,
        tutor=True,
        **values,
    )
