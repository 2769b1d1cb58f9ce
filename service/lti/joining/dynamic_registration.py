"""Dynamic registration: read a platform's configuration, and register this service there."""

import json
from collections.abc import Mapping
from http import HTTPStatus
from typing import Any, Final

from service.formats.shared.plain_text import visible
from service.lti.fetching import FetchError, answer, content
from service.lti.joining.invitations import Invitation
from service.lti.joining.tool_configuration import registration_request
from service.lti.registrations import RegistrationError, origin_of, unusable
from service.translations import say

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

    ``configuration`` is the address of the platform's OpenID configuration. Raises
    RegistrationError.
    """
    # Some platforms send no registration token; then ``token`` is "".
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
