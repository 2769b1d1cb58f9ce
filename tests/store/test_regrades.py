"""Test regrades."""

import json
import os
import signal
import sqlite3
import time
from collections import Counter
from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.store import Outcome
from dh_grader.store import regrades as regrading_module
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.regrades import BATCH, MemoizedReports, Regrading, WrittenReport
from dh_grader.store.results import history
from dh_grader.store.tables import attempts, earlier_reports
from sqlalchemy import func, select, text

from tests.guards import ANSWER, STALL
from tests.store.recorded import NO_TWIST, RIGHT, new_attempt, recorded, recorded_all, regraded


@pytest.fixture
def corrected(catalogue: Mapping[str, Exercise]) -> Exercise:
    scara = catalogue["scara"]
    table, *others = scara.parts
    parts = (table.model_copy(update={"points": 2 * table.points}), *others)
    return replace(scara, version="corrected", parts=parts)


def test_a_corrected_exercise_changes_points_and_keeps_the_reports_before(
    store: AttemptStore, catalogue: Mapping[str, Exercise], corrected: Exercise
) -> None:
    before = recorded(store, catalogue["scara"], "ada", NO_TWIST, worth=0.5, points=1.5)
    recorded(store, catalogue["planar-rr"], "ada", NO_TWIST)
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    with store.engine.connect() as connection:
        numbers = regrading.outdated(connection)
        (previewed,) = regrading.preview(connection, numbers)
        untouched = history(connection, before.id)
    assert untouched is not None
    assert untouched.attempt.points == 1.5
    (done,) = regraded(store, regrading)
    assert done == previewed
    assert (done.learner, done.before, done.reasons) == (
        "ada",
        1.5,
        ("table partial, other points",),
    )
    with store.engine.connect() as connection:
        after = history(connection, before.id)
        assert regrading.outdated(connection) == []
        assert regrading.waiting(connection) == 0
    assert after is not None
    assert after.attempt.points == done.after > 1.5
    assert after.attempt.version == "corrected"
    (earlier,) = after.earlier
    assert (earlier.report, earlier.points, earlier.version) == (
        before.report,
        1.5,
        catalogue["scara"].version,
    )
    assert regraded(store, regrading) == []


def test_a_regrade_does_not_raise_the_feedback_level(
    sqlite_url: str, catalogue: Mapping[str, Exercise], corrected: Exercise
) -> None:
    # The service may have had a ceiling that the regrading process does not know.
    store = AttemptStore.open(sqlite_url)
    under_a_ceiling = replace(catalogue["scara"], feedback_by_attempt=(FeedbackLevel.SCORE,))
    low = recorded(store, under_a_ceiling, "ada", NO_TWIST)
    usual = recorded(store, catalogue["scara"], "grace", NO_TWIST)
    regraded(store, Regrading(corrected, FeedbackLevel.FULL))
    told = []
    with store.engine.connect() as connection:
        for each in (low, usual):
            found = history(connection, each.id)
            assert found is not None
            report = json.loads(found.report)
            told.append((report["feedback"], bool(report["parts"][0]["rows"])))
    assert told == [("score", False), ("hints", True)]
    store.close()


def test_an_attempt_queued_again_is_not_regraded_twice(
    store: AttemptStore, catalogue: Mapping[str, Exercise], corrected: Exercise
) -> None:
    number = recorded(store, catalogue["scara"], "ada", RIGHT).number
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    regraded(store, regrading)
    again = text("INSERT INTO regrade_queue (attempt, exercise) VALUES (:number, 'scara')")
    in_transaction(store.engine, lambda connection: connection.execute(again, {"number": number}))
    assert in_transaction(store.engine, regrading.work) == []
    with store.engine.connect() as connection:
        assert connection.scalar(select(func.count()).select_from(earlier_reports)) == 1
        assert regrading.waiting(connection) == 0


