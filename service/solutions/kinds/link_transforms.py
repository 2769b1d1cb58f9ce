"""The model answer of kind ``link_transforms``: the transforms of the reference table's rows."""

from service.catalogue import Exercise
from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.solutions.lazy import IDENTITY, motion
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work


def answer_link_transforms(part: LinkTransformsSpec, work: Work) -> PrintedAnswer:
    """Return the link transforms in order, each with its name."""
    matrices = work.link_matrices(part.convention)
    return PrintedAnswer(
        "\n\n".join(f"A{label} =\n{matrix.text}" for label, matrix in matrices.items()),
        "\n".join(
            f"A_{{{label}}} = {matrix.latex}" + r" \quad" for label, matrix in matrices.items()
        ),
        [matrix.answer for matrix in matrices.values()],
    )


def lazy_link_transforms(part: LinkTransformsSpec, exercise: Exercise) -> list[object]:
    """Return the motion of each joint, and the identity for each row without a joint."""
    table = exercise.robot.tables[part.convention]
    fixed = len(table.rows) - len(table.joints)
    return [[*(motion([joint]) for joint in table.joints), *[IDENTITY] * fixed]]
