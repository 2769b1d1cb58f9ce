"""Platforms register themselves by one-time links (LTI dynamic registration)."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from html import unescape
from typing import Any

import httpx
import pytest
from dh_grader.lti import all_registrations, deployments_of
from dh_grader.lti.joining import allow, canvas_configuration, invite
from dh_grader.store.tables import invitations
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response
from sqlalchemy import update

from tests.lti.conftest import ADDRESS, Tool
from tests.lti.platform import running

PLATFORM = "https://purl.imsglobal.org/spec/lti-platform-configuration"
TOOL = "https://purl.imsglobal.org/spec/lti-tool-configuration"
FILE_SCOPES = ["noticehandlers", "asset.readonly", "report"]
SCORE = "https://purl.imsglobal.org/spec/lti-ags/scope/score"


@dataclass
class Registrar:
    """A platform that registers the service."""

    token: str = "one-time-token"
    port: int = 0
    changes: dict[str, Any] = field(default_factory=dict)
    refusal: Response | None = None
    requests: list[dict[str, Any]] = field(default_factory=list)

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def is_right(self, request: Request) -> bool:
        expected = f"Bearer {self.token}" if self.token else None
        return request.headers.get("authorization") == expected

    def app(self) -> FastAPI:
        app = FastAPI()

        @app.get("/configuration")
        async def configuration(request: Request) -> Response:
            if not self.is_right(request):
                return Response(status_code=401)
            address = self.address
            found = {
                "issuer": address,
                "authorization_endpoint": f"{address}/auth",
                "token_endpoint": f"{address}/token",
                "jwks_uri": f"{address}/jwks.json",
                "registration_endpoint": f"{address}/registrations",
                "id_token_signing_alg_values_supported": ["RS256"],
                "scopes_supported": ["openid", SCORE],
                "authorization_server": "https://audience.example",
                PLATFORM: {
                    "product_family_code": "canvas",
                    "messages_supported": [
                        {"type": "LtiResourceLinkRequest"},
                        {
                            "type": "LtiDeepLinkingRequest",
                            "placements": ["assignment_selection", "editor_button"],
                        },
                    ],
                },
            }
            return JSONResponse(found | self.changes)

        @app.post("/registrations")
        async def registrations(request: Request) -> Response:
            if not self.is_right(request):
                return Response(status_code=401)
            self.requests.append(await request.json())
            if self.refusal is not None:
                return self.refusal
            return JSONResponse(self.requests[-1] | {"client_id": "client-9"}, 201)

        return app


@pytest.fixture(scope="module")
def one_registrar() -> Iterator[Registrar]:
    registrar = Registrar()
    with running(registrar.app()) as port:
        registrar.port = port
        yield registrar


@pytest.fixture
def registrar(one_registrar: Registrar) -> Registrar:
    one_registrar.token, one_registrar.refusal = "one-time-token", None
    one_registrar.changes.clear()
    one_registrar.requests.clear()
    return one_registrar


def invited(tool: Tool, *, waits: bool = False, address: str = ADDRESS) -> str:
    now = datetime.now(UTC)
    link = tool.do(
        lambda it: invite(it, "Uni <X>", address, "Europe/Berlin", now, days=7, waits=waits)
    )
    assert link.startswith(f"{address}/lti/register?invitation=")
    return str(link.partition("=")[2])


def opened(tool: Tool, registrar: Registrar, text: str, **more: str) -> httpx.Response:
    fields = {
        "invitation": text,
        "openid_configuration": f"{registrar.address}/configuration",
        "registration_token": registrar.token,
        **more,
    }
    page = tool.send("GET", "/lti/register", params=fields)
    assert not registrar.requests
    if page.status_code == 200:
        assert (
            f"frame-ancestors 'self' {registrar.address};"
            in (page.headers["content-security-policy"])
        )
        assert "Uni &lt;X&gt;" in page.text
    return tool.send("POST", "/lti/register", data=fields)


def test_a_platform_registers_itself_once(tool: Tool, registrar: Registrar) -> None:
    text = invited(tool)
    page = opened(tool, registrar, text)
    assert page.status_code == 200
    assert "client-9" in page.text
    assert "close_registration" in page.text
    [asked] = registrar.requests
    assert asked["redirect_uris"] == ["http://127.0.0.1:8000/lti/launch"]
    assert asked["initiate_login_uri"] == "http://127.0.0.1:8000/lti/login"
    assert asked["jwks_uri"] == "http://127.0.0.1:8000/lti/jwks.json"
    assert asked["token_endpoint_auth_method"] == "private_key_jwt"
    assert asked["scope"] == SCORE
    assert asked[TOOL]["claims"] == ["iss", "sub"]
    [message] = asked[TOOL]["messages"]
    assert message["type"] == "LtiDeepLinkingRequest"
    assert message["placements"] == ["assignment_selection"]
    made = tool.do(all_registrations)[-1]
    assert (made.name, made.issuer, made.client_id) == ("Uni <X>", registrar.address, "client-9")
    assert (made.audience, made.zone) == ("https://audience.example", "Europe/Berlin")
    assert made.any_deployment
    registrar.requests.clear()
    again = opened(tool, registrar, text)
    assert (again.status_code, registrar.requests) == (403, [])
    assert "was used already" in again.text


def test_handed_in_files_are_asked_for_where_the_platform_offers_them(
    tool: Tool, registrar: Registrar
) -> None:
    scopes = [f"https://purl.imsglobal.org/spec/lti/scope/{name}" for name in FILE_SCOPES]
    offered = {"type": "LtiDeepLinkingRequest", "placements": ["ActivityAssetProcessor"]}
    registrar.changes["scopes_supported"] = ["openid", SCORE, *scopes]
    registrar.changes[PLATFORM] = {"messages_supported": [offered]}
    assert opened(tool, registrar, invited(tool)).status_code == 200
    [asked] = registrar.requests
    assert asked["scope"].split() == [SCORE, *scopes]
    assert asked[TOOL]["messages"][0]["placements"] == ["ActivityAssetProcessor"]
    # A platform that names no scopes may not know them.
    registrar.requests.clear()
    registrar.changes["scopes_supported"] = None
    page = opened(tool, registrar, invited(tool))
    assert "client-9" not in page.text
    [asked] = registrar.requests
    assert "asset.readonly" not in asked["scope"]


def test_a_held_registration_waits_for_its_admin(tool: Tool, registrar: Registrar) -> None:
    # Brightspace sends no token.
    registrar.token = ""
    page = opened(tool, registrar, invited(tool, waits=True))
    assert "have allowed it" in page.text
    made = tool.do(all_registrations)[-1]
    assert not made.any_deployment
    assert tool.do(lambda it: deployments_of(it, made.id)) == []
    tool.do(lambda it: allow(it, made.id))
    assert tool.do(all_registrations)[-1].any_deployment


def test_the_answer_of_a_platform_that_refuses_is_shown(tool: Tool, registrar: Registrar) -> None:
    text = invited(tool)
    errors = {"errors": [{"field": "redirect_uris", "message": "<b>is wrong</b>"}]}
    registrar.refusal = Response(json.dumps(errors), 422, media_type="application/json")
    page = opened(tool, registrar, text)
    assert "status 422" in page.text
    assert "&lt;b&gt;is wrong&lt;/b&gt;" in page.text
    # The invitation is still valid.
    registrar.refusal = None
    registrar.requests.clear()
    assert opened(tool, registrar, text).status_code == 200


def test_unusable_configurations_are_refused(tool: Tool, registrar: Registrar) -> None:
    text, before = invited(tool), len(tool.do(all_registrations))
    elsewhere = "http://127.0.0.1:9"
    cases: dict[str, dict[str, Any]] = {
        "is of another issuer": {"issuer": elsewhere},
        "registration_endpoint in its configuration is at another host": {
            "registration_endpoint": f"{elsewhere}/registrations"
        },
        "has no token_endpoint": {"token_endpoint": None},
        "the jwks_uri in its configuration must begin": {"jwks_uri": "http://10.0.0.1/jwks.json"},
        "the authorization_endpoint in its configuration is no address": {
            "authorization_endpoint": "javascript:alert(1)"
        },
        "does not sign by RS256": {"id_token_signing_alg_values_supported": ["HS256"]},
    }
    for said, changes in cases.items():
        registrar.changes.clear()
        registrar.changes.update(changes)
        page = opened(tool, registrar, text)
        assert (said, said in page.text, page.status_code) == (said, True, 403)
    registrar.changes.clear()
    for address, said in {
        "https://10.0.0.1/configuration": "private address",
        "http://evil.example/configuration": "must begin with https",
        "file:///etc/passwd": "is no address",
    }.items():
        fields = {"invitation": text, "openid_configuration": address}
        page = tool.send("POST", "/lti/register", data=fields)
        assert (address, said in page.text) == (address, True)
    assert registrar.requests == []
    assert len(tool.do(all_registrations)) == before


def test_an_unusable_configuration_is_told_in_the_language(
    tool: Tool, registrar: Registrar
) -> None:
    fields = {
        "invitation": invited(tool),
        "openid_configuration": f"{registrar.address}/configuration",
        "registration_token": registrar.token,
    }
    french = {"accept-language": "fr"}
    cases: dict[str, dict[str, Any]] = {
        "sa configuration n’a pas de token_endpoint": {"token_endpoint": None},
        "elle ne signe pas avec RS256": {"id_token_signing_alg_values_supported": ["HS256"]},
    }
    for said, changes in cases.items():
        registrar.changes.clear()
        registrar.changes.update(changes)
        page = tool.send("POST", "/lti/register", data=fields, headers=french)
        assert said in unescape(page.text)


def test_invitations_expire_and_cannot_be_changed(tool: Tool, registrar: Registrar) -> None:
    held = invited(tool, waits=True)
    assert held.startswith("held-")
    for text in ("", "nonsense", held.removeprefix("held-")):
        assert opened(tool, registrar, text).status_code == 403
    fields = {"invitation": held, "openid_configuration": f"{registrar.address}/configuration"}
    foreign = {"origin": "https://evil.example", "sec-fetch-site": "cross-site"}
    refused = tool.send("POST", "/lti/register", data=fields, headers=foreign)
    assert "another site" in refused.text
    ended = update(invitations).values(expires_at=datetime.now(UTC) - timedelta(seconds=1))
    tool.do(lambda it: it.execute(ended))
    assert "has expired" in opened(tool, registrar, held).text
    assert registrar.requests == []


def test_a_public_service_asks_no_local_platform(tool: Tool, registrar: Registrar) -> None:
    text = invited(tool, address="https://grader.example.edu")
    page = opened(tool, registrar, text)
    assert "must begin with https" in page.text
    assert registrar.requests == []


def test_the_file_for_canvas_has_our_addresses_and_placements() -> None:
    found = canvas_configuration("https://grader.example.edu")
    assert found["oidc_initiation_url"] == "https://grader.example.edu/lti/login"
    assert found["public_jwk_url"] == "https://grader.example.edu/lti/jwks.json"
    [extension] = found["extensions"]
    assert extension["privacy_level"] == "anonymous"
    kinds = {each["message_type"] for each in extension["settings"]["placements"]}
    assert kinds == {"LtiDeepLinkingRequest"}
    with_files = canvas_configuration("https://grader.example.edu", files=True)
    more = [each for each in with_files["scopes"] if each not in found["scopes"]]
    assert [each.rpartition("/")[2] for each in more] == FILE_SCOPES
    [extension] = with_files["extensions"]
    places = [each["placement"] for each in extension["settings"]["placements"]]
    assert places == ["assignment_selection", "link_selection", "ActivityAssetProcessor"]


def test_the_page_is_in_the_readers_language(tool: Tool) -> None:
    page = tool.send("GET", "/lti/register?invitation=x", headers={"accept-language": "de"})
    assert page.status_code == 403
    assert "Verbinden Sie Ihre Plattform" in page.text
    assert "Dieser Link ist ungültig, wurde schon benutzt oder ist abgelaufen." in page.text
