"""The model answer of kind ``euler_angles``."""

from service.catalogue import Exercise
from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.orientation import euler_angles
from service.solutions.work import Work


def answer_euler_angles(part: EulerAnglesSpec, work: Work) -> PrintedAnswer:
    """Return the angles that the exercise file gives, or the angles of the robot's pose."""
    given = work.as_written(part)
    if given:
        return layout.listed(given[0])
    angles = euler_angles(work.pose_motions(part), part.turns, part.axes)
    return layout.listed(list(map(work.writer.angle, angles)))


def lazy_euler_angles(_part: EulerAnglesSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: three zeros."""
    return [["0"] * 3]
