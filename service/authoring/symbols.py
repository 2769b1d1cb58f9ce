"""Symbols that a student, or a reader, may take for something else."""

import re
from collections import defaultdict
from collections.abc import Iterator
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise, Variable

_SHORTHAND: Final = re.compile(r"[cCsS][0-9]+")
# The reading that each is mistaken for.
_MISLEADING: Final = {
    "e": "Euler's number",
    "E": "Euler's number, or a power of ten",
    "i": "the imaginary unit or an index",
    "j": "the imaginary unit or an index",
    "I": "the digit 1 or the letter l",
    "l": "the digit 1 or the letter I",
    "O": "the digit 0",
    "o": "the digit 0",
    "c": "a cosine",
    "s": "a sine",
}


def ambiguous_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Names that also are a shorthand, another joint's variable, or look like something else."""
    for variable in exercise.variables:
        for problem in _problems(variable, exercise):
            yield warning(f"symbols.{variable.name}", problem)
    alike = defaultdict(list)
    for variable in exercise.variables:
        alike[_as_seen(variable.name)].append(variable.name)
    for names in alike.values():
        if len(names) > 1:
            yield warning(
                f"symbols.{names[1]}",
                f"looks like {names[0]}: a student may type the one for the other; rename one",
            )


def unused_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Symbols that no formula of the file holds."""
    used = {name for _, formula, _ in exercise.fields() for name in formula.symbols}
    for variable in exercise.variables:
        if variable.joint is None and variable.name not in used:
            yield warning(
                f"symbols.{variable.name}",
                "is in no formula: take it out, or say in the statement that it is not needed",
            )


def _problems(variable: Variable, exercise: Exercise) -> Iterator[str]:
    name = variable.name
    if name in _MISLEADING:
        yield f"may be read as {_MISLEADING[name]}; give it a longer name, such as {name}1"
    if _SHORTHAND.fullmatch(name) and _named_joints(name) <= {j.index for j in exercise.joints}:
        yield (
            f"takes the place of the shorthand {name} for a {_function(name)}: whoever writes "
            f"{name} for that is marked wrong; rename it"
        )
    if variable.joint is None:
        for joint in exercise.joints:
            names = {f"q{joint.index}", f"{'d' if joint.prismatic else 'theta'}{joint.index}"}
            if name in names and name != joint.variable:
                yield (
                    f"is also what students call {joint.variable}, the variable of joint "
                    f"{joint.index}; rename one of them"
                )


def _named_joints(shorthand: str) -> set[int]:
    return set(map(int, shorthand[1:]))


def _function(name: str) -> str:
    return "cosine" if name[0] in "cC" else "sine"


def _as_seen(name: str) -> str:
    """The name as it looks: without capitals, with one sign for those that look the same."""
    return name.translate(str.maketrans("IlO", "110")).lower()
