"""Which right each route needs, and whether the caller of a request has it.

The table of rights is here; keys, tokens and limits of rates are in ``dh_grader.access``.
"""

import base64
import binascii
from collections.abc import Awaitable, Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from functools import lru_cache, partial
from http import HTTPStatus
from ipaddress import IPv4Address, IPv6Address, ip_address
from typing import Final, NamedTuple, Protocol
from urllib.parse import urlsplit

from fastapi import Request
from starlette.datastructures import Headers
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as AsgiScope

from dh_grader.access import (
    NOBODY,
    OPEN_ANYWHERE,
    PREFIX,
    Caller,
    CredentialError,
    Keys,
    KeysBusyError,
    KeysUnreachableError,
    OpenAccess,
    Scope,
)
from dh_grader.api.http import (
    CLIENT,
    COURSE_SITE,
    ONE_ADDRESS,
    ONE_STUDENT,
    Client,
    ProblemError,
    language_of,
    message_of,
    store_down,
)
from dh_grader.translations import SentenceValue, say, template

# --- The right that each route needs, as a table
#
# docs/keys.md contains a list made from this table.


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


# --- Check that each caller has the right that the requested route needs
#
# While the service has no API keys, everybody may grade and record. Only the users of this machine
# are tutors then.
#
# A request that a proxy has forwarded does not count as a tutor's, because the proxy also forwards
# requests of students.


# The key of a request's ASGI scope under which the authentication leaves the identity.
IDENTITY: Final = "dh_grader.identity"
# The cookies with the session of a tutor. Browsers accept the first one only over HTTPS, and only
# from the service itself (RFC 6265bis, section 4.1.3.2).
SECURE_COOKIE: Final = "__Host-dh-grader"
PLAIN_COOKIE: Final = "dh-grader"
# Headers by which a proxy names its client or the address it was asked for, besides X-Forwarded-….
_OF_PROXIES: Final = frozenset(
    {
        "forwarded", "via", "x-real-ip", "x-client-ip", "x-cluster-client-ip", "true-client-ip",
        "cf-connecting-ip", "x-original-host", "x-original-forwarded-for", "x-request-start",
    }
)  # fmt: skip

_OPEN: Final = Caller(frozenset({Scope.GRADE, Scope.RECORD}))
# The problem of a request for something that is not shown, or not changed, for this caller.
_NOT_SHOWN: Final = {
    WithoutKeys.SOLUTIONS: "solutions-off",
    WithoutKeys.ATTEMPTS: "attempts-not-shown",
    WithoutKeys.THIS_MACHINE: "attempts-not-changed",
}


@dataclass(frozen=True, slots=True)
class Identity:
    """The caller of a request.

    ``refusal`` is the error to send if the key is not valid. ``in_browser`` is True if a browser
    has sent the key automatically.
    """

    caller: Caller
    by_key: bool = False
    refusal: ProblemError | None = None
    in_browser: bool = False


_UNKNOWN: Final = Identity(NOBODY, by_key=True)


