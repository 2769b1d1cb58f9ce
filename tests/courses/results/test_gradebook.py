"""The database query of the gradebook uses an index."""

from typing import Any

import pytest
from sqlalchemy import Connection, event

from service.courses.results.gradebook import gradebook
from tests.courses.conftest import Class


@pytest.mark.parametrize("class_", ["postgresql"], indirect=True)
def test_postgresql_neither_sorts_nor_hashes_the_attempts(class_: Class) -> None:
    class_.assign()
    class_.assign(id="second")

    def plan(connection: Connection) -> str:
        asked: list[tuple[str, Any]] = []

        @event.listens_for(connection, "before_cursor_execute")
        def note(*given: Any) -> None:
            asked.append((given[2], given[3]))

        gradebook(connection, "robots")
        [(statement, values)] = [each for each in asked if "array_agg" in each[0]]
        lines = connection.exec_driver_sql(f"EXPLAIN {statement}", values).scalars()
        return "\n".join(lines)

    told = class_.do(plan)
    assert "Index Only Scan using ix_attempts_assignment" in told
    assert "Sort" not in told
    assert "Hash" not in told
