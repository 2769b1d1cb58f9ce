import json
from collections.abc import Mapping, Sequence
from datetime import timedelta
from itertools import count

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.contract import ExerciseStatistics
from dh_grader.store import AttemptFilter, NewAttempt, Outcome
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.results import exercise_statistics
from dh_grader.store.tables import hints
from sqlalchemy import insert

from tests.attempts.recorded import NO_TWIST, NOON, RIGHT, new_attempt, recorded, recorded_all

WRONG_LENGTH = NO_TWIST.replace("a2", "a1")


def statistics(store: AttemptStore, **wanted: object) -> ExerciseStatistics:
    with store.engine.connect() as connection:
        return exercise_statistics(connection, AttemptFilter("scara", **wanted))  # type: ignore[arg-type]


def test_a_class_is_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    scara = catalogue["scara"]
    for learner in ("ada", "grace", "linus"):
        recorded(store, scara, learner, NO_TWIST)
    recorded(store, scara, "grace", RIGHT, 2, hours=24)
    recorded(store, scara, "donald", RIGHT, hours=24)
    recorded(store, scara, "edsger", "?!", None, hours=24)
    recorded(store, scara, "ada", WRONG_LENGTH, 2, hours=24)
    recorded(store, catalogue["planar-rr"], "ada", "0 0 0 θ1")
    told = statistics(store)
    assert (told.attempts, told.learners) == (7, 5)
    table, *others = told.parts
    assert (table.part, table.answered, table.correct) == ("table", 7, 2)
    assert all(part.answered == 0 and part.share is None for part in others)
    second = table.rows[1]
    assert [row.label for row in table.rows] == ["1", "2", "3", "4"]
    assert (second.answered, second.correct) == (6, 2)
    cells = {cell.label: (cell.answered, cell.correct) for cell in second.cells}
    assert cells == {"a": (6, 5), "alpha": (6, 2), "d": (6, 6), "theta": (6, 6)}
    days = {slip.code: slip.by_day for slip in told.misconceptions}
    assert days["half_turn"] == {"2026-11-22": 3, "2026-11-23": 1}
    assert all(slip.attempts == sum(slip.by_day.values()) for slip in told.misconceptions)
    sentences = {slip.code: slip.sentence for slip in told.misconceptions}
    # As docs/sentences.md has it.
    assert sentences["half_turn"] == "α is not right: compare z1 and z2."
    (group,) = told.identical
    assert (group.learners, group.attempts, group.among) == (3, 3, ["ada", "grace", "linus"])
    assert group.wrong == ["table/2/alpha"]


def test_a_span_of_time_is_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    recorded(store, catalogue["scara"], "ada", NO_TWIST)
    recorded(store, catalogue["scara"], "ada", RIGHT, 2, hours=1)
    told = statistics(store, since=NOON + timedelta(minutes=1))
    assert (told.attempts, told.parts[0].correct) == (1, 1)
    assert (told.misconceptions, told.identical) == ([], [])


def test_the_statistics_of_no_attempts_are_zero(store: AttemptStore) -> None:
    told = statistics(store)
    assert (told.attempts, told.learners, told.parts) == (0, 0, [])


def record_outcome(
    store: AttemptStore, scara: Exercise, ordinals: Sequence[int | None], learner: str = "ada",
    part: str = "table", codes: str = "", cells: str = "", hours: float | None = None,
) -> None:  # fmt: skip
    """Record attempts whose part has these codes and right cells."""
    told = {
        "verdict": "partial",
        "cells": dict.fromkeys(cells.split(), "correct"),
        "codes": codes.split(),
    }
    outcome = Outcome("scara", json.dumps({part: told}))
    recorded_all(
        store,
        [
            (new_attempt(scara, learner, RIGHT, n, hours=hours or n or 0)[0], outcome)
            for n in ordinals
        ],
    )


