"""Read the members of a course from its platform, page by page."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from http import HTTPStatus
from time import monotonic
from typing import Any, Final
from urllib.parse import parse_qs, urljoin, urlsplit, urlunsplit

from service.contract.courses import MOST_LEARNERS
from service.formats.shared.plain_text import visible
from service.lti.fetching import FetchError, answer, content
from service.lti.registrations import Registration, origin_of, unusable
from service.lti.roles import LtiRole, role_of
from service.translations import say

SCOPE: Final = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly"
_MEDIA_TYPE: Final = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json"
# Limits of what a platform may send.
MOST_PAGES: Final = 200
LARGEST_PAGE: Final = 4 * 1024 * 1024
# How long all pages together may take (seconds), and the learners that we ask for on one page: a
# page of a whole course would take platforms longer than one exchange may.
_ROSTER_TIME: Final = 60.0
_PAGE_SIZE: Final = 200
_LONGEST_ID: Final = 255
_LONGEST_NAME: Final = 200


@dataclass(frozen=True, slots=True)
class Member:
    """A learner in the roster of a platform; ``name`` is "" if the platform does not send it."""

    sub: str
    name: str
    family_name: str = ""


def read_members(registration: Registration, url: str, token: str) -> list[Member]:
    """Return the active learners of a course, each once. Raises FetchError."""
    # Inactive and deleted members, test users and members with other roles are left out.
    found: dict[str, Member] = {}
    for page in _pages(registration, url, token):
        listed = page.get("members")
        if not isinstance(listed, list):
            raise FetchError(say("the answer has no list of members"))
        for each in listed:
            member = _member(each)
            if member is not None:
                found[member.sub] = member
        if len(found) > MOST_LEARNERS:
            raise FetchError(say("the course has more than {most} learners", most=MOST_LEARNERS))
    return list(found.values())


def _pages(registration: Registration, url: str, token: str) -> Iterator[Mapping[str, Any]]:
    # All pages must have the same origin.
    local, first = registration.is_development, url
    until = monotonic() + _ROSTER_TIME
    url = _in_pages(url)
    for _ in range(MOST_PAGES):
        page, following = _page(url, token, until, local=local)
        yield page
        if not following:
            return
        url = urljoin(url, following)
        if unusable(url, local=local) or origin_of(url) != origin_of(first):
            raise FetchError(say("the next page is at another host"))
    raise FetchError(say("the roster has more than {most} pages", most=MOST_PAGES))


def _page(url: str, token: str, until: float, *, local: bool) -> tuple[Mapping[str, Any], str]:
    # The address of the next page may be "".
    headers = {"Authorization": f"Bearer {token}", "Accept": _MEDIA_TYPE}
    with answer(url, local=local, headers=headers, until=until) as response:
        if response.status_code != HTTPStatus.OK:
            raise FetchError(
                say("the platform does not give the roster ({status})", status=response.status_code)
            )
        try:
            page = json.loads(content(response, LARGEST_PAGE))
        except (ValueError, RecursionError) as error:
            raise FetchError(say("the roster is not JSON")) from error
        following = response.links.get("next", {}).get("url", "")
    if not isinstance(page, dict):
        raise FetchError(say("the answer has no list of members"))
    return page, following


def _in_pages(url: str) -> str:
    # The platform may choose another size. A size in its own address stays.
    parts = urlsplit(url)
    if "limit" in parse_qs(parts.query):
        return url
    query = "&".join(filter(None, (parts.query, f"limit={_PAGE_SIZE}")))
    return urlunsplit(parts._replace(query=query))


def _member(entry: Any) -> Member | None:
    if not isinstance(entry, dict) or entry.get("status", "Active") != "Active":
        return None
    sub, roles = entry.get("user_id"), entry.get("roles")
    if not isinstance(sub, str) or not 0 < len(sub) <= _LONGEST_ID or not isinstance(roles, list):
        return None
    full = {_full(each) for each in roles if isinstance(each, str)}
    if role_of(full, has_id=True) is not LtiRole.LEARNER:
        return None
    name = entry.get("name")
    if not isinstance(name, str) or not name.strip():
        parts = [entry.get(each) for each in ("given_name", "family_name")]
        name = " ".join(each for each in parts if isinstance(each, str))
    family = entry.get("family_name")
    return Member(sub, _line(name), _line(family if isinstance(family, str) else ""))


def _line(text: str) -> str:
    return visible(" ".join(text.split()))[:_LONGEST_NAME].strip()


def _full(role: str) -> str:
    # In rosters, roles of a course may be short: ``Learner``.
    is_short = "/" not in role and ":" not in role
    return f"http://purl.imsglobal.org/vocab/lis/v2/membership#{role}" if is_short else role
