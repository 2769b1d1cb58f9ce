"""Test LTI launches of learners, tutors and visitors."""

import re
from typing import Any

import pytest
from dh_grader.store.tables import contexts, resource_links
from dh_grader.translations import LANGUAGES
from sqlalchemy import event, select

from tests.lti.conftest import Tool, hidden, token_of
from tests.lti.platform import LTI, MEMBER, ROLES
from tests.translations.pseudo import PSEUDO

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
RIGHT = {"table": "a1 0 0 θ1\na2 0 0 θ2"}


@KINDS
def test_a_learner_opens_the_exercise_and_hands_in(tool: Tool) -> None:
    page = tool.launch("ada")
    assert page.status_code == 200
    assert "set-cookie" not in page.headers
    bearer = {"authorization": f"Bearer {token_of(page.text)}"}
    view = tool.send("GET", "/v1/me", headers=bearer).json()
    [course] = view["courses"]
    assert (course["title"], course["zone"]) == ("Robotics 2026", "Europe/Berlin")
    [assignment] = course["assignments"]
    assert (assignment["title"], assignment["exercises"][0]["points"]) == ("Homework 1", 10)
    path = f"/v1/courses/{course['id']}/assignments/{assignment['id']}/attempts"
    body = {"exercise": "planar-rr", "answers": RIGHT}
    sent = tool.send("POST", path, json=body, headers=bearer | {"Idempotency-Key": "one"})
    assert sent.status_code == 201
    # The second launch leads to the same learner and the same assignment.
    again = {"authorization": f"Bearer {token_of(tool.launch('ada').text)}"}
    view = tool.send("GET", "/v1/me", headers=again).json()
    assert len(view["courses"][0]["assignments"][0]["exercises"][0]["attempts"]) == 1
    assert set(tool.counts().values()) == {1}
    # Neither the name nor the address of the learner is anywhere.
    assert "secret" not in page.text.lower()
    assert "secret" not in str(view).lower()
    assert "user ada" not in str(view)


@KINDS
def test_a_tutor_sets_up_a_link_and_opens_the_course(tool: Tool) -> None:
    tool.platform.habits.append(lambda claims: claims.update({f"{LTI}custom": {}}))
    assert "has not chosen exercises" in tool.launch("ada").text
    form = tool.launch("turing").text
    ticket = hidden(form, "ticket")
    fields: dict[str, Any] = {"ticket": ticket, "title": "Homework 7"}
    found = tool.send("POST", "/lti/assignment", data=fields | {"search": "SCARA"}).text
    assert "scara" in found
    assert "planar-rrr" not in found
    wrong = fields | {"action": "save"}
    assert "at least one" in tool.send("POST", "/lti/assignment", data=wrong).text
    for points, said in (
        ("-1", "numbers above 0"),
        ("nan", "numbers above 0"),
        ("12", "12 points"),
    ):
        chosen = wrong | {"exercise": "scara", "points:scara": points}
        assert said in tool.send("POST", "/lti/assignment", data=chosen).text
    token = token_of(tool.launch("ada").text)
    view = tool.send("GET", "/v1/me", headers={"authorization": f"Bearer {token}"}).json()
    [assignment] = view["courses"][0]["assignments"]
    assert (assignment["title"], assignment["exercises"][0]["points"]) == ("Homework 7", 12)
    opened = tool.send("POST", "/lti/session", data={"ticket": ticket})
    assert opened.status_code == 303
    cookie = opened.headers["set-cookie"].partition(";")[0]
    path = opened.headers["location"].removeprefix("..")
    assert "Robotics 2026" in tool.send("GET", path, headers={"cookie": cookie}).text
    # The session is for this course only.
    answer = tool.send("POST", "/v1/courses", headers={"cookie": cookie}, json={})
    assert answer.status_code == 403