class Access:
    """Checks who the callers are and what they may do.

    ``solutions`` and ``read_attempts`` say who may see solutions and recorded attempts while the
    service has no keys. True means everybody, None means tutors, False means nobody.
    """

    def __init__(
        self,
        open_access: OpenAccess = OPEN_ANYWHERE,
        *,
        solutions: bool | None = False,
        read_attempts: bool | None = False,
        keys: Keys | None = None,
    ) -> None:
        self.keys = keys
        self._open = open_access
        self._shown = {
            WithoutKeys.SOLUTIONS: solutions,
            WithoutKeys.ATTEMPTS: read_attempts,
            # Even if everybody may read attempts, only tutors change them.
            WithoutKeys.THIS_MACHINE: None if read_attempts else read_attempts,
        }
        self._always = Identity(Caller(open_access.scopes) if open_access.scopes else NOBODY)
        self._until_keys = Identity(_OPEN) if open_access.until_keys else self._always

    async def identify(self, scope: AsgiScope) -> Identity:
        """Return the identity of the caller of a request."""
        if self.keys is None or not await self.keys.are_needed():
            return self._without_keys(scope)
        credential, in_browser = _credential(Headers(scope=scope).get("authorization", ""))
        session = "" if credential else session_in(scope)
        if not (credential or session):
            return Identity(self._always.caller, by_key=True)
        try:
            if session:
                caller, in_browser = await self.keys.session_caller(session), True
            else:
                caller = await self.keys.caller(credential)
        except CredentialError as error:
            if session:  # it has ended
                return Identity(self._always.caller, by_key=True)
            refusal = access_problem("key-not-valid", reason=message_of(error))
        except KeysUnreachableError:
            refusal = store_down(say("The key cannot be checked: the database does not answer."))
        except KeysBusyError:
            refusal = access_problem("busy")
        else:
            return Identity(caller, by_key=True, in_browser=in_browser)
        return Identity(NOBODY, by_key=True, refusal=refusal)

    async def permit(self, request: Request) -> None:
        """Check that the caller has the right that the request's route needs.

        Every route depends on this check. Raises ProblemError.
        """
        self._check(request, right_of(request))

    def caller(self, request: Request) -> Caller:
        """Return the caller of a request."""
        return self._identity(request).caller

    def is_signed_in(self, request: Request) -> bool:
        """True if the request has the session of a tutor."""
        return self._identity(request).in_browser

    def require_allowed_origin(self, request: Request, origins: Collection[str]) -> None:
        """Check that the request comes from a page that may record attempts.

        Raises ProblemError.
        """
        # A browser sends the POST of any page without asking the service first, and only hides the
        # response from the page. Requests with a key that the browser has not added by itself skip
        # this check.
        identity = self._identity(request)
        shows_key = bool(identity.caller.key_id) and not identity.in_browser
        is_allowed = "*" in origins or request.headers.get("origin") in origins
        if not (shows_key or is_allowed or is_same_origin(request)):
            raise access_problem("origin-refused")

    def shows_solutions(self, request: Request) -> bool:
        """True if the caller may see the solutions of at least one exercise."""
        try:
            self._check(request, RIGHTS["GET /tutor"])
        except ProblemError:
            return False
        return True

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """Return a token for the caller's learner, valid until ``expires_at``."""
        assert self.keys is not None, "only keys make tokens"
        return self.keys.token(caller, expires_at)

    def close(self) -> None:
        """Save when keys were last used, and stop the threads."""
        if self.keys is not None:
            self.keys.close()

    def _check(self, request: Request, right: Right) -> None:
        if right.scope is None:
            return
        identity = self._identity(request)
        problem = identity.refusal or self._problem(request, identity, right, right.scope)
        if problem is not None:
            raise problem
        course = identity.caller.course
        if course is not None and not right.in_course:
            raise access_problem("other-course")
        if right.reach is Reach.COURSE and course not in (None, request.path_params["course_id"]):
            raise access_problem("other-course")
        if identity.caller.exercises is None or right.reach is Reach.OWN:
            return
        named = right.reach.named(request)
        if named is None or not identity.caller.reaches(named):
            raise access_problem("other-exercise")

    def _problem(
        self, request: Request, identity: Identity, right: Right, scope: Scope
    ) -> ProblemError | None:
        caller = identity.caller
        shown = self._shown.get(right.without_keys)
        is_learner = caller.learner is not None
        if is_learner and right.tokens and scope is Scope.TUTOR:
            scope = Scope.RECORD  # learners who may record may read what is recorded of them
        if not identity.by_key and right.without_keys in _NOT_SHOWN:
            is_shown = is_at_the_machine(request) if shown is None else shown
        elif right.without_keys is WithoutKeys.NOBODY and not caller.key_id:
            return access_problem("key-needed" if identity.by_key else "tokens-not-made")
        elif is_learner and not right.tokens:
            return scope_missing(scope) if scope is Scope.TUTOR else token_for_token()
        elif scope not in caller.scopes and scope not in self._always.caller.scopes:
            return scope_missing(scope) if caller.key_id else access_problem("key-needed")
        elif right.without_keys not in _NOT_SHOWN:
            return None
        else:
            is_shown = shown is not False
        # A program that sends a key in a header of its own may name any origin.
        sends_key = identity.by_key and not identity.in_browser
        is_allowed = is_shown and (sends_key or is_same_origin(request))
        return None if is_allowed else access_problem(_NOT_SHOWN[right.without_keys])

    def _identity(self, request: Request) -> Identity:
        identity: Identity | None = request.scope.get(IDENTITY)
        if identity is not None:
            return identity
        # If the service may have keys, a request that has not been authenticated has no rights.
        return self._without_keys(request.scope) if self.keys is None else _UNKNOWN

    def _without_keys(self, scope: AsgiScope) -> Identity:
        if self._open.anywhere or _is_to_this_machine((scope.get("server") or ("",))[0]):
            return self._until_keys
        return self._always


