"""Find which exercise a file answers."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from service.submissions.answers import ExerciseAnswers, answers_in
from service.submissions.assignment import Assignment, assigned, of_one
from service.submissions.handed_in import all_handed_in
from service.translations import LANGUAGES, told
from tests.shipped import shipped_exercises

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
        ({"x.pdf": b"%PDF"}, "x.pdf can only be graded by hand: a program cannot read .pdf"),
        ({"a.png": b"\x89PNG", "b.jpg": b"\xff"}, "by hand: a program cannot read a.png, b.jpg"),
        ({"x.xyz": b"a"}, "x.xyz is a file of a kind that is not read (.xyz); known are .json"),
        ({"table.docx": b"PK\x03\x04\0"}, "table.docx is damaged, or not what its name says"),
        ({"table.csv": b"\x81\xfa"}, "table.csv is not text"),
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
