"""Two versions on one database: the newer one migrates while the older one records."""

import random
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from dh_grader.store import UnusableDatabaseError, database
from dh_grader.store.database import open_database, unmigrated_database

from tests.guards import ANSWER
from tests.store.databases import KINDS, migrated_database
from tests.store.test_durability import Acknowledged, _port, _serve, assert_recorded_once
from tests.store.test_migrations import MIGRATIONS

Figure = Callable[[str], None]

# The migration of a newer version: it fills a new column of all attempts, and adds a table.
NEWER = """
import sqlalchemy as sa
from alembic import op

revision = "9999"
down_revision = "{newest}"


def upgrade():
    op.create_table("newer", sa.Column("id", sa.Integer, primary_key=True))
    op.add_column("attempts", sa.Column("newer", sa.Integer))
    op.execute("UPDATE attempts SET newer = 1")
"""


@pytest.fixture
def newer(tmp_path: Path) -> Path:
    """The migrations of a newer version of the program."""
    folder = tmp_path / "migrations"
    shutil.copytree(MIGRATIONS, folder, ignore=shutil.ignore_patterns("__pycache__"))
    newest = max(each.name[:4] for each in (folder / "versions").glob("0*.py"))
    text = NEWER.format(newest=newest)
    (folder / "versions" / "9999_newer.py").write_text(text, "utf-8")
    return folder


def _serve_newer(url: str, log: Path, migrations: Path) -> None:
    database._MIGRATIONS = migrations  # type: ignore[misc]
    _serve(url, log)


def run_both(
    url: str, folder: Path, killable: Any, newer: Path, seed: int, monkeypatch: pytest.MonkeyPatch
) -> int:
    """Start a newer version beside an older one under load, and kill both; return the attempts."""
    dice, logs = random.Random(seed), [folder / f"{name}{seed}" for name in ("old", "half", "new")]
    old = killable(target=_serve, args=(url, logs[0]), daemon=True)
    old.start()
    port = _port(old, logs[0])
    first = Acknowledged([port])
    first.start()
    while not first.ids:
        time.sleep(0.01)
    # The first start of the newer version is killed, perhaps during its migration.
    half = killable(target=_serve_newer, args=(url, logs[1], newer), daemon=True)
    half.start()
    half.join(dice.uniform(0.0, 1.0))
    half.kill()
    half.join(ANSWER)
    new = killable(target=_serve_newer, args=(url, logs[2], newer), daemon=True)
    new.start()
    _port(new, logs[2])
    # The older one records on the new tables.
    for _ in range(2):
        known = len(first.ids)
        while len(first.ids) == known:
            assert old.is_alive()
            time.sleep(0.01)
    time.sleep(dice.uniform(0.0, 0.5))
    for process in (old, new):
        process.kill()
        process.join(ANSWER)
        assert process.exitcode == -signal.SIGKILL
    first.join()
    # The older version refuses to start again, and changes nothing.
    with pytest.raises(UnusableDatabaseError, match="newer version"):
        open_database(url)
    with monkeypatch.context() as patch:
        patch.setattr(database, "_MIGRATIONS", newer)
        assert_recorded_once(url, first.ids)
        engine = unmigrated_database(url)
        with engine.connect() as connection:
            assert database.revisions_of(connection).found == "9999"
        engine.dispose()
    return len(first.ids)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "times",
    [
        pytest.param(1, marks=pytest.mark.long),
        pytest.param(20, marks=[pytest.mark.campaign, pytest.mark.timeout(3600)]),
    ],
)
def test_an_older_version_goes_on_recording_beside_a_newer_one(
    request: pytest.FixtureRequest,
    tmp_path: Path,
    killable: Any,
    newer: Path,
    monkeypatch: pytest.MonkeyPatch,
    figure: Figure,
    kind: str,
    times: int,
) -> None:
    confirmed = 0
    for seed in range(times):
        if kind == "sqlite":
            (tmp_path / str(seed)).mkdir()
            url = str(tmp_path / str(seed) / "attempts.db")
        else:
            url = migrated_database(request.getfixturevalue("postgresql"))
        confirmed += run_both(url, tmp_path, killable, newer, seed, monkeypatch)
    figure(f"{times} migrations under load on {kind}: {confirmed} attempts confirmed, none lost")
