"""What a request is likely to cost."""

import pytest

from service.server.costs import Costs, rest
from service.server.fair_queue import Ticket

ORDINARY, COSTLY = 0.002, 0.060
# Half of what is expected at first.
UNIT = 0.00015


def ticket(connection: int, size: int = 600, client: str = "campus") -> Ticket:
    return Ticket(client, connection, size)


@pytest.fixture
def costs() -> Costs:
    """After an ordinary request on one connection, and a costly one on another."""
    costs = Costs(lambda: UNIT)
    costs.note(ticket(1), ORDINARY)
    costs.note(ticket(2, 5000), COSTLY)
    return costs


@pytest.mark.parametrize(
    ("asked", "costly"),
    [
        (ticket(1), False),
        (ticket(2), True),
        (ticket(3), False),
        (ticket(3, 5000), True),
        (ticket(3, 5100), True),
        (ticket(3, 9000), False),
        (ticket(1, 5000), False),
        (ticket(2, 5000, "elsewhere"), False),
    ],
    ids=[
        "an ordinary connection", "a costly connection", "a new one", "a new one, as long",
        "a new one, nearly as long", "a new one, longer", "an ordinary connection, as long",
        "another client",
    ],
)  # fmt: skip
def test_who_has_been_costly_is_expected_to_be(costs: Costs, asked: Ticket, costly: bool) -> None:
    assert (costs.class_of(costs.expected(asked)) > 0) is costly


def test_a_cheap_request_does_not_hide_that_others_are_costly(costs: Costs) -> None:
    costs.note(ticket(2), ORDINARY)
    assert costs.class_of(costs.expected(ticket(2)))
    for _ in range(3):
        costs.note(ticket(2), ORDINARY)
    assert costs.class_of(costs.expected(ticket(2))) == 0


def test_what_is_costly_depends_on_the_machine() -> None:
    pace = UNIT
    costs = Costs(lambda: pace)
    seconds = [0.023, 0.025, 0.049, 0.095, 0.097, 9.0]
    assert [costs.class_of(each) for each in seconds] == [0, 1, 2, 2, 3, 3]
    pace = 8 * UNIT
    for _ in range(100):
        costs.note(ticket(1), 0.2)
    assert [costs.class_of(4 * each) for each in seconds] == [0, 1, 2, 2, 3, 3]


def test_a_single_measurement_says_little() -> None:
    paces = iter([UNIT, 100 * UNIT])
    costs = Costs(lambda: next(paces))
    costs.note(ticket(1), 0.3)
    assert costs.class_of(0.030) == 1


def test_the_rest_is_longer_for_those_of_the_same_class() -> None:
    assert [rest(0.040, steps) for steps in range(3)] == [9 * 0.040, 4.5 * 0.040, 2.25 * 0.040]


def test_what_is_kept_is_bounded() -> None:
    costs = Costs(lambda: UNIT)
    for number in range(11_000):
        costs.note(ticket(number, number), ORDINARY)
    assert len(costs._means) == 10_000
