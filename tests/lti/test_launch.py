"""Test launches, also forged ones."""

import base64
import json
import re
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Any

import jwt
import pytest
from dh_grader.lti.launch import digest
from dh_grader.lti.registrations import (
    LTI_PROBLEMS,
    NewRegistration,
    add_registration,
    remove_registration,
)
from dh_grader.store.tables import contexts, launches, learners, registrations, resource_links
from dh_grader.translations import LANGUAGES
from sqlalchemy import event, select, update

from tests.lti.conftest import Begun, Tool, hidden, token_of
from tests.lti.platform import (
    CLIENT,
    DL,
    LTI,
    MEMBER,
    ROLES,
    TEST_USER,
    Platform,
    deep_linking,
    public_jwk,
    rsa_key,
)
from tests.translations.pseudo import PSEUDO

# --- Test LTI launches of learners, tutors and visitors

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
    from dh_grader.lti.registrations import LtiRole, role_of

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


# --- The service refuses forged and stale LTI messages, and gives the reason

OTHER_KEY = rsa_key()
SHORT_KEY = rsa_key(1024)
Claims = dict[str, Any]


def without(name: str) -> Callable[[Claims], None]:
    return lambda claims: claims.__delitem__(name)


def put(name: str, value: Any) -> Callable[[Claims], None]:
    return lambda claims: claims.update({name: value})


def lti(name: str, value: Any) -> Callable[[Claims], None]:
    return put(f"{LTI}{name}", value)


def setting(name: str, value: Any) -> Callable[[Claims], None]:
    return lambda claims: claims[SETTINGS].update({name: value})


def now(seconds: float) -> int:
    return int(time.time() + seconds)


# A change of the claims of a right message, and the reason for which it is refused.
CLAIMS: list[tuple[str, Callable[[Claims], None], str]] = [
    ("no issuer", without("iss"), "wrong-issuer"),
    ("another issuer", put("iss", "https://evil.example"), "wrong-issuer"),
    ("no audience", without("aud"), "wrong-audience"),
    ("another audience", put("aud", "client-2"), "wrong-audience"),
    ("a list of other audiences", put("aud", ["client-2", "client-3"]), "wrong-audience"),
    ("an audience that contains ours", put("aud", f"{CLIENT}0"), "wrong-audience"),
    ("several audiences without party", put("aud", [CLIENT, "client-2"]), "wrong-party"),
    ("another party", put("azp", "client-2"), "wrong-party"),
    ("no expiry", without("exp"), "no-expiry"),
    ("an expiry in words", put("exp", "tomorrow"), "no-expiry"),
    ("expired", lambda it: it.update(exp=now(-11)), "expired"),
    ("no time of issue", without("iat"), "no-issue-time"),
    ("true as the time of issue", put("iat", True), "no-issue-time"),
    ("issued in the future", lambda it: it.update(iat=now(30)), "issued-later"),
    ("issued yesterday", lambda it: it.update(iat=now(-86400)), "issued-before"),
    ("valid tomorrow", lambda it: it.update(nbf=now(86400)), "not-yet-valid"),
    ("no nonce", without("nonce"), "no-nonce"),
    ("an empty nonce", put("nonce", ""), "no-nonce"),
    ("another nonce", put("nonce", "x" * 43), "wrong-nonce"),
    ("version 1.1", lti("version", "LTI-1p0"), "wrong-version"),
    ("no version", without(f"{LTI}version"), "wrong-version"),
    ("an unknown message", lti("message_type", "LtiEverythingRequest"), "wrong-message"),
    ("a list as message", lti("message_type", ["LtiResourceLinkRequest"]), "wrong-message"),
    ("no deployment", without(f"{LTI}deployment_id"), "no-deployment"),
    ("a number as deployment", lti("deployment_id", 1), "no-deployment"),
    ("the deployment of another login", lti("deployment_id", "other"), "other-deployment"),
    ("no target", without(f"{LTI}target_link_uri"), "no-target"),
    (
        "a target elsewhere",
        lti("target_link_uri", "https://evil.example/lti/launch"),
        "other-target",
    ),
    ("another path", lti("target_link_uri", "http://127.0.0.1:8000/tutor"), "other-target"),
    (
        "a user in the target",
        lti("target_link_uri", "http://x@127.0.0.1:8000/lti/launch"),
        "other-target",
    ),
    ("no roles", without(f"{LTI}roles"), "no-roles"),
    ("one role as text", lti("roles", "Instructor"), "no-roles"),
    ("an empty user", put("sub", ""), "bad-user"),
    ("a number as user", put("sub", 7), "bad-user"),
    ("a long user", put("sub", "x" * 256), "bad-user"),
    ("no context", without(f"{LTI}context"), "no-context"),
    ("an empty context", lti("context", {"id": ""}), "no-context"),
    ("no resource link", without(f"{LTI}resource_link"), "no-resource-link"),
    ("a text as context", lti("context", "course-1"), "bad-claim"),
    ("a list as parameters", lti("custom", ["exercise=scara"]), "bad-claim"),
]  # fmt: skip


