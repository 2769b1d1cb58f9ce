"""Test what deletion and regrades leave of a course."""

import asyncio
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.cli import program
from dh_grader.contract.courses import Extension, LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment, extend
from dh_grader.courses.roll import issue_links
from dh_grader.store.regrades import Regrading
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
from sqlalchemy import func, select, update
from typer.testing import CliRunner

from tests.access.kept_services import SECRET
from tests.courses.conftest import ADDRESS, NO_TWIST, NOW, Class, days
from tests.courses.test_gradebook import as_tutor
from tests.store.databases import KINDS

# --- Deleted courses, assignments and learners leave no data

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


# --- A tutor of a course can regrade only the attempts in this course

PATH = "/v1/exercises/scara/regrade"


def set_up(class_: Class) -> Class:
    class_.assign()
    exercises = [{"exercise": "scara", "points": 10}]
    new = NewAssignment.model_validate({"id": "homework", "title": "H", "exercises": exercises})

    def add(connection: Any) -> str:
        course = NewCourse(id="others", title="Others", zone="UTC")
        roll.add_course(connection, course, NOW)
        roll.add_learners(connection, "others", [NewLearner(learner="ada", name="Ada")])
        add_assignment(connection, "others", new, {"scara"})
        [link] = issue_links(connection, "others", LinksRequest(), SECRET, ADDRESS, NOW)
        return link.link.partition("#")[2]

    both = replace(class_, keys={**class_.keys, "there": class_.do(add)})
    for by, course in (("ada", "robots"), ("there", "others")):
        path = f"/v1/courses/{course}/assignments/homework/attempts"
        body = {"exercise": "scara", "answers": NO_TWIST}
        assert both.ask("POST", path, by, course, **body).status_code == 201
    class_.do(lambda it: it.execute(update(attempts).values(version="old", points=1.0)))
    return as_tutor(both)


def versions(class_: Class) -> dict[str, bool]:
    rows = select(assignments.c.course, attempts.c.version).join_from(attempts, assignments)
    return {course: version == "old" for course, version in class_.do(lambda it: it.execute(rows))}


@pytest.mark.long
@BOTH
def test_a_tutor_of_a_course_regrades_only_its_attempts(class_: Class) -> None:
    both = set_up(class_)
    told = both.ask("POST", PATH, "tutor", apply=False).json()
    assert (told["applied"], told["regraded"], told["left"]) == (False, 1, 0)
    [change] = told["changes"]
    assert change["before"] == 1.0 < change["after"]
    # scara has 24 points, and 10 in the assignment.
    counted = change["counted"]
    assert change["max_points"] == 24.0
    assert counted["max_points"] == 10.0
    assert counted["before"] == pytest.approx(10 / 24, abs=1e-6)
    assert counted["after"] == pytest.approx(change["after"] * 10 / 24, abs=1e-6)
    assert versions(both) == {"robots": True, "others": True}
    for refused in ("others", "no-such"):
        answer = both.ask("POST", f"{PATH}?course={refused}", "tutor", apply=True)
        assert answer.status_code == 403
        assert answer.json()["type"].endswith(":other-course")
    done = both.ask("POST", f"{PATH}?course=robots", "tutor", apply=True).json()
    assert (done["applied"], done["regraded"], done.get("next")) == (True, 1, None)
    assert versions(both) == {"robots": False, "others": True}
    # A tutor of all courses may do one after the other, or the rest at once.
    of_all = as_tutor(both, None)
    assert of_all.ask("POST", PATH, "tutor", apply=True).json()["regraded"] == 1
    assert versions(both) == {"robots": False, "others": False}


@pytest.mark.long
def test_a_course_leaves_the_queue_of_the_others_alone(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    # An interrupted regrade of all attempts has left attempts of both courses in the queue.
    both = set_up(class_)
    both.do(Regrading(catalogue["scara"], FeedbackLevel.FULL).enqueue)
    assert both.ask("POST", PATH, "tutor", apply=True).json()["regraded"] == 1
    assert versions(both) == {"robots": False, "others": True}


@pytest.mark.long
def test_the_command_regrades_one_course(class_: Class, monkeypatch: pytest.MonkeyPatch) -> None:
    both = set_up(class_)
    monkeypatch.setenv("DH_GRADER_DATABASE", str(both.store.engine.url.database))
    run = partial(CliRunner().invoke, program)
    words = ["attempts", "regrade", "scara", "--course", "others"]
    told = run(words).output
    assert "1 attempt was graded by another version" in told
    # Points of the assignment, not of the exercise.
    assert "0.42 → " in told
    assert " of 10 (" in told
    assert "Regraded: 1." in run([*words, "--apply"]).output
    assert versions(both) == {"robots": True, "others": False}
