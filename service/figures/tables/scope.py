"""The symbols and joints that a drawn table may use, from an exercise or from textbooks."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from service.catalogue import Exercise, Joint, Variable
from service.catalogue.compile import DEFAULT_RANGES
from service.expressions import Kind, Symbol, Vocabulary, joint_variable
from service.figures.geometry.symbol_numbers import drawing_numbers

# The rows of a free table: ten joints and up to two fixed rows.
_ROWS: Final = range(1, 13)


@dataclass(frozen=True, slots=True)
class DrawingScope:
    """The joints and symbols that a table may use, and the numbers to draw it with."""

    joints: tuple[Joint, ...]
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary

    @classmethod
    def of(cls, exercise: Exercise) -> "DrawingScope":
        """Return the joints and symbols that a table of the exercise may use."""
        return cls(exercise.joints, exercise.variables, exercise.vocabulary)

    def numbers(self, given: Mapping[str, float]) -> dict[str, float]:
        """Return a number for each symbol: the given number, or a default for drawing."""
        numbers = drawing_numbers(self.variables)
        return numbers | {name: given[name] for name in numbers.keys() & given.keys()}


@lru_cache(maxsize=256)
def free_scope(structure: str) -> DrawingScope:
    """Return textbook symbols for a robot with the joints ``structure``, such as "RRP"."""
    # The variable of joint i is theta_i (or q_i) if it is revolute, and d_i (or q_i) if it is
    # prismatic. The other symbols a1, alpha1, d1, theta1, l1 up to index 12 are constants.
    joints = tuple(
        Joint(i, f"d{i}" if letter == "P" else f"theta{i}", prismatic=letter == "P")
        for i, letter in enumerate(structure, 1)
    )
    moving = {joint.variable: joint for joint in joints}
    symbols = [joint_variable(joint.index, sliding=joint.prismatic) for joint in joints]
    symbols += [symbol for symbol in _parameters() if symbol.name not in moving]
    variables = tuple(_variable(symbol) for symbol in symbols)
    return DrawingScope(joints, variables, Vocabulary(symbols, of_books=True))


def _parameters() -> Iterator[Symbol]:
    kinds: dict[str, Kind] = {
        "a": "length", "alpha": "angle", "d": "length", "theta": "angle", "l": "length",
    }  # fmt: skip
    for letter, kind in kinds.items():
        yield from (Symbol(f"{letter}{i}", kind) for i in _ROWS)


def _variable(symbol: Symbol) -> Variable:
    low, high = DEFAULT_RANGES[symbol.kind]
    unit = "m" if symbol.kind == "length" else "rad"
    return Variable(symbol.name, symbol.kind, unit, "", low, high, symbol.joint)
