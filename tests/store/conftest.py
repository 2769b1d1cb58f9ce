import multiprocessing
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database

from tests.store.databases import KINDS, new_file


@pytest.fixture(scope="session")
def killable() -> Any:
    # A class of processes that start quickly, because a fork server has imported the service.
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(
        [
            "dh_grader.store.regrades",
            "dh_grader.store",
            "dh_grader.authoring",
            "dh_grader.cli.attempts",
            "dh_grader.cli.attempts",
            "dh_grader.cli",
            "dh_grader.server",
        ]
    )
    return context.Process


@pytest.fixture(scope="session")
def file_with_tables(tmp_path_factory: pytest.TempPathFactory) -> str:
    file = new_file(tmp_path_factory.mktemp("sqlite"))
    open_database(file).dispose()
    return file


@pytest.fixture
def sqlite_url(file_with_tables: str, tmp_path: Path) -> str:
    return str(shutil.copy(file_with_tables, new_file(tmp_path)))


@pytest.fixture(params=KINDS)
def database_url(request: pytest.FixtureRequest) -> str:
    """The URL of an empty database; a test runs once with each kind of database."""
    url: str = request.getfixturevalue(f"{request.param}_url")
    return url


@pytest.fixture
def store(database_url: str) -> Iterator[AttemptStore]:
    store = AttemptStore.open(database_url)
    store.start()
    yield store
    store.close()
