"""The services of a platform's gradebook (AGS): send scores, and find or make columns."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from http import HTTPStatus
from time import monotonic
from typing import Any, Final
from urllib.parse import urlencode, urljoin, urlsplit, urlunsplit

import httpx

from service.lti.fetching import FetchError, TooLargeError, answer, content
from service.lti.registrations import Registration, origin_of, unusable
from service.lti.scores.access_tokens import AccessTokens, seconds_to_wait
from service.lti.scores.line_items import CHANGE, READ, SEND
from service.lti.scores.score_problems import (
    LaterError,
    RefusedError,
    ThisLaterError,
)
from service.translations import say

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

    def __init__(self, tokens: AccessTokens) -> None:
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

        ``redirects`` also allows a redirect as the response. Raises ScoreError.
        """
        # If the token is refused, try once with a new token. With ``redirects``, TooLargeError may
        # be raised.
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
    """Return the address for the scores of a line item (gradebook column)."""
    # The query string of the line item's address stays at the end.
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
