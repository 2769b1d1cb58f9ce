"""How a platform joins: our description, invitations, registration, and a self-test.

What is stored of a platform is in ``registrations.py``.
"""

import json
import secrets
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from email.utils import parsedate_to_datetime
from http import HTTPStatus
from typing import Any, Final, NamedTuple
from urllib.parse import urlsplit

from pydantic import ValidationError
from sqlalchemy import Connection, insert, select, update

from dh_grader.courses import CourseError, zone_named
from dh_grader.formats.texts import visible
from dh_grader.lti.fetching import FetchError, SigningKey, answer, content, usable_keys
from dh_grader.lti.grade_services import AGS, SEND, ScoreError, fetched_token
from dh_grader.lti.handed_files import NOTICES, READ, REPORT
from dh_grader.lti.launch import DEEP_LINKING, digest
from dh_grader.lti.registrations import (
    KEYS_PATH,
    LAUNCH_PATH,
    LOCAL_HOSTS,
    LOGIN_PATH,
    NewRegistration,
    Registration,
    RegistrationError,
    add_registration,
    cause_without_values,
    origin_of,
    registration,
    unusable,
)
from dh_grader.store.tables import invitations, registrations
from dh_grader.translations import joined, say

# --- Describe this service to a platform: as a registration request, or as a file for Canvas


NAME: Final = "DH Grader"
DESCRIPTION: Final = "Forward kinematics and Denavit-Hartenberg tables, graded at once."
TOOL: Final = "https://purl.imsglobal.org/spec/lti-tool-configuration"
SCOPES: Final = (
    f"{AGS}lineitem",
    f"{AGS}lineitem.readonly",
    f"{AGS}result.readonly",
    f"{AGS}score",
    "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly",
)
# For files that students hand in at the platform: notices, the files, and reports on them.
# Platforms that do not know these scopes may refuse a tool that wants them.
FILE_SCOPES: Final = (NOTICES, READ, REPORT)
FILE_PLACEMENT: Final = "ActivityAssetProcessor"
# The places of a platform in which tutors choose exercises. Those of Canvas have names of its own.
CANVAS_PLACEMENTS: Final = ("assignment_selection", "link_selection")
PLACEMENTS: Final = ("ContentArea", *CANVAS_PLACEMENTS, FILE_PLACEMENT)


def registration_request(
    address: str, scopes: Collection[str] | None, messages: dict[str, list[str]] | None
) -> dict[str, Any]:
    """Return the body of a dynamic registration request.

    ``scopes`` and ``messages`` are those that the platform supports, or None if unknown.
    """
    launch = address + LAUNCH_PATH
    linking: dict[str, Any] = {"type": DEEP_LINKING, "target_link_uri": launch, "label": NAME}
    known = (messages or {}).get(DEEP_LINKING, [])
    if placements := [each for each in PLACEMENTS if each in known]:
        linking["placements"] = placements
    wanted = messages is None or DEEP_LINKING in messages
    return {
        "application_type": "web",
        "grant_types": ["client_credentials", "implicit"],
        "response_types": ["id_token"],
        "initiate_login_uri": address + LOGIN_PATH,
        "redirect_uris": [launch],
        "client_name": NAME,
        "jwks_uri": address + KEYS_PATH,
        "token_endpoint_auth_method": "private_key_jwt",
        "scope": " ".join(
            SCOPES if scopes is None else (x for x in (*SCOPES, *FILE_SCOPES) if x in scopes)
        ),
        TOOL: {
            "domain": urlsplit(address).netloc,
            "description": DESCRIPTION,
            "target_link_uri": launch,
            "claims": ["iss", "sub"],
            "messages": [linking] if wanted else [],
        },
    }


