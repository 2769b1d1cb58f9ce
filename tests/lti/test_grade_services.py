"""Test columns of scores on a platform, and their overview."""

import json
from datetime import timedelta
from functools import partial
from typing import Any

import pytest
from dh_grader.lti.fetching import FetchError
from dh_grader.lti.grade_services import LaterError, problem_told, scores_address
from dh_grader.store import tables
from dh_grader.translations import ENGLISH, language_named, say
from sqlalchemy import Connection, update

from tests.cli.conftest import Run
from tests.cli.conftest import run as run
from tests.lti.conftest import Journey
from tests.lti.gradebook import AGS, Item

# --- Test platforms that are busy, down, or refuse a score

ENDPOINT = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"


def test_scores_is_a_part_of_the_path() -> None:
    cases = {
        "https://m.example/1/lineitem?type_id=3": "https://m.example/1/lineitem/scores?type_id=3",
        "https://m.example/1/lineitem": "https://m.example/1/lineitem/scores",
        "https://m.example/1/lineitem/": "https://m.example/1/lineitem/scores",
        "https://m.example/1?a=b/c&d": "https://m.example/1/scores?a=b/c&d",
    }
    assert {url: scores_address(url) for url in cases} == cases


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "trouble",
    [
        (429, {"Retry-After": "30"}),
        (503, {}),
        (502, {}),
        (504, {}),
        (403, {"x-rate-limit-remaining": "0.0"}),
    ],
)
def test_a_failing_platform_is_asked_ever_more_rarely(
    journey: Journey, trouble: tuple[int, dict[str, str]]
) -> None:
    # The pauses between tries grow. When the platform works again, all scores arrive.
    for user in ("ada", "grace"):
        journey.hand_in(user)
    journey.gradebook.trouble = trouble
    tries = 0
    for _ in range(120):
        tries += journey.send()
        journey.clock.go_on(seconds=30)
    assert 4 <= tries <= 14
    assert set(journey.states().values()) == {"waiting"}
    journey.gradebook.trouble = None
    journey.clock.go_on(hours=4)
    journey.send()
    assert set(journey.states().values()) == {"sent"}
    assert set(journey.gradebook.grades()) == {"ada", "grace"}


def test_the_platform_says_how_long_to_wait(journey: Journey) -> None:
    journey.hand_in()
    journey.gradebook.trouble = (429, {"Retry-After": "600"})
    assert journey.send() == 1
    journey.gradebook.trouble = None
    journey.clock.go_on(seconds=590)
    assert journey.send() == 0
    journey.clock.go_on(seconds=11)
    assert journey.send() == 1
    assert journey.states() == {"ada": "sent"}


def test_a_score_waits_for_an_unreachable_platform(journey: Journey) -> None:
    # No server listens at the line item's address.
    journey.hand_in()
    gone = update(tables.line_items).values(url="http://127.0.0.1:1/items/1")
    journey.tool.do(lambda it: it.execute(gone))
    assert journey.send() == 1
    [row] = journey.rows()
    assert (row.state, json.loads(row.refusal)[0]) == ("waiting", "unreachable")


@pytest.mark.long
def test_a_token_is_used_until_shortly_before_its_end(journey: Journey) -> None:
    attempt = journey.hand_in()
    journey.send()

    def again(points: float) -> None:
        body = {"points": points, "reason": "r", "author": "t"}
        journey.post(f"attempts/{attempt['id']}/override", **body)
        journey.send()

    journey.clock.go_on(minutes=30)
    again(1)
    assert journey.gradebook.asked.count("token") == 1
    journey.clock.go_on(minutes=29, seconds=30)
    again(2)
    assert journey.gradebook.asked.count("token") == 2
    assert journey.gradebook.refused == []
    # The platform has forgotten the token before its time.
    journey.gradebook.tokens.clear()
    again(3)
    assert journey.gradebook.refused == ["401"]
    assert journey.gradebook.asked.count("token") == 3
    assert journey.states() == {"ada": "sent"}


def test_a_refused_token_is_renewed_once(journey: Journey) -> None:
    # If the platform refuses a token, the sender tries once with a new token, and then waits.
    journey.gradebook.lifetime = -1
    journey.hand_in()
    assert journey.send() == 1
    assert journey.gradebook.asked == ["token", "score", "token", "score"]
    [row] = journey.rows()
    assert (row.state, json.loads(row.refusal)[0]) == ("waiting", "unauthorised")


