"""Grade valid and wrong tables in frames of the student's choice."""

# Every valid table is accepted, no wrong one is, and the cell with the slip is blamed. `make
# campaign` draws 1,000 tables of each robot and convention.

import sys
import zlib
from collections.abc import Callable

import numpy as np
import pytest

from tests.frame_choice.figures import HEAD, line
from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS, conventions
from tests.frame_choice.trials import Tally, run

pytestmark = pytest.mark.long

# For each robot and convention: how many tables, and how many of them also with slips.
GIVEN_TABLES, GIVEN_SLIPS = 4, 3
FREE_TABLES, FREE_SLIPS = 2, 1


def tallied(only_given: bool) -> Tally:
    total = Tally()
    tables, slips = (GIVEN_TABLES, GIVEN_SLIPS) if only_given else (FREE_TABLES, FREE_SLIPS)
    for robot in ROBOTS:
        for convention in conventions(robot, GIVEN if only_given else POLICIES[-1]):
            rng = np.random.default_rng(zlib.crc32(f"{robot.name} {convention}".encode()))
            total.add(run(robot, convention, only_given, tables, rng, slips=slips, explain=False))
    sys.stdout.write(f"{HEAD}\n{line('all robots', total)}\n")
    return total


@pytest.fixture(scope="module")
def given() -> Tally:
    return tallied(only_given=True)


@pytest.fixture(scope="module")
def free() -> Tally:
    return tallied(only_given=False)


@pytest.fixture(params=["given", "free"])
def either(request: pytest.FixtureRequest) -> Tally:
    tally: Tally = request.getfixturevalue(request.param)
    return tally


def first_misses(tally: Tally, chosen: Callable[[str], bool]) -> str:
    return "\n\n".join(str(miss) for miss in tally.misses if chosen(miss.what))[:4000]


def test_every_valid_table_gets_full_marks_and_no_error_message(either: Tally) -> None:
    assert either.counts["valid"] >= 60
    assert either.counts["valid accepted"] == either.counts["valid"], first_misses(
        either, lambda what: what.startswith("valid")
    )


def test_no_table_with_a_slip_gets_full_marks(either: Tally) -> None:
    wrong = either.counts["slip"] + either.counts["two slips"]
    caught = either.counts["slip caught"] + either.counts["two caught"]
    assert wrong >= 60
    assert caught == wrong, first_misses(either, lambda what: what.startswith("wrong"))


def test_nothing_raises(either: Tally) -> None:
    assert either.counts["crashed"] == 0, first_misses(either, lambda what: what == "crash")


def test_a_slip_between_axes_that_are_not_parallel_is_blamed_on_its_cell(given: Tally) -> None:
    # Slips that a change of another cell would repair as well are not counted.
    assert given.counts["skew unshared"] >= 25
    assert given.share("skew unshared exact", "skew unshared") >= 0.99, first_misses(
        given, lambda what: what.startswith("one slip, skew")
    )


def test_a_slip_between_parallel_axes_is_blamed_on_one_row(given: Tally) -> None:
    assert given.counts["parallel"] >= 45
    assert given.share("parallel one row", "parallel") >= 0.90, first_misses(
        given, lambda what: what.startswith("one slip, parallel")
    )


def test_two_independent_slips_are_both_found(given: Tally) -> None:
    assert given.counts["two unshared"] >= 45
    assert given.share("two unshared found", "two unshared") >= 0.95, first_misses(
        given, lambda what: what.startswith("two slips")
    )


def test_of_slips_that_could_be_repaired_elsewhere_the_likeliest_is_blamed(given: Tally) -> None:
    # The required shares are three standard deviations below those measured in 31,000 tables.
    assert given.counts["skew"] >= 30
    assert given.share("skew exact", "skew") >= 0.95
    assert given.counts["two slips"] >= 80
    assert given.share("two found", "two slips") >= 0.85