def require_reach(caller: Caller, exercise: str | None) -> None:
    """Raise ProblemError if the caller may not use ``exercise``."""
    if exercise is not None and not caller.reaches(exercise):
        raise access_problem("other-exercise")


def is_at_the_machine(request: Request) -> bool:
    """True if a client on this machine has made the request directly, without a proxy."""
    # A local Host is required, so that pages whose domain name resolves to this machine are
    # refused.
    server = request.scope.get("server") or ("",)
    client = request.scope.get("client") or ("",)
    asked = _host_name(request.headers.get("host", ""))
    return (
        is_loopback(server[0])
        and is_loopback(client[0])
        and (asked == "localhost" or is_loopback(asked))
        and not _is_of_proxy(request)
    )


def is_same_origin(request: Request) -> bool:
    """True unless a page of another origin has made the request."""
    # Programs send no origin. Browsers send Sec-Fetch-Site (Fetch Metadata) over HTTPS and to their
    # own machine, also with requests that have no Origin header. It is more reliable than comparing
    # schemes, because a service behind a proxy may not know the browser's scheme. A user may follow
    # a link from any page, because that page cannot read the response.
    headers = request.headers
    site = headers.get("sec-fetch-site")
    if site not in (None, "same-origin", "none") and not _follows_link(request):
        return False
    origin = headers.get("origin")
    if origin is None:
        return True
    scheme, _, host = origin.partition("://")
    is_of_scheme = site == "same-origin" or scheme == request.scope["scheme"]
    return is_of_scheme and host == headers.get("host", "")


def session_in(scope: AsgiScope) -> str:
    """Return the session token in the cookies of a request, or ""."""
    # Over HTTPS, only the secure cookie counts: another host of the same site, or an attacker who
    # changes HTTP responses, could set the plain cookie.
    request = Request(scope)
    origin = request.headers.get("origin", "")
    is_secure = scope["scheme"] == "https" or origin.startswith("https:")
    # A proxy that this service does not trust may have hidden that the browser uses HTTPS.
    names = (SECURE_COOKIE,) if is_secure else (SECURE_COOKIE, PLAIN_COOKIE)
    session = next(filter(None, map(request.cookies.get, names)), "")
    return session if session and is_same_origin(request) else ""


def is_loopback(host: str) -> bool:
    """True if an address is a loopback address, which only this machine reaches."""
    address = _address(host)
    return address is not None and address.is_loopback


def _is_of_proxy(request: Request) -> bool:
    # An unconfigured nginx adds no header and names this machine as host, but it speaks HTTP/1.0
    # (ngx_http_proxy_module, "proxy_http_version", "proxy_set_header"), which no browser does.
    return request.scope.get("http_version") == "1.0" or any(
        name in _OF_PROXIES or name.startswith("x-forwarded-") for name in request.headers
    )


def _is_to_this_machine(server: str) -> bool:
    return _address(server) is None or is_loopback(server)


@lru_cache(1024)
def _address(host: str) -> IPv4Address | IPv6Address | None:
    try:
        return ip_address(host)
    except ValueError:
        return None


def _host_name(netloc: str) -> str:
    try:
        return urlsplit(f"//{netloc}").hostname or ""
    except ValueError:
        return ""


def _follows_link(request: Request) -> bool:
    headers = request.headers
    return (
        request.method in ("GET", "HEAD")
        and headers.get("sec-fetch-mode") == "navigate"
        and headers.get("sec-fetch-dest") == "document"
    )


