"""Today's program opens a database of the program's first version."""

import asyncio
import csv
import json
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest
from alembic import command
from alembic.config import Config
from dh_grader.access import Secret
from dh_grader.access.keys import add_key, fits, revoke_key, settle
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.store import AttemptStore, database
from dh_grader.store.attempts import AttemptFilter, GradesFormat
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import graded_attempts, history, page, written
from sqlalchemy import create_engine, make_url, text

from tests.attempts.databases import new_database, new_file
from tests.attempts.recorded import RIGHT, regraded

OLDEST = "0001"
MIGRATIONS = Path(database.__file__).parent / "migrations"
# A report of an older exercise version, in which the right table earned nothing.
REPORT = json.dumps(
    {
        "exercise": "scara",
        "version": "0",
        "grader": "0.0.1",
        "feedback": "hints",
        "parts": [{"part": "table", "verdict": "incorrect", "points": 0.0, "rows": []}],
    }
)
OUTCOME = '{"table":{"verdict":"incorrect","cells":{},"codes":[]}}'
ROWS: tuple[dict[str, Any], ...] = (
    {"id": "a" * 32, "learner": "ada", "ordinal": 1, "is_late": True, "worth": 0.5, "key": "k"},
    {"id": "b" * 32, "learner": "bob", "ordinal": None, "is_late": False, "worth": 1, "key": None},
)
# The statement with which the first version records an attempt.
INSERT = (
    "INSERT INTO attempts (id, exercise, learner, ordinal, at, is_late, worth, submission, "
    "answers_digest, report, version, grader, points, max_points, outcome, owner, idempotency_key, "
    "request_digest) VALUES (:id, 'scara', :learner, :ordinal, '2026-09-01 12:00:00.000000{zone}', "
    ":is_late, :worth, :submission, 'x', :report, '0', '0.0.1', 0.0, 16.0, 1, 'course', :key, 'r')"
)
FIXED = {"submission": json.dumps({"answers": {"table": RIGHT}}), "report": REPORT}


def make_old(url: str, revision: str) -> None:
    parsed = make_url(url if "://" in url else f"sqlite:///{url}")
    zone = ""
    if parsed.get_backend_name() == "postgresql":
        parsed, zone = parsed.set(drivername="postgresql+psycopg"), "+00"
    engine = create_engine(parsed)
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    with engine.execution_options(writes=True).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, revision)
        connection.execute(
            text(
                "INSERT INTO outcomes (exercise, digest, content) VALUES ('scara', 'd', :content)"
            ),
            {"content": OUTCOME},
        )
        connection.execute(text(INSERT.format(zone=zone)), [row | FIXED for row in ROWS])
    engine.dispose()


@pytest.fixture(params=["sqlite", "postgresql"])
def oldest(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    if request.param == "sqlite":
        url = f"sqlite:///{new_file(tmp_path)}"
    else:
        url = new_database(request.getfixturevalue("postgresql"), f"first_{uuid4().hex}")
    make_old(url, OLDEST)
    return url


@pytest.fixture
def store(oldest: str) -> Iterator[AttemptStore]:
    store = AttemptStore.open(oldest)
    store.start()
    yield store
    store.close()


def test_keys_without_a_recorded_secret_get_that_of_the_next_key(store: AttemptStore) -> None:
    right, other, now = Secret("right" * 8), Secret("other" * 8), datetime.now(UTC)
    with store.engine.execution_options(writes=True).begin() as connection:
        key = add_key(connection, "a", "d", (), None, now, now + timedelta(days=1))
        assert fits(connection, right)
        assert fits(connection, other)
        assert settle(connection, right, now)
        assert fits(connection, right)
        assert not fits(connection, other)
        assert not settle(connection, other, now)
        assert revoke_key(connection, key.id, now)
        assert settle(connection, other, now)
        assert not fits(connection, right)


def exported(store: AttemptStore) -> list[dict[str, str]]:
    with store.engine.connect() as connection:
        graded = graded_attempts(connection, AttemptFilter("scara"), lambda _: "best")
        lines = b"".join(written(graded, GradesFormat.CSV, "")).decode("utf-8-sig").splitlines()
    return list(csv.DictReader(lines))


def test_attempts_of_the_first_version_are_read_regraded_and_exported(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    table: Any = scara.part("table")
    with store.engine.connect() as connection:
        found, _ = page(connection, AttemptFilter("scara"), None, 10)
        untouched = history(connection, ROWS[0]["id"])
    assert [(each.learner, each.ordinal, each.is_late, each.points) for each in found] == [
        ("bob", None, False, 0.0),
        ("ada", 1, True, 0.0),
    ]
    assert {each.at.isoformat() for each in found} == {"2026-09-01T12:00:00+00:00"}
    assert untouched is not None
    assert (untouched.report, untouched.earlier) == (REPORT, [])
    # An old request is recognized by its idempotency key.
    earlier = asyncio.run(store.standing("scara", "ada", "course", "k")).earlier
    assert earlier is not None
    assert earlier.id == ROWS[0]["id"]

    regrading = Regrading(scara, FeedbackLevel.HINTS)
    done = regraded(store, regrading)
    assert [(each.learner, each.before, each.after) for each in done] == [
        ("ada", 0.0, table.points / 2),
        ("bob", 0.0, table.points),
    ]
    new = {f"{part.id} is new, missing" for part in scara.parts if part.id != "table"}
    assert {reason for each in done for reason in each.reasons} == {
        "table incorrect → correct",
        *new,
    }
    with store.engine.connect() as connection:
        after = history(connection, ROWS[0]["id"])
    assert after is not None
    assert [(each.report, each.version) for each in after.earlier] == [(REPORT, "0")]
    assert [
        (row["learner"], float(row["points"]), row["counts"], row["version"])
        for row in exported(store)
    ] == [
        ("ada", table.points / 2, "true", scara.version),
        ("bob", table.points, "false", scara.version),
    ]