# The same for a message of deep linking; the return address is that of the platform.
SETTINGS = f"{DL}deep_linking_settings"
LINKING: list[tuple[str, Callable[[Claims], None], str]] = [
    ("no settings", without(SETTINGS), "no-linking-settings"),
    ("a text as settings", put(SETTINGS, "return"), "bad-claim"),
    ("a learner", lti("roles", [f"{MEMBER}#Learner"]), "not-a-tutor"),
    ("a mentor", lti("roles", [f"{MEMBER}#Mentor"]), "not-a-tutor"),
    ("a test user", lti("roles", [f"{MEMBER}#Instructor", TEST_USER]), "not-a-tutor"),
    ("no user", without("sub"), "not-a-tutor"),
    ("no return", setting("deep_link_return_url", None), "no-return-address"),
    ("a script as return", setting("deep_link_return_url", "javascript:x"), "no-return-address"),
    ("a list as return", setting("deep_link_return_url", []), "no-return-address"),
    (
        "a return without HTTPS",
        setting("deep_link_return_url", "http://evil.example/"),
        "no-return-address",
    ),
    (
        "a return elsewhere",
        setting("deep_link_return_url", "https://evil.example/"),
        "foreign-return-address",
    ),
    (
        "a return to another port",
        setting("deep_link_return_url", "http://127.0.0.1:9/"),
        "foreign-return-address",
    ),
    ("no types", setting("accept_types", None), "no-links-accepted"),
    ("files only", setting("accept_types", ["file", "html"]), "no-links-accepted"),
    ("a text as types", setting("accept_types", "ltiResourceLink"), "no-links-accepted"),
    ("a number as data", setting("data", 7), "bad-claim"),
    ("much data", setting("data", "x" * 16_001), "bad-claim"),
    ("another nonce", put("nonce", "x" * 43), "wrong-nonce"),
    ("another deployment", lti("deployment_id", "other"), "other-deployment"),
    ("another target", lti("target_link_uri", "https://evil.example/lti/launch"), "other-target"),
    ("an empty target", lti("target_link_uri", ""), "no-target"),
    ("a number as target", lti("target_link_uri", 1), "no-target"),
]  # fmt: skip


