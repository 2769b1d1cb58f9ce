"""The tests' own LTI platform, over real HTTP."""

# The functions in `Platform.habits` change the claims of messages; tests add such functions.

import html
import json
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final
from urllib.parse import parse_qs

import jwt
import uvicorn
from cryptography.hazmat.primitives.asymmetric import rsa
from fastapi import FastAPI, Request
from fastapi.responses import HTMLResponse, JSONResponse, Response
from jwt.algorithms import RSAAlgorithm

from tests.guards import ANSWER
from tests.lti.file_store import FileStore
from tests.lti.gradebook import Gradebook

LTI: Final = "https://purl.imsglobal.org/spec/lti/claim/"
AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/"
DL: Final = "https://purl.imsglobal.org/spec/lti-dl/claim/"
NRPS: Final = "https://purl.imsglobal.org/spec/lti-nrps/"
MEMBER: Final = "http://purl.imsglobal.org/vocab/lis/v2/membership"
TEST_USER: Final = "http://purl.imsglobal.org/vocab/lti/system/person#TestUser"
ROLES: Final = {
    "ada": [f"{MEMBER}#Learner"],
    "grace": [f"{MEMBER}#Learner"],
    "turing": [f"{MEMBER}#Instructor"],
    "helper": [f"{MEMBER}/Instructor#TeachingAssistant"],
    "preview": [f"{MEMBER}#Learner", TEST_USER],
    "parent": [f"{MEMBER}#Mentor"],
    "": [f"{MEMBER}#Learner"],
}
CLIENT: Final = "client-1"
DEPLOYMENT: Final = "deployment-1"
# A change of the claims of a message.
Habit = Callable[[dict[str, Any]], None]


def deep_linking(address: str, **settings: Any) -> Habit:
    # Return a habit that turns a launch into a deep-linking request with this return address.
    #
    # A setting is left out if it is None.
    asked = {
        "deep_link_return_url": address,
        "accept_types": ["link", "ltiResourceLink"],
        "accept_presentation_document_targets": ["iframe", "window"],
        "accept_multiple": True,
        "data": "op=321&v=44",
        **settings,
    }

    def change(claims: dict[str, Any]) -> None:
        claims[f"{LTI}message_type"] = "LtiDeepLinkingRequest"
        del claims[f"{LTI}resource_link"]
        del claims[f"{LTI}custom"]
        given = {name: value for name, value in asked.items() if value is not None}
        claims[f"{DL}deep_linking_settings"] = given

    return change


def rsa_key(bits: int = 2048) -> rsa.RSAPrivateKey:
    return rsa.generate_private_key(public_exponent=65537, key_size=bits)


def public_jwk(key: Any, key_id: str, **more: Any) -> dict[str, Any]:
    """Return the public key as a JSON Web Key."""
    jwk = RSAAlgorithm.to_jwk(key.public_key(), as_dict=True)
    return {**jwk, "kid": key_id, "alg": "RS256", "use": "sig", **more}


