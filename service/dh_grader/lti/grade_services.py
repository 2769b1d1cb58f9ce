"""The services of a platform's gradebook (AGS): scores, columns, and access tokens.

When a score is sent, and again, is decided in ``outbox.py``.
"""

import json
import re
import secrets
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from http import HTTPStatus
from time import monotonic
from typing import Any, Final
from urllib.parse import urlencode, urljoin, urlsplit, urlunsplit

import httpx
import jwt
from sqlalchemy import Connection, Engine, select, update

from dh_grader.access import Secret
from dh_grader.lti.fetching import (
    FetchError,
    SigningKey,
    TooLargeError,
    answer,
    content,
    ensure_key,
    signing_key,
)
from dh_grader.lti.registrations import LtiError, Registration, origin_of, short_value, unusable
from dh_grader.regex import regex
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.database import in_transaction, queue_scores
from dh_grader.store.tables import assignments, attempts, line_items, resource_links, scores
from dh_grader.translations import ENGLISH, Language, Sentence, SentenceValue, say, template, told

# --- The reasons why a score did not reach a platform, as sentences for tutors


# By their names. Braces are places for values.
SCORE_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": template(
        "The platform refuses the score (status {status}). Is the learner still "
        "enrolled in the course there?"
    ),
    "no-line-item": template(
        "The platform has no column for this assignment any more. Open the assignment "
        "from the course at the platform, then send again."
    ),
    "no-token-address": template(
        "No token address is registered for this platform. Register it, then send again."
    ),
    "no-scope": template(
        "The platform does not allow to make a column for the assignment. Allow it at the "
        "platform, open the assignment there, then send again."
    ),
    "token-refused": template("The platform gives no access token: {reason}"),
    "busy": template("The platform asks to wait (status {status})."),
    "unreachable": template("The platform cannot be reached: {reason}"),
    "unusable-answer": template("The answer of the platform cannot be used: {reason}"),
    "unauthorised": template("The platform refuses the access token (status 401)."),
    "stamp": template("The platform has a score with a later time."),
    "no-secret": template(
        "The secret of the service is not the one with which its keys were made."
    ),
    "failed": template("The service could not send the score. Its log has the cause."),
}
# The same for reports on handed-in files, where the sentence is another one.
_REPORT_PROBLEMS: Final[Mapping[str, str]] = {
    "not-accepted": template("The platform refuses the report (status {status})."),
    "no-token-address": template("No token address is registered for this platform."),
    "stamp": template("The platform has a report with a later time."),
    "failed": template("The service could not grade the files. Its log has the cause."),
}


class ScoreError(Exception):
    """A score was not sent; ``name`` is one of ``SCORE_PROBLEMS``."""

    def __init__(self, name: str, /, **values: object) -> None:
        self.name = name
        self.values = {key: short_value(value) for key, value in values.items()}
        super().__init__(Sentence(SCORE_PROBLEMS[name], self.values))

    @property
    def stored(self) -> str:
        """The problem as a text for the database."""
        return json.dumps([self.name, _packed(self.values)])


class RefusedError(ScoreError):
    """The platform will not take the score, however often it is sent."""


class LaterError(ScoreError):
    """The platform accepts nothing now; ``seconds`` is the time that it asks to wait, or None."""

    def __init__(self, name: str, /, seconds: float | None = None, **values: object) -> None:
        self.seconds = seconds
        super().__init__(name, **values)


class ThisLaterError(ScoreError):
    """The platform does not accept this score now, but may accept other scores."""


def problem_told(
    stored: str | None, language: Language = ENGLISH, *, of_report: bool = False
) -> str:
    """Return the sentence that describes a stored problem, or "".

    ``of_report`` is True for a report on files, False for a score.
    """
    if not stored:
        return ""
    name, values = json.loads(stored)
    sentences = {**SCORE_PROBLEMS, **_REPORT_PROBLEMS} if of_report else SCORE_PROBLEMS
    return told(Sentence(sentences[name], _unpacked(values)), language.translation)


def _packed(values: Mapping[str, SentenceValue]) -> dict[str, Any]:
    # JSON cannot store a Sentence: store its template and values.
    return {
        key: [value.template, _packed(value.values)] if isinstance(value, Sentence) else value
        for key, value in values.items()
    }


def _unpacked(values: Mapping[str, Any]) -> dict[str, SentenceValue]:
    return {
        key: Sentence(value[0], _unpacked(value[1])) if isinstance(value, list) else value
        for key, value in values.items()
    }


