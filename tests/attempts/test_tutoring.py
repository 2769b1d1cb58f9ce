import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.store import AttemptStore
from dh_grader.store.database import UnknownAttemptError, UnusablePointsError
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import LearnerData, forget, history, override
from dh_grader.store.tables import attempts, metadata, outcomes, regrade_queue
from sqlalchemy import func, select, text

from tests.attempts.recorded import NO_TWIST, NOON, RIGHT, recorded, regraded
from tests.guards import ANSWER


def test_points_of_a_tutor_count_and_can_be_withdrawn(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST)
    earned = []
    for points, reason in ((5.0, "the sheet was wrong"), (None, "it was not")):
        with store.engine.execution_options(writes=True).begin() as connection:
            override(connection, attempt.id, points, reason, "Dr. Lee", NOON)
            found = history(connection, attempt.id)
        assert found is not None
        earned.append(found.attempt.earned)
    assert earned == [5.0, attempt.points]
    with store.engine.connect() as connection:
        found = history(connection, attempt.id)
    assert found is not None
    told = [(row.points, row.reason, row.author, row.at) for row in found.overrides]
    assert told == [
        (5.0, "the sheet was wrong", "Dr. Lee", NOON),
        (None, "it was not", "Dr. Lee", NOON),
    ]


def test_points_out_of_range_are_refused(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST)
    for points in (-0.5, 1000.0, float("nan")):
        with (
            store.engine.execution_options(writes=True).begin() as connection,
            pytest.raises(UnusablePointsError),
        ):
            override(connection, attempt.id, points, "", "", NOON)
    with (
        store.engine.execution_options(writes=True).begin() as connection,
        pytest.raises(UnknownAttemptError),
    ):
        override(connection, "0" * 32, 1.0, "", "", NOON)


def test_nothing_of_a_forgotten_learner_is_left(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    first = recorded(store, scara, "ada", NO_TWIST)
    recorded(store, scara, "ada", RIGHT, 2)
    other = recorded(store, scara, "grace", RIGHT)
    regrading = Regrading(replace(scara, version="2"), FeedbackLevel.FULL)
    regraded(store, regrading)
    with store.engine.execution_options(writes=True).begin() as connection:
        override(connection, first.id, 1.0, "because", "me", NOON)
        connection.execute(regrade_queue.insert().values(attempt=first.number, exercise="scara"))
    with store.engine.execution_options(writes=True).begin() as connection:
        assert forget(connection, "ada") == LearnerData(2, 2, 1, 0)
        assert forget(connection, "ada") == LearnerData(0, 0, 0, 0)
    with store.engine.connect() as connection:
        assert list(connection.scalars(select(attempts.c.id))) == [other.id]
        for table in metadata.tables.values():
            if table not in (attempts, outcomes):
                rows = connection.scalar(select(func.count()).select_from(table)) or 0
                assert rows == (1 if table.name == "earlier_reports" else 0)


def test_a_learner_can_be_forgotten_while_a_regrade_begins(
    postgresql_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(postgresql_url)
    recorded(store, catalogue["scara"], "ada", NO_TWIST)
    regrading = Regrading(replace(catalogue["scara"], version="2"), FeedbackLevel.FULL)

    def forgotten() -> LearnerData:
        with store.engine.execution_options(writes=True).begin() as connection:
            return forget(connection, "ada")

    waiting = text("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'")
    with ThreadPoolExecutor(1) as thread:
        with store.engine.execution_options(writes=True).begin() as connection:
            regrading.enqueue(connection)
            deleted = thread.submit(forgotten)
            end = time.monotonic() + ANSWER
            with store.engine.connect() as watching:
                while not watching.scalar(waiting) and time.monotonic() < end:
                    # Within one transaction the view would not change.
                    watching.rollback()
                    time.sleep(0.01)
        assert deleted.result(ANSWER) == LearnerData(1, 0, 0, 0)
    with store.engine.connect() as connection:
        assert regrading.waiting(connection) == 0
    store.close()
