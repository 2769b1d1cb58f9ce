"""Check the messages of platforms (id tokens); each fault has its own code."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

import jwt
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey

from service.lti.logins import Login, digest
from service.lti.problems import LtiError
from service.lti.registrations import Registration, same_place
from service.lti.roles import LtiRole, role_of

LTI: Final = "https://purl.imsglobal.org/spec/lti/claim/"
RESOURCE_LINK: Final = "LtiResourceLinkRequest"
DEEP_LINKING: Final = "LtiDeepLinkingRequest"
REVIEW: Final = "LtiSubmissionReviewRequest"
# The report on a file that a student has handed in at the platform, and the settings of reports.
REPORT: Final = "LtiReportReviewRequest"
SETTINGS: Final = "LtiAssetProcessorSettingsRequest"
# The types of messages that are accepted, and for each whether it has a resource link.
KINDS: Final[dict[str, bool]] = {
    RESOURCE_LINK: True,
    DEEP_LINKING: False,
    REVIEW: True,
    REPORT: False,
    SETTINGS: False,
}
_AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"
_NRPS: Final = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice"
_ALGORITHM: Final = "RS256"
_LEEWAY: Final = 10
# The greatest age of a message (seconds).
_OLDEST: Final = 3600
_LONGEST_TOKEN: Final = 48_000
_LONGEST_NAME: Final = 255
_LONGEST_ADDRESS: Final = 1000
_JWS: Final = jwt.PyJWS()


@dataclass(frozen=True, slots=True)
class LaunchMessage:
    """A message that has passed all checks. ``sub`` is None for guests.

    ``reviewed`` is the user whose attempts are to be shown, or "". ``locale`` is the language of
    the user on the platform, or "".
    """

    registration: Registration
    kind: str
    deployment: str
    role: LtiRole
    sub: str | None
    context: str
    context_title: str
    link: str
    link_title: str
    custom: Mapping[str, str]
    lineitem_url: str | None
    lineitems_url: str | None
    scopes: str
    memberships_url: str | None
    reviewed: str
    locale: str
    claims: Mapping[str, Any]


def key_id_of(token: str) -> str:
    """Return the id of the key with which a token claims to be signed. Raises LtiError."""
    # Keys and addresses of keys in the token's header are never used.
    if not token:
        raise LtiError("no-token")
    if len(token) > _LONGEST_TOKEN:
        raise LtiError("token-too-long")
    try:
        header = jwt.get_unverified_header(token)
    except (jwt.InvalidTokenError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    if header.get("alg") != _ALGORITHM:
        raise LtiError("wrong-algorithm", algorithm=header.get("alg"))
    key_id = header.get("kid")
    if not isinstance(key_id, str) or not key_id:
        raise LtiError("no-key-id")
    return key_id


def message_in(
    token: str, key: RSAPublicKey, registration: Registration, login: Login, now: datetime
) -> LaunchMessage:
    """Return the message in a token, which must belong to ``login``. Raises LtiError."""
    claims = signed_claims(token, key)
    check_parties(claims, registration)
    check_times(claims, now.timestamp())
    _check_nonce(claims, login)
    _check_kind(claims)
    deployment = _deployment(claims, login)
    _check_target(claims, login)
    return _content(claims, registration, deployment)


def signed_claims(token: str, key: RSAPublicKey) -> dict[str, Any]:
    """Return the claims of a token that is signed with this key. Raises LtiError."""
    try:
        claims = json.loads(_JWS.decode(token, key, [_ALGORITHM]))
    except jwt.InvalidSignatureError as error:
        raise LtiError("wrong-signature") from error
    except (jwt.InvalidTokenError, ValueError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    if not isinstance(claims, dict):
        raise LtiError("token-malformed")
    return claims


def check_parties(claims: Mapping[str, Any], registration: Registration) -> None:
    """Check that claims come from this platform and are addressed to us. Raises LtiError."""
    if claims.get("iss") != registration.issuer:
        raise LtiError("wrong-issuer")
    audience = claims.get("aud")
    listed = audience if isinstance(audience, list) else [audience]
    if registration.client_id not in listed:
        raise LtiError("wrong-audience")
    party = claims.get("azp")
    if party != registration.client_id and (party is not None or len(listed) > 1):
        raise LtiError("wrong-party")


def check_times(claims: Mapping[str, Any], now: float) -> None:
    """Check that claims are neither old nor from the future. Raises LtiError."""
    expires, issued, begins = (_number(claims.get(name)) for name in ("exp", "iat", "nbf"))
    if expires is None:
        raise LtiError("no-expiry")
    if expires <= now - _LEEWAY:
        raise LtiError("expired")
    if issued is None:
        raise LtiError("no-issue-time")
    if issued > now + _LEEWAY:
        raise LtiError("issued-later")
    if issued < now - _OLDEST:
        raise LtiError("issued-before")
    if begins is not None and begins > now + _LEEWAY:
        raise LtiError("not-yet-valid")


def _number(value: Any) -> float | None:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return value if is_number and abs(value) < 1e12 else None


def _check_nonce(claims: Mapping[str, Any], login: Login) -> None:
    nonce = claims.get("nonce")
    if not isinstance(nonce, str) or not nonce:
        raise LtiError("no-nonce")
    if digest(nonce) != login.nonce:
        raise LtiError("wrong-nonce")


def _check_kind(claims: Mapping[str, Any]) -> None:
    if claims.get(f"{LTI}version") != "1.3.0":
        raise LtiError("wrong-version")
    kind = claims.get(f"{LTI}message_type")
    if not isinstance(kind, str) or kind not in KINDS:
        raise LtiError("wrong-message", kind=kind)


def _check_target(claims: Mapping[str, Any], login: Login) -> None:
    target = claims.get(f"{LTI}target_link_uri")
    # Deep Linking 2.0 does not ask for a target, and some platforms send none. The target of the
    # login was checked already: it is our registered address.
    if target is None and claims[f"{LTI}message_type"] == DEEP_LINKING:
        return
    if not isinstance(target, str) or not target:
        raise LtiError("no-target")
    if not same_place(target, login.target):
        raise LtiError("other-target")


def _deployment(claims: Mapping[str, Any], login: Login) -> str:
    deployment = claims.get(f"{LTI}deployment_id")
    if not isinstance(deployment, str) or not 0 < len(deployment) <= _LONGEST_NAME:
        raise LtiError("no-deployment")
    if login.deployment not in (None, deployment):
        raise LtiError("other-deployment")
    return deployment


def _content(
    claims: Mapping[str, Any], registration: Registration, deployment: str
) -> LaunchMessage:
    kind = claims[f"{LTI}message_type"]
    roles = claims.get(f"{LTI}roles")
    if not isinstance(roles, list) or not all(isinstance(each, str) for each in roles):
        raise LtiError("no-roles")
    sub = claims.get("sub")
    if sub is not None and not (isinstance(sub, str) and 0 < len(sub) <= _LONGEST_NAME):
        raise LtiError("bad-user")
    context = _object(claims, f"{LTI}context")
    if not (context_id := _name(context.get("id"))):
        raise LtiError("no-context")
    link = _object(claims, f"{LTI}resource_link")
    link_id = _name(link.get("id"))
    if KINDS[kind] and not link_id:
        raise LtiError("no-resource-link")
    grades, roster = _object(claims, _AGS), _object(claims, _NRPS)
    scopes = grades.get("scope", [])
    return LaunchMessage(
        registration=registration,
        kind=kind,
        deployment=deployment,
        role=role_of(roles, has_id=sub is not None),
        sub=sub,
        context=context_id,
        context_title=_line(context.get("title")) or _line(context.get("label")),
        link=link_id,
        link_title=_line(link.get("title")),
        custom={
            name: value
            for name, value in _object(claims, f"{LTI}custom").items()
            if isinstance(value, str)
        },
        lineitem_url=_address(grades.get("lineitem")),
        lineitems_url=_address(grades.get("lineitems")),
        scopes=" ".join(each for each in scopes if isinstance(each, str))[:2000]
        if isinstance(scopes, list)
        else "",
        reviewed=_reviewed(claims) if kind == REVIEW else "",
        locale=_locale(claims.get(f"{LTI}launch_presentation")),
        memberships_url=_address(roster.get("context_memberships_url")),
        claims=claims,
    )


def _reviewed(claims: Mapping[str, Any]) -> str:
    name = f"{LTI}for_user"
    if not (user := _name(_object(claims, name).get("user_id"))):
        raise LtiError("bad-claim", claim=name)
    return user


def _locale(presentation: Any) -> str:
    # An invalid language does not prevent a launch.
    return _line(presentation.get("locale")) if isinstance(presentation, dict) else ""


def _object(claims: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = claims.get(name, {})
    if not isinstance(value, dict):
        raise LtiError("bad-claim", claim=name)
    return value


def _name(value: Any) -> str:
    return value if isinstance(value, str) and len(value) <= _LONGEST_NAME else ""


def _line(value: Any) -> str:
    return " ".join(value.split())[:200].strip() if isinstance(value, str) else ""


def _address(value: Any) -> str | None:
    return value if isinstance(value, str) and 0 < len(value) <= _LONGEST_ADDRESS else None
