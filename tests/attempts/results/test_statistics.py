from collections.abc import Mapping
from datetime import timedelta

from service.attempts.attempt import AttemptFilter
from service.attempts.results.statistics import exercise_statistics
from service.attempts.store import AttemptStore
from service.catalogue import Exercise
from service.contract.statistics import ExerciseStatistics
from tests.attempts.recorded import NO_TWIST, NOON, RIGHT, recorded

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
