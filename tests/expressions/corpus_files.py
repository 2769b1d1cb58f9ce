"""The written cases in corpus/*.txt, and the robot that they are about."""

import re
from pathlib import Path
from typing import NamedTuple

from service.expressions import Symbol, Vocabulary, joint_variable

FOLDER = Path(__file__).parent / "corpus"
ROBOT = Vocabulary(
    [
        *(joint_variable(index, sliding=index == 3) for index in range(1, 7)),
        *(Symbol(name, "length") for name in ("l1", "l2", "a1", "a2", "d1", "l_base")),
        *(Symbol(name, "angle") for name in ("alpha1", "alpha2", "beta")),
        Symbol("k", "number"),
    ]
)
_NUMBER = re.compile(r"(\w+) = (-?[0-9.]+)")


class Case(NamedTuple):
    """One line of a file: the text, what is said of it, and where it stands."""

    text: str
    answers: tuple[str, ...]
    place: str


def cases(name: str) -> list[Case]:
    """Return the cases of corpus/`name`.txt."""
    found = []
    lines = (FOLDER / f"{name}.txt").read_text("utf-8").split("\n")
    for number, line in enumerate(lines, 1):
        if line and not line.startswith("# ") and line != "#":
            columns = 1 if name != "errors" else 3
            text, *answers = line.rsplit(" | ", columns)
            found.append(Case(text, tuple(answers), f"{name}.txt:{number}"))
    return found


def numbers(name: str) -> dict[str, float]:
    """Return the symbols' values in the head of corpus/`name`.txt."""
    text = (FOLDER / f"{name}.txt").read_text("utf-8")
    head = "\n".join(line for line in text.split("\n") if line.startswith("#"))
    return {match[1]: float(match[2]) for match in _NUMBER.finditer(head)}


def names() -> list[str]:
    """Return the files that hold values."""
    return sorted(
        file.stem for file in FOLDER.glob("*.txt") if file.stem not in {"errors", "hostile"}
    )
