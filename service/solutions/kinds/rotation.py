"""The model answer of kind ``rotation``."""

from service.catalogue import Exercise
from service.catalogue.parts.rotation import RotationSpec
from service.solutions import layout
from service.solutions.lazy import poses
from service.solutions.model_solution import PrintedAnswer
from service.solutions.motions import Motion, Turn, X, Y, Z, multiplied
from service.solutions.work import Work

_AXES = {"x": X, "y": Y, "z": Z}


def answer_rotation(part: RotationSpec, work: Work) -> PrintedAnswer:
    """Return the rotation that the exercise file or the robot determines."""
    given = work.as_written(part) if part.steps is None else None
    return layout.matrix(given) if given else work.matrix(multiplied(_turns(part, work)).rotation)


def _turns(part: RotationSpec, work: Work) -> list[Motion]:
    # A turn about a fixed axis goes to the front.
    if part.steps is None:
        return work.pose_motions(part)
    angles = work.algebra.matrix(work.exercise.formulas[part.id])
    motions: list[Motion] = []
    for step, angle in zip(part.steps, angles, strict=True):
        motions.insert(0 if step.about == "fixed" else len(motions), Turn(_AXES[step.axis], angle))
    return motions


def lazy_rotation(_part: RotationSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the rotation of an arm whose joints all have the same axis."""
    return [*poses(exercise, 3)]
