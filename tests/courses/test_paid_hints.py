"""Test hints that cost points."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import httpx
import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.contract.courses import AssignmentChange, Extension
from dh_grader.courses.assignments import assignment_of, change_assignment, extend
from dh_grader.grading.reading.entries import Reader
from dh_grader.store.attempts import AttemptFilter
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import everything_of, exercise_statistics, forget
from dh_grader.store.tables import hints
from sqlalchemy import func, select

from tests.courses.conftest import NO_TWIST, RIGHT, Class, days
from tests.solutions.solved import solved

PRICES = [0.0, 0.05, 0.1]
# The message on the missing half turn of α in row 2.
TWIST = {"part": "table", "code": "half_turn", "row": "2", "cell": "alpha"}
# The points of a right table, of the 24 points of scara.
TABLE = 8
PROBLEM = "urn:dh-grader:problem:"


def wrong(d: str = "d3") -> Mapping[str, str]:
    return {"table": f"a1 0 0 θ1\na2 0 0 θ2\n0 0 {d} 0\n0 0 d4 θ4"}


def handed_in(class_: Class, key: str, answers: Any = None) -> Any:
    answer = class_.hand_in(key, answers)
    assert answer.status_code == 201, answer.text
    return answer.json()["attempt"]


def take(class_: Class, attempt: Any, step: int, by: str = "ada", **more: Any) -> httpx.Response:
    return class_.ask("POST", f"/v1/attempts/{attempt['id']}/hints", by, step=step, **TWIST | more)


def kind(answer: httpx.Response) -> tuple[int, str]:
    return answer.status_code, answer.json()["type"].removeprefix(PROBLEM)


def test_a_hint_reduces_the_points_of_later_attempts(class_: Class) -> None:
    class_.assign(hint_prices=PRICES)
    first = handed_in(class_, "one")
    assert "hint_points" not in first
    hint = take(class_, first, 1).json()
    assert (hint["step"], hint["title"]) == (1, "Link twist α")
    second = handed_in(class_, "two", wrong("d3 + d4"))
    # The first step is free.
    assert "hint_points" not in second
    assert take(class_, second, 2).status_code == 200
    third = handed_in(class_, "three", wrong("d4"))
    assert take(class_, third, 3).status_code == 200
    last = handed_in(class_, "four", RIGHT)
    assert last["max_points"] == 24
    assert last["hint_points"] == pytest.approx(0.15 * 24)
    assert last["points"] == pytest.approx(TABLE - 0.15 * 24)
    # What was handed in before stays as it is.
    own = class_.own()
    assert [each.get("hint_points", 0) for each in own["attempts"]] == [0, 0, 1.2, 3.6]
    # Of all attempts the best one counts: here the first.
    assert own["earned"] == pytest.approx(first["points"] / 24 * 10)
    assert own["hint_prices"] == PRICES
    assert [(each["step"], each["price"]) for each in own["hints"]] == [(1, 0), (2, 0.05), (3, 0.1)]
    found = class_.ask("GET", f"/v1/attempts/{third['id']}").json()
    assert [(each["code"], each["step"]) for each in found["hints"]] == [
        ("half_turn", 1),
        ("half_turn", 2),
    ]


def test_full_marks_after_hints_open_the_solution(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    class_.assign(hint_prices=[0.1, 0.1, 0.1], solution="after_full")
    take(class_, handed_in(class_, "one"), 1)
    assert not class_.own()["shows_solution"]
    handed_in(class_, "two", {each.part: each.answer for each in solved(catalogue["scara"]).parts})
    own = class_.own()
    assert own["earned"] == pytest.approx(9)
    assert own["shows_solution"]


def test_between_two_steps_another_answer_is_handed_in(
    class_: Class, monkeypatch: pytest.MonkeyPatch
) -> None:
    class_.assign(hint_prices=PRICES)
    first = handed_in(class_, "one")
    with monkeypatch.context() as context:
        # A refused step reads no answers.
        context.setattr(Reader, "of", None)
        assert kind(take(class_, first, 2)) == (403, "earlier-step-first")
    assert take(class_, first, 1).status_code == 200
    with monkeypatch.context() as context:
        context.setattr(Reader, "of", None)
        assert kind(take(class_, first, 2)) == (403, "try-first")
    same = handed_in(class_, "two")
    assert kind(take(class_, same, 2)) == (403, "try-first")
    changed = handed_in(class_, "three", wrong("d4"))
    assert take(class_, changed, 2).status_code == 200
    # A step that was taken is shown again, without another price.
    assert take(class_, changed, 2).status_code == 200
    assert take(class_, changed, 1).status_code == 200
    assert handed_in(class_, "four", RIGHT)["hint_points"] == pytest.approx(1.2)


@pytest.mark.long
def test_the_steps_at_a_cell_go_on_after_another_mistake(class_: Class) -> None:
    class_.assign(hint_prices=[0.1, 0.2, 0.3])
    take(class_, handed_in(class_, "one"), 1)
    answer = class_.hand_in(
        "two", {"table": "a1 0 0 θ1\na2 90deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
    ).json()
    [told] = answer["report"]["parts"][0]["rows"][1]["cells"][1]["feedback"]
    assert told["code"] != "half_turn"
    second = take(class_, answer["attempt"], 2, code=told["code"])
    assert second.json()["step"] == 2
    assert [each["step"] for each in class_.own()["hints"]] == [1, 2]


def test_a_hint_of_another_learner_has_no_price_for_this_one(class_: Class) -> None:
    class_.assign(hint_prices=[0.2, 0.2, 0.2])
    attempt = handed_in(class_, "one")
    assert kind(take(class_, attempt, 1, by="grace")) == (404, "unknown-attempt")
    take(class_, attempt, 1)
    other = class_.hand_in("two", RIGHT, "grace").json()["attempt"]
    assert other["points"] == TABLE


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("fields", "more", "expected"),
    [
        ({}, {}, (403, "no-hints")),
        ({"hint_prices": PRICES, "feedback": ["verdicts"]}, {}, (403, "no-hints")),
        ({"hint_prices": PRICES, "limit": 1}, {}, (403, "no-attempts-left")),
        ({"hint_prices": PRICES}, {"code": "sign"}, (404, "no-hint")),
        ({"hint_prices": PRICES}, {"part": "nothing"}, (422, "unknown-part")),
    ],
)
def test_a_refused_hint_costs_nothing(
    fields: Mapping[str, Any], more: Mapping[str, Any], expected: tuple[int, str], class_: Class
) -> None:
    class_.assign(**fields)
    attempt = handed_in(class_, "one")
    assert kind(take(class_, attempt, 1, **more)) == expected
    assert class_.own()["hints"] == []


def test_practice_gives_no_free_hints_at_an_exercise_whose_hints_cost(class_: Class) -> None:
    class_.assign(hint_prices=PRICES, practice="open", due=days(1))
    body = {"answers": NO_TWIST, "step": 1, **TWIST}
    path = "/v1/exercises/scara/hints"
    assert kind(class_.ask("POST", path, **body)) == (403, "hints-have-a-price")
    # Nor at an exercise with the same robot; the answers do not matter.
    path = "/v1/exercises/scara-faded/hints"
    assert kind(class_.ask("POST", path, **body)) == (403, "hints-have-a-price")

    def change(**fields: Any) -> None:
        changed = AssignmentChange.model_validate(fields)
        class_.do(lambda it: change_assignment(it, "robots", "homework", changed, {"scara"}))

    change(due=days(-1))
    assert class_.ask("POST", path, **body).status_code == 200
    change(due=days(1), hint_prices=None)
    assert class_.ask("POST", path, **body).status_code == 200


@pytest.mark.long
def test_a_late_attempt_after_hints_gets_back_only_its_lateness(class_: Class) -> None:
    class_.assign(hint_prices=[0.05, 0, 0], due=days(-1), closes=days(1), late_worth=0.5)
    take(class_, handed_in(class_, "one"), 1)
    late = handed_in(class_, "two", RIGHT)
    assert late["points"] == pytest.approx((TABLE - 0.05 * 24) * 0.5)
    without = (TABLE - 0.05 * 24) / 24 * 10
    assert class_.own()["best"] == pytest.approx(without)
    more = Extension.model_validate({"learner": "ada", "due": days(2)})
    class_.do(lambda it: extend(it, "robots", "homework", more))
    assert class_.own()["earned"] == pytest.approx(without)


def test_hints_never_cost_more_than_all_points(class_: Class) -> None:
    class_.assign(hint_prices=[1, 1, 1])
    first = handed_in(class_, "one")
    take(class_, first, 1)
    take(class_, handed_in(class_, "two", wrong("d4")), 2)
    assert handed_in(class_, "three", RIGHT)["points"] == 0
    # The first attempt counts.
    assert class_.own()["earned"] == pytest.approx(first["points"] / 24 * 10)


def test_prices_can_be_changed_and_removed(class_: Class) -> None:
    class_.assign(hint_prices=PRICES)

    def prices() -> Any:
        return class_.do(lambda it: assignment_of(it, "robots", "homework")).hint_prices

    assert prices() == PRICES
    for wanted in ([0, 0, 0.5], None):
        change = partial(
            change_assignment,
            course="robots",
            assignment="homework",
            change=AssignmentChange.model_validate({"hint_prices": wanted}),
            known={"scara"},
        )
        class_.do(change)
        assert prices() == wanted


def test_the_statistics_count_hints_and_misconceptions_by_attempt(class_: Class) -> None:
    class_.assign(hint_prices=PRICES)
    first = handed_in(class_, "one")
    take(class_, first, 1)
    take(class_, handed_in(class_, "two", wrong("d4")), 2)
    handed_in(class_, "three", RIGHT)
    class_.hand_in("four", NO_TWIST, "grace")
    class_.hand_in("five", {"table": "nonsense"}, "grace")
    found = class_.do(lambda it: exercise_statistics(it, AttemptFilter("scara", course="robots")))
    assert [each.model_dump() for each in found.hints] == [
        {"part": "table", "code": "half_turn", "taken": [1, 1, 0]}
    ]
    # Grace's second attempt cannot be read.
    assert found.learners_by_attempt == [2, 1, 1]
    curves = {each.code: each.by_attempt for each in found.misconceptions}
    assert curves["half_turn"] == [2, 1, 0]


@pytest.mark.long
def test_a_thief_with_all_hints_gains_nothing_below_their_price(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    # In ten rounds, the thief takes hints, and writes the symbols that the hints name.
    class_.assign(hint_prices=[0.01, 0.01, 0.01])
    names = [each.name for each in catalogue["scara"].variables]
    rows = [["7", "7", "7", f"theta{i}"] for i in range(1, 5)]
    columns = ("a", "alpha", "d", "theta")
    earned, texts, steps = [], "", dict[tuple[str, ...], int]()
    for turn in range(10):
        answer = class_.hand_in(f"{turn}", {"table": "\n".join(" ".join(row) for row in rows)})
        attempt, report = answer.json()["attempt"], answer.json()["report"]
        earned.append(attempt["points"])
        for row in report["parts"][0]["rows"]:
            for cell in row["cells"]:
                for told in cell["feedback"]:
                    if len(steps) > 2 and (told["code"], row["label"], cell["label"]) not in steps:
                        continue
                    topic = {"code": told["code"], "row": row["label"], "cell": cell["label"]}
                    step = steps.get(tuple(topic.values()), 0) + 1
                    hint = take(class_, attempt, min(step, 3), **topic)
                    if hint.status_code == 200:
                        steps[tuple(topic.values())] = step
                        texts += hint.json()["text"]
        # Whatever the hints name is tried in all cells that are wrong.
        stolen = [name for name in names if name in texts] or ["0.5"]
        for i, row in enumerate(report["parts"][0]["rows"]):
            for cell in row["cells"]:
                if cell["verdict"] != "correct":
                    rows[i][columns.index(cell["label"])] = (
                        f"{stolen[turn % len(stolen)]}*{turn + 2}"
                    )
    assert steps
    assert max(steps.values()) >= 3
    assert max(earned[1:]) <= earned[0]
    assert earned == sorted(earned, reverse=True)


@pytest.mark.long
def test_the_solution_for_right_answers_waits_for_the_assignment(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    class_.assign(solution="after_due", practice="open", due=days(1))
    answers = {each.part: each.answer for each in solved(catalogue["scara"]).parts}
    path = "/v1/exercises/scara/solution"
    assert kind(class_.ask("POST", path, answers=answers)) == (403, "solution-not-shown")
    change = AssignmentChange.model_validate({"solution": "after_full"})
    class_.do(lambda it: change_assignment(it, "robots", "homework", change, {"scara"}))
    assert class_.ask("POST", path, answers=answers).status_code == 403
    handed_in(class_, "one", answers)
    assert class_.ask("POST", path, answers=answers).status_code == 200


def test_a_learner_s_hints_are_exported_and_forgotten(class_: Class) -> None:
    class_.assign(hint_prices=PRICES)
    take(class_, handed_in(class_, "one"), 1)
    [attempt] = class_.do(lambda it: everything_of(it, "ada"))["attempts"]
    assert [(each["cell"], each["step"]) for each in attempt["hints"]] == [("alpha", 1)]
    class_.do(lambda it: forget(it, "ada"))
    assert class_.do(lambda it: it.scalar(select(func.count()).select_from(hints))) == 0


def test_a_regrade_keeps_the_price_of_hints(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    class_.assign(hint_prices=[0.1, 0, 0])
    take(class_, handed_in(class_, "one"), 1)
    handed_in(class_, "two", RIGHT)
    corrected = replace(catalogue["scara"], version="corrected")
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    with class_.store.engine.connect() as connection:
        done = regrading.preview(connection, regrading.outdated(connection))
    assert [(each.before, each.after) for each in done] == [(6.25, 6.25), (5.6, 5.6)]
