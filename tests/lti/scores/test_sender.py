"""Send a score from the hand-in to the platform's gradebook."""

import json
from datetime import UTC, datetime, timedelta

import pytest
from dh_grader.store.tables import attempts
from sqlalchemy import select, update

from tests.lti.gradebook import AGS
from tests.lti.platform import LTI
from tests.lti.scores.conftest import RIGHT, WRONG, Journey

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
ENDPOINT = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"


@pytest.mark.long
@KINDS
def test_a_hand_in_an_override_and_a_forgotten_learner_arrive(journey: Journey) -> None:
    attempt = journey.hand_in()
    assert journey.send() == 1
    [message] = journey.gradebook.received
    assert message["scoreGiven"] == journey.total() > 0
    assert message["scoreMaximum"] == 10
    assert message["submission"]["submittedAt"][:19] == attempt["at"][:19]
    # Nothing waits, and nothing is sent twice.
    assert journey.send() == 0
    override = {"reason": "copied", "author": "t"}
    journey.post(f"attempts/{attempt['id']}/override", points=0, **override)
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": 0}
    journey.post(f"attempts/{attempt['id']}/override", points=attempt["max_points"], **override)
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": 100}
    known = journey.known()
    [platform], [score] = known["platforms"], known["scores"]
    assert (platform["name"], platform["sub"]) == ("Moodle of the university", "user ada")
    assert (score["sub"], score["state"], score["sent_points"]) == ("user ada", "sent", 10)
    assert journey.place() == (score["course"], score["in_assignment"])
    journey.post("learners/forget", learner=attempt["learner"], apply=True)
    assert "user ada" not in json.dumps(journey.known())
    journey.clock.go_on(seconds=3)
    [row] = journey.rows()
    assert "lti-" not in row.learner
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": None}
    assert journey.rows() == []


def test_only_the_best_attempt_is_sent(journey: Journey) -> None:
    # An attempt that is worse than the best, or as good, changes nothing at the platform.
    journey.hand_in(answers=WRONG)
    journey.send()
    best = journey.hand_in()
    journey.send()
    before = journey.gradebook.received[-1]
    assert before["scoreGiven"] > journey.gradebook.received[0]["scoreGiven"]
    for answers in (WRONG, RIGHT):
        journey.hand_in(answers=answers)
        journey.clock.go_on(seconds=5)
        assert journey.send() == 0
    assert journey.states() == {"ada": "sent"}
    assert before["submission"]["submittedAt"][:19] == best["at"][:19]
    assert journey.gradebook.asked.count("score") == 2


def test_more_time_gives_a_late_score_its_points_back(journey: Journey) -> None:
    # A late attempt counts half. With a later due date, its points come back.
    journey.launch()
    course, assignment = journey.place()
    path = f"courses/{course}/assignments/{assignment}"
    yesterday = datetime.now(UTC) - timedelta(days=1)
    closes = datetime.now(UTC) + timedelta(days=2)
    journey.post(path, due=yesterday.isoformat(), closes=closes.isoformat(), late_worth=0.5)
    journey.hand_in()
    journey.send()
    half = journey.gradebook.received[-1]["scoreGiven"]
    due = (datetime.now(UTC) + timedelta(days=1)).isoformat()
    journey.post(f"{path}/extensions", learner=journey.learner(), due=due)
    assert journey.send() == 1
    assert journey.gradebook.received[-1]["scoreGiven"] == pytest.approx(2 * half)
    assert journey.total() == pytest.approx(2 * half)


