"""An exercise, compiled: its vocabulary, its reference robot, and its parts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from service.catalogue.attempts import AttemptsSpec
from service.catalogue.feedback_level import FeedbackLevel
from service.catalogue.files.schema import CheckSpec, ViewSpec
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import FormulaField, FormulaGrid, fields_of
from service.catalogue.robots.robot import Joint, Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.robots.variables import Variable
from service.expressions import Vocabulary

_ANY_TIME: Final = AttemptsSpec()


@dataclass(frozen=True, slots=True)
class Exercise:
    """One exercise of the catalogue.

    ``version`` changes with anything in its file that changes a grading: not with its checks and
    its ``view``, nor with ``feedback_by_attempt``, the most that a student is told at each attempt
    (at later ones as at the last of them), nor with the rules for ``attempts``.
    ``reference`` is the robot, None where there is none; ``formulas`` holds the answers that the
    file gives, by the part's id. ``length_scale`` is the longest length, the scale of small
    differences. ``view`` is where the author has its figure seen from.
    """

    id: str
    version: str
    title: str
    source: str
    statement: str
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary
    reference: Reference | None
    formulas: Mapping[str, FormulaGrid]
    parts: tuple[PartSpec, ...]
    length_scale: float
    checks: tuple[CheckSpec, ...] = ()
    feedback_by_attempt: tuple[FeedbackLevel, ...] = (FeedbackLevel.HINTS,)
    attempts: AttemptsSpec = _ANY_TIME
    view: ViewSpec | None = None

    @property
    def feedback(self) -> FeedbackLevel:
        """The most that a student is told at the first attempt, and where none is recorded."""
        return self.feedback_by_attempt[0]

    def feedback_at(self, ordinal: int) -> FeedbackLevel:
        """The most that a student is told at this attempt, counted from 1."""
        return self.feedback_by_attempt[min(ordinal, len(self.feedback_by_attempt)) - 1]

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

    def fields(self) -> Iterator[FormulaField]:
        """Every formula of the file, with its field and quantity."""
        if self.reference is not None:
            yield from self.reference.fields()
        for i, part in enumerate(self.parts):
            written = part.formulas()
            if written is not None:
                path, grid = f"parts[{i}].{written.path}", self.formulas[part.id]
                yield from fields_of(path, grid, written.quantities)