@dataclass
class Platform:
    """The LTI platform of the tests."""

    # `storage` is true if its pages offer storage to tools. `members` is the roster, sent in pages
    # of `page_size`; `next_page` replaces the address of the second page of the roster.
    key: Any = field(default_factory=rsa_key)
    keys: list[dict[str, Any]] = field(default_factory=list)
    port: int = 0
    habits: list[Habit] = field(default_factory=list)
    fetched: list[str] = field(default_factory=list)
    asked: list[dict[str, str]] = field(default_factory=list)
    returned: list[str] = field(default_factory=list)
    storage: bool = True
    members: list[dict[str, Any]] = field(default_factory=list)
    page_size: int = 50
    next_page: str = ""
    visit: int = 0
    host: str = "127.0.0.1"
    tool: str = "http://127.0.0.1:8000"

    def __post_init__(self) -> None:
        self.keys = self.keys or [public_jwk(self.key, "key-1")]
        self.gradebook = Gradebook(lambda: self.address, self._roster_token)
        self.files = FileStore(self)

    @property
    def address(self) -> str:
        return f"http://{self.host}:{self.port}"

    @property
    def registration(self) -> dict[str, Any]:
        return {
            "id": "moodle",
            "name": "Moodle of the university",
            "issuer": self.address,
            "client_id": CLIENT,
            "auth_url": f"{self.address}/auth",
            "jwks_url": f"{self.address}/jwks.json?{self.visit}",
            "token_url": f"{self.address}/token",
            "address": self.tool,
            "zone": "Europe/Berlin",
            "deployments": [DEPLOYMENT],
            "is_development": True,
        }

    def login(self, user: str = "ada", link: str = "link-1", **more: str) -> dict[str, str]:
        return {
            "iss": self.address,
            "client_id": CLIENT,
            "login_hint": user or "guest",
            "lti_message_hint": link,
            "target_link_uri": f"{self.tool}/lti/launch",
            "lti_deployment_id": DEPLOYMENT,
            **more,
        }

    def claims(self, user: str, link: str, nonce: str) -> dict[str, Any]:
        now = int(time.time())
        claims = {
            "iss": self.address,
            "aud": CLIENT,
            "sub": f"user {user}",
            "iat": now,
            "exp": now + 300,
            "nonce": nonce,
            "name": f"{user.title()} Secret",
            "email": f"{user}@secret.example",
            f"{LTI}version": "1.3.0",
            f"{LTI}message_type": "LtiResourceLinkRequest",
            f"{LTI}deployment_id": DEPLOYMENT,
            f"{LTI}target_link_uri": f"{self.tool}/lti/launch",
            f"{LTI}roles": ROLES.get(user, ROLES["ada"]),
            f"{LTI}context": {"id": "course-1", "title": "Robotics 2026"},
            f"{LTI}resource_link": {"id": link, "title": "Homework 1"},
            f"{LTI}custom": {"exercise": "planar-rr=10"},
            f"{AGS}claim/endpoint": {
                "scope": [f"{AGS}scope/lineitem", f"{AGS}scope/score"],
                "lineitems": f"{self.address}/items?type=1",
                "lineitem": f"{self.address}/items/1?type=1",
            },
            f"{NRPS}claim/namesroleservice": {
                "context_memberships_url": f"{self.address}/members",
                "service_versions": ["2.0"],
            },
        }
        if not user:
            del claims["sub"]
        for habit in self.habits:
            habit(claims)
        return claims

    def signed(self, claims: Any, key: Any = None, **header: Any) -> str:
        content = json.dumps(claims).encode()
        return jwt.PyJWS().encode(content, key or self.key, "RS256", {"kid": "key-1", **header})

    def _roster_token(self, form: Mapping[str, str]) -> Response:
        assert form["grant_type"] == "client_credentials"
        kind = "urn:ietf:params:oauth:client-assertion-type:jwt-bearer"
        assert form["client_assertion_type"] == kind
        claims = jwt.decode(
            form["client_assertion"],
            options={"verify_signature": False, "require": ["exp", "iat", "jti"]},
            audience=f"{self.address}/token",
        )
        assert claims["iss"] == claims["sub"] == CLIENT
        self.asked.append(dict(form))
        name = f"token for {form['scope']}".replace(" ", "-")
        answer = {"access_token": name, "token_type": "Bearer", "expires_in": 60}
        return JSONResponse(answer)

    def app(self) -> FastAPI:
        app = FastAPI()

        app.include_router(self.gradebook.routes())
        app.include_router(self.files.routes())

        @app.get("/jwks.json")
        async def jwks() -> Any:
            self.fetched.append("/jwks.json")
            return {"keys": self.keys}

        @app.get("/members")
        async def members(request: Request, page: int = 0) -> Response:
            scope = f"{NRPS}scope/contextmembership.readonly"
            if request.headers.get("authorization") != f"Bearer token-for-{scope}":
                return Response(status_code=401)
            self.fetched.append(f"/members?page={page}")
            start = page * self.page_size
            listed = self.members[start : start + self.page_size]
            answer = JSONResponse({"id": str(request.url), "members": listed})
            if start + self.page_size < len(self.members):
                following = self.next_page or f"{self.address}/members?page={page + 1}"
                answer.headers["link"] = (
                    f'<{self.address}/members?Differences>; rel="differences", '
                    f'<{following}>; rel="next"'
                )
            return answer

        @app.get("/auth")
        async def auth(request: Request) -> HTMLResponse:
            asked = request.query_params
            expected = ("openid", "id_token", "form_post", "none", CLIENT)
            names = ("scope", "response_type", "response_mode", "prompt", "client_id")
            assert tuple(asked[name] for name in names) == expected
            assert asked["redirect_uri"] == f"{self.tool}/lti/launch"
            user = "" if asked["login_hint"] == "guest" else asked["login_hint"]
            claims = self.claims(user, asked["lti_message_hint"], asked["nonce"])
            fields = {"state": asked["state"], "id_token": self.signed(claims)}
            return HTMLResponse(_form(asked["redirect_uri"], fields))

        @app.post("/return")
        async def returned(request: Request) -> HTMLResponse:
            form = parse_qs((await request.body()).decode())
            self.returned.append(form["JWT"][0])
            return HTMLResponse("<!doctype html><html lang=en><title>Added</title><h1>Added</h1>")

        @app.get("/course/{user}/{link}")
        async def course(user: str, link: str) -> HTMLResponse:
            more = {"lti_storage_target": "_parent"} if self.storage else {}
            fields = self.login(user, link, **more)
            return HTMLResponse(_course(f"{self.tool}/lti/login", fields, self.storage))

        return app


def _inputs(fields: dict[str, str]) -> str:
    return "".join(
        f'<input type="hidden" name="{name}" value="{html.escape(value)}">'
        for name, value in fields.items()
    )


def _form(action: str, fields: dict[str, str]) -> str:
    form = f'<form method="post" action="{html.escape(action)}">{_inputs(fields)}</form>'
    return f"<!doctype html>{form}<script>document.forms[0].submit()</script>"


_STORAGE: Final = """
const kept = new Map();
addEventListener("message", ({ data, source, origin }) => {
  const [name, verb] = String(data?.subject).split(".");
  if (name !== "lti" || !["put_data", "get_data"].includes(verb)) return;
  const key = `${origin} ${data.key}`;
  if (verb === "put_data") kept.set(key, data.value);
  source.postMessage({ subject: `${data.subject}.response`, message_id: data.message_id,
    key: data.key, value: kept.get(key) }, origin);
});
"""


def _course(login: str, fields: dict[str, str], storage: bool) -> str:
    script = _STORAGE if storage else ""
    return (
        "<!doctype html><html lang=en><title>Course</title><link rel=icon href='data:,'>"
        '<h1>Course</h1><iframe name="tool" title="Exercise" width="1000" height="900"></iframe>'
        f'<form method="post" target="tool" action="{login}">{_inputs(fields)}</form>'
        f"<script>{script}document.forms[0].submit()</script>"
    )


@contextmanager
def running(app: Any) -> Iterator[int]:
    """Serve an application on a free port, in a thread; yield the port."""
    config = uvicorn.Config(app, "127.0.0.1", 0, log_level="error", lifespan="off")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    until = time.monotonic() + ANSWER
    while not server.started:
        assert time.monotonic() < until, "the platform does not start"
        time.sleep(0.005)
    yield server.servers[0].sockets[0].getsockname()[1]
    server.should_exit = True
    thread.join(ANSWER)
