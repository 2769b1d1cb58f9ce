"""Who may do what: the one place that routes ask.

Where there are keys, they say it. Where there are none, grading and recording are open, and the
tutor is whoever asks from the machine that serves, unless a proxy stands in between, which brings
in the students.
"""

import base64
import binascii
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from ipaddress import ip_address
from typing import Final
from urllib.parse import urlsplit

from fastapi import Request
from starlette.datastructures import Headers
from starlette.types import Scope as Asked

from service.access.caller import NOBODY, Caller, Scope
from service.access.key_text import PREFIX
from service.access.keys import CredentialError, Keys, KeysBusyError, KeysUnreachableError
from service.access.open_access import OPEN_ANYWHERE, OpenAccess
from service.api.http.problems import ProblemError
from service.api.permissions.access_problems import (
    asking_for_password,
    attempts_not_changed,
    attempts_not_shown,
    credential_refused,
    key_needed,
    keys_busy,
    keys_unreachable,
    learner_makes_token,
    origin_refused,
    other_exercise,
    scope_missing,
    solutions_off,
    tokens_not_made,
)

# Where the layer at the door leaves who asks, in the scope of a request.
IDENTITY: Final = "dh_grader.identity"
# A proxy names whom it speaks for, or how it was asked, in one of these or in X-Forwarded-…
_OF_PROXIES: Final = frozenset(
    {
        "forwarded", "via", "x-real-ip", "x-client-ip", "x-cluster-client-ip", "true-client-ip",
        "cf-connecting-ip", "x-original-host", "x-original-forwarded-for", "x-request-start",
    }
)  # fmt: skip

_OPEN: Final = Caller(frozenset({Scope.GRADE, Scope.RECORD}))


@dataclass(frozen=True, slots=True)
class Identity:
    """Who asks; ``by_key`` where keys decide.

    ``refusal`` is the problem of a key that is not valid. ``in_browser`` is set
    where a browser has added the key by itself, as it may for other pages, too.
    """

    caller: Caller
    by_key: bool = False
    refusal: ProblemError | None = None
    in_browser: bool = False


_UNKNOWN: Final = Identity(NOBODY, by_key=True)


