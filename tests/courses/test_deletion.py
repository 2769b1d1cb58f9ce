"""Deleted courses, assignments and learners leave no data."""

import asyncio
from functools import partial
from typing import Any

import pytest
from dh_grader.cli import program
from dh_grader.contract.courses import Extension
from dh_grader.courses.assignments import extend
from dh_grader.store.tables import (
    assignments,
    attempts,
    course_learners,
    courses,
    earlier_reports,
    extensions,
    overrides,
    regrade_queue,
)
from sqlalchemy import func, select
from typer.testing import CliRunner

from tests.attempts.databases import KINDS
from tests.courses.conftest import Class, days
from tests.courses.results.test_workbook import as_tutor

BOTH = pytest.mark.parametrize("class_", KINDS, indirect=True)
ASSIGNMENT = "/v1/courses/robots/assignments/homework/delete"
TABLES = (
    courses, course_learners, assignments, extensions,
    attempts, overrides, earlier_reports, regrade_queue,
)  # fmt: skip


def rows(class_: Class) -> dict[str, int]:
    """Return the row counts of the database tables that are not empty."""

    def counted(connection: Any) -> dict[str, int]:
        found = {
            table.name: connection.scalar(select(func.count()).select_from(table))
            for table in TABLES
        }
        return {name: number for name, number in found.items() if number}

    found: dict[str, int] = class_.do(counted)
    return found


@pytest.fixture
def tutored(class_: Class) -> Class:
    class_.assign(due=days(1))
    more = Extension.model_validate({"learner": "ada", "due": days(2)})
    class_.do(partial(extend, course="robots", assignment="homework", extension=more))
    for learner, key in (("ada", "a"), ("ada", "b")):
        assert class_.hand_in(key, learner=learner).status_code == 201
    made = class_.hand_in("c", learner="grace").json()["attempt"]["id"]
    asyncio.run(class_.store.override(made, 1.0, "A misprint.", "Prof. X"))
    return as_tutor(class_)


WHOLE = {
    "courses": 1, "course_learners": 2, "assignments": 1, "extensions": 1,
    "attempts": 3, "overrides": 1,
}  # fmt: skip


@pytest.mark.sampled(2)
@BOTH
def test_an_assignment_is_deleted_with_its_attempts_only_on_request(tutored: Class) -> None:
    told = tutored.ask("POST", ASSIGNMENT, "tutor", apply=False).json()
    numbers = {"assignments": 1, "learners": 0, "extensions": 1, "keys": 0, "attempts": 3}
    assert told == {"deleted": False, **numbers}
    refused = tutored.ask("POST", ASSIGNMENT, "tutor", apply=True)
    assert (refused.status_code, "3 recorded attempts" in refused.text) == (409, True)
    assert rows(tutored) == WHOLE
    done = tutored.ask("POST", ASSIGNMENT, "tutor", apply=True, with_attempts=True).json()
    assert done == {"deleted": True, **numbers}
    assert rows(tutored) == {"courses": 1, "course_learners": 2}
    assert tutored.ask("POST", ASSIGNMENT, "tutor", apply=True).status_code == 404
    # The attempts count nowhere any more, neither in a new assignment nor outside of all.
    tutored.assign(limit=1)
    assert tutored.own()["attempts_left"] == 1
    assert tutored.hand_in("d").status_code == 201
    outside = asyncio.run(tutored.store.standing("scara", "grace", "", None))
    assert outside.counted == 0


@pytest.mark.long
@BOTH
def test_the_attempts_of_another_assignment_stay_and_do_not_count_outside(tutored: Class) -> None:
    # Deleted attempts leave gaps in the numbers of a learner's attempts.
    exercises = [{"exercise": "scara", "points": 10}]
    tutored.assign(id="other", title="Other", exercises=exercises)
    path = "/v1/courses/robots/assignments/other/attempts"
    body = {"exercise": "scara", "answers": {}}
    assert tutored.ask("POST", path, "ada", "x", **body).status_code == 201
    tutored.ask("POST", ASSIGNMENT, "tutor", apply=True, with_attempts=True)
    outside = asyncio.run(tutored.store.standing("scara", "ada", "", None))
    assert outside.counted == 0
    assert rows(tutored)["attempts"] == 1


