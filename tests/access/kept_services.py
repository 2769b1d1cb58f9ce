"""Share services with keys and a database between tests, because building one is slow."""

from collections.abc import Callable
from typing import Any

import pytest
from dh_grader.access import Secret
from dh_grader.access.key_ring import KeyRing
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.tables import metadata

from tests.store.databases import migrated_database, new_file

SECRET_TEXT = "0123456789abcdef" * 4
SECRET = Secret(SECRET_TEXT)
# Makes an application over a store, with its keys.
Build = Callable[[AttemptStore, KeyRing], Any]


class KeptServices:
    """Services that tests share: one for each kind of database and each catalogue."""

    def __init__(self, request: pytest.FixtureRequest, folders: pytest.TempPathFactory) -> None:
        self._request, self._folders = request, folders
        self._built: dict[tuple[str, int], tuple[Any, AttemptStore, KeyRing]] = {}

    def empty(
        self, kind: str, catalogue: object, build: Build
    ) -> tuple[Any, AttemptStore, KeyRing]:
        """Return the application, store and keys of a service with empty database tables."""
        # The application must keep the catalogue alive, because Python's id of the catalogue is
        # used to find the application again.
        place = kind, id(catalogue)
        if place not in self._built:
            store = AttemptStore.open(self._url(kind))
            ring = KeyRing(store.engine, SECRET, seconds=0.01)
            self._built[place] = build(store, ring), store, ring
            store.start()
        app, store, ring = self._built[place]
        with store.engine.begin() as connection:
            for table in reversed(metadata.sorted_tables):
                connection.execute(table.delete())
        return app, store, ring

    def close(self) -> None:
        for _, store, ring in self._built.values():
            ring.close()
            store.close()

    def _url(self, kind: str) -> str:
        if kind == "sqlite":
            return new_file(self._folders.mktemp("kept"))
        return migrated_database(self._request.getfixturevalue("postgresql"))