class Access:
    """Who may do what.

    ``solutions`` and ``read_attempts`` say whether these are shown at all: to nobody (False), to
    tutors (None), and where there are no keys, to whoever asks (True).
    """

    def __init__(
        self,
        open_access: OpenAccess = OPEN_ANYWHERE,
        *,
        solutions: bool | None = False,
        read_attempts: bool | None = False,
        keys: Keys | None = None,
    ) -> None:
        self._open = open_access
        self._solutions = solutions
        self._read_attempts = read_attempts
        self.keys = keys
        self._always = Identity(Caller(open_access.scopes) if open_access.scopes else NOBODY)
        self._until_keys = Identity(_OPEN) if open_access.until_keys else self._always

    async def identify(self, asked: Asked) -> Identity:
        """Who asks, where there may be keys."""
        if self.keys is None or not await self.keys.are_needed():
            return self._without_keys(asked)
        credential, in_browser = _credential(Headers(scope=asked).get("authorization", ""))
        if not credential:
            return Identity(self._always.caller, by_key=True)
        try:
            caller = await self.keys.caller(credential)
        except CredentialError as error:
            return Identity(NOBODY, by_key=True, refusal=credential_refused(str(error)))
        except KeysUnreachableError:
            return Identity(NOBODY, by_key=True, refusal=keys_unreachable())
        except KeysBusyError:
            return Identity(NOBODY, by_key=True, refusal=keys_busy())
        return Identity(caller, by_key=True, in_browser=in_browser)

    def require(self, request: Request, scope: Scope, exercise: str | None = None) -> Caller:
        """Who asks, who may do so, for this exercise where one is named. Raises ProblemError."""
        identity = self._identity(request)
        caller = identity.caller
        if scope not in caller.scopes and scope not in self._always.caller.scopes:
            raise identity.refusal or (scope_missing(scope) if caller.key_id else key_needed())
        if identity.refusal is not None:
            raise identity.refusal
        require_reach(caller, exercise)
        return caller

    def require_recording(
        self, request: Request, exercise: str, origins: Collection[str]
    ) -> Caller:
        """Who records an attempt at this exercise. Raises ProblemError.

        A page records only from the service's own origin, or from one of ``origins``: a browser
        sends what any other page posts as well, without asking first, and only withholds the
        answer. Who shows a key in a header of its own has no need of that.
        """
        caller = self.require(request, Scope.RECORD, exercise)
        shows_key = bool(caller.key_id) and not self._identity(request).in_browser
        is_allowed = "*" in origins or request.headers.get("origin") in origins
        if not (shows_key or is_allowed or _is_same_origin(request)):
            raise origin_refused()
        return caller

    def require_solutions(self, request: Request, exercise: str | None = None) -> None:
        """Check the right to model solutions: of one exercise, or of all. Raises ProblemError."""
        caller = self.require_solutions_of_some(request)
        if caller.exercises is not None and exercise not in caller.exercises:
            raise other_exercise()

    def require_solutions_of_some(self, request: Request) -> Caller:
        """Who has that right, of whatever exercises. Raises ProblemError."""
        self._require_tutor(request, self._solutions, solutions_off())
        return self._identity(request).caller

    def require_tutor(self, request: Request, exercise: str | None) -> None:
        """Check the right to what is known of a class: in an exercise, or in all of them.

        Raises ProblemError.
        """
        self.require_tutor_of_one(request)
        self.require_reading(request, exercise)

    def require_tutor_of_one(self, request: Request) -> Caller:
        """Who has the same right, of whatever exercises. Raises ProblemError."""
        caller = self.require_reading_one(request)
        if caller.learner is not None:
            raise scope_missing(Scope.TUTOR)
        return caller

    def require_reading(self, request: Request, exercise: str | None) -> Caller:
        """Who asks for recorded attempts: of one exercise, or of all. Raises ProblemError.

        A learner with a token, too, who then reads no attempts but their own.
        """
        caller = self.require_reading_one(request)
        if caller.exercises is not None and exercise not in caller.exercises:
            raise other_exercise()
        return caller

    def require_reading_one(self, request: Request) -> Caller:
        """Who asks for one recorded attempt, of whatever exercise it is. Raises ProblemError."""
        caller = self._identity(request).caller
        if caller.learner is None:
            self._require_tutor(request, self._read_attempts, attempts_not_shown())
        elif self._read_attempts is False:
            raise attempts_not_shown()
        else:
            self.require(request, Scope.RECORD)
        return caller

    def require_change(self, request: Request, exercise: str | None) -> Caller:
        """Who may change what is recorded: of one exercise, or of all. Raises ProblemError."""
        caller = self.require_change_of_one(request)
        if caller.exercises is not None and exercise not in caller.exercises:
            raise other_exercise()
        return caller

    def require_change_of_one(self, request: Request) -> Caller:
        """Who may change one recorded attempt, of whatever exercise it is. Raises ProblemError.

        Where there are no keys, nobody but who is at the machine, even where others may read.
        """
        shown = None if self._read_attempts else self._read_attempts
        self._require_tutor(request, shown, attempts_not_changed())
        return self._identity(request).caller

    def require_key(self, request: Request) -> Caller:
        """The holder of a key, not of a token. Raises ProblemError."""
        identity = self._identity(request)
        if identity.refusal is not None:
            raise identity.refusal
        if identity.caller.learner is not None:
            raise learner_makes_token()
        if not identity.caller.key_id:
            raise key_needed() if identity.by_key else tokens_not_made()
        return identity.caller

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """A token with the rights of a holder of a key, bound to a learner."""
        assert self.keys is not None, "only keys make tokens"
        return self.keys.token(caller, expires_at)

    def shows_solutions(self, request: Request) -> bool:
        """Whether who asks has the right to model solutions: of all exercises, or of some."""
        try:
            self.require_solutions_of_some(request)
        except ProblemError:
            return False
        return True

    def close(self) -> None:
        """Write what waits, and end."""
        if self.keys is not None:
            self.keys.close()

    def _identity(self, request: Request) -> Identity:
        identity: Identity | None = request.scope.get(IDENTITY)
        if identity is not None:
            return identity
        # Where there may be keys, nobody is let in who did not pass the door.
        return self._without_keys(request.scope) if self.keys is None else _UNKNOWN

    def _without_keys(self, asked: Asked) -> Identity:
        if self._open.anywhere or _is_to_this_machine((asked.get("server") or ("",))[0]):
            return self._until_keys
        return self._always

    def _require_tutor(self, request: Request, shown: bool | None, refusal: ProblemError) -> None:
        identity = self._identity(request)
        caller = identity.caller
        if not identity.by_key:
            allowed = is_at_the_machine(request) if shown is None else shown
            if not (allowed and _is_same_origin(request)):
                raise refusal
            return
        if identity.refusal is not None:
            raise asking_for_password(identity.refusal)
        if Scope.TUTOR not in caller.scopes:
            raise scope_missing(Scope.TUTOR) if caller.key_id else key_needed(with_password=True)
        if shown is False or (identity.in_browser and not _is_same_origin(request)):
            raise refusal