@pytest.mark.long
def test_the_page_is_in_the_language_that_the_user_has_on_the_platform(
    tool: Tool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    told: dict[str, Any] = {}
    tool.platform.habits.append(lambda claims: claims.update(told))
    for presentation, tag in (
        ({"locale": "qps-Ploc"}, "qps-Ploc"),
        ({"locale": "tlh"}, "en"),
        ({"locale": 7}, "en"),
        (None, "en"),
    ):
        told[f"{LTI}launch_presentation"] = presentation
        page = tool.launch("ada")
        assert page.status_code == 200
        assert f'<html lang="{tag}">' in page.text


def test_a_tutor_goes_on_in_the_language_of_the_platform(tool: Tool) -> None:
    german = {f"{LTI}launch_presentation": {"locale": "de-AT"}, f"{LTI}custom": {}}
    tool.platform.habits.append(lambda claims: claims.update(german))
    page = tool.launch("turing").text
    fields = {name: hidden(page, name) for name in ("ticket", "locale")}
    assert "Ihre Studierenden sehen diese Aufgaben" in page
    refused = tool.send("POST", "/lti/assignment", data=fields | {"action": "save"}).text
    assert "Wählen Sie mindestens eine Aufgabe." in refused
    assert fields["locale"] == hidden(refused, "locale") == "de"
    # Words of either language find an exercise.
    for word in ("ebener", "revolute"):
        found = tool.send("POST", "/lti/assignment", data=fields | {"search": f"planar-rr {word}"})
        assert 'value="planar-rr"' in found.text
    chosen = {"title": "Blatt 7", "exercise": "scara", "points:scara": "12", "action": "save"}
    made = tool.send("POST", "/lti/assignment", data=fields | chosen).text
    assert "Was Ihre Studierenden bekommen" in made
    assert ": 12 Punkte</li>" in made
    opened = tool.send("POST", "/lti/session", data=fields)
    cookie = opened.headers["set-cookie"].partition(";")[0]
    path = opened.headers["location"].removeprefix("..")
    assert "Neues Übungsblatt" in tool.send("GET", path, headers={"cookie": cookie}).text


def test_previews_and_guests_record_nothing(tool: Tool) -> None:
    for user in ("preview", "", "parent"):
        before = tool.counts()
        page = tool.launch(user)
        assert (user, page.status_code, tool.counts()) == (user, 200, before)
        assert "data-key" not in page.text
    tool.launch("turing")
    before = tool.counts()
    for user in ("", "parent"):
        assert "token=" not in tool.launch(user).text
    preview = tool.launch("preview").text
    [token] = re.findall(r' token="([^"]+)"', preview)
    bearer = {"authorization": f"Bearer {token}"}
    graded = tool.send(
        "POST", "/v1/exercises/planar-rr/grade", json={"answers": RIGHT}, headers=bearer
    )
    assert graded.json()["score"] > 0
    for path, body in (
        ("planar-rr/attempts", {"answers": RIGHT}),
        ("scara/grade", {"answers": {}}),
    ):
        refused = tool.send("POST", f"/v1/exercises/{path}", json=body, headers=bearer)
        assert (path, refused.status_code) == (path, 403)
    assert tool.counts() == before


def test_roles_of_platforms_have_a_role_here() -> None:
    from dh_grader.lti import LtiRole, role_of

    lis = "http://purl.imsglobal.org/vocab/lis/v2"
    cases = {
        f"{MEMBER}#Instructor": LtiRole.TUTOR,
        f"{MEMBER}#Administrator": LtiRole.TUTOR,
        f"{MEMBER}#ContentDeveloper": LtiRole.TUTOR,
        f"{MEMBER}/Instructor#TeachingAssistant": LtiRole.TUTOR,
        f"{lis}/system/person#Administrator": LtiRole.TUTOR,
        f"{lis}/institution/person#Administrator": LtiRole.TUTOR,
        f"{MEMBER}#Learner": LtiRole.LEARNER,
        f"{MEMBER}/Learner#NonCreditLearner": LtiRole.LEARNER,
        f"{MEMBER}#Mentor": LtiRole.GUEST,
        f"{MEMBER}/Mentor#Observer": LtiRole.GUEST,
        f"{lis}/institution/person#Instructor": LtiRole.GUEST,
        f"{lis}/institution/person#Observer": LtiRole.GUEST,
        "Instructor": LtiRole.GUEST,
        f"https://evil.example/{MEMBER}#Instructor": LtiRole.GUEST,
        f"{MEMBER}#Instructors": LtiRole.GUEST,
    }
    assert {role: role_of([role], has_id=True) for role in cases} == cases
    assert role_of(ROLES["turing"], has_id=False) is LtiRole.GUEST


def test_only_the_platform_may_frame_the_pages(tool: Tool) -> None:
    for user in ("ada", "turing", "preview", ""):
        policy = tool.launch(user).headers["content-security-policy"]
        assert f"frame-ancestors 'self' {tool.platform.address};" in policy
    assert (
        tool.platform.address not in tool.send("GET", "/learn").headers["content-security-policy"]
    )


def test_the_services_of_the_platform_are_kept(tool: Tool) -> None:
    tool.launch("ada")
    [link] = tool.do(lambda it: it.execute(select(resource_links)).all())
    [context] = tool.do(lambda it: it.execute(select(contexts)).all())
    assert link.lineitem_url == f"{tool.platform.address}/items/1?type=1"
    assert link.lineitems_url == f"{tool.platform.address}/items?type=1"
    assert link.scopes.split()[1].endswith("scope/score")
    assert context.memberships_url == f"{tool.platform.address}/members"


def test_a_tutor_reviews_the_attempts_of_a_learner(tool: Tool) -> None:
    tool.launch("ada")

    def review(claims: dict[str, Any]) -> None:
        claims[f"{LTI}message_type"] = "LtiSubmissionReviewRequest"
        claims[f"{LTI}for_user"] = {"user_id": "user ada", "name": "Ada Secret"}

    tool.platform.habits.append(review)
    page = tool.launch("turing").text
    assert "Open the attempts" in page
    opened = tool.send("POST", "/lti/session", data={"ticket": hidden(page, "ticket")})
    cookie = opened.headers["set-cookie"].partition(";")[0]
    path = opened.headers["location"].removeprefix("..")
    shown = tool.send("GET", path, headers={"cookie": cookie})
    assert shown.status_code == 200
    assert "Homework 1" in shown.text
    assert "Secret" not in shown.text
    # A message without the user is refused.
    tool.platform.habits.append(lambda claims: claims.pop(f"{LTI}for_user"))
    assert tool.launch("turing").status_code == 403


@pytest.mark.long
@KINDS
def test_launches_of_a_class_share_no_row_that_changes(tool: Tool) -> None:
    # If two launches changed the same row, one would wait for the other in PostgreSQL.
    tool.launch("ada")
    changed = []

    def note(*given: Any) -> None:
        cursor, statement = given[1], given[2]
        if statement.startswith("UPDATE") and cursor.rowcount:
            changed.append(statement.split()[1])

    event.listen(tool.store.engine, "after_cursor_execute", note)
    tool.launch("grace")
    event.remove(tool.store.engine, "after_cursor_execute", note)
    assert changed == ["lti_launches", "lti_learners"]
    # What is new is noted.
    tool.platform.habits.append(lambda claims: claims[f"{LTI}resource_link"].update(title="New"))
    tool.launch("grace")
    assert tool.do(lambda it: it.scalar(select(resource_links.c.title))) == "New"
