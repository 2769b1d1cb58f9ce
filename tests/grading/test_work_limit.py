"""The search for explanations stops at a limit."""

from collections.abc import Iterator, Mapping

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.grading import PartReport, Report, Submission, grade
from dh_grader.grading.report import WorkBudget, messages_of

from tests.grading.support.robots import EXACT, STANFORD
from tests.solutions.solved import solved

# Many kinds of wrong entries: signs, values, variables of other joints, decimals, undefined values.
WRONG = ["-theta1", "d2 + 0.333", "0.707", "sin(theta1)", "1", "theta3", "0^-1", "c1*s2"]
SHIPPED = ["stanford-arm", "scara", "spatial-rrr", "planar-rpr-poe", "simple-twist"]


def spoilt(answer: object, every: int) -> object:
    count = 0

    def changed(inside: object) -> object:
        nonlocal count
        if isinstance(inside, list):
            return [changed(each) for each in inside]
        if isinstance(inside, dict):
            return {
                key: each if key == "convention" else changed(each) for key, each in inside.items()
            }
        count += 1
        return WRONG[count % len(WRONG)] if count % every == 0 else inside

    return changed(answer)


def spoilt_answers(exercise: Exercise) -> Iterator[dict[str, object]]:
    for every in (1, 2, 3, 7):
        yield {part: spoilt(right, every) for part, right in solved(exercise).answers.items()}


def marks(report: Report) -> list[tuple[object, ...]]:
    return [
        (part.part, part.verdict, part.points, row.label, row.verdict, row.points, cell.verdict)
        for part in report.parts
        for row in part.rows
        for cell in row.cells
    ]


def told(report: Report) -> list[str]:
    return [part.part for part in report.parts for m in part.feedback if m.code == "work_limit"]


@pytest.mark.long
@pytest.mark.parametrize("name", SHIPPED)
def test_marks_are_the_same_without_any_explanation(
    name: str, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    exercise = catalogue[name]
    for answers in spoilt_answers(exercise):
        explained = grade(exercise, Submission(answers))
        with monkeypatch.context() as context:
            context.setattr("dh_grader.grading.report.WorkBudget.affords", _affords_nothing)
            bare = grade(exercise, Submission(answers))
        assert marks(bare) == marks(explained), answers
        assert len(told(bare)) <= 1


def _affords_nothing(budget: WorkBudget, work: float) -> bool:
    budget.has_left_out = True
    return False


def everything_wrong(exercise: Exercise) -> dict[str, object]:
    return {part: spoilt(right, 1) for part, right in solved(exercise).answers.items()}


def test_an_omission_gets_one_message(catalogue: Mapping[str, Exercise]) -> None:
    # The 24 wrong cells of the table are explained before the seven wrong matrices.
    exercise = catalogue["stanford-arm"]
    report = grade(exercise, Submission(everything_wrong(exercise)))
    assert len(told(report)) == 1
    assert "value" in _codes(report.parts[0])
    # Messages on unreadable or undefined entries do not need the budget for explanations.
    assert _codes(report.parts[-1]) <= {"undefined", "unknown_joint"}


def _codes(part: PartReport) -> set[str]:
    return {message.code for message, *_ in messages_of(part)}


@pytest.mark.parametrize("level", [FeedbackLevel.VERDICTS, FeedbackLevel.SCORE])
def test_levels_without_hints_have_no_message_on_omissions(
    level: FeedbackLevel, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["stanford-arm"]
    assert told(grade(exercise, Submission(everything_wrong(exercise), feedback=level))) == []


def test_an_ordinary_wrong_answer_is_explained_completely(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue["stanford-arm"]
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[1][1], rows[3][1], rows[4][3] = "-pi/2", "0", "theta4"
    answers = {**solved(exercise).answers, "table": {"rows": rows}}
    assert told(grade(exercise, Submission(answers))) == []


def test_reading_and_searches_reduce_the_work_for_explanations() -> None:
    read, searched = WorkBudget(), WorkBudget()
    assert read.charge_reading(14_000)
    searched.charge_search(200.0)
    assert searched.affords(70.0)
    assert not searched.affords(20.0)
    assert searched.has_left_out
    assert WorkBudget().affords(140.0)
    assert read.affords(140.0)
    assert read.affords_search(140.0)
    assert not read.affords(1.0)


def test_searches_do_not_depend_on_explanations() -> None:
    bare, explained = WorkBudget(), WorkBudget()
    assert not explained.affords(500.0)
    for budget in (bare, explained):
        assert budget.affords_search(200.0)
        # A refused search costs nothing.
        assert not budget.affords_search(90.0)
        assert budget.affords_search(10.0)