def require_reach(caller: Caller, exercise: str | None) -> None:
    """Check that what is asked for may be of this exercise, if of any. Raises ProblemError."""
    if exercise is not None and not caller.reaches(exercise):
        raise other_exercise()


def is_at_the_machine(request: Request) -> bool:
    """Whether the request was made on this machine, to this machine, and for nobody else.

    Both ends of the connection are on it, the client asks for it by a name of its own (a page of
    another name that leads here asks for that name), and no proxy stands in between.
    """
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
    """Whether a proxy shows that it stands in between.

    nginx without a line of configuration adds no header and names this machine as host, but speaks
    HTTP/1.0 (ngx_http_proxy_module, "proxy_http_version", "proxy_set_header"), as no browser does.
    """
    return request.scope.get("http_version") == "1.0" or any(
        name in _OF_PROXIES or name.startswith("x-forwarded-") for name in request.headers
    )


@lru_cache(1024)
def is_loopback(host: str) -> bool:
    """Whether an address is one that only this machine reaches."""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _is_to_this_machine(server: str) -> bool:
    """Whether the address that was asked is a loopback address, or a socket in the file system."""
    return is_loopback(server) or not _is_address(server)


@lru_cache(1024)
def _is_address(host: str) -> bool:
    try:
        ip_address(host)
    except ValueError:
        return False
    return True


def _host_name(netloc: str) -> str:
    try:
        return urlsplit(f"//{netloc}").hostname or ""
    except ValueError:
        return ""


def _is_same_origin(request: Request) -> bool:
    """True if no page of another origin asks; programs name no origin.

    A browser says by Sec-Fetch-Site where a request comes from, also for pictures and scripts, for
    which it names no origin (Fetch Metadata). It says so over HTTPS and to this machine, and knows
    the scheme better than a service behind a proxy. Following a link from anywhere is no fault: the
    page that holds the link sees nothing of the answer.
    """
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


def _follows_link(request: Request) -> bool:
    """True if a browser opens the answer as a page of its own, in no frame."""
    headers = request.headers
    return (
        request.method in ("GET", "HEAD")
        and headers.get("sec-fetch-mode") == "navigate"
        and headers.get("sec-fetch-dest") == "document"
    )


def _credential(header: str) -> tuple[str, bool]:
    """The key or token in a header, and whether a browser sends it as a password.

    Another password is none: it may be that of a proxy, which has looked at it already.
    """
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
