"""Grade exercises that have only numbers, without a robot."""

from collections.abc import Callable, Iterator

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import SPECS
from dh_grader.grading import FeedbackLevel, Verdict

from tests.grading.support.bare_numbers import BARE, OF_A_ROBOT, BareExercise
from tests.grading.support.submitting import handed_in, part
from tests.together import together

Make = Callable[[str], Exercise]
# Texts of cells that are unreadable, empty, or without a value.
SPOILT = ["0.5 +", "foo", "", None, "0,5", "1/0", "sqrt(-1)", "0.333", True]
ODD: list[object] = ["", None, [], {}, "0.5", 3, "[1 2; 3 4]", [[]], {"rows": []}]


def spoilt(answer: object) -> Iterator[object]:
    if isinstance(answer, dict):
        for key in answer:
            yield from ({**answer, key: each} for each in SPOILT)
            yield {name: each for name, each in answer.items() if name != key}
    elif isinstance(answer, list):
        for i, entry in enumerate(answer):
            changes = list(spoilt(entry)) if isinstance(entry, list) else SPOILT
            yield from ([*answer[:i], change, *answer[i + 1 :]] for change in changes)
            yield [*answer[:i], *answer[i + 1 :]]


def test_there_is_an_exercise_of_each_kind() -> None:
    assert {bare.kind for bare in BARE} | OF_A_ROBOT == set(SPECS)


@pytest.mark.long
@together("bare", BARE)
def test_right_numbers_get_full_marks_and_wrong_ones_do_not(
    bare: BareExercise, make_exercise: Make
) -> None:
    exercise = make_exercise(bare.text)
    for level in FeedbackLevel:
        right = part(handed_in(exercise, {"it": bare.right}, feedback=level), "it")
        assert (right.verdict, right.points) == (Verdict.CORRECT, right.max_points)
        for answer in bare.wrong:
            wrong = part(handed_in(exercise, {"it": answer}, feedback=level), "it")
            assert wrong.verdict in (Verdict.INCORRECT, Verdict.PARTIAL), answer
            assert wrong.points < wrong.max_points


@pytest.mark.long
@together("bare", BARE)
def test_unreadable_numbers_get_a_report(bare: BareExercise, make_exercise: Make) -> None:
    exercise = make_exercise(bare.text)
    for answer in [*spoilt(bare.right), *ODD]:
        report = part(handed_in(exercise, {"it": answer}), "it")
        assert 0 <= report.points <= report.max_points


def test_a_wrong_number_is_explained(make_exercise: Make) -> None:
    # Slips in bare numbers get the same codes as those in formulas, but no counterexample.
    vector, position = (make_exercise(BARE[i].text) for i in (0, 2))
    report = part(handed_in(vector, {"it": ["0.7", "30deg", "-3"]}), "it")
    found = [message for row in report.rows for each in row.cells for message in each.feedback]
    assert [message.code for message in found] == ["value", "value", "sign"]
    assert not any(message.values for message in found)
    report = part(handed_in(position, {"it": ["-0.5", "0", "-2"]}), "it")
    assert [message.code for message in report.feedback] == ["reversed_position"]


@pytest.mark.parametrize("answer", [["0", "0", "0"], ["1", "1", "1"]])
def test_wrong_numbers_are_wrong_beside_unused_symbols(
    answer: list[str], make_exercise: Make
) -> None:
    text = BARE[2].text.replace(
        "[[parts]]", '[symbols]\nl1 = { kind = "length", description = "unused" }\n[[parts]]'
    )
    report = part(handed_in(make_exercise(text), {"it": answer}), "it")
    assert report.points < report.max_points