def test_the_audience_of_the_token(journey: Journey) -> None:
    # Brightspace requires its own audience. Without this audience, scores wait with a reason.
    journey.gradebook.audience = "https://api.brightspace.example/auth/token"
    journey.hand_in()
    journey.send()
    [row] = journey.rows()
    assert (row.state, json.loads(row.refusal)[0]) == ("waiting", "token-refused")
    registered = update(tables.registrations).values(audience=journey.gradebook.audience)
    journey.tool.do(lambda it: it.execute(registered))
    journey.clock.go_on(minutes=1)
    journey.send()
    assert journey.states() == {"ada": "sent"}


@pytest.mark.long
@pytest.mark.parametrize("status", [400, 403, 404, 422])
def test_the_score_of_a_learner_waits_for_the_enrolment(journey: Journey, status: int) -> None:
    # The service does not send a refused score again until the learner launches again.
    for user in ("ada", "grace"):
        journey.hand_in(user)
    journey.gradebook.enrolled = {"user grace"}
    journey.gradebook.not_enrolled = status
    assert journey.send() == 2
    assert journey.states() == {"ada": "refused", "grace": "sent"}
    assert json.loads(journey.rows()[0].refusal) == ["not-accepted", {"status": str(status)}]
    journey.clock.go_on(days=2)
    assert journey.send() == 0
    journey.gradebook.enrolled = None
    journey.launch()
    assert journey.send() == 1
    assert set(journey.states().values()) == {"sent"}


@pytest.mark.long
def test_a_line_item_is_found_at_its_new_address(journey: Journey) -> None:
    journey.hand_in()
    journey.gradebook.items = {"77": Item("link-1"), "78": Item("link-2")}
    assert journey.send() == 1
    assert set(journey.gradebook.grades("77")) == {"ada"}
    assert journey.gradebook.items["78"].grades == {}
    # The new address is kept.
    journey.hand_in("grace")
    asked = journey.gradebook.asked.count("items")
    journey.launch("grace")
    journey.send()
    assert journey.gradebook.asked.count("items") >= asked


def test_a_deleted_line_item_is_not_made_again(journey: Journey) -> None:
    # A teacher has deleted the column at the platform. The service does not make it again.
    journey.hand_in()
    journey.gradebook.items.clear()
    journey.send()
    assert json.loads(journey.rows()[0].refusal)[0] == "no-line-item"
    assert journey.gradebook.items == {}


@pytest.mark.long
def test_timestamps_are_later_by_a_second(journey: Journey) -> None:
    # Moodle compares whole seconds. The clock of the platform may be ahead of ours, too.
    attempt = journey.hand_in()
    for points in (1, 2, 3):
        body = {"points": points, "reason": "r", "author": "t"}
        journey.post(f"attempts/{attempt['id']}/override", **body)
        journey.clock.go_on(milliseconds=1100)
        assert journey.send() == 1
    assert journey.gradebook.refused == []
    item = journey.gradebook.items["1"]
    item.stamps["user ada"] += timedelta(seconds=20)
    journey.post(f"attempts/{attempt['id']}/override", points=4, reason="r", author="t")
    journey.send()
    assert journey.gradebook.refused == ["409"]
    for _ in range(10):
        journey.clock.go_on(seconds=10)
        journey.send()
    assert journey.states() == {"ada": "sent"}


UNUSABLE: list[object] = [
    [],
    {},
    [{"resourceLinkId": "link-1"}],
    [{"resourceLinkId": "link-1", "id": "https://evil.example/items/1"}],
    [{"resourceLinkId": "link-1", "id": "http://169.254.169.254/items/1"}],
    [{"resourceLinkId": "link-1", "id": 7}],
    [{"resourceLinkId": "link-1", "id": "x" * 2000}],
    "x" * 100_000,
    None,
]