# --- The services of a platform's gradebook (AGS): send scores, and find or make columns


_SCORE: Final = "application/vnd.ims.lis.v1.score+json"
_ITEM: Final = "application/vnd.ims.lis.v2.lineitem+json"
_ITEMS: Final = "application/vnd.ims.lis.v2.lineitemcontainer+json"
_BUSY: Final = {
    HTTPStatus.TOO_MANY_REQUESTS,
    HTTPStatus.BAD_GATEWAY,
    HTTPStatus.SERVICE_UNAVAILABLE,
    HTTPStatus.GATEWAY_TIMEOUT,
}
# Another line item may take the score.
_NOT_THERE: Final = {HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.GONE}
_MOST_PAGES: Final = 20
# How long the search for a line item may take, with all pages (seconds).
_SEARCH_TIME: Final = 15.0


class NotThereError(RefusedError):
    """The platform has no such line item (gradebook column), or no such learner."""


@dataclass(frozen=True, slots=True)
class Column:
    """A gradebook column of a platform to find or to make."""

    lineitems_url: str | None
    scopes: str
    link: str
    title: str
    assignment: str
    max_points: float


class GradeServices:
    """Uses the gradebook services of platforms, with the access tokens of this process."""

    def __init__(self, tokens: "AccessTokens") -> None:
        self._tokens = tokens

    def send_score(self, registration: Registration, url: str, message: Any) -> None:
        """Send a score to a platform. Raises RefusedError, LaterError, ThisLaterError."""
        sent = {"content": json.dumps(message).encode(), "headers": {"Content-Type": _SCORE}}
        with self.asked(registration, scores_address(url), "POST", SEND, sent):
            return

    def line_item(self, registration: Registration, column: Column) -> tuple[str, bool]:
        """Return the address of a gradebook column, and True if it is new. Raises ScoreError."""
        if (found := self.found_line_item(registration, column)) is not None:
            return found, False
        if column.lineitems_url is None or CHANGE not in column.scopes.split():
            raise RefusedError("no-scope")
        item = {
            "scoreMaximum": column.max_points,
            "label": column.title,
            "resourceLinkId": column.link,
            "resourceId": column.assignment,
            "tag": "dh-grader",
        }
        sent = {"content": json.dumps(item).encode(), "headers": {"Content-Type": _ITEM}}
        with self.asked(registration, column.lineitems_url, "POST", CHANGE, sent) as response:
            made = _json(response)
        return _item_address(made, column.lineitems_url), True

    def found_line_item(self, registration: Registration, column: Column) -> str | None:
        """Return the address of an existing gradebook column, or None. Raises ScoreError."""
        scopes = " ".join(each for each in (CHANGE, READ) if each in column.scopes.split())
        if column.lineitems_url is None or not scopes:
            return None
        url: str | None = _with_query(column.lineitems_url, resource_link_id=column.link)
        until = monotonic() + _SEARCH_TIME
        for _ in range(_MOST_PAGES):
            assert url is not None
            asked = {"headers": {"Accept": _ITEMS}, "until": until}
            with self.asked(registration, url, "GET", scopes, asked) as response:
                items, following = _json(response), response.links.get("next", {}).get("url")
            for each in items if isinstance(items, list) else ():
                if isinstance(each, dict) and each.get("resourceLinkId") == column.link:
                    return _item_address(each, column.lineitems_url)
            if not following:
                return None
            url = _of_platform(urljoin(url, following), column.lineitems_url)
        return None

    @contextmanager
    def asked(
        self,
        registration: Registration,
        url: str,
        method: str,
        scopes: str,
        more: Mapping[str, Any],
        *,
        redirects: bool = False,
    ) -> Iterator[httpx.Response]:
        """Send a request with an access token, and yield the successful response.

        If the token is refused, try once with a new token. ``redirects`` also allows a redirect as
        the response. Raises ScoreError, and with ``redirects`` also TooLargeError.
        """
        for is_last in (False, True):
            token = self._tokens.token(registration, scopes)
            headers = {**more["headers"], "Authorization": f"Bearer {token}"}
            sent = {**more, "headers": headers}
            try:
                with answer(url, method, local=registration.is_development, **sent) as response:
                    if response.status_code == HTTPStatus.UNAUTHORIZED:
                        self._tokens.forget(registration, scopes)
                        if not is_last:
                            continue
                    if not (redirects and response.is_redirect):
                        _check(response)
                    yield response
                    return
            except FetchError as error:
                if redirects and isinstance(error, TooLargeError):
                    raise
                raise LaterError("unreachable", reason=error) from error


