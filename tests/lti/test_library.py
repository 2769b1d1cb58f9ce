"""Test the service with an LTI platform by others."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime

import jwt
import pytest
from dh_grader.lti.roster import ask_for_roster, enrol_members, read_roster
from dh_grader.store.tables import course_learners, registrations
from sqlalchemy import select, update

from tests.access.kept_services import SECRET
from tests.lti.conftest import WRONG, Journey, Tool, hidden, token_of
from tests.lti.conftest import journey as journey
from tests.lti.library import Configuration, Launch, OtherPlatform, Preflight
from tests.lti.platform import MEMBER, deep_linking, rsa_key, running

# --- Test launches from an independent platform, built with lti1p3platform


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


# --- Test scores and class lists with an independent platform, built with lti1p3platform

LEARNER = [f"{MEMBER}#Learner"]


@dataclass
class Course:
    """A course at a platform built with lti1p3platform, with learners who submit answers."""

    other: OtherPlatform
    journey: Journey

    def launch(self, user: str) -> None:
        # Launch the tool as `user`, with a launch message that the library makes.
        #
        # The message contains the addresses of the platform's services for scores and the roster.
        tool, other = self.journey.tool, self.other
        begun = tool.login(user)
        launch = Launch(Preflight(begun.asked), other.configuration)
        launch.set_user_data(f"user {user}", LEARNER)
        launch.set_resource_link_claim("link-9", title="Homework 9")
        launch.set_launch_context_claim("course-9", context_title="Robots")
        launch.set_custom_parameters_claim({"exercise": "planar-rr=10"})
        launch.set_ags(f"{other.address}/items", allow_creating_lineitems=other.makes_items)
        launch.set_nrps(f"{other.address}/members?limit=2")
        sent = launch.lti_launch()
        page = tool.post(sent["state"], sent["id_token"], begun.cookies)
        token = token_of(page.text)
        self.journey.tokens[user] = {"authorization": f"Bearer {token}"}

    def score(self, user: str, item: str = "i0") -> float | None:
        """Return the points that the platform has for a learner."""
        found: float | None = self.other.scores[item][f"user {user}"].get("scoreGiven")
        return found


@pytest.fixture
def course(tool: Tool, journey: Journey) -> Iterator[Course]:
    configuration = Configuration(platform=tool.platform)
    tool.platform.keys[:] = configuration.get_jwks()["keys"]
    own_keys = tool.send("GET", "/lti/jwks.json").json()
    configuration._registration.set_tool_key_set(own_keys)
    other = OtherPlatform(configuration)
    with running(other.app()) as other.port:
        token_url = f"{other.address}/token"
        tool.do(lambda it: it.execute(update(registrations).values(token_url=token_url)))
        yield Course(other, journey)


@pytest.mark.long
def test_scores_arrive_at_a_platform_by_others(course: Course) -> None:
    # The platform has no line item, so the first score makes one. The latest score counts.
    other, journey = course.other, course.journey
    course.launch("ada")
    attempt = journey.hand_in()
    assert journey.send() == 1
    assert course.score("ada") == journey.total() > 0
    [item] = other.items.values()
    assert (item["resourceLinkId"], item["label"]) == ("link-9", "Homework 9")
    assert item["scoreMaximum"] == 10
    sent = other.scores["i0"]["user ada"]
    assert (sent["activityProgress"], sent["gradingProgress"]) == ("Completed", "FullyGraded")
    course.launch("grace")
    journey.hand_in("grace", answers=WRONG)
    journey.send()
    assert course.score("grace") == journey.total("grace")
    override = {"points": 0, "reason": "copied", "author": "t"}
    journey.post(f"attempts/{attempt['id']}/override", **override)
    # The platform's own clock does not go on with ours, and it refuses requests from its future.
    journey.clock.go_on(seconds=-3)
    # The token that the service has is not accepted any more: it asks for another one.
    other.configuration.sign_with(rsa_key())
    assert journey.send() == 1
    assert other.asked[-3:] == ["score refused", "token", "score"]
    assert course.score("ada") == 0
    journey.post("learners/forget", learner=attempt["learner"], apply=True)
    journey.clock.go_on(seconds=3)
    assert journey.send() == 1
    assert course.score("ada") is None
    assert other.asked.count("new item") == 1


@pytest.mark.long
def test_a_line_item_is_found_on_the_second_page(course: Course) -> None:
    other = course.other
    for name, link in (("i0", "link-1"), ("i1", "link-9")):
        other.items[name] = {"id": f"{other.address}/items/{name}", "resourceLinkId": link}
    other.makes_items = False
    course.launch("ada")
    course.journey.hand_in()
    assert course.journey.send() == 1
    assert course.score("ada", "i1") == course.journey.total()
    assert other.asked == ["token", "items", "items", "token", "score"]


def test_the_roster_of_a_platform_by_others(course: Course, tool: Tool) -> None:
    course.launch("ada")
    people = [{"user_id": f"user {i}", "name": f"Person {i}", "roles": LEARNER} for i in range(4)]
    course.other.members = [{"user_id": "user ada", "name": "Ada", "roles": LEARNER}, *people]
    place, _ = course.journey.place()
    now = datetime.now(UTC)
    asked = tool.do(lambda it: ask_for_roster(it, place, SECRET, now))
    members = read_roster(asked)
    tool.do(lambda it: enrol_members(it, asked, members, SECRET, shows_names=True))
    names = tool.do(lambda it: it.execute(select(course_learners.c.name)).scalars().all())
    assert sorted(names) == ["Ada", "Person 0", "Person 1", "Person 2", "Person 3"]
    assert course.other.asked == ["token", "members", "members", "members"]
