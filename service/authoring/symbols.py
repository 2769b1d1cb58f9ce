"""Checks of symbols and numbers: ambiguous names, bad ranges, and degrees without a unit."""

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise, Variable
from service.expressions import Expression
from service.expressions.parsing.degrees import in_degrees
from service.expressions.tree import Node, Number, Unit, children
from service.regex import regex
from service.translations import say

_SHORTHAND: Final = regex(r"[cCsS][0-9]+")
# Names, and what students may mistake them for.
_MISLEADING: Final = {
    "e": say("Euler's number"),
    "E": say("Euler's number, or a power of ten"),
    "i": say("the imaginary unit or an index"),
    "j": say("the imaginary unit or an index"),
    "I": say("the digit 1 or the letter l"),
    "l": say("the digit 1 or the letter I"),
    "O": say("the digit 0"),
    "o": say("the digit 0"),
    "c": say("a cosine"),
    "s": say("a sine"),
}
# Beyond this ratio, a slip in a small length changes only the last digits of a pose.
MOST_RATIO: Final = 1000.0
# In a narrower range, a constant differs by a thousandth only and would count as rounded.
LEAST_WIDTH: Final = 0.01
# Larger numbers without π are probably degrees.
FULL_TURN: Final = 2 * math.pi
_LOOK_ALIKE: Final = str.maketrans("IlO", "110")


def ambiguous_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about names that students may confuse."""
    for variable in exercise.variables:
        for problem in _problems(variable, exercise):
            yield warning(f"symbols.{variable.name}", problem)
    alike = defaultdict(list)
    for variable in exercise.variables:
        as_seen = variable.name.translate(_LOOK_ALIKE).lower()
        alike[as_seen].append(variable.name)
    for names in alike.values():
        if len(names) > 1:
            yield warning(
                f"symbols.{names[1]}",
                say("looks like {other}: students may confuse them; rename one", other=names[0]),
            )


def unused_symbols(exercise: Exercise) -> Iterator[Remark]:
    """Yield a warning for each symbol that no formula of the file uses."""
    used = {name for _, formula, _ in exercise.fields() for name in formula.symbols}
    for variable in exercise.variables:
        if variable.joint is None and variable.name not in used:
            yield warning(
                f"symbols.{variable.name}",
                say("is in no formula: remove it, or say in the statement that it is not needed"),
            )


def _problems(variable: Variable, exercise: Exercise) -> Iterator[str]:
    name = variable.name
    if name in _MISLEADING:
        yield say(
            "may be read as {meaning}; give it a longer name, such as {name}1",
            meaning=_MISLEADING[name],
            name=name,
        )
    joints = {joint.index for joint in exercise.joints}
    if _SHORTHAND.fullmatch(name) and set(map(int, name[1:])) <= joints:
        yield say(
            "takes the place of the shorthand {name} for {function}: students who write "
            "{name} for that are marked wrong; rename it",
            name=name,
            function=_MISLEADING[name[0].lower()],
        )
    if variable.joint is None:
        for joint in exercise.joints:
            names = {f"q{joint.index}", f"{'d' if joint.prismatic else 'theta'}{joint.index}"}
            if name in names and name != joint.variable:
                yield say(
                    "is also what students call {variable}, the variable of joint {joint}; "
                    "rename one of them",
                    variable=joint.variable,
                    joint=joint.index,
                )


def badly_scaled(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about narrow ranges, lengths near 0, and very different lengths."""
    for variable in exercise.variables:
        yield from _range(variable)
    sizes = {v.name: max(abs(v.low), abs(v.high)) for v in exercise.variables if v.kind == "length"}
    if not sizes:
        return
    least, most = min(sizes, key=sizes.__getitem__), max(sizes, key=sizes.__getitem__)
    if sizes[most] > MOST_RATIO * sizes[least]:
        yield warning(
            f"symbols.{least}.range",
            say(
                "reaches {size} where {most} reaches {largest}, so that a slip in {least} is too "
                "small to be detected; write lengths of one unit and similar size",
                size=f"{sizes[least]:g}",
                most=most,
                largest=f"{sizes[most]:g}",
                least=least,
            ),
        )


def _range(variable: Variable) -> Iterator[Remark]:
    field = f"symbols.{variable.name}.range"
    size = max(abs(variable.low), abs(variable.high))
    if variable.high - variable.low < LEAST_WIDTH * size:
        yield warning(
            field,
            say(
                "is so narrow that the number {low} may be accepted for {name}; widen it, or write "
                "the number in the formulas",
                low=f"{variable.low:g}",
                name=variable.name,
            ),
        )
    is_constant_length = variable.kind == "length" and variable.joint is None
    if is_constant_length and variable.low <= 0 <= variable.high:
        yield warning(
            field,
            say(
                "holds 0, where separate axes would intersect; begin above 0, as in {range}",
                range=f"[{size / 3:.1g}, {size:.1g}]",
            ),
        )
    ends = sorted((abs(variable.low), abs(variable.high)))
    if 0 < ends[0] * MOST_RATIO < ends[1]:
        yield warning(
            field,
            say(
                "goes from {low} to {high}; narrow it, because mistakes at one end are not "
                "detected at the other",
                low=f"{variable.low:g}",
                high=f"{variable.high:g}",
            ),
        )


def bare_degrees(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about large angles without a unit, which are probably degrees."""
    for field, formula, quantity in exercise.fields():
        for term in _bare_terms(formula.tree, is_angle=quantity == "angle"):
            constant = Expression(formula.source, term, (), frozenset())
            value = float(constant.evaluate({}))
            if abs(value) > FULL_TURN:
                text = f"{value:.12g}" if isinstance(term, Number) else f"({constant.text()})"
                yield warning(
                    field,
                    say(
                        "angles without a unit are in radians, and {text} looks like degrees; did "
                        "you mean {text}deg?",
                        text=text,
                    ),
                )


def _bare_terms(tree: Node, *, is_angle: bool) -> Iterator[Node]:
    written = {(unit.start, unit.end) for unit in _units(tree)}
    for unit in _units(in_degrees(tree, is_angle=is_angle, notes=[])):
        if (unit.start, unit.end) not in written:
            yield unit.operand


def _units(node: Node) -> Iterator[Unit]:
    if isinstance(node, Unit):
        yield node
    for child in children(node):
        yield from _units(child)
