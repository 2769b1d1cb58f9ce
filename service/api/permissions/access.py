"""Check that each caller has the right that the requested route needs.

While the service has no API keys, everybody may grade and record. Only the users of this machine
are tutors then.
"""

# A request that a proxy has forwarded does not count as a tutor's, because the proxy also forwards
# requests of students.

import base64
import binascii
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from ipaddress import IPv4Address, IPv6Address, ip_address
from typing import Final
from urllib.parse import urlsplit

from fastapi import Request
from starlette.datastructures import Headers
from starlette.types import Scope as AsgiScope

from service.access.caller import NOBODY, Caller, Scope
from service.access.key_text import PREFIX
from service.access.keys import CredentialError, Keys, KeysBusyError, KeysUnreachableError
from service.access.open_access import OPEN_ANYWHERE, OpenAccess
from service.api.http.problems import ProblemError, message_of, store_down
from service.api.permissions.access_problems import (
    access_problem,
    scope_missing,
    token_for_token,
)
from service.api.permissions.rights import RIGHTS, Reach, Right, WithoutKeys, right_of
from service.translations import say

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


def _is_of_proxy(request: Request) -> bool:
    # An unconfigured nginx adds no header and names this machine as host, but it speaks HTTP/1.0
    # (ngx_http_proxy_module, "proxy_http_version", "proxy_set_header"), which no browser does.
    return request.scope.get("http_version") == "1.0" or any(
        name in _OF_PROXIES or name.startswith("x-forwarded-") for name in request.headers
    )


def is_loopback(host: str) -> bool:
    """True if an address is a loopback address, which only this machine reaches."""
    address = _address(host)
    return address is not None and address.is_loopback


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
