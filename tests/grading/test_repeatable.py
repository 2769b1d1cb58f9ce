"""Test that a report depends on the exercise and the answer only."""

import ast
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import dh_grader
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import as_data, handed_in, not_correct, part, table

# --- The same submission always gets the same report, byte for byte

PROGRAM = """
import json, sys
from dataclasses import asdict
from dh_grader.catalogue import load_catalogue, shipped_folder
from dh_grader.grading import Submission, grade

exercise = load_catalogue(shipped_folder())["stanford-arm"]
print(json.dumps(asdict(grade(exercise, Submission(json.load(sys.stdin))))))
"""


def wrong_answers() -> dict[str, Any]:
    rows: list[list[Any]] = [list(row) for row in EXACT.rows(STANFORD)]
    rows[0][1] = "-1.5708"
    rows[1][3] = "q2 + d2*d6 + q5"
    rows[3][2] = "d2 + d6"
    rows[4][0] = "(q1"
    pose = [["c1 c2 c4 c5 c6", "s12", "0", "sqrt(q4)"], [0.5] * 4, [], ["0", "0", "0", "1"]]
    return {"table": table(rows), "pose": pose}


def as_bytes(exercise: Exercise, answers: Mapping[str, object]) -> bytes:
    return json.dumps(as_data(handed_in(exercise, answers))).encode()


def test_reports_are_equal_in_one_process(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    reports = {as_bytes(exercise, wrong_answers()) for _ in range(5)}
    assert len(reports) == 1
    assert b"yours" in reports.pop()


@pytest.mark.long
def test_reports_are_equal_for_every_hash_seed(catalogue: Mapping[str, Exercise]) -> None:
    here = as_bytes(catalogue[STANFORD.exercise], wrong_answers())
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", PROGRAM],
            env={**os.environ, "PYTHONHASHSEED": seed},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        for seed in ("1", "4242")
    ]
    question = json.dumps(wrong_answers()).encode()
    for process in processes:
        answer, _ = process.communicate(question)
        assert process.returncode == 0
        assert answer.strip() == here


