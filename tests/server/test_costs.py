"""What a request is likely to cost."""

import pytest

from service.server.costs import Costs
from service.server.fair_queue import Ticket

ORDINARY, COSTLY = 0.001, 0.040


def ticket(connection: int, size: int = 600, client: str = "campus") -> Ticket:
    return Ticket(client, connection, size)


@pytest.fixture
def costs() -> Costs:
    """After some ordinary requests on one connection, and a costly one on another."""
    costs = Costs()
    for _ in range(20):
        costs.note(ticket(1), ORDINARY, ordinary=True)
    costs.note(ticket(2, 5000), COSTLY, ordinary=True)
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
    assert costs.is_costly(costs.expected(asked)) is costly


def test_a_cheap_request_does_not_hide_that_others_are_costly(costs: Costs) -> None:
    costs.note(ticket(2), ORDINARY, ordinary=False)
    assert costs.is_costly(costs.expected(ticket(2)))
    for _ in range(3):
        costs.note(ticket(2), ORDINARY, ordinary=False)
    assert not costs.is_costly(costs.expected(ticket(2)))


def test_what_is_costly_depends_on_the_machine_and_the_course() -> None:
    costs = Costs()
    assert costs.is_costly(0.030)
    for _ in range(200):
        costs.note(ticket(1), 0.004, ordinary=True)
    assert not costs.is_costly(0.030)
    assert costs.is_costly(0.100)


def test_trifles_make_nothing_costly() -> None:
    costs = Costs()
    for _ in range(1000):
        costs.note(ticket(1), 0.0001, ordinary=True)
    assert not costs.is_costly(0.008)
    assert costs.is_costly(0.012)


def test_the_costlier_the_longer_is_the_rest() -> None:
    costs = Costs()
    assert 3 * 0.014 <= costs.rest(0.0141) < 4 * 0.014
    assert 11 * 0.028 < costs.rest(0.028) < 13 * 0.028
    assert costs.rest(0.100) == costs.rest(10.0) == 2.0


def test_what_is_kept_is_bounded() -> None:
    costs = Costs()
    for number in range(11_000):
        costs.note(ticket(number, number), ORDINARY, ordinary=True)
    assert len(costs._means) == 10_000