def scores_address(url: str) -> str:
    """Return the address for the scores of a line item; a query string stays at the end."""
    parts = urlsplit(url)
    return urlunsplit(parts._replace(path=f"{parts.path.rstrip('/')}/scores"))


def _check(response: httpx.Response) -> None:
    status = response.status_code
    if response.is_success:
        return
    headers = response.headers
    if status in _BUSY or (status == HTTPStatus.FORBIDDEN and _is_used_up(headers)):
        raise LaterError("busy", seconds_to_wait(headers), status=status)
    if status == HTTPStatus.UNAUTHORIZED:
        raise LaterError("unauthorised")
    if status == HTTPStatus.CONFLICT:
        raise ThisLaterError("stamp")
    if status >= HTTPStatus.INTERNAL_SERVER_ERROR or status == HTTPStatus.REQUEST_TIMEOUT:
        raise ThisLaterError("busy", status=status)
    if status in _NOT_THERE:
        raise NotThereError("not-accepted", status=status)
    raise RefusedError("not-accepted", status=status)


def _is_used_up(headers: Mapping[str, str]) -> bool:
    # Canvas answers 403 when we have sent too many requests.
    try:
        return float(headers.get("x-rate-limit-remaining", "")) <= 0
    except ValueError:
        return False


def _json(response: httpx.Response) -> Any:
    try:
        return json.loads(content(response))
    except (ValueError, RecursionError) as error:
        raise ThisLaterError("unusable-answer", reason=say("it is not JSON")) from error


def _item_address(item: Any, lineitems_url: str) -> str:
    found = item.get("id") if isinstance(item, dict) else None
    if not isinstance(found, str) or len(found) > 1000:
        raise ThisLaterError("unusable-answer", reason=say("the line item has no address"))
    return _of_platform(found, lineitems_url)


def _of_platform(url: str, lineitems_url: str) -> str:
    # The access token is sent only to the platform's own host.
    if unusable(url, local=True) or origin_of(url) != origin_of(lineitems_url):
        raise ThisLaterError("unusable-answer", reason=say("an address is of another host"))
    return url


def _with_query(url: str, **more: str) -> str:
    parts = urlsplit(url)
    query = "&".join(filter(None, (parts.query, urlencode(more))))
    return urlunsplit(parts._replace(query=query))


# --- Access tokens of platforms (OAuth client credentials)


_ASSERTION: Final = "urn:ietf:params:oauth:client-assertion-type:jwt-bearer"
# How long our assertion is valid. It begins a little in the past: clocks differ.
_VALID: Final = timedelta(minutes=5)
_PAST: Final = timedelta(seconds=5)
# A token is used until this long before its end, and at most this long (seconds).
_BEFORE_END: Final = 60.0
_LONGEST: Final = 86_400.0
_USUAL: Final = 3600.0
_TOKEN: Final = regex(r"[\x21-\x7e]{1,16000}")


class AccessTokens:
    """The access tokens of this process, by registration and scopes."""

    def __init__(self, now: Callable[[], datetime], key: Callable[[], SigningKey]) -> None:
        # ``now`` returns the time, and ``key`` our signing key.
        self._now, self._key = now, key
        self._known: dict[tuple[str, str], tuple[str, datetime]] = {}

    def token(self, registration: Registration, scopes: str) -> str:
        """Return an access token for these scopes. Raises RefusedError, LaterError."""
        place, now = (registration.id, scopes), self._now()
        known = self._known.get(place)
        if known is not None and now < known[1]:
            return known[0]
        token, seconds = fetched_token(registration, scopes, self._key(), now)
        kept = max(min(seconds, _LONGEST) - _BEFORE_END, seconds / 2)
        self._known[place] = token, now + timedelta(seconds=min(kept, _LONGEST))
        return token

    def forget(self, registration: Registration, scopes: str) -> None:
        """Forget a token that the platform does not accept any more."""
        self._known.pop((registration.id, scopes), None)