def canvas_configuration(address: str, *, files: bool = False) -> dict[str, Any]:
    """Return the JSON that an admin of Canvas pastes to add this service.

    With ``files``, the service also grades files that students hand in.
    """
    launch = address + LAUNCH_PATH
    placements = [
        {
            "placement": each,
            "message_type": DEEP_LINKING,
            "target_link_uri": launch,
            "text": NAME,
            "enabled": True,
        }
        for each in (*CANVAS_PLACEMENTS, *([FILE_PLACEMENT] if files else []))
    ]
    return {
        "title": NAME,
        "description": DESCRIPTION,
        "target_link_uri": launch,
        "oidc_initiation_url": address + LOGIN_PATH,
        "public_jwk_url": address + KEYS_PATH,
        "scopes": [*SCOPES, *(FILE_SCOPES if files else [])],
        "custom_fields": {},
        "extensions": [
            {
                "platform": "canvas.instructure.com",
                "domain": urlsplit(address).netloc,
                "privacy_level": "anonymous",
                "settings": {"text": NAME, "placements": placements},
            }
        ],
    }


# --- Invitations: one-time links by which a platform registers itself
#
# The database has only a digest of the secret text in a link. The text begins with ``held-`` if the
# registration must wait for ``dh-grader lti allow``; nobody can remove that, because it is part of
# the digested text.


LONGEST_DAYS: Final = 90
_HELD: Final = "held-"


@dataclass(frozen=True, slots=True)
class Invitation:
    """A valid invitation; ``waits`` is True if an admin must allow the registration."""

    digest: str
    name: str
    address: str
    zone: str
    waits: bool

    @property
    def is_development(self) -> bool:
        """True if the address of this service is local, as in development."""
        return any(self.address.startswith(f"http://{host}") for host in LOCAL_HOSTS)


def invite(
    connection: Connection,
    name: str,
    address: str,
    zone: str,
    now: datetime,
    *,
    days: int,
    waits: bool,
) -> str:
    """Make an invitation; return the link for the admin of the platform.

    Raises RegistrationError.
    """
    address = address.rstrip("/")
    if reason := unusable(address, local=True):
        raise RegistrationError(joined(": ", ["address", reason]))
    try:
        zone_named(zone)
    except CourseError as error:
        raise RegistrationError(error.args[0]) from error
    text = f"{_HELD if waits else ''}{secrets.token_urlsafe(24)}"
    values = {"digest": digest(text), "name": name, "address": address, "zone": zone}
    times = {"created_at": now, "expires_at": now + timedelta(days=days)}
    connection.execute(insert(invitations).values(values | times))
    return f"{address}/lti/register?invitation={text}"


def invitation_of(connection: Connection, text: str, now: datetime) -> Invitation:
    """Return the invitation with this secret text. Raises RegistrationError."""
    mine = invitations.c.digest == digest(text)
    row = connection.execute(select(invitations).where(mine)).one_or_none()
    if row is None or row.used_at is not None or row.expires_at <= now:
        raise RegistrationError(say("This link is not valid, was used already, or has expired."))
    return Invitation(row.digest, row.name, row.address, row.zone, text.startswith(_HELD))


def claim(connection: Connection, text: str, now: datetime) -> Invitation:
    """Mark an invitation as used, and return it. Raises RegistrationError."""
    found = invitation_of(connection, text, now)
    mine = (invitations.c.digest == found.digest) & invitations.c.used_at.is_(None)
    if not connection.execute(update(invitations).where(mine).values(used_at=now)).rowcount:
        raise RegistrationError(say("This link is being used just now."))
    return found


def release(connection: Connection, invitation: Invitation) -> None:
    """Make an invitation usable again after a failed registration."""
    mine = (invitations.c.digest == invitation.digest) & invitations.c.registration.is_(None)
    connection.execute(update(invitations).where(mine).values(used_at=None))


def accept(
    connection: Connection, invitation: Invitation, values: dict[str, Any], now: datetime
) -> Registration:
    """Add the registration of an invited platform. Raises RegistrationError."""
    try:
        new = NewRegistration(
            name=invitation.name,
            address=invitation.address,
            zone=invitation.zone,
            is_development=invitation.is_development,
            **values,
        )
    except ValidationError as error:
        raise RegistrationError(say("The platform has sent unusable values.")) from error
    made = add_registration(connection, new, now)
    if invitation.waits:
        mine = registrations.c.id == made.id
        connection.execute(update(registrations).where(mine).values(any_deployment=False))
    mine = invitations.c.digest == invitation.digest
    connection.execute(update(invitations).where(mine).values(registration=made.id))
    return made


