"""Notices of platforms (Platform Notification Service) about files that were handed in."""

from collections.abc import Mapping
from datetime import datetime
from typing import Annotated, Any, Final, TypeGuard

import jwt
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError

from service.lti.messages import LTI, check_parties, check_times, signed_claims
from service.lti.problems import LtiError
from service.lti.registrations import Registration, unusable
from service.regex import regex

HANDED_IN: Final = "LtiAssetProcessorSubmissionNotice"
# With this one, platforms try whether notices arrive.
HELLO: Final = "LtiHelloWorldNotice"
MOST_FILES: Final = 20
_SURROGATE: Final = regex(r"[\ud800-\udfff]")

_Name = Annotated[str, StringConstraints(min_length=1, max_length=255)]
_Address = Annotated[str, StringConstraints(min_length=1, max_length=1000)]


class _Stored(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)


class FileAtPlatform(_Stored):
    """A file at the platform. ``filename`` is "" for a text that a student has typed there."""

    asset_id: _Name
    url: _Address
    filename: str = ""
    content_type: str = ""
    sha256_checksum: str = ""


class HandedFiles(_Stored):
    """The files of one submission, and where to send the reports.

    ``deployment`` and ``context`` identify the course at the platform; both may be "".
    """

    assets: Annotated[list[FileAtPlatform], Field(min_length=1, max_length=MOST_FILES)]
    report_url: _Address
    custom: dict[str, str] = {}
    deployment: str = ""
    context: str = ""


class SubmissionNotice(BaseModel):
    """A checked notice: ``user`` has handed in ``files``."""

    id: str
    deployment: str
    submission: str
    user: str
    files: HandedFiles


def parties_of(token: str) -> tuple[str, str]:
    """Return the issuer and the client id in a token without checking its signature.

    Raises LtiError.
    """
    try:
        claims = jwt.decode(token, options={"verify_signature": False})
    except (jwt.InvalidTokenError, ValueError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    issuer, audience, party = (claims.get(name) for name in ("iss", "aud", "azp"))
    client = party or (audience[0] if isinstance(audience, list) and audience else audience)
    if not _is_text(issuer):
        raise LtiError("wrong-issuer")
    if not _is_text(client):
        raise LtiError("wrong-audience")
    return issuer, client


def notice_in(
    token: str, key: RSAPublicKey, registration: Registration, now: datetime
) -> SubmissionNotice | None:
    """Return the notice in a token, or None if it is only a test. Raises LtiError."""
    # A platform may send the same notice again, with the same id.
    claims = signed_claims(token, key)
    check_parties(claims, registration)
    check_times(claims, now.timestamp())
    if claims.get(f"{LTI}version") != "1.3.0":
        raise LtiError("wrong-version")
    notice = claims.get(f"{LTI}notice")
    kind = notice.get("type") if isinstance(notice, dict) else None
    if kind == HELLO:
        return None
    if kind != HANDED_IN:
        raise LtiError("wrong-notice", kind=kind)
    return SubmissionNotice(
        id=_name(claims, "notice", "id"),
        deployment=_text(claims.get(f"{LTI}deployment_id"), "no-deployment"),
        submission=_name(claims, "submission", "id"),
        user=_name(claims, "for_user", "user_id"),
        files=_files(claims, registration),
    )


def _files(claims: Mapping[str, Any], registration: Registration) -> HandedFiles:
    service, report = claims.get(f"{LTI}assetservice"), claims.get(f"{LTI}assetreport")
    custom, context = claims.get(f"{LTI}custom"), claims.get(f"{LTI}context")
    deployment = claims.get(f"{LTI}deployment_id")
    course = context.get("id") if isinstance(context, dict) else None
    try:
        found = HandedFiles(
            assets=service["assets"] if isinstance(service, dict) else [],
            report_url=report["report_url"] if isinstance(report, dict) else "",
            custom={
                name: value
                for name, value in (custom.items() if isinstance(custom, dict) else ())
                if isinstance(value, str) and len(value) <= 2000
            },
            deployment=deployment if isinstance(deployment, str) else "",
            context=course if isinstance(course, str) else "",
        )
    except (ValidationError, KeyError) as error:
        raise LtiError("no-files") from error
    for address in (found.report_url, *(each.url for each in found.assets)):
        if reason := unusable(address, local=registration.is_development):
            raise LtiError("bad-address", address=address, reason=reason)
    return found


def _is_text(value: Any) -> TypeGuard[str]:
    # No database stores a lone surrogate.
    return isinstance(value, str) and bool(value) and not _SURROGATE.search(value)


def _name(claims: Mapping[str, Any], claim: str, name: str) -> str:
    found = claims.get(f"{LTI}{claim}")
    value = found.get(name) if isinstance(found, dict) else None
    return _text(value, "bad-claim", claim=f"{LTI}{claim}")


def _text(value: Any, problem: str, **more: str) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= 255:
        raise LtiError(problem, **more)
    return value