def fetched_token(
    registration: Registration, scopes: str, key: SigningKey, now: datetime
) -> tuple[str, float]:
    """Fetch an access token; return it and its lifetime in seconds.

    Raises RefusedError, LaterError.
    """
    if registration.token_url is None:
        raise RefusedError("no-token-address")
    claims = {
        "iss": registration.client_id,
        "sub": registration.client_id,
        "aud": registration.audience or registration.token_url,
        "iat": int((now - _PAST).timestamp()),
        "exp": int((now + _VALID).timestamp()),
        "jti": secrets.token_urlsafe(16),
    }
    fields = {
        "grant_type": "client_credentials",
        "client_assertion_type": _ASSERTION,
        "client_assertion": jwt.encode(claims, key.private_key, "RS256", {"kid": key.id}),
        "scope": scopes,
    }
    local = registration.is_development
    try:
        with answer(registration.token_url, "POST", local=local, data=fields) as response:
            if response.status_code != HTTPStatus.OK:
                reason = say("the status is {status}", status=response.status_code)
                raise LaterError("token-refused", seconds_to_wait(response.headers), reason=reason)
            found = json.loads(content(response))
    except FetchError as error:
        raise LaterError("token-refused", reason=error) from error
    except (ValueError, RecursionError) as error:
        raise LaterError("token-refused", reason=say("the answer is not JSON")) from error
    token = found.get("access_token") if isinstance(found, dict) else None
    if not isinstance(token, str) or not _TOKEN.fullmatch(token):
        raise LaterError("token-refused", reason=say("the answer has no token"))
    seconds = found.get("expires_in", _USUAL)
    is_number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
    return token, float(seconds) if is_number and 0 < seconds < 1e9 else _USUAL


def available_key(engine: Engine, secret: Secret, now: datetime) -> SigningKey:
    """Return our signing key; make one if there is none. Raises LaterError."""

    def found() -> SigningKey:
        with engine.connect() as connection:
            return signing_key(connection, secret, now)

    try:
        return found()
    except LtiError:
        in_transaction(engine, lambda it: ensure_key(it, secret, now))
    try:
        return found()
    except LtiError as error:
        raise LaterError("no-secret") from error


def seconds_to_wait(headers: Mapping[str, str]) -> float | None:
    """Return the seconds of the header ``Retry-After``, or None."""
    text = headers.get("retry-after", "")
    return float(text) if re.fullmatch(r"\d{1,9}", text, re.ASCII) else None


# --- Line items: the columns of a platform's gradebook, one for each resource link


AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SEND: Final = f"{AGS}score"
CHANGE: Final = f"{AGS}lineitem"
READ: Final = f"{AGS}lineitem.readonly"


def ensure_line_item(connection: Connection, link: int) -> None:
    """Store the line item (gradebook column) of a resource link, and queue earlier scores.

    If its address is unknown, the sender of the first score looks up the line item, or makes it.
    """
    row = connection.execute(
        select(resource_links).where(resource_links.c.number == link)
    ).one_or_none()
    if row is None or row.assignment is None or not takes_scores(row.scopes):
        return
    if row.lineitem_url is None and row.lineitems_url is None:
        return
    values = {
        "context": row.context,
        "resource_link": row.number,
        "assignment": row.assignment,
        "url": row.lineitem_url,
        "max_points": max_points(connection, row.assignment),
        "is_own": False,
    }
    statement = insert_or_ignore(line_items)[connection.dialect.name]
    if connection.execute(statement.values(values)).rowcount:
        of_assignment = (attempts.c.assignment == row.assignment) & attempts.c.ordinal.is_not(None)
        queue_scores(connection, of_assignment)
    elif row.lineitem_url is not None:
        mine = (line_items.c.resource_link == link) & (line_items.c.assignment == row.assignment)
        is_new = line_items.c.url.is_distinct_from(row.lineitem_url)
        connection.execute(update(line_items).where(mine, is_new).values(url=row.lineitem_url))


def try_refused_again(connection: Connection, learner: str, now: datetime) -> None:
    """Queue a learner's refused scores again, because after a launch the platform knows them."""
    mine = (scores.c.learner == learner) & (scores.c.state == "refused")
    values = {"state": "waiting", "next_try_at": now, "version": scores.c.version + 1}
    connection.execute(update(scores).where(mine).values(values))


def takes_scores(scopes: str) -> bool:
    """True if the scopes of a platform allow us to send scores."""
    return SEND in scopes.split()


def max_points(connection: Connection, assignment: int) -> float:
    """Return the sum of the points of an assignment's exercises."""
    mine = assignments.c.number == assignment
    text: str = connection.execute(select(assignments.c.exercises).where(mine)).scalar_one()
    return float(round(sum(each["points"] for each in json.loads(text)), 6))
