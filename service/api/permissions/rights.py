"""A table with the right that each route needs.

docs/keys.md contains a list made from this table.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import partial
from typing import Final

from fastapi import Request

from service.access.caller import Scope


class Reach(Enum):
    """Which exercises a route is about, to check keys that are for some exercises only."""

    PATH = "the one in the path"
    QUERY = "the one in `?exercise=`, else all"
    ALL = "all"
    # A key of a course must be for this one; a key restricted to some exercises is refused.
    COURSE = "all; a key of a course: that in the path"
    # The route itself checks each exercise of its body, or answers for these exercises only.
    OWN = "those of the key"

    def named(self, request: Request) -> str | None:
        """Return the exercise that the request is about; None for all exercises."""
        if self is Reach.QUERY:
            return request.query_params.get("exercise")
        return request.path_params["exercise_id"] if self is Reach.PATH else None


class WithoutKeys(Enum):
    """Who may use a route while the service has no keys."""

    EVERYBODY = "everybody"
    OPEN = "`DH_GRADER_OPEN`"
    SOLUTIONS = "`DH_GRADER_SOLUTIONS`"
    ATTEMPTS = "`DH_GRADER_READ_ATTEMPTS`"
    THIS_MACHINE = "this machine"
    NOBODY = "nobody"


@dataclass(frozen=True, slots=True)
class Right:
    """What a caller needs for a route.

    ``scope`` is the right that a key needs, or None if no key is needed. ``tokens`` is True if
    learners may use the route with a token. ``in_course`` is True if a key of one course may be
    used.
    """

    scope: Scope | None
    without_keys: WithoutKeys
    reach: Reach
    tokens: bool = False
    in_course: bool = False


_EVERYBODY: Final = Right(None, WithoutKeys.EVERYBODY, Reach.OWN, tokens=True)
_grade = partial(Right, Scope.GRADE, WithoutKeys.OPEN, tokens=True, in_course=True)
_record = partial(Right, Scope.RECORD, WithoutKeys.OPEN, tokens=True)
_solutions = partial(Right, Scope.TUTOR, WithoutKeys.SOLUTIONS)
_attempts = partial(Right, Scope.TUTOR, WithoutKeys.ATTEMPTS)
_change = partial(Right, Scope.TUTOR, WithoutKeys.THIS_MACHINE)
_read_course = partial(_attempts, Reach.COURSE, in_course=True)
_change_course = partial(_change, Reach.COURSE, in_course=True)

# The right of each route, by its method and the pattern of its path.
RIGHTS: Final[Mapping[str, Right]] = {
    "GET /": _EVERYBODY,
    "GET /play": _EVERYBODY,
    "GET /practice": _EVERYBODY,
    "GET /learn": _EVERYBODY,
    "GET /learn-dh": _EVERYBODY,
    "GET /help": _EVERYBODY,
    "GET /help/expressions": _EVERYBODY,
    "GET /help/pasting": _EVERYBODY,
    "GET /help/points": _EVERYBODY,
    "GET /lti/login": _EVERYBODY,
    "POST /lti/login": _EVERYBODY,
    "POST /lti/launch": _EVERYBODY,
    "GET /lti/jwks.json": _EVERYBODY,
    "POST /lti/assignment": _EVERYBODY,
    "POST /lti/session": _EVERYBODY,
    "POST /lti/links": _EVERYBODY,
    "POST /lti/notices": _EVERYBODY,
    "GET /lti/register": _EVERYBODY,
    "POST /lti/register": _EVERYBODY,
    "GET /embed.js": _EVERYBODY,
    "GET /static/{name}": _EVERYBODY,
    "GET /exercises/{exercise_id}": _EVERYBODY,
    "GET /docs": _EVERYBODY,
    "GET /docs/{name}": _EVERYBODY,
    "GET /openapi.json": _EVERYBODY,
    "GET /healthz": _EVERYBODY,
    "GET /readyz": _EVERYBODY,
    "GET /v1/exercises": _EVERYBODY,
    "GET /v1/exercises/{exercise_id}": _EVERYBODY,
    "GET /v1/exercises/{exercise_id}/figure.svg": _EVERYBODY,
    "GET /v1/practice/next": _grade(Reach.OWN),
    "POST /v1/exercises/{exercise_id}/grade": _grade(Reach.PATH),
    "POST /v1/exercises/{exercise_id}/hints": _grade(Reach.PATH),
    "POST /v1/exercises/{exercise_id}/choices": _grade(Reach.PATH),
    "POST /v1/exercises/{exercise_id}/solution": _grade(Reach.PATH),
    "GET /v1/rules/{convention}/{rule}.svg": _EVERYBODY,
    "POST /v1/grade": _grade(Reach.OWN),
    "POST /v1/preview": _grade(Reach.OWN),
    "POST /v1/previews": _grade(Reach.OWN),
    "POST /v1/frames": _grade(Reach.OWN),
    "POST /v1/tokens": Right(Scope.GRADE, WithoutKeys.NOBODY, Reach.OWN, in_course=True),
    "POST /v1/exercises/{exercise_id}/attempts": _record(Reach.PATH),
    "GET /v1/attempts": _attempts(Reach.QUERY, tokens=True, in_course=True),
    "GET /v1/attempts/{attempt_id}": _attempts(Reach.OWN, tokens=True, in_course=True),
    "POST /v1/attempts/{attempt_id}/hints": _record(Reach.OWN, in_course=True),
    "GET /v1/attempts/export": _attempts(Reach.QUERY, in_course=True),
    "GET /v1/exercises/{exercise_id}/statistics": _attempts(Reach.PATH, in_course=True),
    "POST /v1/attempts/{attempt_id}/override": _change(Reach.OWN, in_course=True),
    "POST /v1/learners/forget": _change(Reach.ALL),
    "POST /v1/exercises/{exercise_id}/regrade": _change(Reach.PATH, in_course=True),
    "GET /v1/courses": _attempts(Reach.ALL, in_course=True),
    "POST /v1/courses": _change(Reach.ALL),
    "GET /v1/courses/{course_id}": _read_course(),
    "POST /v1/courses/{course_id}": _change_course(),
    "POST /v1/courses/{course_id}/delete": _change(Reach.ALL),
    "GET /v1/courses/{course_id}/learners": _read_course(),
    "POST /v1/courses/{course_id}/learners": _change_course(),
    "POST /v1/courses/{course_id}/learners/remove": _change_course(),
    "POST /v1/courses/{course_id}/links": _change_course(),
    "POST /v1/courses/{course_id}/links/revoke": _change_course(),
    "GET /v1/courses/{course_id}/gradebook": _read_course(),
    "GET /v1/courses/{course_id}/scores": _read_course(),
    "POST /v1/courses/{course_id}/scores/send": _change_course(),
    "GET /v1/courses/{course_id}/assignments": _read_course(),
    "POST /v1/courses/{course_id}/assignments": _change_course(),
    "GET /v1/courses/{course_id}/assignments/{assignment_id}": _read_course(),
    "POST /v1/courses/{course_id}/assignments/{assignment_id}": _change_course(),
    "POST /v1/courses/{course_id}/assignments/{assignment_id}/delete": _change_course(),
    "POST /v1/courses/{course_id}/assignments/{assignment_id}/extensions": _change_course(),
    "GET /v1/courses/{course_id}/assignments/{assignment_id}/variants": _read_course(),
    "POST /v1/courses/{course_id}/assignments/{assignment_id}/variants": _change_course(),
    "GET /v1/courses/{course_id}/assignments/{assignment_id}/missing": _read_course(),
    "POST /v1/courses/{course_id}/assignments/{assignment_id}/attempts": _record(
        Reach.COURSE, in_course=True
    ),
    "GET /v1/courses/{course_id}/assignments/{assignment_id}/solutions/{exercise_id}": Right(
        Scope.RECORD, WithoutKeys.NOBODY, Reach.COURSE, tokens=True, in_course=True
    ),
    "GET /v1/courses/{course_id}/learners/{learner:path}/view": _read_course(),
    "GET /v1/me": Right(Scope.RECORD, WithoutKeys.NOBODY, Reach.OWN, tokens=True, in_course=True),
    "GET /v1/exercises/{exercise_id}/solution": _solutions(Reach.PATH, in_course=True),
    "GET /tutor/sign-in": _EVERYBODY,
    "POST /tutor/sign-in": _EVERYBODY,
    "POST /tutor/sign-out": _EVERYBODY,
    "GET /tutor": _solutions(Reach.OWN, in_course=True),
    "GET /tutor/solutions/{exercise_id}": _solutions(Reach.PATH, in_course=True),
    "GET /tutor/solutions/{exercise_id}/frames.svg": _solutions(Reach.PATH, in_course=True),
    "GET /tutor/misconceptions/{exercise_id}": _solutions(Reach.PATH, in_course=True),
    "GET /tutor/courses": _attempts(Reach.ALL, in_course=True),
    "GET /tutor/courses/{course_id}": _read_course(),
    "GET /tutor/courses/{course_id}/assignments/{assignment_id}": _read_course(),
    "GET /tutor/courses/{course_id}/gradebook": _read_course(),
    "GET /tutor/courses/{course_id}/learner": _read_course(),
    "POST /tutor/courses/{course_id}/links.csv": _change_course(),
    "POST /tutor/courses/{course_id}/roster": _change_course(),
    "GET /tutor/platforms": _change(Reach.ALL),
    "POST /tutor/platforms/{registration_id}/check": _change(Reach.ALL),
    "GET /tutor/editor": _solutions(Reach.ALL),
    "POST /tutor/check": _solutions(Reach.ALL),
    "POST /tutor/import": _solutions(Reach.ALL),
    "POST /tutor/drafts": _solutions(Reach.ALL),
    "POST /tutor/files": _solutions(Reach.ALL),
    "GET /tutor/class": _solutions(Reach.ALL),
    "GET /tutor/class/report": _solutions(Reach.ALL),
    "POST /tutor/class": _solutions(Reach.ALL),
    "GET /tutor/attempts": _attempts(Reach.OWN, in_course=True),
    "GET /tutor/attempts/{attempt_id}": _attempts(Reach.OWN, in_course=True),
    "GET /tutor/statistics/{exercise_id}": _attempts(Reach.PATH, in_course=True),
}


def right_of(request: Request) -> Right:
    """Return the right that the route of this request needs."""
    return RIGHTS[f"{request.method} {request.scope['route'].path}"]