def test_points_of_the_assignment_that_change(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, assignment = journey.place()
    exercises = [{"exercise": "planar-rr", "points": 40}, {"exercise": "scara", "points": 60}]
    journey.post(f"courses/{course}/assignments/{assignment}", exercises=exercises)
    assert journey.send() == 1
    first, second = journey.gradebook.received
    assert second["scoreMaximum"] == 100
    assert second["scoreGiven"] == pytest.approx(4 * first["scoreGiven"]) == journey.total()


def test_a_regrade_queues_only_what_it_changes(journey: Journey) -> None:
    # An earlier program gave one of two learners wrong points. Only that learner is queued.
    changed = journey.hand_in("ada")
    journey.hand_in("grace")
    journey.send()
    right = journey.gradebook.grades()["ada"]
    mine = attempts.c.id == changed["id"]
    # As if an earlier program had graded both, and one of them wrongly.
    journey.tool.do(lambda it: it.execute(update(attempts).values(grader="0")))
    journey.tool.do(lambda it: it.execute(update(attempts).where(mine).values(points=0)))
    journey.post("exercises/planar-rr/regrade", apply=True)
    waiting = [each.sub for each in journey.rows() if each.state == "waiting"]
    assert waiting == ["user ada"]
    [row] = [each for each in journey.rows() if each.state == "waiting"]
    assert row.priority == 2
    # The platform has this score already.
    assert journey.send() == 0
    assert journey.gradebook.grades()["ada"] == right


def test_removed_learners_lose_their_score(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, _ = journey.place()
    journey.post(
        f"courses/{course}/learners/remove",
        learner=journey.learner(),
        with_attempts=True,
        apply=True,
    )
    assert journey.send() == 1
    assert journey.gradebook.grades() == {"ada": None}


def test_a_deleted_course_can_be_launched_again(journey: Journey) -> None:
    journey.hand_in()
    journey.send()
    course, assignment = journey.place()
    body = {"apply": True, "with_attempts": True}
    journey.post(f"courses/{course}/assignments/{assignment}/delete", **body)
    assert journey.rows() == []
    journey.launch()
    journey.hand_in()
    journey.post(f"courses/{course}/delete", **body)
    journey.launch()
    journey.hand_in()
    assert journey.send() == 1


def test_a_learner_who_comes_back_keeps_the_new_score(journey: Journey) -> None:
    # A forgotten learner submits again before the service has cleared the platform's score.
    journey.hand_in()
    journey.send()
    journey.post("learners/forget", learner=journey.learner(), apply=True)
    del journey.tokens["ada"]
    journey.hand_in(answers=RIGHT)
    journey.clock.go_on(seconds=5)
    journey.send()
    assert journey.gradebook.grades()["ada"] == pytest.approx(journey.total() * 10)
    assert len(journey.rows()) == 1


def test_a_learner_of_whom_nothing_was_sent_leaves_nothing(journey: Journey) -> None:
    journey.hand_in()
    journey.post("learners/forget", learner=journey.learner(), apply=True)
    assert journey.rows() == []


@pytest.mark.long
def test_a_platform_without_line_items_gets_one(journey: Journey) -> None:
    # The service makes one line item for all learners, with the title of the assignment.
    journey.tool.platform.habits.append(lambda claims: claims[ENDPOINT].pop("lineitem"))
    journey.gradebook.items.clear()
    for user in ("ada", "grace"):
        journey.hand_in(user)
    assert journey.send() == 2
    assert journey.gradebook.asked.count("new item") == 1
    [name] = journey.gradebook.items
    assert set(journey.gradebook.grades(name)) == {"ada", "grace"}
    assert journey.gradebook.items[name].label == "Homework 1"


def test_two_replicas_do_not_make_two_line_items(journey: Journey) -> None:
    journey.tool.platform.habits.append(lambda claims: claims[ENDPOINT].pop("lineitem"))
    journey.gradebook.items.clear()
    for user in ("ada", "grace"):
        journey.hand_in(user)
    other = journey.another_sender()
    tried: list[bool] = []

    def meanwhile() -> None:
        if not tried:
            tried.append(other.send_next())

    # The other replica takes a score while the first one is making the line item.
    journey.gradebook.before_item = meanwhile
    journey.send()
    assert tried == [True]
    journey.clock.go_on(seconds=5)
    journey.send()
    assert set(journey.states().values()) == {"sent"}
    assert len(journey.gradebook.items) == 1


@pytest.mark.parametrize("scopes", [["score"], ["score", "lineitem.readonly"]])
def test_a_score_is_refused_if_its_line_item_may_not_be_made(
    journey: Journey, scopes: list[str]
) -> None:
    def habit(claims: dict[str, dict[str, object]]) -> None:
        claims[ENDPOINT].pop("lineitem")
        claims[ENDPOINT]["scope"] = [f"{AGS}{each}" for each in scopes]

    journey.tool.platform.habits.append(habit)
    journey.gradebook.items.clear()
    journey.hand_in()
    journey.send()
    assert journey.states() == {"ada": "refused"}
    assert json.loads(journey.rows()[0].refusal)[0] == "no-scope"


def test_earlier_scores_are_sent_once_the_platform_takes_scores(journey: Journey) -> None:
    # When the platform begins to accept scores, scores of earlier attempts are sent, too.
    journey.tool.platform.habits.append(lambda claims: claims.pop(ENDPOINT))
    journey.hand_in()
    assert journey.rows() == []
    journey.tool.platform.habits.clear()
    journey.launch("grace")
    assert journey.send() == 1
    assert set(journey.gradebook.grades()) == {"ada"}


def test_names_that_change_change_no_score(journey: Journey) -> None:
    journey.hand_in()

    def renamed(claims: dict[str, object]) -> None:
        claims["name"] = "Ada King"
        claims[f"{LTI}context"] = {"id": "course-1", "title": "Robots"}

    journey.tool.platform.habits.append(renamed)
    journey.launch()
    journey.hand_in(answers=WRONG)
    assert journey.send() == 1
    assert len(journey.gradebook.received) == 1
    assert len(journey.tool.do(lambda it: it.execute(select(attempts)).all())) == 2


@pytest.mark.long
def test_no_timestamp_is_in_the_future(journey: Journey) -> None:
    # If a score changes often in a second, some changes wait. The platform gets the last score.
    attempt = journey.hand_in()
    for points in range(1, 7):
        body = {"points": points, "reason": "r", "author": "t"}
        journey.post(f"attempts/{attempt['id']}/override", **body)
        journey.send()
    for _ in range(5):
        journey.clock.go_on(seconds=1)
        journey.send()
    assert journey.gradebook.refused == []
    assert journey.gradebook.received[-1]["scoreGiven"] == journey.total()
    assert journey.states() == {"ada": "sent"}


def test_a_score_that_is_sent_at_once_is_not_from_before_the_attempt(journey: Journey) -> None:
    attempt = journey.hand_in()
    journey.clock.go_on(seconds=-3)
    assert journey.send() == 1
    [message] = journey.gradebook.received
    assert message["submission"]["submittedAt"][:19] == attempt["at"][:19]
    assert message["timestamp"] >= message["submission"]["submittedAt"]
    # A change within a second waits, because its timestamp must be later.
    journey.post(f"attempts/{attempt['id']}/override", points=1, reason="r", author="t")
    journey.clock.go_on(seconds=1)
    assert journey.send() == 1
    assert journey.gradebook.received[-1]["timestamp"] > message["timestamp"]
