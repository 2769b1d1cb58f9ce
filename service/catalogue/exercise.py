"""An exercise, compiled: its vocabulary, its reference robot, and what its parts ask for."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.catalogue.robot import Joint, Robot
from service.catalogue.schema import CheckSpec, PartSpec
from service.catalogue.screw_robot import FormulaGrid, ScrewRobot
from service.expressions import Kind, Vocabulary


@dataclass(frozen=True, slots=True)
class Variable:
    """A letter that may stand in an answer, with the range that its test values are drawn from.

    Angles are in radians, lengths in ``unit``. ``joint`` is the joint's number where the letter is
    a joint variable.
    """

    name: str
    kind: Kind
    unit: str
    description: str
    low: float
    high: float
    joint: int | None = None


@dataclass(frozen=True, slots=True)
class Exercise:
    """One exercise of the catalogue; ``version`` changes with anything in its file but its checks.

    ``reference`` is the robot, None where there is none; ``formulas`` what a part's file says is
    right, by the part's id. ``length_scale`` is the longest length of it, to measure small
    differences against.
    """

    id: str
    version: str
    title: str
    source: str
    statement: str
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary
    reference: Robot | ScrewRobot | None
    formulas: Mapping[str, FormulaGrid]
    parts: tuple[PartSpec, ...]
    length_scale: float
    checks: tuple[CheckSpec, ...] = ()

    @property
    def robot(self) -> Robot:
        """The robot by its table. Raises LookupError where there is none.

        An exercise with a part that asks for a table always has one.
        """
        if not isinstance(self.reference, Robot):
            raise LookupError(f"exercise {self.id!r} has no robot with a table")
        return self.reference

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints; none where there is no robot."""
        return self.reference.joints if self.reference else ()

    @property
    def structure(self) -> str | None:
        """The robot's joints by their letters, such as "RRP"; None where there is no robot."""
        return self.reference.structure if self.reference else None

    def part(self, part_id: str) -> PartSpec | None:
        """The part with this id, or None."""
        return next((part for part in self.parts if part.id == part_id), None)
