"""Grade tables of random robots under each policy (what a student may choose)."""

import pytest

from tests.frame_choice.by_policy import MISJUDGED, UNSTEADY, VALID, WRONG, Counts, lines, run
from tests.frame_choice.robots import POLICIES

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def sample() -> Counts:
    return run(range(1), seed=1, seeds=2)


@pytest.mark.parametrize("policy", [policy.name for policy in POLICIES])
def test_no_table_is_misjudged(sample: Counts, policy: str) -> None:
    for truth in (VALID, WRONG):
        assert sample.of(truth, "", policy) >= 1
        assert sample.of(truth, MISJUDGED, policy) == 0, "\n".join(sample.misses)


def test_no_verdict_depends_on_the_random_samples(sample: Counts) -> None:
    unsteady = sample.of(VALID, UNSTEADY) + sample.of(WRONG, UNSTEADY)
    assert unsteady == 0, "\n".join(sample.misses)


def test_the_figures_are_those_of_each_policy_and_of_all(sample: Counts) -> None:
    table = lines(sample)
    assert len(table) == len(POLICIES) + 2
    assert table[-1].split()[1] == str(sample.of(VALID))
