"""Test launches from an independent platform, built with lti1p3platform."""

import jwt
import pytest

from tests.lti.conftest import Tool, hidden, token_of
from tests.lti.library.services import Configuration, Launch, Preflight
from tests.lti.platform import MEMBER, deep_linking


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
