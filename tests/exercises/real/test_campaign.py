"""Grade a few random tables of the real robots."""

import pytest

from tests.exercises.real.campaign import ACCEPTED, REFUSED, policy_of, run
from tests.frame_choice.robots import GIVEN, POLICIES
from tests.shipped import REAL_ROBOTS, shipped_exercises
from tests.together import together


@pytest.mark.long
@together("name", REAL_ROBOTS)
def test_valid_tables_are_accepted_and_wrong_ones_refused(name: str) -> None:
    found = run(name, tables=1, seed=29)
    assert found.misses == []
    assert found.counts[ACCEPTED] == found.counts[REFUSED] == 1


@pytest.mark.campaign
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("name", REAL_ROBOTS)
def test_a_thousand_tables_of_each_kind_are_judged_rightly(name: str) -> None:
    found = run(name, tables=1000, seed=1)
    assert found.misses == []
    assert found.counts[ACCEPTED] == found.counts[REFUSED] == 1000


def test_base_tool_and_directions_are_each_free_somewhere() -> None:
    policies = {name: policy_of(shipped_exercises()[name]) for name in REAL_ROBOTS}
    free = {name: policy for name, policy in policies.items() if policy != GIVEN}
    assert {policy.name for policy in free.values()} == {
        "free base", "free tool", "free directions", "all free",
    }  # fmt: skip
    assert len(free) == 4
    assert set(policies.values()) <= set(POLICIES)
