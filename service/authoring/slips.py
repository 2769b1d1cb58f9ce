"""Check that the planted mistake of a part ``find_slip`` is possible in a table of the robot."""

from collections.abc import Iterator

from service.authoring.remarks import Remark, failed
from service.catalogue import Exercise
from service.catalogue.parts.find_slip import FindSlipSpec
from service.grading.kinds.find_slip import slip_of
from service.translations import say


def unfit_slips(exercise: Exercise) -> Iterator[Remark]:
    """Yield a failure for each part whose planted mistake fits no table of the robot."""
    for i, part in enumerate(exercise.parts):
        if not isinstance(part, FindSlipSpec) or part.slip is None:
            continue
        found = slip_of(part, exercise).misconception
        if found != part.slip:
            yield failed(
                f"parts[{i}].slip",
                say(
                    "no {convention} table of this robot has the slip {slip} alone; leave slip "
                    "out, or write another one, such as {found}",
                    convention=part.convention.value,
                    slip=part.slip,
                    found=found,
                ),
            )