def tokens(platform: Platform, begun: Begun) -> list[tuple[str, str, str]]:
    # Return forged tokens: a description, the token, and the reason for which it is refused.
    claims = platform.claims("ada", "link-1", begun.asked["nonce"])
    good = platform.signed(claims)
    head, body, signature = good.split(".")
    other = body[:-8] + ("A" if body[-8] != "A" else "B") + body[-7:]

    def encoded(text: str) -> str:
        return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")

    def header(**fields: Any) -> str:
        return f"{encoded(json.dumps(fields))}.{body}.{signature}"

    confused = jwt.PyJWS().encode(json.dumps(claims).encode(), "x" * 40, "HS256", {"kid": "key-1"})
    own = public_jwk(OTHER_KEY, "key-1")
    address = "http://169.254.169.254/jwks.json"
    return [
        ("no token", "", "no-token"),
        ("a long token", "x" * 50_000, "token-too-long"),
        ("no parts", "nonsense", "token-malformed"),
        ("two parts", f"{head}.{body}", "token-malformed"),
        ("nested lists", f"{encoded('[' * 20_000)}.{body}.{signature}", "token-malformed"),
        ("no object", platform.signed(["claims"]), "token-malformed"),
        ("no signature", f"{head}.{body}.", "wrong-signature"),
        ("another signature", f"{head}.{other}.{signature}", "wrong-signature"),
        ("alg none", header(alg="none", kid="key-1"), "wrong-algorithm"),
        ("HS256", confused, "wrong-algorithm"),
        ("RS512", header(alg="RS512", kid="key-1"), "wrong-algorithm"),
        ("no key id", header(alg="RS256"), "no-key-id"),
        ("a number as key id", header(alg="RS256", kid=1), "token-malformed"),
        ("another key", platform.signed(claims, OTHER_KEY), "wrong-signature"),
        ("its own key", platform.signed(claims, OTHER_KEY, jwk=own), "wrong-signature"),
        ("an address of keys", platform.signed(claims, OTHER_KEY, jku=address), "wrong-signature"),
        ("a certificate", platform.signed(claims, OTHER_KEY, x5u=address), "wrong-signature"),
        ("an unknown key", platform.signed(claims, OTHER_KEY, kid="evil"), "unknown-key"),
        ("a short key", header(alg="RS256", kid="short"), "unusable-key"),
        ("a key for encryption", platform.signed(claims, kid="encrypts"), "unusable-key"),
    ]  # fmt: skip


def reason(page: Any) -> str:
    """Return the error code on the page of a refused launch."""
    assert page.status_code in (403, 503), page.status_code
    assert "Reference number" in page.text
    assert "data-key" not in page.text
    assert 'name="ticket"' not in page.text
    return str(page.text.rpartition("</code> (")[2].partition(")")[0])


@pytest.fixture
def keys(platform: Platform) -> Platform:
    platform.keys.append(public_jwk(SHORT_KEY, "short"))
    platform.keys.append(public_jwk(platform.key, "encrypts", use="enc"))
    return platform


def test_forged_messages_are_refused(tool: Tool, keys: Platform) -> None:
    before, begun = tool.counts(), tool.login()
    told = {}
    for name, change, _ in CLAIMS:
        claims = keys.claims("ada", "link-1", begun.asked["nonce"])
        change(claims)
        told[name] = reason(tool.post(begun.asked["state"], keys.signed(claims), begun.cookies))
    assert told == {name: expected for name, _, expected in CLAIMS}
    forged = tokens(keys, begun)
    told = {
        name: reason(tool.post(begun.asked["state"], token, begun.cookies))
        for name, token, _ in forged
    }
    assert told == {name: expected for name, _, expected in forged}
    assert tool.counts() == before
    # The right message is still accepted: the platform's keys were fetched once.
    right = keys.signed(keys.claims("ada", "link-1", begun.asked["nonce"]))
    assert tool.post(begun.asked["state"], right, begun.cookies).status_code == 200
    assert keys.fetched == ["/jwks.json"]
    assert len(CLAIMS) + len(forged) >= 40


def test_forged_messages_of_deep_linking_are_refused(tool: Tool, platform: Platform) -> None:
    platform.habits.append(deep_linking(f"{platform.address}/return"))
    before, begun = tool.counts(), tool.login("turing")

    def sent(*changes: Callable[[Claims], None]) -> Any:
        claims = platform.claims("turing", "", begun.asked["nonce"])
        for change in changes:
            change(claims)
        return tool.post(begun.asked["state"], platform.signed(claims), begun.cookies)

    told = {name: reason(sent(change)) for name, change, _ in LINKING}
    assert told == {name: expected for name, _, expected in LINKING}
    assert tool.counts() == before
    page = sent()
    assert page.status_code == 200
    assert reason(sent()) == "state-used"
    # Tickets are not taken for those of the other form, nor from a page of another site.
    ticket = {"ticket": hidden(page.text, "ticket"), "action": "cancel"}
    assert reason(tool.send("POST", "/lti/session", data=ticket)) == "ticket-expired"
    platform.habits.clear()
    other = {"ticket": hidden(tool.launch("turing").text, "ticket"), "action": "cancel"}
    assert reason(tool.send("POST", "/lti/links", data=other)) == "ticket-expired"
    foreign = {"origin": "https://evil.example", "sec-fetch-site": "cross-site"}
    refused = tool.send("POST", "/lti/links", data=ticket, headers=foreign)
    assert reason(refused) == "binding-from-elsewhere"
    tool.do(lambda it: remove_registration(it, "moodle"))
    assert reason(tool.send("POST", "/lti/links", data=ticket)) == "no-longer-registered"