def test_a_learning_curve_has_twelve_attempts_of_each_learner(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    record_outcome(store, scara, (1, 2, 3), codes="value half_turn")
    record_outcome(store, scara, (4,), codes="value")
    record_outcome(store, scara, range(5, 14))
    # An attempt in which nothing could be read is in no curve.
    record_outcome(store, scara, (None,), codes="value")
    record_outcome(store, scara, (1,), "grace", codes="half_turn")
    record_outcome(store, scara, (2,), "grace", codes="an_a_code")
    # A part that the exercise no longer has.
    record_outcome(store, scara, (3,), "grace", part="axes", codes="value")
    told = statistics(store)
    assert (told.attempts, told.learners) == (17, 2)
    assert told.learners_by_attempt == [2, 2, 2, *[1] * 9]
    found = [(each.part, each.code, each.attempts, each.by_attempt) for each in told.misconceptions]
    assert found == [
        ("table", "value", 5, [1, 1, 1, 1, *[0] * 8]),
        ("table", "half_turn", 4, [2, 1, 1, *[0] * 9]),
        ("axes", "value", 1, [0, 0, 1, *[0] * 9]),
        ("table", "an_a_code", 1, [0, 1, *[0] * 10]),
    ]


def test_the_first_attempt_is_the_one_that_was_made_first(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    # Neither the order of arrival nor the ordinals decide, but the times.
    record_outcome(store, catalogue["scara"], (1,), codes="value", hours=3)
    record_outcome(store, catalogue["scara"], (2,), codes="half_turn", hours=2)
    found = {each.code: each.by_attempt for each in statistics(store).misconceptions}
    assert found == {"value": [0, 1], "half_turn": [1, 0]}


def test_equally_common_misconceptions_are_in_alphabetical_order(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    for i, code in enumerate(("value", "half_turn", "sign", "half_turn"), start=1):
        record_outcome(store, catalogue["scara"], (i,), codes=code)
    found = [each.code for each in statistics(store).misconceptions]
    assert found == ["half_turn", "sign", "value"]


# Ordinals that no other attempt of a learner has.
_ORDINALS = count(1)


def with_wrong_cell(
    scara: Exercise, digest: str, times_of: Mapping[str, int], verdict: str = "incorrect"
) -> list[tuple[NewAttempt, Outcome]]:
    """Return equal attempts, so many of each learner, whose cell 1/a has this verdict."""
    told = {"verdict": "partial", "cells": {"1/a": verdict, "1/d": "correct"}, "codes": []}
    outcome = Outcome("scara", json.dumps({"table": told}))
    return [
        (new_attempt(scara, learner, RIGHT, next(_ORDINALS), answers_digest=digest)[0], outcome)
        for learner, times in times_of.items()
        for _ in range(times)
    ]


def test_equal_wrong_answers_are_in_the_order_of_learners_and_of_attempts(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    groups = {
        "a": {"ada": 1, "grace": 1},
        "b": {"ada": 3, "grace": 1},
        "c": {"linus": 1, "grace": 1, "ada": 1},
        "d": {"ada": 1, "linus": 1},
        # One learner alone has copied nothing.
        "e": {"ada": 5},
    }
    new = [with_wrong_cell(catalogue["scara"], *each) for each in groups.items()]
    new.append(with_wrong_cell(catalogue["scara"], "f", {"ada": 3, "grace": 3}, "correct"))
    recorded_all(store, (each for group in new for each in group))
    found = [(each.learners, each.attempts, each.among) for each in statistics(store).identical]
    assert found == [
        (3, 3, ["ada", "grace", "linus"]),
        (2, 4, ["ada", "grace"]),
        (2, 2, ["ada", "grace"]),
        (2, 2, ["ada", "linus"]),
    ]
    assert {str(each.wrong) for each in statistics(store).identical} == {"['table/1/a']"}


def test_the_statistics_name_the_first_of_very_many(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara, numbers = catalogue["scara"], range(101)
    record_outcome(store, scara, (1,), codes=" ".join(f"code_{i:03}" for i in numbers))
    learners = [f"learner {i:03}" for i in numbers[:51]]
    new = with_wrong_cell(scara, "0", dict.fromkeys(learners, 1))
    for i in numbers[:50]:
        new += with_wrong_cell(scara, f"digest {i}", {"ada": 1, "grace": 1})
    recorded_all(store, new)
    told = statistics(store)
    assert [each.code for each in told.misconceptions] == [f"code_{i:03}" for i in numbers[:100]]
    assert [each.learners for each in told.identical] == [51, *[2] * 49]
    assert told.identical[0].among == learners[:50]


@pytest.mark.parametrize(
    ("with_row", "without", "unread", "is_shown"),
    [(1, 0, 0, True), (1, 1, 0, False), (2, 1, 0, True), (2, 2, 0, False), (1, 0, 2, True)],
)
def test_a_row_is_shown_if_most_tables_have_it(
    store: AttemptStore,
    catalogue: Mapping[str, Exercise],
    with_row: int,
    without: int,
    unread: int,
    is_shown: bool,
) -> None:
    # Tables without cells are not counted.
    numbers = iter(range(1, 10))
    for times, cells in ((with_row, "1/a 5/a"), (without, "1/a"), (unread, "")):
        ordinals = [next(numbers) for _ in range(times)]
        record_outcome(store, catalogue["scara"], ordinals, cells=cells)
    (table,) = statistics(store).parts
    first, fifth = ("1", with_row + without), ("5", with_row)
    shown = [(row.label, row.answered) for row in table.rows]
    assert shown == ([first, fifth] if is_shown else [first])


def test_taken_hints_are_counted(store: AttemptStore, catalogue: Mapping[str, Exercise]) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST).number
    place = {"attempt": attempt, "part": "table", "code": "half_turn", "row": "2", "at": NOON}
    taken = [{**place, "cell": "alpha", "step": step, "price": 0.1} for step in (1, 2)]
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(insert(hints), [*taken, {**taken[0], "cell": "a"}])
    (told,) = statistics(store).hints
    assert (told.part, told.code, told.taken) == ("table", "half_turn", [2, 1, 0])
