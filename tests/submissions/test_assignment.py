from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, Exercise, FeedbackLevel, shipped_folder
from dh_grader.grading import Submission, grade
from dh_grader.submissions import Assignment, assigned, load_assignment
from dh_grader.submissions.answers import answers_in
from dh_grader.submissions.bodies import find_exercise
from dh_grader.submissions.files import all_handed_in

from tests.shipped import shipped_exercises

CATALOGUE = shipped_exercises()

HOMEWORK = """\
title = "Homework 3"
pass_mark = 0.6
feedback = "verdicts"

[[exercises]]
id = "planar-rrr"
parts = ["table"]
points = 10
files = "dh.csv"

[[exercises]]
path = "own/crane.toml"

[exercises.part_files]
pose = ["T0?.tex", "last/*"]
"""


def find(exercise_id: str) -> Exercise:
    return find_exercise(CATALOGUE, exercise_id)


@pytest.fixture
def load(tmp_path: Path) -> Callable[[str], Assignment]:
    def load(text: str) -> Assignment:
        (tmp_path / "own").mkdir(exist_ok=True)
        crane = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
        (tmp_path / "own/crane.toml").write_text(crane, encoding="utf-8")
        (tmp_path / "hw.toml").write_text(text, encoding="utf-8")
        return load_assignment(tmp_path / "hw.toml", find)

    return load


def test_all_fields_of_an_assignment_are_used(
    load: Callable[[str], Assignment], tmp_path: Path
) -> None:
    assignment = load(HOMEWORK)
    first, second = assignment.exercises
    assert (assignment.title, assignment.pass_mark) == ("Homework 3", 0.6)
    assert assignment.ceiling(first) is assignment.ceiling(second) is FeedbackLevel.VERDICTS
    assert [part.id for part in first.exercise.parts] == ["table"]
    assert (first.worth, first.left_out) == (10, frozenset({"pose"}))
    assert second.exercise.id == "crane"
    assert second.path == tmp_path / "own/crane.toml"
    # Without ``points``, those of the parts.
    assert second.worth == sum(part.points for part in CATALOGUE["scara"].parts)


def test_the_file_names_of_an_assignment_are_used(
    load: Callable[[str], Assignment], tmp_path: Path
) -> None:
    assignment = load(HOMEWORK)
    for name in ("anna/DH.csv", "anna/T04.tex", "anna/planar-rrr.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name, encoding="utf-8")
    [handed] = all_handed_in([tmp_path / "anna"], folder_is_one=True)
    found = answers_in(handed, assignment)
    assert [each.body and each.body.answers for each in found] == [
        {"table": "anna/DH.csv"}, {"pose": "anna/T04.tex"},
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        ('title = "Homework 3"', "", "title: Field required: write title = …"),
        (
            "pass_mark = 0.6",
            "pass_mark = 60",
            "pass_mark (line 2): is 60; write a share from 0 to 1, so 0.6 for 60 %",
        ),
        ('"verdicts"', '"verdict"', "feedback (line 3): is 'verdict'; did you mean 'verdicts'?"),
        ('"planar-rrr"', '"planar_rr"', "exercises[0].id (line 6): "),
        ('"planar-rrr"', '"planar-rrx"', "There is no exercise 'planar-rrx'. Did you mean"),
        ('["table"]', '["tabel"]', "exercises[0].parts (line 7): planar-rrr has no part 'tabel'."),
        (
            "points = 10",
            "points = 0",
            "exercises[0].points (line 8): is 0; write a number greater than 0",
        ),
        ('"dh.csv"', '["a.csv", "."]', "exercises[0].files[1] (line 9): '.' names no file"),
        ("files =", "file =", "no key 'file' here; did you mean 'files'?"),
        ('path = "own/crane.toml"', "", "exercises[1] (line 11): names no exercise"),
        ('path = "own', 'id = "x"\npath = "own', "exercises[1] (line 11): has an id and a path"),
        ("crane.toml", "none.toml", "none.toml: cannot be read: No such file"),
        ('path = "own/crane.toml"', 'id = "planar-rrr"', "exercises[1] (line 11): is 'planar-rrr'"),
        ("pose =", "pos =", "exercises[1].part_files.pos (line 15): no part 'pos' is set"),
        ("[[exercises]]", "[[exercise]", "is not TOML"),
    ],
)
def test_a_fault_names_its_place_and_a_repair(
    load: Callable[[str], Assignment], before: str, after: str, reason: str
) -> None:
    with pytest.raises(CatalogueError) as caught:
        load(HOMEWORK.replace(before, after, 1))
    assert reason in str(caught.value)


def test_all_faulty_exercises_are_reported_together(
    load: Callable[[str], Assignment],
) -> None:
    text = HOMEWORK.replace('"planar-rrr"', '"planar-rrx"').replace("pose =", "pos =")
    with pytest.raises(CatalogueError) as caught:
        load(text)
    assert [fault.field for fault in caught.value.faults] == [
        "exercises[0].id", "exercises[1].part_files.pos",
    ]  # fmt: skip


def test_an_assignment_has_at_most_100_exercises(load: Callable[[str], Assignment]) -> None:
    with pytest.raises(CatalogueError, match="at most 100"):
        load('title = "x"\n' + '[[exercises]]\nid = "scara"\n' * 101)


def test_a_part_follows_the_predecessor_of_a_dropped_part() -> None:
    exercise = find("planar-rr")
    follows = {part.id: part.follows for part in exercise.parts}
    assert follows == {
        "table": None, "links": "table", "pose": "links", "position": "pose", "task-space": None,
    }  # fmt: skip
    chosen = assigned(exercise, ["table", "position"]).exercise
    assert isinstance(chosen, Exercise)
    assert {part.id: part.follows for part in chosen.parts} == {"table": None, "position": "table"}
    report = grade(chosen, Submission({"position": ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]}))
    assert [part.points for part in report.parts] == [0, 2]
    (alone,) = assigned(exercise, ["pose"]).exercise.parts
    assert alone.id == "pose"
