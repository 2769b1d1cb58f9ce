from datetime import UTC, datetime, timedelta, timezone

import pytest
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store import AttemptRefusedError, Ruling, points_after, ruling
from pydantic import ValidationError

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
HOUR = timedelta(hours=1)


def refusal(rules: AttemptsSpec, counted: int, now: datetime) -> str:
    with pytest.raises(AttemptRefusedError) as refused:
        ruling(rules, counted, now)
    return refused.value.name


def test_without_rules_every_attempt_is_taken() -> None:
    assert ruling(AttemptsSpec(), 1000, NOON) == Ruling(1001, is_late=False, worth=1.0)


def test_the_last_attempt_is_taken_and_no_further_one() -> None:
    rules = AttemptsSpec(limit=3)
    assert ruling(rules, 2, NOON).ordinal == 3
    assert refusal(rules, 3, NOON) == "no-attempts-left"


def test_attempts_exactly_at_opening_and_due_are_in_time() -> None:
    rules = AttemptsSpec(opens=NOON, due=NOON + HOUR)
    assert refusal(rules, 0, NOON - timedelta(microseconds=1)) == "not-open"
    assert ruling(rules, 0, NOON).worth == 1
    assert not ruling(rules, 0, NOON + HOUR).is_late
    assert refusal(rules, 0, NOON + HOUR + timedelta(microseconds=1)) == "closed"


def test_a_late_attempt_earns_its_share_until_the_exercise_closes() -> None:
    rules = AttemptsSpec(due=NOON, closes=NOON + HOUR, late_worth=0.25)
    assert ruling(rules, 0, NOON + HOUR) == Ruling(1, is_late=True, worth=0.25)
    assert refusal(rules, 0, NOON + 2 * HOUR) == "closed"


@pytest.mark.parametrize(
    ("points", "price", "worth", "expected"),
    [
        (24, 0, 1, 24),
        (24, 0.25, 1, 18),
        # A late attempt earns its share of what is left.
        (24, 0.25, 0.5, 9),
        (4, 0.25, 1, 0),
        (24, 1.5, 1, 0),
    ],
)
def test_hints_reduce_the_points_before_lateness(
    points: float, price: float, worth: float, expected: float
) -> None:
    assert points_after(points, 24, price, worth) == expected


def test_moments_of_other_zones_are_compared_as_moments() -> None:
    in_berlin = NOON.astimezone(timezone(HOUR))
    assert refusal(AttemptsSpec(opens=in_berlin + HOUR), 0, NOON) == "not-open"


@pytest.mark.parametrize(
    "wrong",
    [
        {"opens": datetime(2026, 11, 22, 12)},  # noqa: DTZ001 - the missing zone is the fault
        {"closes": NOON},
        {"due": NOON, "closes": NOON - HOUR},
        {"limit": 0},
        {"late_worth": 1.5},
        {"hint_prices": [0, 0.1]},
        {"hint_prices": [0, 0.1, 1.5]},
        {"hint_prices": [0, -0.1, 0]},
    ],
)
def test_rules_that_make_no_sense_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        AttemptsSpec.model_validate(wrong)
