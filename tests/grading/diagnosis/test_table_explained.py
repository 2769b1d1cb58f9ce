"""Each misconception of a table is named in every robot that it changes."""

from collections.abc import Callable

import pytest

from service.grading import Severity
from tests.frame_choice.misconceptions import (
    MISCONCEPTIONS,
    Misconception,
    named_in_all_robots,
    report,
)
from tests.frame_choice.robots import ROBOTS, Robot


@pytest.mark.parametrize(
    ("misconception", "names"), MISCONCEPTIONS, ids=lambda x: getattr(x, "__name__", "")
)
def test_a_misconception_is_named_in_every_robot_that_it_changes(
    misconception: Misconception, names: set[str], figure: Callable[[str], None]
) -> None:
    found = named_in_all_robots(misconception, names)
    figure(f"{misconception.__name__}: named in {found.named} of {found.total}")
    assert found.total
    assert found.named >= 0.95 * found.total, found.missed[:6]


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_the_reference_draws_no_word_of_an_error(robot: Robot) -> None:
    part = report(robot, robot.rows)
    messages = [*part.feedback, *(m for row in part.rows for c in row.cells for m in c.feedback)]
    assert not [message for message in messages if message.severity is Severity.ERROR]
    assert part.points == part.max_points
