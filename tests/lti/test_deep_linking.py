"""Deep linking: a tutor picks exercises on the platform, and learners open them."""

import json
import re
from dataclasses import replace
from datetime import UTC, datetime
from html import unescape
from typing import Any

import httpx
import jwt
import pytest
from dh_grader.lti import Registration
from dh_grader.store.tables import assignments
from sqlalchemy import select

from tests.lti.conftest import Tool, hidden, token_of
from tests.lti.platform import CLIENT, DEPLOYMENT, DL, LTI, Platform, deep_linking

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)


def picker(tool: Tool, user: str = "turing", address: str = "", **settings: Any) -> httpx.Response:
    address = address or f"{tool.platform.address}/return?course=1"
    tool.platform.habits[:] = [deep_linking(address, **settings)]
    return tool.launch(user)


def submitted(tool: Tool, page: str, **fields: Any) -> httpx.Response:
    return tool.send("POST", "/lti/links", data={"ticket": hidden(page, "ticket"), **fields})


def answer(tool: Tool, page: httpx.Response) -> dict[str, Any]:
    assert page.status_code == 200
    [address] = re.findall(r'id="send" method="post" action="([^"]+)"', page.text)
    assert unescape(address) == f"{tool.platform.address}/return?course=1"
    policy = page.headers["content-security-policy"]
    assert f"form-action {tool.platform.address};" in policy
    keys = jwt.PyJWKSet.from_dict(tool.send("GET", "/lti/jwks.json").json())
    text = hidden(page.text, "JWT")
    key = keys[jwt.get_unverified_header(text)["kid"]]
    needed = ["exp", "iat", "nonce", "iss", "aud"]
    claims = jwt.decode(
        text, key, ["RS256"], {"require": needed}, audience=tool.platform.address, issuer=CLIENT
    )
    assert claims[f"{LTI}message_type"] == "LtiDeepLinkingResponse"
    assert claims[f"{LTI}version"] == "1.3.0"
    assert claims[f"{LTI}deployment_id"] == DEPLOYMENT
    return dict(claims)


def launched(tool: Tool, item: dict[str, Any], link: str) -> dict[str, Any]:
    def of_link(claims: dict[str, Any]) -> None:
        claims[f"{LTI}custom"] = item["custom"]
        claims[f"{LTI}resource_link"] = {"id": link, "title": item["title"]}

    tool.platform.habits[:] = [of_link]
    bearer = {"authorization": f"Bearer {token_of(tool.launch('ada', link).text)}"}
    [course] = tool.send("GET", "/v1/me", headers=bearer).json()["courses"]
    return {each["title"]: each for each in course["assignments"]}


@pytest.mark.long
@KINDS
def test_two_exercises_are_linked_and_launched(tool: Tool) -> None:
    before = tool.counts()
    page = picker(tool)
    assert "set-cookie" not in page.headers
    found = submitted(tool, page.text, search="SCARA prismatic", action="search").text
    assert 'value="scara"' in found
    assert 'value="planar-rr"' not in found
    assert "/v1/exercises/scara/figure.svg" in found
    chosen = {
        "exercise": ["planar-rr", "scara"],
        "points:planar-rr": "10",
        "points:scara": "2.5",
        "as": "several",
        "due": "2126-11-30T23:59",
    }
    sent = answer(tool, submitted(tool, found, action="add", **chosen))
    assert sent[f"{DL}data"] == "op=321&v=44"
    one, two = sent[f"{DL}content_items"]
    assert one["type"] == "ltiResourceLink"
    assert one["url"] == "http://127.0.0.1:8000/lti/launch"
    # The course is in Berlin, an hour before Greenwich in winter.
    dates = {"due": "2126-11-30T22:59:00Z"}
    assert one["custom"] == {"exercise": "planar-rr=10"} | dates
    assert two["custom"] == {"exercise": "scara=2.5"} | dates
    assert [each["lineItem"]["scoreMaximum"] for each in (one, two)] == [10, 2.5]
    assert two["submission"] == {"endDateTime": "2126-11-30T22:59:00Z"}
    assert tool.counts() == before
    assert len(launched(tool, one, "link-1")) == 1
    found_there = launched(tool, two, "link-2")
    assert list(found_there) == [one["title"], two["title"]]
    second = found_there[two["title"]]
    assert [(it["exercise"], it["points"]) for it in second["exercises"]] == [("scara", 2.5)]
    assert second["due"] == "2126-11-30T23:59:00+01:00"


def test_several_exercises_become_one_assignment_and_can_be_linked_again(tool: Tool) -> None:
    page = picker(tool, accept_multiple=None).text
    chosen: dict[str, Any] = {
        "exercise": ["planar-rr", "scara"],
        "points:planar-rr": "10",
        "points:scara": "2",
    }
    assert "Enter a title" in submitted(tool, page, action="add", **chosen).text
    sent = answer(tool, submitted(tool, page, action="add", title="Arms", **chosen))
    [item] = sent[f"{DL}content_items"]
    assert (item["title"], item["lineItem"]["scoreMaximum"]) == ("Arms", 12)
    [made] = launched(tool, item, "link-1").values()
    assert [each["points"] for each in made["exercises"]] == [10, 2]
    # The course has the assignment now: a second link leads to the same one.
    sent = answer(tool, submitted(tool, picker(tool).text, action="add", assignment=made["id"]))
    [again] = sent[f"{DL}content_items"]
    assert again["custom"] == {"assignment": made["id"]}
    assert list(launched(tool, again, "link-2")) == ["Arms"]
    assert len(launched(tool, again, "link-3")) == 1


