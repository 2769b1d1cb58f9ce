"""Try some slips of random arms; ``make slips`` tries more."""

from collections.abc import Callable, Sequence
from functools import cache

import pytest
from dh_grader.grading import FeedbackLevel, Submission, Verdict, grade
from dh_grader.grading.report import messages_of

from tests.pose_slips.unseen.arms import Arm, arms
from tests.pose_slips.unseen.slips import CELL, CLASSES, PRODUCT, slips_of
from tests.pose_slips.unseen.trials import (
    KINDS,
    ArmTrial,
    answer_to,
    exercise_of,
    right_answer,
    trials,
    two_slips,
)

SAMPLE = tuple(arms(7, 10))
# The least number of trials of each class, so that the sample is large enough.
LEAST = 10


@cache
def one_slip_each() -> Sequence[ArmTrial]:
    return [trial for i, arm in enumerate(SAMPLE) for trial in trials(arm, i, each=1)]


@pytest.mark.long
def test_slips_in_rows_and_columns_are_named(figure: Callable[[str], None]) -> None:
    found = one_slip_each()
    for kind in CLASSES:
        alone = [trial for trial in found if trial.slip.kind == kind and trial.is_alone]
        named = [trial for trial in alone if trial.is_named and trial.is_placed]
        figure(f"{kind}: {len(named)} of {len(alone)} named behind the poses of random arms")
        assert len(alone) >= LEAST
        assert len(named) >= 0.95 * len(alone)


@pytest.mark.long
def test_if_several_slips_fit_one_of_them_is_named() -> None:
    shared = [trial for trial in one_slip_each() if not trial.is_alone]
    assert len(shared) > LEAST
    assert sum(trial.is_named for trial in shared) >= 0.95 * len(shared)


@pytest.mark.long
def test_two_slips_are_not_explained_by_one_slip_of_rows_or_columns() -> None:
    # A slip of one cell may explain two slips; a slip of rows or columns must not.
    found = [trial for i, arm in enumerate(SAMPLE) for trial in two_slips(arm, i)]
    of_many = {code for arm in SAMPLE for slip in slips_of(arm) for code in slip.codes}
    of_many -= {code for arm in SAMPLE for s in slips_of(arm) if s.kind == CELL for code in s.codes}
    told = [trial for trial in found if len(trial.said) == 1 and trial.said[0][0] in of_many]
    assert len(found) > LEAST
    assert told == []


@pytest.mark.parametrize("arm", SAMPLE[:5], ids=lambda arm: arm.structure)
def test_a_right_answer_has_no_message(arm: Arm) -> None:
    exercise = exercise_of(arm)
    answers = {kind: answer_to(kind, right_answer(arm)) for kind in KINDS}
    for part in grade(exercise, Submission(answers)).parts:
        if part.part in KINDS:
            assert part.verdict is Verdict.CORRECT
            assert list(messages_of(part)) == []


@pytest.mark.long
def test_hints_contain_no_correction() -> None:
    [arm] = SAMPLE[2:3]
    exercise, told = exercise_of(arm), 0
    for slip in slips_of(arm):
        if slip.kind not in (CELL, PRODUCT):
            submission = Submission(
                {"transform": answer_to("transform", slip)}, feedback=FeedbackLevel.HINTS
            )
            for part in grade(exercise, submission).parts:
                for message, _, _ in messages_of(part):
                    told += 1
                    assert message.correction is None
    assert told
