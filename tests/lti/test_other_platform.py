"""A launch and links for a platform by others: the library lti1p3platform."""

from typing import Any

import jwt
import pytest
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
)
from lti1p3platform.ltiplatform import LTI1P3PlatformConfAbstract
from lti1p3platform.message_launch import LTIAdvantageMessageLaunchAbstract
from lti1p3platform.registration import Registration
from lti1p3platform.request import Request

from tests.lti.conftest import Tool, hidden, token_of
from tests.lti.platform import CLIENT, DEPLOYMENT, MEMBER, deep_linking


class Configuration(LTI1P3PlatformConfAbstract):  # type: ignore[misc]
    """The registration of our service at the other platform, with the keys of ours."""

    def init_platform_config(self, **kwargs: Any) -> None:
        platform = kwargs["platform"]
        private = platform.key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
        public = platform.key.public_key().public_bytes(
            Encoding.PEM, PublicFormat.SubjectPublicKeyInfo
        )
        made = Registration().set_iss(platform.address).set_client_id(CLIENT)
        made.set_deployment_id(DEPLOYMENT).set_launch_url(f"{platform.tool}/lti/launch")
        made.set_oidc_login_url(f"{platform.tool}/lti/login")
        made.set_platform_public_key(public.decode())
        made.set_platform_private_key(private.decode())
        self._registration = made

    def get_registration_by_params(self, **_: Any) -> Registration:
        raise NotImplementedError


class Launch(LTIAdvantageMessageLaunchAbstract):  # type: ignore[misc]
    """A launch that returns the fields of its form."""

    def render_launch_form(self, launch_data: dict[str, Any], **_: Any) -> Any:
        return launch_data


class Preflight(Request):  # type: ignore[misc]
    """The request that our login has sent to the platform."""

    def build_metadata(self, request: Any) -> Any:
        return {"get_data": request, "form_data": {}}


def test_a_platform_by_others_launches(tool: Tool) -> None:
    configuration = Configuration(platform=tool.platform)
    tool.platform.keys[:] = configuration.get_jwks()["keys"]
    begun = tool.login()
    launch = Launch(Preflight(begun.asked), configuration)
    launch.set_user_data("u1", [f"{MEMBER}#Learner"], "Ada Lovelace", "ada@example.edu")
    launch.set_resource_link_claim("link-9", title="Homework 9")
    launch.set_launch_context_claim("course-9", context_title="Robots")
    launch.set_custom_parameters_claim({"exercise": "planar-rr=10"})
    launch.set_ags("https://platform.example/items")
    sent = launch.lti_launch()
    page = tool.post(sent["state"], sent["id_token"], begun.cookies)
    assert page.status_code == 200
    bearer = {"authorization": f"Bearer {token_of(page.text)}"}
    [course] = tool.send("GET", "/v1/me", headers=bearer).json()["courses"]
    assert (course["title"], course["assignments"][0]["title"]) == ("Robots", "Homework 9")
    assert not course["name"].startswith("Ada")


def test_a_platform_by_others_reads_the_links(tool: Tool) -> None:
    configuration = Configuration(platform=tool.platform)
    tool.platform.habits.append(deep_linking(f"{tool.platform.address}/return"))
    ticket = hidden(tool.launch("turing").text, "ticket")
    chosen = {"exercise": "scara", "points:scara": "4", "title": "Arms", "action": "add"}
    page = tool.send("POST", "/lti/links", data={"ticket": ticket, **chosen})
    configuration._registration.set_tool_key_set(tool.send("GET", "/lti/jwks.json").json())
    answer = {"JWT": hidden(page.text, "JWT")}
    [item] = configuration.validate_deeplinking_resp(answer)
    assert item["type"] == "ltiResourceLink"
    assert item["lineItem"]["scoreMaximum"] == 4
    answer["JWT"] = answer["JWT"][:-8] + "AAAAAAAA"
    with pytest.raises(jwt.InvalidSignatureError):
        configuration.validate_deeplinking_resp(answer)
