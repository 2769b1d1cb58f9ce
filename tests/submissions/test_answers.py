"""Test the answers of a submission, and the assignment they belong to."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import CatalogueError, Exercise, FeedbackLevel, shipped_folder
from dh_grader.grading import Submission, grade
from dh_grader.submissions import Assignment, assigned, load_assignment, of_one
from dh_grader.submissions.answers import ExerciseAnswers, answers_in
from dh_grader.submissions.bodies import find_exercise
from dh_grader.submissions.files import all_handed_in
from dh_grader.translations import LANGUAGES, told

from tests.shipped import shipped_exercises

# --- Find which exercise a file answers

CATALOGUE = shipped_exercises()
RRR = of_one(CATALOGUE["planar-rrr"])  # parts: table, pose
TWO = Assignment(tuple(assigned(CATALOGUE[name]) for name in ("planar-rrr", "scara")))
CSV = "a, alpha, d, theta\n0, 0, 0, q1\n"


def handed(folder: Path, files: Mapping[str, Any], what: Assignment) -> list[ExerciseAnswers]:
    for name, content in files.items():
        file = folder / "anna" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            file.write_bytes(content)
        else:
            text = content if isinstance(content, str) else json.dumps(content)
            file.write_text(text, encoding="utf-8")
    [found] = all_handed_in([folder])
    return list(answers_in(found, what))


def answers_of(found: ExerciseAnswers) -> dict[str, Any]:
    assert found.body is not None, found.problem
    return found.body.answers


@pytest.mark.parametrize(
    ("files", "answers"),
    [
        ({"hand-in.json": {"answers": {"table": 1}}}, {"table": 1}),
        ({"x.json": {"exercise": "planar-rrr", "answers": {"pose": 1}}}, {"pose": 1}),
        ({"planar-rrr.toml": "answers.pose = 2"}, {"pose": 2}),
        ({"a.b.Table.csv": CSV, "a.b.pose (1).txt": "I"}, {"table": CSV, "pose": "I"}),
        ({"table.csv": CSV, "old.table.csv": "0"}, {"table": CSV}),
        ({"table.csv": CSV, "pose.tex": "x", "README.md": "# Hi"}, {"table": CSV, "pose": "x"}),
        ({"Table.CSV": CSV}, {"table": CSV}),
        ({"table-1.csv": CSV, "pose (2).m": "y"}, {"table": CSV, "pose": "y"}),
        ({"planar-rrr/table.csv": CSV}, {"table": CSV}),
        ({"planar-rrr.table.csv": CSV, "planar-rrr_pose.md": "x"}, {"table": CSV, "pose": "x"}),
        ({"table.json": {"rows": []}}, {"table": {"rows": []}}),
        ({"a.json": {"answers": {"table": 1}}, "pose.txt": "x"}, {"table": 1, "pose": "x"}),
        ({"a.json": {"answers": {"table": 1}}, "package.json": {"name": "x"}}, {"table": 1}),
        ({"a.txt": '{"answers": {"table": 1}}'}, {"table": 1}),
        ({"answer": {"answers": {"table": 1}}}, {"table": 1}),
        ({"table.csv": "\ufeff1".encode("utf-16-le")}, {"table": "1"}),
        ({"table.csv": "\ufeffα".encode()}, {"table": "α"}),
    ],
)
def test_answers_are_found_by_file_name_and_content(
    tmp_path: Path, files: dict[str, Any], answers: dict[str, Any]
) -> None:
    [found] = handed(tmp_path, files, RRR)
    assert found.problem == ""
    assert answers_of(found) == answers


def test_the_only_part_needs_no_name(tmp_path: Path) -> None:
    table = of_one(CATALOGUE["planar-rrr"], "table")
    [found] = handed(tmp_path, {"hand-in.csv": CSV, "README.md": "# Hi"}, table)
    assert answers_of(found) == {"table": CSV}


def test_parts_that_are_not_set_are_left_out(tmp_path: Path) -> None:
    table = of_one(CATALOGUE["planar-rrr"], "table")
    [found] = handed(tmp_path, {"x.json": {"answers": {"table": 1, "pose": 2}}}, table)
    assert answers_of(found) == {"table": 1}


@pytest.mark.parametrize(
    ("files", "reason"),
    [
        ({"x.csv": CSV}, "after it, as in STUDENT.table.csv or STUDENT.pose.csv, or name the part"),
        ({"x.csv": CSV, "y.csv": CSV}, "there are x.csv, y.csv; name it as planar-rrr/table.csv"),
        ({"x.pdf": b"%PDF"}, "x.pdf can only be graded by hand: this program cannot read .pdf"),
        ({"a.png": b"\x89PNG", "b.jpg": b"\xff"}, "by hand: this program cannot read a.png, b.jpg"),
        (
            {"x.xyz": b"a"},
            "x.xyz is a file of a kind that this program does not read (.xyz); known are .json",
        ),
        ({"table.docx": b"PK\x03\x04\0"}, "table.docx is damaged, or not what its name says"),
        (
            {"table.csv": b"\x81\xfa"},
            "table.csv is not text in UTF-8 or Windows-1252",
        ),
        ({"table.csv": b"a\0b"}, "zero bytes"),
        ({"table.csv": " \n"}, "is empty"),
        ({"table.csv": b"x" * 300_000}, "larger than 256 KiB"),
        ({"a.json": {"exercise": "scara", "answers": {}}}, "answers the exercise 'scara', and not"),
        (
            {"a.json": {"answers": {"table": 1}}, "table.csv": CSV},
            "two answers to 'table', in table.csv and in a.json",
        ),
        (
            {
                "a.json": {"answers": {"table": 1}, "angle_unit": "degrees"},
                "b.json": {"answers": {"pose": 1}, "angle_unit": "radians"},
            },
            "differ in 'angle_unit'",
        ),
    ],
)
def test_files_that_cannot_be_assigned_are_explained(
    tmp_path: Path, files: dict[str, Any], reason: str
) -> None:
    [found] = handed(tmp_path, files, RRR)
    assert found.body is None
    assert reason in found.problem
    assert told(found.problem, LANGUAGES["de"].translation) != found.problem


def test_a_broken_file_affects_only_itself(tmp_path: Path) -> None:
    [found] = handed(tmp_path, {"table.csv": CSV, "pose.csv": b"\x81"}, RRR)
    assert answers_of(found) == {"table": CSV}
    assert found.problem.startswith("pose.csv is not text")
    assert found.file == str(tmp_path / "anna")


def test_files_are_assigned_to_their_exercises(tmp_path: Path) -> None:
    files = {
        "scara/table.csv": CSV,
        "scara/README.md": "# Hi",
        "first.json": {"exercise": "planar-rrr", "answers": {"table": 1}},
    }
    first, second = handed(tmp_path, files, TWO)
    assert (answers_of(first), answers_of(second)) == ({"table": 1}, {"table": CSV})
    assert first.file == str(tmp_path / "anna/first.json")


def test_an_exercise_without_a_file_is_not_a_problem(tmp_path: Path) -> None:
    first, second = handed(tmp_path, {"scara.json": {"answers": {"table": 1}}}, TWO)
    assert (first.file, first.problem, answers_of(first)) == ("", "", {})
    assert answers_of(second) == {"table": 1}


@pytest.mark.parametrize(
    ("files", "reason"),
    [
        ({"x.json": {"answers": {}}}, 'write "exercise", or name the file after it'),
        ({"x.json": {"exercise": "rrrp", "answers": {}}}, "those set are planar-rrr, scara"),
        ({"x.csv": CSV}, "name it as planar-rrr/table.csv"),
        ({"x.json": "{"}, "line 1, column 2"),
    ],
)
def test_a_file_must_name_one_of_several_exercises(
    tmp_path: Path, files: dict[str, Any], reason: str
) -> None:
    found = handed(tmp_path, files, TWO)
    assert [each.body for each in found] == [None, None]
    assert all(reason in each.problem for each in found)
    assert told(found[0].problem, LANGUAGES["de"].translation) != found[0].problem


def test_an_empty_folder_is_a_problem(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    [found] = handed(tmp_path, {}, RRR)
    assert (found.body, found.problem) == (None, "anna holds no file")
    assert told(found.problem, LANGUAGES["de"].translation) == "anna enthält keine Datei"


@pytest.mark.parametrize(
    "file",
    [
        "homework.xlsx",
        "hw.docx",
        "scan.pdf",
        "all.csv",
        "hw.zip",
        "x_1_assignsubmission_file_/a.txt",
    ],
)
def test_an_unnamed_file_beside_a_named_one_may_be_the_missing_answer(
    tmp_path: Path, file: str
) -> None:
    [found] = handed(tmp_path, {"table.csv": CSV, file: b"x"}, RRR)
    assert found.problem.startswith(f"{file} ")
    assert answers_of(found) == {"table": CSV}
    [full] = handed(tmp_path / "2", {"table.csv": CSV, "pose.csv": "I", file: b"x"}, RRR)
    assert full.problem == ""


@pytest.mark.parametrize(
    "file", ["requirements.txt", "helper.py", "README.docx", "readme.pdf", "x.c"]
)
def test_other_files_of_a_repository_are_no_answers(tmp_path: Path, file: str) -> None:
    [found] = handed(tmp_path, {"table.csv": CSV, file: b"x"}, RRR)
    assert (found.problem, answers_of(found)) == ("", {"table": CSV})


RECEIPT = """Name: Ada Byron (abyron)
Assignment: HW1
Date Submitted: Friday, November 20, 2026 5:31:02 PM CET
Current Grade: Needs Grading

