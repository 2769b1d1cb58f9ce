"""Test databases that can be read but not written."""

import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.store import UnusableDatabaseError
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database
from sqlalchemy import event

from tests.api.conftest import InProcess
from tests.attempts.databases import KINDS
from tests.attempts.recorded import NO_TWIST

STRANGER = 65534


@pytest.fixture(params=KINDS)
def store_and_switch(
    request: pytest.FixtureRequest,
) -> Iterator[tuple[AttemptStore, Callable[[str], None]]]:
    url = request.getfixturevalue(f"{request.param}_url")
    store = AttemptStore.open(url)
    store.start()
    if request.param == "sqlite":
        state = {"now": "off"}
        event.listen(
            store.engine,
            "connect",
            lambda connection, _: connection.execute(f"PRAGMA query_only = {state['now']}"),
        )

        def switch(to: str) -> None:
            state["now"] = to
            store.engine.dispose()
    else:
        server, name = request.getfixturevalue("postgresql"), store.engine.url.database

        def switch(to: str) -> None:
            server.psql(f"""
                SET default_transaction_read_only = off;
                ALTER DATABASE {name} SET default_transaction_read_only = {to};
                SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = '{name}';
            """)
            # Drop the connections that the server has closed.
            store.engine.dispose()

    yield store, switch
    store.close()


def test_a_read_only_database_stops_only_recording(
    store_and_switch: tuple[AttemptStore, Callable[[str], None]],
    catalogue: Mapping[str, Exercise],
    caplog: pytest.LogCaptureFixture,
) -> None:
    store, switch = store_and_switch
    app = application(catalogue, store=store, access=Access(read_attempts=True))
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:

        def post(key: str) -> httpx.Response:
            body = {"learner": "ada", "answers": {"table": NO_TWIST}}
            address = "/v1/exercises/scara/attempts"
            return client.post(address, json=body, headers={"Idempotency-Key": key})

        first = post("first")
        assert first.status_code == 201
        switch("on")
        refused = post("second")
        assert (refused.status_code, refused.headers["retry-after"]) == (503, "5")
        assert refused.json()["type"].endswith(":store-down")
        assert "read-only" in caplog.text.replace("readonly", "read-only")
        assert client.get("/readyz").status_code == 503
        graded = client.post("/v1/exercises/scara/grade", json={"answers": {"table": NO_TWIST}})
        assert graded.json() == first.json()["report"]
        assert len(client.get("/v1/attempts").json()["attempts"]) == 1
        with pytest.raises(UnusableDatabaseError, match=r"cannot be recorded there: .*read-?only"):
            AttemptStore.open(_read_only(store))
        switch("off")
        assert post("second").status_code == 201
        assert client.get("/readyz").status_code == 200


def _read_only(store: AttemptStore) -> str:
    url = store.engine.url
    if url.get_backend_name() == "sqlite":
        return f"sqlite:///file:{url.database}?mode=ro&uri=true"
    return url.render_as_string(hide_password=False)


@contextmanager
def without_permission(path: Path) -> Iterator[None]:
    path.chmod(0o555)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(STRANGER)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)
        path.chmod(0o755)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such permissions")
@pytest.mark.parametrize("whole_folder", [True, False])
def test_a_file_without_write_permission_is_reported_at_startup(whole_folder: bool) -> None:
    # Other users can read this folder, unlike the folders of pytest.
    folder = Path(tempfile.mkdtemp(dir="/tmp"))
    try:
        file = folder / "attempts.db"
        open_database(str(file)).dispose()
        file.chmod(0o666)
        folder.chmod(0o777)
        before = file.read_bytes()
        place = folder if whole_folder else file
        with without_permission(place), pytest.raises(UnusableDatabaseError) as told:
            AttemptStore.open(str(file))
        assert str(file) in str(told.value)
        assert re.search("readonly database|unable to open database file", str(told.value))
        assert file.read_bytes() == before
    finally:
        shutil.rmtree(folder)