def _credential(header: str) -> tuple[str, bool]:
    # Browsers send a key as a password. A password that is not a key is ignored: it may be meant
    # for a proxy, which has already checked it.
    scheme, _, value = header.partition(" ")
    match scheme.lower():
        case "bearer":
            return value.strip(), False
        case "basic":
            try:
                password = base64.b64decode(value, validate=True).decode().partition(":")[2]
            except (binascii.Error, UnicodeDecodeError):
                return "", False
            return (password, True) if password.startswith(PREFIX) else ("", False)
    return "", False


# --- Middleware that authenticates the callers of requests and limits their rates


# Parts of the paths that count towards limits, after any prefix of a proxy; pages and files do not.
_COUNTED: Final = ("/v1/", "/tutor", "/lti/")
# Supervisors have no key, and must not wait for the database of keys.
_HEALTH: Final = ("/healthz", "/readyz")


# The key of a request's ASGI scope under which the authentication leaves a function that counts
# submissions towards the caller's limit.
COUNT: Final = "dh_grader.count"


class RequestRates(Protocol):
    """Counts the requests of callers, to limit their rates."""

    def most_at_once(self, caller: Caller) -> float:
        """Return the most requests that may be counted for the caller at once."""

    async def seconds_to_wait(self, caller: Caller, address: str, requests: int = 1) -> int:
        """Count requests; return 0 if they are allowed, otherwise the seconds to wait."""

    def close(self) -> None:
        """Stop the counting threads."""