def allow(connection: Connection, registration_id: str) -> None:
    """Allow a waiting registration to launch. Raises RegistrationError."""
    registration(connection, registration_id)
    mine = registrations.c.id == registration_id
    connection.execute(update(registrations).where(mine).values(any_deployment=True))


# --- Dynamic registration: read a platform's configuration, and register this service there


_PLATFORM: Final = "https://purl.imsglobal.org/spec/lti-platform-configuration"
_ADDRESSES: Final = (
    "issuer",
    "authorization_endpoint",
    "token_endpoint",
    "jwks_uri",
    "registration_endpoint",
)
# Canvas in the cloud has one issuer, and serves its configuration from another host.
_OTHER_HOSTS: Final = {
    "https://canvas.instructure.com": "https://sso.canvaslms.com",
    "https://canvas.beta.instructure.com": "https://sso.beta.canvaslms.com",
    "https://canvas.test.instructure.com": "https://sso.test.canvaslms.com",
}
_LONGEST_TOKEN: Final = 8000
_LONGEST_ANSWER: Final = 600


def register_at(invitation: Invitation, configuration: str, token: str) -> dict[str, Any]:
    """Register this service at a platform; return the values of the registration.

    ``configuration`` is the address of the platform's OpenID configuration. ``token`` is "" for
    platforms that send no registration token. Raises RegistrationError.
    """
    local = invitation.is_development
    if reason := unusable(configuration, local=local):
        raise RegistrationError(
            say("The address of the configuration cannot be used ({reason}).", reason=reason)
        )
    if len(token) > _LONGEST_TOKEN or not (token.isascii() and token.isprintable()):
        raise RegistrationError(say("The registration token is no token."))
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    try:
        found = _asked(configuration, "GET", local=local, headers=headers)
        _check(found, configuration, local=local)
        body = registration_request(invitation.address, _scopes(found), _messages(found))
        endpoint = found["registration_endpoint"]
        made = _asked(endpoint, "POST", local=local, headers=headers, json=body)
    except FetchError as error:
        raise RegistrationError(
            say("The platform cannot be registered: {reason}.", reason=error.args[0])
        ) from error
    client = made.get("client_id")
    # Some platforms have numbers.
    client = str(client) if isinstance(client, int) and not isinstance(client, bool) else client
    if not isinstance(client, str) or not 0 < len(client) <= 255:
        raise RegistrationError(say("The platform gives no client id."))
    audience = found.get("authorization_server")
    return {
        "issuer": found["issuer"],
        "client_id": client,
        "auth_url": found["authorization_endpoint"],
        "jwks_url": found["jwks_uri"],
        "token_url": found["token_endpoint"],
        "audience": audience if isinstance(audience, str) and 0 < len(audience) <= 1000 else None,
    }


def _asked(url: str, method: str, *, local: bool, **more: Any) -> dict[str, Any]:
    # No redirect is followed, because the request contains the registration token.
    with answer(url, method, local=local, **more) as response:
        text = content(response)
        if response.status_code not in (HTTPStatus.OK, HTTPStatus.CREATED):
            said = visible(" ".join(text.decode(errors="replace").split())[:_LONGEST_ANSWER])
            raise FetchError(
                say(
                    "the platform answers with status {status}: {said}",
                    status=response.status_code,
                    said=said,
                )
            )
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FetchError(say("the answer is not JSON")) from error
    if not isinstance(found, dict):
        raise FetchError(say("the answer is no JSON object"))
    return found


