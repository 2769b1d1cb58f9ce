"""Search the files of an SQLite database for a text."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from dh_grader.store.database import open_database


def files_with(text: str, path: str) -> list[str]:
    name = Path(path).name
    found = Path(path).parent.glob(f"{name}*")
    return sorted(
        file.name.removeprefix(name) for file in found if text.encode() in file.read_bytes()
    )


@contextmanager
def reader(path: str) -> Iterator[None]:
    """Keep a second connection open that reads the database."""
    other = open_database(path, create=False)
    with other.connect() as connection:
        assert connection.exec_driver_sql("SELECT count(*) FROM attempts").scalar_one() >= 0
        yield
    other.dispose()
