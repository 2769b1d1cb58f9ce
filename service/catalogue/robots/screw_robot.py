"""The reference robot given by its product of exponentials: a home pose and screw axes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from service.catalogue.robots.formulas import (
    HOMOGENEOUS,
    SCREW,
    FormulaField,
    FormulaGrid,
    fields_of,
    grid_values,
)
from service.catalogue.robots.robot import Joint, Robot
from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.screws import product_in_space
from service.kinematics.transforms import Matrices, Numbers


@dataclass(frozen=True, slots=True)
class ScrewRobot:
    """A reference robot: ``home`` is 4×4, ``axes`` has a six-vector (ω; v) for each joint."""

    structure: str
    joints: tuple[Joint, ...]
    home: FormulaGrid
    axes: FormulaGrid

    def fields(self) -> Iterator[FormulaField]:
        """Yield every formula of the author with its field and quantity."""
        yield from fields_of("robot.home[{i}][{j}]", self.home, HOMOGENEOUS)
        yield from fields_of("robot.screws[{i}][{j}]", self.axes, (SCREW,) * len(self.axes))

    @property
    def frames(self) -> tuple[int | str, ...]:
        """The names of the robot's frames: the base (space) frame and the tool (body) frame."""
        return ("base", "tool")

    def has_frame(self, name: int | str) -> bool:
        """True if the robot has a frame of this name."""
        return name in self.frames

    def frame(self, name: int | str, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of a frame in the base frame, ``(samples, 4, 4)``."""
        if name == "base":
            return np.broadcast_to(np.eye(4), (samples, 4, 4))
        home = np.moveaxis(grid_values(self.home, values, samples), -1, 0)
        amounts = np.array([values[joint.variable] for joint in self.joints])
        return product_in_space(self.screws(values, samples), amounts, home)

    def screws(self, values: SymbolValues, samples: int) -> Numbers:
        """Return the screw axes with all joint variables 0, ``(joints, samples, 6)``."""
        return np.swapaxes(grid_values(self.axes, values, samples), 1, 2)


Reference = Robot | ScrewRobot
