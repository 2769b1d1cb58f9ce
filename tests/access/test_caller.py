"""Test what a caller may reach, and whose requests and attempts are one client's."""

import pytest
from dh_grader.access import NOBODY, Caller

LEARNER = Caller(frozenset(), learner="ada", key_id="0011aaff")


@pytest.mark.parametrize(
    ("exercises", "named", "reaches"),
    [
        (None, "scara", True),
        (["scara"], "scara", True),
        (["scara"], "scara~k7", True),
        (["scara"], "scara~k7~k8", True),
        (["scara", "puma"], "puma~k7", True),
        (["scara"], "puma", False),
        (["scara"], "puma~scara", False),
        (["scara"], "scara-2~k7", False),
        (["scara"], "~scara", False),
        ([], "scara", False),
    ],
)
def test_a_caller_reaches_exercises_and_their_variants(
    exercises: list[str] | None, named: str, reaches: bool
) -> None:
    only = None if exercises is None else frozenset(exercises)
    assert Caller(frozenset(), only).reaches(named) is reaches


@pytest.mark.parametrize(
    ("exercises", "course", "reaches_all"),
    [
        (None, None, True), (frozenset({"scara"}), None, False),
        (None, "robots", False), (frozenset({"scara"}), "robots", False),
    ],
)  # fmt: skip
def test_a_caller_with_a_course_or_exercises_does_not_reach_all(
    exercises: frozenset[str] | None, course: str | None, reaches_all: bool
) -> None:
    assert Caller(frozenset(), exercises, course=course).reaches_all is reaches_all


def test_the_owner_is_a_key_or_one_learner() -> None:
    assert NOBODY.owner == ""
    assert Caller(frozenset(), key_id="0011aaff").owner == "0011aaff"
    others = (
        Caller(frozenset(), learner="grace", key_id="0011aaff"),
        Caller(frozenset(), learner="ada", key_id="0011aaee"),
        Caller(frozenset(), learner="ada", key_id="0011aaff", course="robots"),
        Caller(frozenset(), learner="ada", key_id="0011aaff", course="others"),
    )
    owners = [LEARNER.owner, *(each.owner for each in others)]
    assert len(set(owners)) == len(owners)
    # The column for it has 32 characters.
    assert {len(each) for each in owners} == {32}
    # A renewed personal link has another key.
    renewed = Caller(frozenset(), learner="ada", key_id="0011aaee", course="robots")
    assert renewed.owner == others[2].owner
