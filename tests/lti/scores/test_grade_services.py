"""Test platforms that are busy, down, or refuse a score."""

import json
from datetime import timedelta
from functools import partial
from typing import Any

import pytest
from dh_grader.lti.grade_services import scores_address
from dh_grader.store import tables
from sqlalchemy import Connection, update

from tests.lti.gradebook import AGS, Item
from tests.lti.scores.conftest import Journey

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