def test_answers_to_a_removed_part_are_ignored(
    sqlite_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(sqlite_url)
    scara = catalogue["scara"]
    recorded(store, scara, "ada", RIGHT)
    table, *others = scara.parts
    renamed = replace(scara, version="2", parts=(table.model_copy(update={"id": "t"}), *others))
    (done,) = regraded(store, Regrading(renamed, FeedbackLevel.HINTS))
    assert done.before > done.after == 0
    assert done.reasons == ("table is no part any more", "t is new, missing")
    store.close()


def test_in_sqlite_others_write_while_a_worker_grades(
    sqlite_url: str,
    catalogue: Mapping[str, Exercise],
    corrected: Exercise,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    store = AttemptStore.open(sqlite_url)
    recorded(store, catalogue["scara"], "ada", RIGHT)
    grade = Regrading._report

    def grade_beside_a_writer(*given: Any) -> Any:
        with closing(sqlite3.connect(sqlite_url, timeout=0, isolation_level=None)) as another:
            another.execute("BEGIN IMMEDIATE")
        return grade(*given)

    monkeypatch.setattr(Regrading, "_report", grade_beside_a_writer)
    assert len(regraded(store, Regrading(corrected, FeedbackLevel.HINTS))) == 1
    store.close()


def test_a_batch_ends_when_its_time_is_over(
    store: AttemptStore,
    catalogue: Mapping[str, Exercise],
    corrected: Exercise,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recorded_all(store, [new_attempt(catalogue["scara"], f"l{i}", RIGHT) for i in range(3)])
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    in_transaction(store.engine, regrading.enqueue)
    monkeypatch.setattr(regrading_module, "_BATCH_SECONDS", 0.0)
    done = [len(regrading.next_batch(store.engine)) for _ in range(4)]
    assert done == [1, 1, 1, 0]


def _worker(url: str, exercise: Exercise) -> None:
    engine = open_database(url)
    regrading = Regrading(exercise, FeedbackLevel.HINTS)
    while True:
        with engine.connect() as connection:
            connection = connection.execution_options(writes=True)
            with connection.begin():
                regrading.work(connection)
                # Hold the locks for a moment, so that the kill comes during the transaction.
                time.sleep(0.02)


@pytest.mark.long
def test_attempts_of_a_killed_worker_are_regraded_once_by_another(
    postgresql_url: str,
    catalogue: Mapping[str, Exercise],
    corrected: Exercise,
    killable: Any,
) -> None:
    count = 3 * BATCH
    store = AttemptStore.open(postgresql_url)
    recorded_all(store, [new_attempt(catalogue["scara"], f"l{i}", NO_TWIST) for i in range(count)])
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    in_transaction(store.engine, regrading.enqueue)
    worker = killable(target=_worker, args=(postgresql_url, corrected), daemon=True)
    worker.start()
    left = count
    deadline = time.monotonic() + ANSWER
    while left == count and time.monotonic() < deadline:
        with store.engine.connect() as connection:
            left = regrading.waiting(connection)
    assert worker.pid
    os.kill(worker.pid, signal.SIGKILL)
    worker.join()
    assert left < count
    regraded(store, regrading)
    with store.engine.connect() as connection:
        times = Counter(connection.scalars(select(earlier_reports.c.attempt)))
        versions = set(connection.scalars(select(attempts.c.version)))
    assert set(times.values()) == {1}
    assert (len(times), versions) == (count, {"corrected"})
    store.close()


def test_workers_do_not_wait_for_one_another(
    postgresql_url: str,
    catalogue: Mapping[str, Exercise],
    corrected: Exercise,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(regrading_module, "_BATCH_SECONDS", STALL)
    store = AttemptStore.open(postgresql_url)
    recorded_all(store, [new_attempt(catalogue["scara"], f"l{i}", RIGHT) for i in range(BATCH + 2)])
    regrading = Regrading(corrected, FeedbackLevel.HINTS)
    in_transaction(store.engine, regrading.enqueue)
    with (
        store.engine.execution_options(writes=True).begin() as one,
        store.engine.begin() as another,
    ):
        assert len(regrading.work(one)) == BATCH
        assert len(regrading.work(another)) == 2
        assert regrading.work(another) == []
    store.close()


# --- Memoized reports

HINTS, SCORE = FeedbackLevel.HINTS, FeedbackLevel.SCORE


def report(text: str) -> WrittenReport:
    return WrittenReport(text, 1.0, 2.0, {}, Outcome("scara", "{}"), "v1")


def graded_again() -> WrittenReport:
    pytest.fail("It was graded again.")


def test_the_same_answers_at_the_same_level_are_graded_once() -> None:
    memoized = MemoizedReports()
    first = memoized.get("answers", HINTS, lambda: report("hints"))
    assert memoized.get("answers", HINTS, graded_again) is first
    assert memoized.get("answers", SCORE, lambda: report("score")).text == "score"
    assert memoized.get("others", HINTS, lambda: report("of others")).text == "of others"


def test_the_least_recently_used_report_is_dropped_first() -> None:
    memoized = MemoizedReports(most_bytes=100_000)
    for name in "abc":
        memoized.get(name, HINTS, lambda: report("x" * 20_000))
    memoized.get("a", HINTS, graded_again)
    # Four reports of this length fit; 40,000 more bytes displace two.
    memoized.get("d" * 20_000, HINTS, lambda: report("x" * 20_000))
    memoized.get("a", HINTS, graded_again)
    memoized.get("c", HINTS, graded_again)
    assert memoized.get("b", HINTS, lambda: report("new")).text == "new"


def test_a_report_over_the_limit_is_not_memoized() -> None:
    memoized = MemoizedReports(most_bytes=10_000)
    assert memoized.get("answers", HINTS, lambda: report("x" * 20_000)).text[0] == "x"
    assert memoized.get("answers", HINTS, lambda: report("y" * 20_000)).text[0] == "y"
