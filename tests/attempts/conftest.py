from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from service.attempts.store import AttemptStore
from tests.attempts.databases import KINDS, new_database, new_file, postgresql_server

_number = count()


@pytest.fixture(scope="session")
def server() -> Iterator[Any]:
    with postgresql_server() as running:
        yield running


@pytest.fixture(params=KINDS)
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """An empty database of each kind."""
    if request.param == "sqlite":
        return new_file(tmp_path)
    url: str = request.getfixturevalue("postgresql_url")
    return url


@pytest.fixture
def postgresql_url(server: Any) -> str:
    """An empty database of the PostgreSQL server."""
    return new_database(server, f"attempts{next(_number)}")


@pytest.fixture
def store(database_url: str) -> Iterator[AttemptStore]:
    store = AttemptStore.open(database_url)
    store.start()
    yield store
    store.close()
