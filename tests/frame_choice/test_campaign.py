"""Run small campaigns."""

import pytest

from tests.frame_choice.by_policy import MISJUDGED, UNSTEADY, VALID, WRONG, Counts, lines, run
from tests.frame_choice.campaign import Figure, figures, tasks, whole_campaign
from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS
from tests.frame_choice.rounded import RoundedCell
from tests.frame_choice.rounded import run as run_rounded

# --- Run the whole campaign (``pytest -m campaign``), and test its own code

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


# --- Grade tables of random robots under each policy (what a student may choose)


@pytest.fixture(scope="module")
def sample() -> Counts:
    return run(range(1), seed=1, seeds=2)


@pytest.mark.long
@pytest.mark.parametrize("policy", [policy.name for policy in POLICIES])
def test_no_table_is_misjudged(sample: Counts, policy: str) -> None:
    for truth in (VALID, WRONG):
        assert sample.of(truth, "", policy) >= 1
        assert sample.of(truth, MISJUDGED, policy) == 0, "\n".join(sample.misses)


@pytest.mark.long
def test_no_verdict_depends_on_the_random_samples(sample: Counts) -> None:
    unsteady = sample.of(VALID, UNSTEADY) + sample.of(WRONG, UNSTEADY)
    assert unsteady == 0, "\n".join(sample.misses)


@pytest.mark.long
def test_the_figures_are_those_of_each_policy_and_of_all(sample: Counts) -> None:
    table = lines(sample)
    assert len(table) == len(POLICIES) + 2
    assert table[-1].split()[1] == str(sample.of(VALID))


# --- Rounded valid tables are right; tables with a changed digit are wrong


def test_a_rounded_cell_has_the_number_of_figures() -> None:
    assert RoundedCell(angle=True, constant=0.0505, figures=3).text == "0.0505"
    assert RoundedCell(angle=True, constant=1.0472, figures=3, units=3).text == "1.08"
    assert RoundedCell(angle=True, constant=-1.5, variables={"q1": 1}).text == "q1 - 1.50"


@pytest.mark.long
def test_rounded_tables_are_judged_right() -> None:
    found = run_rounded(range(4), seed=3, seeds=1, policies=(GIVEN,))
    assert found.misses == []
    assert found.counts["changed, given"] >= 3


def test_rounded_tables_with_free_ends_are_judged_right() -> None:
    found = run_rounded(range(2, 3), seed=3, policies=POLICIES[1::2])
    assert found.misses == []
    assert sum(found.counts.values()) >= 6