class AuthenticationMiddleware:
    """Authenticate the caller of each request, and enforce the caller's rate limit."""

    def __init__(self, app: ASGIApp, access: Access, rates: RequestRates | None) -> None:
        self.app = app
        self._access = access
        self._rates = rates

    async def __call__(self, scope: AsgiScope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http" or scope["path"].endswith(_HEALTH):
            await self.app(scope, receive, send)
            return
        identity = await self._access.identify(scope)
        if self._rates is not None and any(each in scope["path"] for each in _COUNTED):
            address = (scope.get("client") or ("",))[0]
            seconds = await self._rates.seconds_to_wait(identity.caller, address)
            if seconds:
                refused = access_problem("too-often", seconds=seconds)
                await refused.response(scope["path"], language_of(HTTPConnection(scope)))(
                    scope, receive, send
                )
                return
            scope = {**scope, COUNT: partial(_count, self._rates, identity.caller, address)}
        inner = {**scope, IDENTITY: identity}
        if identity.caller.owner:
            inner[CLIENT] = Client(identity.caller.owner, _most_shares(identity.caller))
        await self.app(inner, receive, send)


async def count_submissions(request: Request, number: int) -> None:
    """Count each submission of a batch as a request of the caller.

    Raises ProblemError if the caller's limit does not allow the whole batch.
    """
    count: Callable[[int], Awaitable[None]] | None = request.scope.get(COUNT)
    if count is not None:
        await count(number)


async def _count(rates: RequestRates, caller: Caller, address: str, number: int) -> None:
    most = rates.most_at_once(caller)
    if number > most:
        raise access_problem("batch-too-large", number=number, most=int(most))
    # The request itself has been counted.
    seconds = await rates.seconds_to_wait(caller, address, number - 1) if number > 1 else 0
    if seconds:
        raise access_problem("too-often", seconds=seconds)


def _most_shares(caller: Caller) -> float:
    # A key that may record counts as the key of a course site, which acts for all its students.
    if caller.learner is not None:
        return ONE_STUDENT
    return COURSE_SITE if Scope.RECORD in caller.scopes else ONE_ADDRESS


# --- The errors for requests that the caller has no right to make


_BEARER: Final = "Bearer"
_ALLOWS: Final = {
    Scope.GRADE: say("have answers graded"),
    Scope.RECORD: say("record attempts"),
    Scope.TUTOR: say("see what tutors see"),
}


class AccessProblem(NamedTuple):
    """The constant texts of an error, with placeholders in braces."""

    status: HTTPStatus
    title: str
    detail: str
    retry_after: str | None = None
    challenges: Sequence[str] = ()


# The problems by the ends of their types.
ACCESS_PROBLEMS: Final[Mapping[str, AccessProblem]] = {
    "key-needed": AccessProblem(
        HTTPStatus.UNAUTHORIZED,
        template("A key is needed"),
        template("This needs a key. Send it in the header Authorization: Bearer dhg_…"),
        challenges=(_BEARER,),
    ),
    "key-not-valid": AccessProblem(
        HTTPStatus.UNAUTHORIZED,
        template("The key is not valid"),
        "{reason}",
        challenges=(f'{_BEARER} error="invalid_token"',),
    ),
    "scope-missing": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is not for this"),
        template("This key may not {allowed}: it has not the scope {scope}."),
    ),
    "other-exercise": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is for other exercises"),
        template(
            "This key or token is for certain exercises. Name one of them; others, and all at "
            "once, are not for it."
        ),
    ),
    "other-course": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The key is for one course"),
        template("This key or link is for one course. Others, and all at once, are not for it."),
    ),
    "learner-needed": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("This is for a learner"),
        template("This needs the personal link or the token of a learner."),
    ),
    "other-learner": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The token is for another learner"),
        template("This token is for one learner, and not for the one that is named here."),
    ),
    "solutions-off": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Model solutions are not shown here"),
        template(
            "Model solutions are for tutors, and this service does not show them. To show them to "
            "everybody who can reach it, start it with DH_GRADER_SOLUTIONS=true; on the machine "
            "itself, use dh-grader exercises show ID --solution."
        ),
    ),
    "attempts-not-shown": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Recorded attempts are not shown here"),
        template(
            "Recorded attempts are for tutors, and this service does not show them. Ask from the "
            "machine itself, use dh-grader attempts there, or set DH_GRADER_READ_ATTEMPTS=true to "
            "show them to everybody who can reach the service."
        ),
    ),
    "attempts-not-changed": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("Recorded attempts are not changed here"),
        template(
            "Only tutors change recorded attempts: with a key or, while the service has no keys, "
            "from the machine itself, on a page of the service or by dh-grader attempts."
        ),
    ),
    "origin-refused": AccessProblem(
        HTTPStatus.FORBIDDEN,
        template("The page is of another origin"),
        template(
            "A page of this origin may not record attempts. DH_GRADER_CORS_ORIGINS names those "
            "that may."
        ),
    ),
    "tokens-not-made": AccessProblem(
        HTTPStatus.NOT_FOUND,
        template("No tokens are made here"),
        template("A token is made by the holder of a key, and this service needs no keys."),
    ),
    "too-often": AccessProblem(
        HTTPStatus.TOO_MANY_REQUESTS,
        template("Too many requests"),
        template("These are more requests than are allowed. Come again in {seconds} seconds."),
        retry_after="{seconds}",
    ),
    "batch-too-large": AccessProblem(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        template("The batch is too large"),
        template(
            "Each submission counts as a request. {number} at once are never allowed here: send "
            "at most {most} in one request."
        ),
    ),
    "busy": AccessProblem(
        HTTPStatus.SERVICE_UNAVAILABLE,
        template("The service has a lot to do"),
        template("Too many keys are being checked. Send this request again."),
        retry_after="1",
    ),
}


def access_problem(name: str, **values: SentenceValue) -> ProblemError:
    """Return the error called ``name``, with ``values`` put into its texts."""
    status, title, detail, retry_after, challenges = ACCESS_PROBLEMS[name]
    headers = None if retry_after is None else {"Retry-After": retry_after.format_map(values)}
    return ProblemError(
        status, say(detail, **values), name, say(title), headers=headers, challenges=challenges
    )


def scope_missing(scope: Scope) -> ProblemError:
    """Return the error for a key without this scope (a right of a key)."""
    return access_problem("scope-missing", allowed=_ALLOWS[scope], scope=str(scope))


def token_for_token() -> ProblemError:
    """Return the error for a request that shows a token, not a key, to create a token."""
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        say("A token makes no tokens; this needs a key."),
        "scope-missing",
        say("The token is not for this"),
    )
