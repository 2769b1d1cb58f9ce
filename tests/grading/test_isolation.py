"""Student input is never executed, and grading uses no files, sockets or processes."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import dh_grader
import pytest

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
PROGRAM = r"""
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
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    lines = dict(line.split(": ", 1) for line in result.stdout.splitlines())
    assert "sympy" not in lines["imported"]
    assert "scipy" not in lines["imported"]
    assert "sympy" not in lines["heavy after"]
    assert lines["touched"] == "[]"