Submission Field:
{typed}

Comments:
There are no student comments for this assignment.

Files:
\tOriginal filename: hw.csv
\tFilename: HW1_abyron_attempt_2026-11-20-17-31-02_hw.csv
"""
NOTHING = "There is no student submission text data for this assignment."
ATTEMPT = "HW1_abyron_attempt_2026-11-20-17-31-02"


def in_blackboard(folder: Path, typed: str, files: Mapping[str, str], part: str | None) -> Any:
    folder.mkdir()
    receipt = RECEIPT.format(typed=typed).replace("\n", "\r\n")
    (folder / f"{ATTEMPT}.txt").write_bytes(receipt.encode())
    for name, content in files.items():
        (folder / f"{ATTEMPT}_{name}").write_text(content, encoding="utf-8")
    [handed_file] = all_handed_in([folder])
    [found] = answers_in(handed_file, of_one(shipped_exercises()["planar-rrr"], part))
    return found


def test_the_receipt_of_blackboard_is_no_answer(tmp_path: Path) -> None:
    found = in_blackboard(tmp_path / "1", NOTHING, {"hw.csv": CSV}, "table")
    assert (found.problem, answers_of(found)) == ("", {"table": CSV})
    found = in_blackboard(tmp_path / "2", NOTHING, {"table.csv": CSV}, None)
    assert (found.problem, answers_of(found)) == ("", {"table": CSV})
    found = in_blackboard(tmp_path / "3", NOTHING, {}, "table")
    assert (found.problem.endswith("holds no file"), found.body) == (True, None)


def test_what_a_student_typed_in_blackboard_is_the_answer(tmp_path: Path) -> None:
    typed = "".join(f"<p>{line}</p>" for line in CSV.splitlines())
    found = in_blackboard(tmp_path / "1", typed, {}, "table")
    assert (found.problem, answers_of(found)) == ("", {"table": CSV.strip()})
    found = in_blackboard(tmp_path / "2", "my table", {"table.csv": CSV}, None)
    assert found.problem.startswith("attempt.txt is a pasted answer")


# --- Assignment

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