def test_replayed_and_mixed_up_messages_are_refused(tool: Tool, platform: Platform) -> None:
    one, two = tool.login(), tool.login("grace")
    first, second = (
        platform.signed(platform.claims(user, "link-1", begun.asked["nonce"]))
        for user, begun in (("ada", one), ("grace", two))
    )
    before = tool.counts()
    cases = {
        "the nonce of another login": (one.asked["state"], second, one.cookies, "wrong-nonce"),
        "no state": ("", first, one.cookies, "no-state"),
        "a state that nobody began": ("x" * 43, first, one.cookies, "unknown-state"),
    }
    told = {
        name: reason(tool.post(state, token, cookies))
        for name, (state, token, cookies, _) in cases.items()
    }
    assert told == {name: case[-1] for name, case in cases.items()}
    # Another browser has no cookie, or that of another login.
    assert "Open in a new window" in tool.post(one.asked["state"], first, two.cookies).text
    stolen = f"{one.cookies.partition('=')[0]}={two.cookies.partition('=')[2]}"
    assert reason(tool.post(one.asked["state"], first, stolen)) == "other-browser"
    # A page of another site has what the platform's storage keeps for its own login.
    secret = one.cookies.partition("=")[2]
    sent = tool.post(one.asked["state"], first, "", browser=secret)
    assert reason(sent) == "binding-from-elsewhere"
    ours = {"origin": "http://127.0.0.1:8000", "sec-fetch-site": "same-origin"}
    fields = {"state": one.asked["state"], "id_token": first, "browser": "x" * 43}
    assert reason(tool.send("POST", "/lti/launch", data=fields, headers=ours)) == "other-browser"
    window = {"sec-fetch-dest": "document"}
    sent = tool.send("POST", "/lti/launch", data=fields | {"browser": ""}, headers=window)
    assert reason(sent) == "cookies-blocked"
    failed = tool.post(one.asked["state"], "", one.cookies, error="login_required")
    assert reason(failed) == "platform-error"
    assert tool.counts() == before
    assert tool.post(one.asked["state"], first, one.cookies).status_code == 200
    after = tool.counts()
    assert reason(tool.post(one.asked["state"], first, one.cookies)) == "state-used"
    assert tool.counts() == after


def test_stale_logins_are_refused(tool: Tool, platform: Platform) -> None:
    begun = tool.login()
    token = platform.signed(platform.claims("ada", "link-1", begun.asked["nonce"]))

    def aged(minutes: float) -> None:
        mine = launches.c.state == digest(begun.asked["state"])
        ended = datetime.now(UTC) - timedelta(minutes=minutes)
        tool.do(lambda it: it.execute(update(launches).where(mine).values(expires_at=ended)))

    aged(0)
    assert reason(tool.post(begun.asked["state"], token, begun.cookies)) == "state-expired"
    aged(11)
    tool.login()
    assert reason(tool.post(begun.asked["state"], token, begun.cookies)) == "unknown-state"