def test_a_link_gives_each_learner_a_variant(tool: Tool) -> None:
    page = picker(tool).text
    chosen = {
        "exercise": ["planar-rr-numbers"],
        "points:planar-rr-numbers": "8",
        "variants": "yes",
        "as": "several",
    }
    # A complaint keeps what was checked.
    refused = submitted(tool, page, action="add", **chosen, due="tomorrow").text
    assert 'name="variants" value="yes" checked' in refused
    [item] = answer(tool, submitted(tool, page, action="add", **chosen))[f"{DL}content_items"]
    assert item["custom"] == {"exercise": "planar-rr-numbers=8", "variants": "true"}
    launched(tool, item, "link-1")
    [row] = tool.do(lambda it: it.execute(select(assignments)).all())
    assert row.variants is not None
    assert list(json.loads(row.choices)) == ["planar-rr-numbers"]


@pytest.mark.long
def test_what_the_platform_does_not_take_is_not_sent(tool: Tool) -> None:
    page = picker(tool, accept_multiple=False, accept_lineitem=False, data=None).text
    assert "a link for each exercise" not in page
    chosen = {"exercise": ["planar-rr", "scara"], "points:planar-rr": "1", "points:scara": "1"}
    refused = submitted(tool, page, action="add", **chosen, **{"as": "several"}).text
    assert "accepts one link" in refused
    sent = answer(tool, submitted(tool, page, action="add", title="Arms", **chosen))
    [item] = sent[f"{DL}content_items"]
    assert "lineItem" not in item
    assert f"{DL}data" not in sent
    nothing = answer(tool, submitted(tool, page, action="cancel", **chosen))
    assert nothing[f"{DL}content_items"] == []


def test_unusable_choices_are_named(tool: Tool) -> None:
    page = picker(tool).text
    good = {"exercise": "scara", "points:scara": "2", "title": "Arms", "action": "add"}
    cases: dict[str, dict[str, Any]] = {
        "Choose at least one": {"exercise": []},
        "numbers above 0": {"points:scara": "-1"},
        "numbers above 0,": {"points:scara": "nan"},
        "not there any more": {"exercise": "robot-from-nowhere"},
        "Write dates": {"due": "tomorrow"},
        "is before the date": {"opens": "2126-11-30T10:00", "due": "2126-11-29T10:00"},
        "never show": {"due": "2126-03-31T02:30"},
    }
    told = {
        said: said in submitted(tool, page, **(good | more)).text for said, more in cases.items()
    }
    assert told == dict.fromkeys(cases, True)
    # Every answer has a nonce of its own.
    nonces = {answer(tool, submitted(tool, page, **good))["nonce"] for _ in range(2)}
    assert len(nonces) == 2


ADDRESSES = [
    ("https://canvas.instructure.com", "https://tum.instructure.com/courses/1", True),
    ("https://canvas.instructure.com", "https://sso.canvaslms.com/x", True),
    ("https://canvas.instructure.com", "http://tum.instructure.com/courses/1", False),
    ("https://canvas.instructure.com", "https://evilinstructure.com/courses/1", False),
    ("https://canvas.instructure.com", "https://instructure.com.evil.example/", False),
    ("https://canvas.instructure.com", "https://school.blackboard.com/x", False),
    ("https://moodle.example.edu", "https://tum.instructure.com/courses/1", False),
    ("https://moodle.example.edu", "https://moodle.example.edu:8443/x", False),
    ("https://moodle.example.edu", "https://moodle.example.edu:443/x", True),
]


def test_the_addresses_of_a_platform(platform: Platform) -> None:
    values = platform.registration | {"any_deployment": True, "audience": None}
    del values["deployments"]
    times: Any = dict.fromkeys(("launched_at", "refused_at", "refusal"))
    known = Registration(**values, created_at=datetime.now(UTC), **times)
    told = []
    for issuer, address, _ in ADDRESSES:
        auth = "https://sso.canvaslms.com/auth" if "canvas" in issuer else f"{issuer}/auth"
        is_own = replace(known, issuer=issuer, auth_url=auth).is_own(address)
        told.append((issuer, address, is_own))
    assert told == ADDRESSES


@pytest.mark.parametrize("target", ["absent", None])
def test_a_platform_may_leave_out_the_target(tool: Tool, target: str | None) -> None:
    def without_target(claims: dict[str, Any]) -> None:
        del claims[f"{LTI}target_link_uri"]
        if target is None:
            claims[f"{LTI}target_link_uri"] = None

    link = deep_linking(f"{tool.platform.address}/return?course=1")
    tool.platform.habits[:] = [link, without_target]
    page = tool.launch("turing")
    assert page.status_code == 200
    chosen = {"exercise": ["scara"], "points:scara": "2.5", "as": "several"}
    [item] = answer(tool, submitted(tool, page.text, action="add", **chosen))[f"{DL}content_items"]
    assert item["url"] == "http://127.0.0.1:8000/lti/launch"
