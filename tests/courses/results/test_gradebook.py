"""The gradebook has the best points of each learner, and its database query uses an index."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.contract.courses import Gradebook, GradebookFormat
from dh_grader.courses.gradebook import gradebook, written_gradebook
from dh_grader.store.tables import assignments
from sqlalchemy import Connection, event, select

from tests.attempts.databases import KINDS
from tests.attempts.recorded import NO_TWIST, new_attempt, recorded_all
from tests.courses.conftest import Class

# The gradebook of ``fill``: 12 of 24 points are 5 of 10, 18 of 24 are 3 of 4, and 1 of 1 is 4 of 4.
POINTS = {"ada": [5.0, 3.0], "grace": [0.0, 4.0]}


def fill(class_: Class, catalogue: Mapping[str, Exercise]) -> None:
    """Record attempts in two assignments; some of them are in no place of the gradebook."""
    class_.assign()
    class_.assign(id="second", exercises=[{"exercise": "scara", "points": 4}])
    numbered = select(assignments.c.id, assignments.c.number)
    number_of = {row.id: row.number for row in class_.do(lambda it: it.execute(numbered).all())}
    recorded_all(
        class_.store,
        [
            new_attempt(
                catalogue[exercise], learner, NO_TWIST, ordinal, hours, assignment=number_of[name],
                points=points, max_points=most,
            )
            for exercise, learner, ordinal, hours, name, points, most in (
                ("scara", "ada", 1, 0, "homework", 12.0, 24.0),
                ("scara", "ada", 2, 1, "homework", 6.0, 24.0),
                ("scara", "ada", 3, 2, "second", 18.0, 24.0),
                # Without points to earn, the share is 0.
                ("scara", "grace", 1, 3, "homework", 0.0, 0.0),
                ("scara", "grace", 2, 4, "second", 1.0, 1.0),
                # The exercise has left the assignment, and the learner has left the course.
                ("planar-rr", "ada", 1, 5, "homework", 24.0, 24.0),
                ("scara", "linus", 1, 6, "homework", 24.0, 24.0),
            )
        ],
    )  # fmt: skip


@pytest.mark.parametrize("class_", KINDS, indirect=True)
def test_the_best_share_counts_for_learners_and_exercises_of_the_course(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    fill(class_, catalogue)
    book: Gradebook = class_.do(lambda it: gradebook(it, "robots"))
    assert book.course == "robots"
    assert [(each.assignment, each.points) for each in book.columns] == [
        ("homework", 10.0),
        ("second", 4.0),
    ]
    assert {row.learner: row.points for row in book.rows} == POINTS
    assert [row.total for row in book.rows] == [8.0, 4.0]
    second: Gradebook = class_.do(lambda it: gradebook(it, "robots", "second"))
    assert [row.points for row in second.rows] == [[3.0], [4.0]]


WRITTEN: Mapping[GradebookFormat, list[str]] = {
    "canvas": [
        "Student,ID,SIS User ID,SIS Login ID,Section,homework scara,second scara",
        "    Points Possible,,,,,10,4",
        "Ada,,,ada,,5,3",
        "Grace,,,grace,,0,4",
    ],
    "moodle": [
        "ID number,Full name,Email address,homework scara,second scara",
        "ada,Ada,,5,3",
        "grace,Grace,,0,4",
    ],
    "csv": [
        "learner,name,email,homework scara,second scara,total",
        "ada,Ada,,5,3,8",
        "grace,Grace,,0,4,4",
    ],
}


def test_each_format_has_its_own_columns(class_: Class, catalogue: Mapping[str, Exercise]) -> None:
    fill(class_, catalogue)
    book: Gradebook = class_.do(lambda it: gradebook(it, "robots"))
    for form, expected in WRITTEN.items():
        written = b"".join(written_gradebook(book, form)).decode()
        assert written.splitlines() == expected, form


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
