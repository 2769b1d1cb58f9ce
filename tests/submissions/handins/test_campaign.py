"""Hand-ins in all kinds are graded like the same answers in JSON, or listed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.submissions.handins.__main__ import LEAST_RIGHT
from tests.submissions.handins.answers import PARTS, expected, right, wrong
from tests.submissions.handins.campaign import (
    SchoolClass,
    drawn,
    faults,
    outcomes,
    share_right,
    table_of,
)
from tests.submissions.handins.files import KINDS
from tests.submissions.handins.platforms import PLATFORMS


def graded(classes: list[SchoolClass], folder: Path) -> tuple[list[str], float, str]:
    found = [outcome for each in classes for outcome in outcomes(each, folder)]
    failed = [f"{each.kind.name}: {each.where}: {each.said}" for each in faults(found)]
    return failed, share_right(found), table_of(found)


def test_the_campaign_has_all_platforms_and_many_kinds() -> None:
    assert len({kind.name for kind in KINDS}) == len(KINDS) >= 50
    assert {name.partition(",")[0] for name in PLATFORMS} == {
        "Moodle", "Canvas", "Brightspace", "Blackboard",
    }  # fmt: skip


@pytest.mark.parametrize("exercise", PARTS)
def test_a_slip_costs_points(exercise: str) -> None:
    for part in PARTS[exercise]:
        whole = right(exercise, part)
        spoilt = wrong(exercise, part, np.random.default_rng(1))
        assert spoilt.slip
        assert expected([spoilt])[part].points < expected([whole])[part].points


@pytest.mark.long
def test_forty_hand_ins_are_graded_or_listed(tmp_path: Path) -> None:
    classes = drawn(44, 5, tmp_path, class_size=22, with_libreoffice=False)
    assert len(classes) == 2
    failed, share, table = graded(classes, tmp_path)
    assert failed == [], table
    assert share >= LEAST_RIGHT, table


@pytest.mark.long
def test_the_campaign_sees_an_answer_with_other_points(tmp_path: Path) -> None:
    [school_class] = drawn(6, 5, tmp_path, with_libreoffice=False)
    changed = [
        [replace(it, answer=wrong(it.answer.exercise, it.answer.part, np.random.default_rng(3)))]
        for [it, *_] in school_class.hand_ins
    ]
    failed, share, _ = graded([replace(school_class, hand_ins=changed)], tmp_path)
    assert failed
    assert share < LEAST_RIGHT


@pytest.mark.campaign
@pytest.mark.timeout(1800)
def test_three_hundred_hand_ins_are_graded_or_listed(
    tmp_path: Path, figure: Callable[[str], None]
) -> None:
    failed, share, table = graded(drawn(300, 1, tmp_path), tmp_path)
    figure(f"hand-ins: {share:.1%} right\n{table}")
    assert failed == []
    assert share >= LEAST_RIGHT