def test_forged_logins_are_refused(tool: Tool, platform: Platform) -> None:
    other = platform.registration | {"id": "second", "client_id": "client-2"}
    new = NewRegistration.model_validate(other)
    tool.do(lambda it: add_registration(it, new, datetime.now(UTC)))
    cases = {
        "no issuer": ({"iss": ""}, "login-incomplete"),
        "no user": ({"login_hint": ""}, "login-incomplete"),
        "no target": ({"target_link_uri": ""}, "login-incomplete"),
        "a long hint": ({"login_hint": "x" * 4001}, "login-too-long"),
        "an unknown issuer": ({"iss": "https://evil.example"}, "unknown-platform"),
        "an unknown client": ({"client_id": "client-3"}, "unknown-platform"),
        "one of two clients": ({"client_id": ""}, "several-platforms"),
        "a target elsewhere": (
            {"target_link_uri": "https://evil.example/lti/launch"},
            "foreign-target",
        ),
        "a target without meaning": ({"target_link_uri": "javascript:alert(1)"}, "foreign-target"),
        "another path": ({"target_link_uri": "http://127.0.0.1:8000/tutor"}, "foreign-target"),
    }
    told = {name: reason(tool.login(**more).answer) for name, (more, _) in cases.items()}
    assert told == {name: case[-1] for name, case in cases.items()}


def test_a_deployment_must_be_registered_where_some_are(tool: Tool, platform: Platform) -> None:
    platform.habits.append(lti("deployment_id", "deployment-2"))
    before = tool.counts()
    page = tool.launch(lti_deployment_id="deployment-2")
    assert (reason(page), tool.counts()) == ("unknown-deployment", before)
    open_to_all = update(registrations).values(any_deployment=True)
    tool.do(lambda it: it.execute(open_to_all))
    assert tool.launch(lti_deployment_id="deployment-2").status_code == 200
    # The same context in two deployments is two courses.
    platform.habits.clear()
    assert tool.launch().status_code == 200
    assert tool.counts()["courses"] == 2


def test_a_removed_registration_launches_nothing(tool: Tool, platform: Platform) -> None:
    tool.launch()
    begun = tool.login()
    tool.do(lambda it: remove_registration(it, "moodle"))
    token = platform.signed(platform.claims("ada", "link-1", begun.asked["nonce"]))
    assert reason(tool.post(begun.asked["state"], token, begun.cookies)) == "unknown-state"
    assert reason(tool.login().answer) == "unknown-platform"


def test_every_reason_says_what_to_do() -> None:
    for code, problem in LTI_PROBLEMS.items():
        assert problem.cause.endswith((".", ": {reason}")), code
        assert (
            "course" in problem.advice or "teacher" in problem.advice or "browser" in problem.advice
        )


@pytest.mark.long
def test_two_platforms_and_two_courses_with_the_same_user(tool: Tool, platform: Platform) -> None:
    # A user id is one learner in two courses of a platform, but two learners at two platforms.
    other = platform.registration | {"id": "second", "client_id": "client-2"}
    new = NewRegistration.model_validate(other)
    tool.do(lambda it: add_registration(it, new, datetime.now(UTC)))
    for client, course in (("client-1", "a"), ("client-1", "b"), ("client-2", "a")):
        begun = tool.login(client_id=client)
        claims = platform.claims("ada", "link-1", begun.asked["nonce"])
        claims |= {"aud": client, f"{LTI}context": {"id": course, "title": course}}
        page = tool.post(begun.asked["state"], platform.signed(claims), begun.cookies)
        assert page.status_code == 200
    counts = tool.counts()
    assert (counts["lti_learners"], counts["courses"], counts["course_learners"]) == (2, 3, 3)
    rows = tool.do(lambda it: it.execute(select(learners)).all())
    assert {row.sub for row in rows} == {"user ada"}
    assert len({row.learner for row in rows}) == 2
    # A message of one platform is not accepted for a login at the other.
    begun = tool.login(client_id="client-2")
    mixed = platform.signed(platform.claims("ada", "link-1", begun.asked["nonce"]))
    assert reason(tool.post(begun.asked["state"], mixed, begun.cookies)) == "wrong-audience"
    assert tool.counts() == counts


def test_a_learner_is_a_platform_and_its_user() -> None:
    from dh_grader.lti.launch import pseudonym

    from tests.access.kept_services import SECRET

    one, two = (pseudonym(each, "user 1", SECRET) for each in ("moodle", "canvas"))
    assert one != two
    assert one == pseudonym("moodle", "user 1", SECRET)
    assert pseudonym("a", "b\nc", SECRET) != pseudonym("a\nb", "c", SECRET)
