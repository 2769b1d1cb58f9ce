"""A new score is sent before the many scores of a regrade."""

from collections.abc import Callable
from datetime import UTC, datetime

import pytest
from dh_grader.store.database import Priority, queue_scores
from dh_grader.store.tables import attempts, learners
from sqlalchemy import insert, select

from tests.lti.scores.conftest import Journey

# 20 scores in ten seconds.
PACE = (20, 10)


def enrol_many(journey: Journey, number: int) -> None:
    [row] = journey.tool.do(lambda it: it.execute(select(attempts)).all())
    names = [f"{i:05}" for i in range(number)]
    of_platform = [
        {"registration": "moodle", "sub": f"user {name}", "learner": f"lti-{name}"}
        for name in names
    ]
    same = dict(row._mapping)
    del same["number"]
    new = [
        same | {"id": name, "learner": f"lti-{name}", "idempotency_key": f"k{name}"}
        for name in names
    ]
    journey.tool.do(lambda it: it.execute(insert(learners), of_platform))
    journey.tool.do(lambda it: it.execute(insert(attempts), new))
    chosen = attempts.c.id.in_(names)
    journey.tool.do(lambda it: queue_scores(it, chosen, Priority.REGRADE))


def sent_while(journey: Journey, ended: Callable[[], bool]) -> int:
    tries = 0
    while not ended():
        if journey.sender.send_next():
            tries += 1
            continue
        due = journey.sender.next_due()
        if due is None:
            return tries
        journey.clock.added += max(due - journey.clock.now(), journey.clock.added * 0)
    return tries


def hurried(journey: Journey, number: int) -> str:
    journey.hand_in()
    journey.send()
    enrol_many(journey, number)
    received = journey.gradebook.received
    received.clear()
    journey.gradebook.pace = PACE
    begun, worked = journey.clock.now(), datetime.now(UTC)
    tries = sent_while(journey, lambda: len(received) >= number // 2)
    journey.hand_in("grace")
    before, handed_in = len(received), journey.clock.now()
    tries += sent_while(journey, lambda: len(received) > before)
    waited = journey.clock.now() - handed_in
    assert received[before]["userId"] == "user grace"
    tries += sent_while(journey, lambda: False)
    assert {each["userId"] for each in received} >= {f"user {i:05}" for i in range(number)}
    # Each once.
    assert len(received) == number + 1
    assert tries <= (number + 1) * (1 + 2 / PACE[0]) + 2
    took = journey.clock.now() - begun
    return (
        f"{number} scores of a regrade at {PACE[0]} in {PACE[1]} s: {took.total_seconds():.0f} s "
        f"by the clock of the test, {tries} tries, in {(datetime.now(UTC) - worked).seconds} s; "
        f"a hand-in meanwhile was the next score, after {waited.total_seconds():.1f} s"
    )


@pytest.mark.long
def test_a_hand_in_goes_before_the_scores_of_a_regrade(journey: Journey) -> None:
    hurried(journey, 60)


@pytest.mark.campaign
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)
def test_a_hand_in_goes_before_ten_thousand_scores(
    journey: Journey, figure: Callable[[str], None]
) -> None:
    figure(hurried(journey, 10_000))
