"""Run the whole campaign (``pytest -m campaign``), and test its own code."""

import pytest

from tests.frame_choice.campaign import Figure, figures, tasks, whole_campaign
from tests.frame_choice.robots import ROBOTS

HOURS = 3600


@pytest.mark.campaign
@pytest.mark.timeout(4 * HOURS)
def test_all_figures_hold() -> None:
    given, free = whole_campaign()
    found = list(figures(given, free))
    assert [str(figure) for figure in found if not figure.holds] == []


@pytest.mark.long
def test_a_small_campaign_counts_what_it_draws() -> None:
    robots = [robot for robot in ROBOTS if robot.name == "SCARA"]
    given, free = whole_campaign(tables=2, free_tables=1, robots=robots, jobs=1)
    drawn = len(tasks(robots, only_given=True, tables=2, seed=1))
    assert given.counts["valid"] == 2 * drawn == given.counts["valid accepted"]
    assert free.counts["valid"] == free.counts["valid accepted"] > 0


def test_a_figure_fails_below_its_least_share() -> None:
    assert Figure("", 99, 100, 0.99).holds
    assert not Figure("", 98, 100, 0.99).holds
    assert "FAILS" in str(Figure("", 98, 100, 0.99))
    assert Figure("", 0, 0, 1.0).holds
