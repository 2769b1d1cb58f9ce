"""Describe this service to a platform: as a registration request, or as a file for Canvas."""

from collections.abc import Collection
from typing import Any, Final
from urllib.parse import urlsplit

from service.lti.handed_files.platform_files import NOTICES, READ, REPORT
from service.lti.messages import DEEP_LINKING
from service.lti.registrations import KEYS_PATH, LAUNCH_PATH, LOGIN_PATH

NAME: Final = "DH Grader"
DESCRIPTION: Final = "Forward kinematics and Denavit-Hartenberg tables, graded at once."
TOOL: Final = "https://purl.imsglobal.org/spec/lti-tool-configuration"
_AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/scope/"
SCOPES: Final = (
    f"{_AGS}lineitem",
    f"{_AGS}lineitem.readonly",
    f"{_AGS}result.readonly",
    f"{_AGS}score",
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
