"""The model answer of kind ``transform``."""

from service.catalogue import Exercise
from service.catalogue.parts.transform import TransformSpec
from service.solutions import layout
from service.solutions.lazy import poses
from service.solutions.model_solution import PrintedAnswer
from service.solutions.motions import multiplied
from service.solutions.work import Work


def answer_transform(part: TransformSpec, work: Work) -> PrintedAnswer:
    """Return the transform that the exercise file gives, or the pose of the robot."""
    given = work.as_written(part)
    return (
        layout.matrix(given) if given else work.matrix(multiplied(work.pose_motions(part)).matrix())
    )


def lazy_transform(_part: TransformSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the transform of an arm whose joints all have the same axis."""
    return [*poses(exercise, 4)]