@BOTH
def test_a_removed_learner_has_no_link_and_comes_back_with_the_attempts(tutored: Class) -> None:
    path = "/v1/courses/robots/learners/remove"
    told = tutored.ask("POST", path, "tutor", learner="ada").json()
    numbers = {"assignments": 0, "learners": 1, "extensions": 1, "keys": 1, "attempts": 2}
    assert told == {"deleted": False, **numbers}
    assert rows(tutored) == WHOLE
    assert tutored.ask("POST", path, "tutor", learner="ada", apply=True).json()["deleted"]
    left = {**WHOLE, "course_learners": 1}
    del left["extensions"]
    assert rows(tutored) == left
    while tutored.ask("GET", "/v1/me").status_code == 200:  # the key is memoized for a moment
        continue
    book = tutored.ask("GET", "/v1/courses/robots/gradebook", "tutor").json()
    assert [row["learner"] for row in book["rows"]] == ["grace"]
    again = {"learners": [{"learner": "ada", "name": "Ada"}]}
    tutored.ask("POST", "/v1/courses/robots/learners", "tutor", **again)
    [ada, _] = tutored.ask("GET", "/v1/courses/robots/gradebook", "tutor").json()["rows"]
    assert ada["points"] != [None]
    removal = {"learner": "ada", "apply": True, "with_attempts": True}
    assert tutored.ask("POST", path, "tutor", **removal).json()["attempts"] == 2
    assert rows(tutored)["attempts"] == 1
    assert tutored.ask("POST", path, "tutor", **removal).status_code == 404


@pytest.mark.sampled(2)
@BOTH
def test_only_a_tutor_of_all_courses_deletes_a_course(tutored: Class) -> None:
    path = "/v1/courses/robots/delete"
    body = {"apply": True, "with_attempts": True}
    assert tutored.ask("POST", path, "tutor", **body).status_code == 403
    assert tutored.ask("POST", path, "ada", **body).status_code == 403
    of_all = as_tutor(tutored, None)
    assert of_all.ask("POST", path, "tutor", apply=True).status_code == 409
    assert rows(tutored) == WHOLE
    done = of_all.ask("POST", path, "tutor", **body).json()
    # Two links of learners and the key of the course's tutor.
    assert (done["learners"], done["keys"], done["attempts"]) == (2, 3, 3)
    assert rows(tutored) == {}
    while tutored.ask("GET", "/v1/me").status_code == 200:
        continue
    assert tutored.ask("GET", "/v1/me").status_code == 401
    assert of_all.ask("GET", "/v1/courses", "tutor").json() == {"courses": []}


def test_the_commands_name_what_goes_and_ask(
    tutored: Class, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tutored.store.engine.url.database))

    def run(*words: str, answer: str = "") -> tuple[int, str]:
        told = CliRunner().invoke(program, ["courses", *words], input=answer)
        return told.exit_code, told.output

    everything = ("assignments", "delete", "robots", "homework", "--with-attempts")
    code, told = run(*everything, answer="n\n")
    assert (code, "assignments: 1, extensions: 1, attempts: 3" in told) == (1, True)
    code, told = run("assignments", "delete", "robots", "homework", "--yes")
    assert (code, "3 recorded attempts" in told) == (2, True)
    code, told = run("delete", "robots", "--yes")
    assert (code, "3 recorded attempts" in told) == (2, True)
    assert rows(tutored) == WHOLE
    code, told = run("learners", "remove", "robots", "ada", "--yes")
    assert (code, "attempts" in told) == (0, False)
    assert run(*everything, answer="y\n")[0] == 0
    assert rows(tutored) == {"courses": 1, "course_learners": 1}
    assert run("delete", "robots", "--yes")[0] == 0
    assert rows(tutored) == {}
    assert run("delete", "robots", "--yes")[0] == 2
