"""The program never runs a student's text as code."""

import ast
from pathlib import Path

import dh_grader
import pytest

from tests.together import together

FORBIDDEN = frozenset({
    "eval", "exec", "compile", "__import__", "sympify", "parse_expr", "parse_latex", "lambdify",
    "S", "literal_eval", "loads", "load", "getattr", "setattr", "system", "popen", "Popen",
    "import_module", "resolve_name",
})  # fmt: skip
MODULES = frozenset(
    {"pickle", "marshal", "shelve", "subprocess", "sympy", "importlib", "pkgutil", "builtins"}
)
ROOT = Path(dh_grader.__file__).parent
FOLDERS = ("expressions", "grids", "grading")
FILES = sorted(file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py"))


def found(source: str) -> list[str]:
    """Return the forbidden calls and imports in Python code."""
    calls = []
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Call(func=ast.Name(id=name)) if name in FORBIDDEN:
                calls.append(name)
            case ast.Call(func=ast.Attribute(value=value, attr=name)) if name in FORBIDDEN:
                if not (name == "compile" and isinstance(value, ast.Name) and value.id == "re"):
                    calls.append(name)
            case ast.Import(names=names):
                calls += [n.name for n in names if n.name.split(".")[0] in MODULES]
            case ast.ImportFrom(module=str() as module) if module.split(".")[0] in MODULES:
                calls.append(module.split(".")[0])
            case ast.Import() | ast.ImportFrom():
                pass
    return calls


@pytest.mark.long
@together("file", FILES)
def test_no_evaluator_is_called(file: Path) -> None:
    assert found(file.read_text("utf-8")) == []


@pytest.mark.parametrize(
    "source",
    ["eval('1')", "sympy.sympify(x)", "import pickle", "from sympy import S", "a.parse_expr(x)"],
)
def test_a_forbidden_call_is_found(source: str) -> None:
    assert found(source)
    assert len(FILES) > 40
