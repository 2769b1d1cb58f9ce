"""A tutor of a course can regrade only the attempts in this course."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.cli import program
from dh_grader.contract.courses import LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment
from dh_grader.courses.roll import issue_links
from dh_grader.store.regrades import Regrading
from dh_grader.store.tables import assignments, attempts
from sqlalchemy import select, update
from typer.testing import CliRunner

from tests.access.kept_services import SECRET
from tests.attempts.databases import KINDS
from tests.courses.conftest import ADDRESS, NO_TWIST, NOW, Class
from tests.courses.results.test_workbook import as_tutor

PATH = "/v1/exercises/scara/regrade"
BOTH = pytest.mark.parametrize("class_", KINDS, indirect=True)


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