@pytest.mark.long
def test_unusable_lists_of_line_items_cost_one_try(journey: Journey) -> None:
    # A hostile list of line items costs one try. The token goes only to the platform's host.
    def habit(claims: dict[str, dict[str, object]]) -> None:
        claims[ENDPOINT].pop("lineitem")
        claims[ENDPOINT]["scope"] = [f"{AGS}score", f"{AGS}lineitem.readonly"]

    journey.tool.platform.habits.append(habit)
    journey.hand_in()
    for answer in UNUSABLE:
        journey.gradebook.listed = [answer]
        journey.clock.go_on(hours=5)
        again = update(tables.scores).values(state="waiting", next_try_at=journey.clock.now())
        journey.tool.do(partial(_execute, again))
        assert journey.send() == 1, answer
        [row] = journey.rows()
        code = json.loads(row.refusal)[0]
        assert code in ("no-scope", "unusable-answer", "unreachable"), answer
    assert "score" not in journey.gradebook.asked


def _execute(statement: Any, connection: Connection) -> None:
    connection.execute(statement)


# --- Test the tutors' list of sent scores


def refused_and_sent(journey: Journey) -> str:
    for user in ("ada", "grace"):
        journey.hand_in(user)
    journey.gradebook.enrolled = {"user grace"}
    journey.send()
    return journey.place("ada")[0]


def test_a_tutor_sees_why_and_sends_again(journey: Journey) -> None:
    course = refused_and_sent(journey)
    path = f"/v1/courses/{course}/scores"
    listed = journey.tool.send("GET", path, headers=journey.tutor()).json()["scores"]
    by_learner = {each["learner"]: each for each in listed}
    refused, sent = by_learner[journey.learner("ada")], by_learner[journey.learner("grace")]
    assert (sent["state"], sent["max_points"]) == ("sent", 10)
    assert sent["sent_points"] == pytest.approx(journey.total("grace"))
    assert refused["state"] == "refused"
    assert "status 400" in refused["problem"]
    failed = journey.tool.send("GET", f"{path}?failed=true", headers=journey.tutor()).json()
    assert [each["learner"] for each in failed["scores"]] == [journey.learner("ada")]
    # Only those that failed, then all of one learner.
    journey.gradebook.enrolled = None
    assert journey.post(f"courses/{course}/scores/send", failed=True) == {"queued": 1}
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"ada", "grace"}
    grace = journey.learner("grace")
    assert journey.post(f"courses/{course}/scores/send", learner=grace) == {"queued": 1}
    journey.gradebook.items["1"].grades.clear()
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"grace"}


def test_the_pages_show_it(journey: Journey) -> None:
    course = refused_and_sent(journey)
    _, assignment = journey.place("ada")
    for path in (
        f"/tutor/courses/{course}/assignments/{assignment}",
        f"/tutor/courses/{course}/learner?learner={journey.learner('ada')}",
    ):
        page = journey.tool.send("GET", path, headers=journey.tutor())
        assert page.status_code == 200, page.text
        assert "Sent to the learning platform" in page.text
        assert "refused: The platform refuses the score (status 400)." in page.text
        assert "Send again" in page.text


def test_problems_are_told_in_the_language_of_the_reader(journey: Journey) -> None:
    course = refused_and_sent(journey)
    german = {**journey.tutor(), "accept-language": "de"}
    path = f"/v1/courses/{course}/scores?failed=true"
    [score] = journey.tool.send("GET", path, headers=german).json()["scores"]
    assert score["problem"].startswith("Die Plattform lehnt die Punkte ab (Status 400).")
    reason = FetchError(say("the status is {status}", status=503))
    stored = LaterError("token-refused", reason=reason).stored
    assert problem_told(stored, language_named("de") or ENGLISH) == (
        "Die Plattform gibt kein Zugriffstoken: der Status ist 503"
    )


@pytest.mark.long
def test_the_command(journey: Journey, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    course = refused_and_sent(journey)
    monkeypatch.setenv("DH_GRADER_DATABASE", journey.tool.url)
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 4)
    lines = run("lti", "scores", course).output.splitlines()
    assert len(lines) == 2
    [line] = run("lti", "scores", course, "--failed").output.splitlines()
    assert "refused" in line
    assert journey.learner("ada") in line
    again = run("lti", "scores", course, "--failed", "--again")
    assert again.output == "Scores that are sent again: 1.\n"
    assert run("lti", "scores", "nothing").exit_code == 2
    checked = run("lti", "check", "moodle")
    assert "the platform gives one for scores" in checked.output
    journey.gradebook.token_trouble = (400, {})
    checked = run("lti", "check", "moodle")
    assert checked.exit_code == 1
    assert "the status is 400" in checked.output