def test_the_order_of_keys_does_not_matter(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    answers = wrong_answers()
    turned = {
        "pose": answers["pose"],
        "table": {"rows": [dict(reversed(row.items())) for row in answers["table"]["rows"]]},
    }
    assert list(turned) != list(answers)
    assert as_bytes(exercise, turned) == as_bytes(exercise, answers)


def test_another_submission_in_between_changes_nothing(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[STANFORD.exercise]
    before = as_bytes(exercise, wrong_answers())
    for other in catalogue.values():
        handed_in(other, {other.parts[0].id: [["q1", "c12"]]}, angle_unit="degrees")
    assert as_bytes(exercise, wrong_answers()) == before


def test_grading_does_not_change_the_answers(catalogue: Mapping[str, Exercise]) -> None:
    answers = wrong_answers()
    handed_in(catalogue[STANFORD.exercise], answers)
    assert answers == wrong_answers()


def test_another_answer_is_graded_at_other_values(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue[STANFORD.exercise]
    seen = set()
    for text in ("d2 + 0.1", "0.1 + d2", "d2+.1"):
        rows = [list(row) for row in EXACT.rows(STANFORD)]
        rows[1][2] = text
        report = part(handed_in(exercise, {"table": table(rows)}), "table")
        assert not_correct(report) == {("2", "d"): Verdict.INCORRECT}
        [feedback] = report.rows[1].cells[2].feedback
        assert feedback.values is not None
        assert feedback.values["yours"] == pytest.approx(
            float(feedback.values["d2"]) + 0.1, abs=2e-4
        )
        seen.add(feedback.values["d2"])
    assert len(seen) == 3


# --- Student input is never executed, and grading uses no files, sockets or processes

SERVICE = Path(dh_grader.__file__).parent
RUNNERS = {
    "eval",
    "exec",
    "compile",
    "__import__",
    "sympify",
    "parse_expr",
    "literal_eval",
}
RUNNING_MODULES = {"pickle", "cPickle", "dill", "marshal", "shelve", "jsonpickle", "code", "runpy"}
# re.compile compiles a regular expression and runs no code.
HARMLESS = {("re", "compile")}


def offences(source: str) -> Iterator[str]:
    """Yield the places in source code where input might be executed."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Name(id=name) | ast.alias(name=name) if name.split(".")[-1] in RUNNERS:
                yield name
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if (owner, name) in HARMLESS:
                pass
            case ast.Attribute(attr=name) if name in RUNNERS:
                yield name
            case ast.Import(names=names):
                yield from (n.name for n in names if n.name.split(".")[0] in RUNNING_MODULES)
            case ast.ImportFrom(module=str(module)) if module.split(".")[0] in RUNNING_MODULES:
                yield module
            case ast.ImportFrom(module=str(module)) if module.startswith("sympy.parsing"):
                yield module


FILES = sorted(SERVICE.rglob("*.py"))


@pytest.mark.long
def test_the_program_executes_no_input() -> None:
    assert len(FILES) > 30
    found = {
        str(file.relative_to(SERVICE)): offending
        for file in FILES
        if (offending := list(offences(file.read_text(encoding="utf-8"))))
    }
    assert found == {}


@pytest.mark.parametrize(
    "text",
    [
        "eval('1')",
        "f = eval\nf('1')",
        "exec(text)",
        "builtins.exec(text)",
        "sympy.sympify(text)",
        "from sympy import sympify as s\ns(text)",
        "from sympy.parsing.latex import parse_latex",
        "from sympy.parsing.sympy_parser import parse_expr",
        "import pickle",
        "from pickle import loads",
        "__import__(name)",
        "compile(text, '', 'eval')",
    ],
)
def test_the_search_finds_execution_of_input(text: str) -> None:
    assert list(offences(text))


def test_the_search_leaves_regular_expressions_alone() -> None:
    assert list(offences("import re\nre.compile('x')\nevaluate(x)\nx.evaluate(y)")) == []


# Run in a fresh process, where nothing is imported yet. The audit hook sees each file that is
# opened, each socket, each process and each piece of code that is compiled or run.
ISOLATION_PROGRAM = r"""
import sys
import dh_grader.grading
from dh_grader.catalogue import load_catalogue, shipped_folder
from dh_grader.grading import Submission, grade

heavy = {"sympy", "scipy", "httpx", "fastapi", "sqlalchemy", "typer", "rich"}
print("imported:", sorted(heavy & {name.partition(".")[0] for name in sys.modules}))

exercises = load_catalogue(shipped_folder())
seen = []
watching = False

def hook(event, arguments):
    if watching and event.split(".")[0] in {
        "open", "socket", "subprocess", "os", "exec", "compile", "import", "shutil", "ctypes",
        "pickle", "marshal", "tempfile", "urllib", "glob", "pathlib", "sqlite3"
    }:
        seen.append((event, str(arguments)[:120]))

sys.addaudithook(hook)
watching = True
rows = [{"a": "l1 + 1", "alpha": "90", "d": "(", "theta": "sqrt(q1)"}] * 3
line = ["c12 + q1", "1/0", "sin(", "0.05", "1", "-1"]
sizes = {"transform": 4, "rotation": 3, "screw_axes": 6}
lists = {"position", "vector", "euler_angles"}
for exercise in exercises.values():
    answers = {
        part.id: {"rows": rows} if part.kind in ("dh_table", "find_slip")
        else rows[0] if part.kind == "dh_row"
        else line[:2] if part.kind in lists
        else [line[:sizes.get(part.kind, 4)]]
        for part in exercise.parts
    }
    assert grade(exercise, Submission(answers)).gradable
watching = False
print("touched:", seen)
print("heavy after:", sorted(heavy & {name.partition(".")[0] for name in sys.modules}))
"""


@pytest.mark.long
def test_grading_imports_no_algebra_system_and_opens_nothing() -> None:
    result = subprocess.run(
        [sys.executable, "-c", ISOLATION_PROGRAM], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    lines = dict(line.split(": ", 1) for line in result.stdout.splitlines())
    assert "sympy" not in lines["imported"]
    assert "scipy" not in lines["imported"]
    assert "sympy" not in lines["heavy after"]
    assert lines["touched"] == "[]"
