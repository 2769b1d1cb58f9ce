"""The data of a model solution, as it is sent and printed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field


@dataclass(frozen=True, slots=True)
class Shown:
    """A matrix as a textbook prints it."""

    text: str
    latex: str


@dataclass(frozen=True, slots=True)
class PrintedAnswer(Shown):
    """An answer. ``answer`` is its JSON value, or None if it is too long to be submitted."""

    answer: object


@dataclass(frozen=True, slots=True)
class LinkSolution(Shown):
    """The link transform of one row of the robot's table."""

    label: str


@dataclass(frozen=True, slots=True)
class PartAnswer(Shown):
    """The right answer to one part."""

    part: str
    kind: str
    title: str
    answer: Annotated[
        Any, Field(description="The answer's JSON value, ready to post; `text` may be posted, too.")
    ]


@dataclass(frozen=True, slots=True)
class ModelSolution:
    """The right answer to each part of an exercise, and the steps that lead to it."""

    exercise: str
    version: str
    notation: Annotated[
        Mapping[str, str],
        Field(description="The meaning of each shorthand: c12 is cos(theta1 + theta2)."),
    ]
    parts: tuple[PartAnswer, ...]
    links: Annotated[
        tuple[LinkSolution, ...],
        Field(
            description="The link transforms of the robot's own table; empty if it has no table."
        ),
    ]
    pose: Annotated[Shown | None, Field(description="From the base frame to the tool frame.")] = (
        None
    )

    @property
    def answers(self) -> dict[str, object]:
        """The answer to each part, by the part's id."""
        return {part.part: part.answer for part in self.parts}