def _check(found: Mapping[str, Any], configuration: str, *, local: bool) -> None:
    for name in _ADDRESSES:
        value = found.get(name)
        if not isinstance(value, str) or not 0 < len(value) <= 1000:
            raise FetchError(say("its configuration has no {name}", name=name))
        if reason := unusable(value, local=local):
            raise FetchError(
                say("the {name} in its configuration {reason}", name=name, reason=reason)
            )
    asked, issuer = origin_of(configuration), origin_of(found["issuer"])
    if asked not in (issuer, _OTHER_HOSTS.get(issuer)):
        raise FetchError(say("its configuration is of another issuer"))
    # The token goes there.
    if origin_of(found["registration_endpoint"]) not in (asked, issuer):
        raise FetchError(say("the registration_endpoint in its configuration is at another host"))
    algorithms = found.get("id_token_signing_alg_values_supported", ["RS256"])
    if not isinstance(algorithms, list) or "RS256" not in algorithms:
        raise FetchError(say("it does not sign by RS256"))


def _scopes(found: Mapping[str, Any]) -> list[str] | None:
    scopes = found.get("scopes_supported")
    return [each for each in scopes if isinstance(each, str)] if isinstance(scopes, list) else None


def _messages(found: Mapping[str, Any]) -> dict[str, list[str]] | None:
    platform = found.get(_PLATFORM)
    listed = platform.get("messages_supported") if isinstance(platform, dict) else None
    if not isinstance(listed, list):
        return None
    messages = {}
    for each in listed:
        if isinstance(each, dict) and isinstance(each.get("type"), str):
            places = each.get("placements")
            places = places if isinstance(places, list) else []
            messages[each["type"]] = [place for place in places if isinstance(place, str)]
    return messages


# --- The self-test of a platform's registration: keys, clocks, access token and last launch


# The greatest difference of clocks (seconds): messages may come from ten seconds ahead.
_CLOCKS: Final = 10.0


class CheckLine(NamedTuple):
    """A line of the self-test; ``is_fine`` is None if the line only informs."""

    is_fine: bool | None
    text: str


def check_registration(registration: Registration, key: SigningKey) -> Iterator[CheckLine]:
    """Yield the lines of the self-test, which asks the platform for keys and an access token."""
    try:
        with answer(registration.jwks_url, local=registration.is_development) as response:
            if response.status_code != HTTPStatus.OK:
                raise FetchError(say("the status is {status}", status=response.status_code))
            try:
                keys = usable_keys(json.loads(content(response)))
            except (ValueError, RecursionError) as error:
                raise FetchError(say("the answer is not JSON")) from error
            date = response.headers.get("date")
    except FetchError as error:
        yield CheckLine(False, say("Keys of the platform: {reason}", reason=error.args[0]))
    else:
        usable = sum(key is not None for key in keys.values())
        count = len(keys)
        said = say("Keys of the platform: {usable} of {all} can be used", usable=usable, all=count)
        yield CheckLine(usable > 0, said)
        yield _clocks(date)
    yield _token(registration, key)
    launched = registration.launched_at
    told = f"{launched:%Y-%m-%d %H:%M} UTC" if launched else say("never")
    yield CheckLine(None, say("Last launch: {when}", when=told))
    if refusal := last_refusal(registration):
        yield CheckLine(None, say("Last refusal: {refusal}", refusal=refusal))


def last_refusal(registration: Registration) -> str:
    """Return when and why a launch was last refused, or "" if none was refused."""
    if registration.refused_at is None:
        return ""
    moment = f"{registration.refused_at:%Y-%m-%d %H:%M} UTC"
    return say(
        "{moment}: {cause}", moment=moment, cause=cause_without_values(registration.refusal or "")
    )


def _token(registration: Registration, key: SigningKey) -> CheckLine:
    if registration.token_url is None:
        return CheckLine(
            None, say("Access token: no token address is registered; no scores are sent")
        )
    try:
        fetched_token(registration, SEND, key, datetime.now(UTC))
    except ScoreError as error:
        return CheckLine(False, say("Access token: {reason}", reason=error.args[0]))
    return CheckLine(True, say("Access token: the platform gives one for scores"))


def _clocks(date: str | None) -> CheckLine:
    try:
        theirs = parsedate_to_datetime(date or "")
        apart = abs((datetime.now(UTC) - theirs).total_seconds())
    except (ValueError, TypeError):
        return CheckLine(None, say("Clocks: the platform does not tell its time"))
    return CheckLine(apart <= _CLOCKS, say("Clocks: {seconds} s apart", seconds=f"{apart:.0f}"))
