"""Read the test cases in the folder corpus/."""

import ast
import re
from pathlib import Path
from typing import Any, NamedTuple

from dh_grader.expressions import Symbol, Vocabulary, joint_variable

FOLDER = Path(__file__).parent / "corpus"
ROBOT = Vocabulary(
    [
        *(joint_variable(index, sliding=index == 3) for index in range(1, 7)),
        *(Symbol(name, "length") for name in ("l1", "l2", "a1", "a2", "d1", "l_base")),
        *(Symbol(name, "angle") for name in ("alpha1", "alpha2", "beta")),
        Symbol("k", "number"),
    ]
)
_PYTHON = "python: "
_REFUSED = re.compile(r"(.+) \| ([a-z_]+) \| ([0-9]+-[0-9]+)(?: (.+))? \| (.+)")
_NUMBER = re.compile(r"(\w+) = (-?[0-9.]+)")


class Case(NamedTuple):
    """A test case: a text, its expected result, and its file and line."""

    text: str
    answers: tuple[str, ...]
    place: str


def cases(name: str) -> list[Case]:
    """Return the test cases of corpus/`name`.txt."""
    found = []
    lines = (FOLDER / f"{name}.txt").read_text("utf-8").split("\n")
    for number, line in enumerate(lines, 1):
        if line and not line.startswith("# ") and line != "#":
            columns = 1 if name != "errors" else 3
            text, *answers = line.rsplit(" | ", columns)
            found.append(Case(text, tuple(answers), f"{name}.txt:{number}"))
    return found


class SpellingCase(NamedTuple):
    """A formula as people type it, and its meaning in plain arithmetic."""

    text: str
    meaning: str
    refused: bool
    place: str


def spelling_cases() -> list[SpellingCase]:
    # Return the cases of corpus/spellings/: `text | meaning`, or `| ! meaning` if refused.
    found = []
    for file in sorted((FOLDER / "spellings").glob("*.txt")):
        for number, line in enumerate(file.read_text("utf-8").split("\n"), 1):
            if line and not line.startswith("# "):
                text, meaning = line.rsplit(" | ", 1)
                refused = meaning.startswith("! ")
                place = f"{file.name}:{number}"
                found.append(SpellingCase(text, meaning.removeprefix("! "), refused, place))
    return found


class RepairCase(NamedTuple):
    """A text, and the correction that the reader should suggest for the text."""

    # `span` is the place of the fault, from-to, and `part` the text at this place (empty for a text
    # written in Python). `answer` is the repaired text, or None if there is no repair. For a text
    # that is read, `answer` is the meaning of this text.
    text: str | float
    code: str
    span: str
    part: str
    answer: str | None
    place: str


def repairs() -> list[str]:
    return sorted(file.stem for file in (FOLDER / "repairs").glob("*.txt"))


def repair_cases(repair: str) -> list[RepairCase]:
    """Return the test cases of corpus/repairs/``repair``.txt."""
    # Invisible characters and JSON's numbers are written as Python literals after `python:`.
    found = []
    lines = (FOLDER / "repairs" / f"{repair}.txt").read_text("utf-8").split("\n")
    for number, line in enumerate(lines, 1):
        place = f"{repair}.txt:{number}"
        if refused := _REFUSED.fullmatch(line):
            text, code, span, part, suggestion = refused.groups("")
            answer = None if suggestion == "-" else suggestion
            found.append(RepairCase(_typed(text), code, span, part, answer, place))
        elif line and not line.startswith("# "):
            text, meaning = line.rsplit(" | ", 1)
            found.append(RepairCase(_typed(text), "", "", "", meaning, place))
    return found


def _typed(text: str) -> str | float:
    if not text.startswith(_PYTHON):
        return text
    return python_text(text.removeprefix(_PYTHON))


def python_text(line: str) -> str | float:
    # Evaluate a Python literal, a repeated literal (`*`), or several joined by `+`.
    value: str | float = _joined(ast.parse(line, mode="eval").body)
    return value


def _joined(node: ast.expr) -> Any:
    match node:
        case ast.Constant(value=value):
            return value
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _joined(left) + _joined(right)
        case ast.BinOp(left=left, op=ast.Mult(), right=ast.Constant(value=int() as times)):
            return _joined(left) * times
        case _:
            raise ValueError(ast.dump(node))


def numbers(name: str) -> dict[str, float]:
    text = (FOLDER / f"{name}.txt").read_text("utf-8")
    head = "\n".join(line for line in text.split("\n") if line.startswith("#"))
    return {match[1]: float(match[2]) for match in _NUMBER.finditer(head)}


def names() -> list[str]:
    return sorted(
        file.stem for file in FOLDER.glob("*.txt") if file.stem not in {"errors", "hostile"}
    )
