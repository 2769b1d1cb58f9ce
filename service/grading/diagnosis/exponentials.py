"""Slips in a product of exponentials.

Each function is one misconception. It returns what to say and the pose that the misconception leads
to; where that is the student's matrix, and not the right one, the misconception explains it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from service.catalogue import Exercise, ScrewRobot
from service.catalogue.robot import at_home
from service.grading.diagnosis.matrix_case import Explanation, MatrixCase
from service.grading.feedback import Finding
from service.grading.samples import SAMPLES, Samples
from service.kinematics.screws import moved, product_in_body, product_in_space
from service.kinematics.transforms import Matrices, Numbers, inverse


@dataclass(frozen=True, slots=True)
class Exponentials:
    """Screw axes ``(n, SAMPLES, 6)`` seen from the base and from the tool, amounts, home pose."""

    space: Numbers
    body: Numbers
    amounts: Numbers
    home: Matrices

    @classmethod
    def of(cls, robot: ScrewRobot, samples: Samples) -> "Exponentials":
        """Those of the reference robot."""
        home = robot.frame("tool", at_home(robot.joints, samples.values, SAMPLES), SAMPLES)
        space = robot.screws(samples.values, SAMPLES)
        amounts = np.array([samples.values[joint.variable] for joint in robot.joints])
        return cls(space, moved(inverse(home), space), amounts, home)


Misconception = tuple[Finding, Matrices]


def home_on_the_wrong_side(product: Exponentials) -> list[Misconception]:
    """Space axes were multiplied behind M, or body axes in front of it."""
    finding = Finding(
        "home_on_wrong_side",
        "M stands on the wrong side of the exponentials: space axes are multiplied in front of M, "
        "body axes behind it.",
        "T = e^[S1]θ1 … e^[Sn]θn M = M e^[B1]θ1 … e^[Bn]θn.",
    )
    return [
        (finding, product_in_body(product.space, product.amounts, product.home)),
        (finding, product_in_space(product.body, product.amounts, product.home)),
    ]


def missing_home(product: Exponentials) -> list[Misconception]:
    """The home pose was left out."""
    finding = Finding(
        "missing_home",
        "This is the product of the exponentials without the home pose M.",
        "Multiply M behind the space axes' exponentials.",
    )
    identity = np.eye(4)
    return [
        (finding, product_in_space(product.space, product.amounts, identity)),
        (finding, product_in_space(product.body, product.amounts, identity)),
    ]


def reversed_product(product: Exponentials) -> list[Misconception]:
    """The exponentials were multiplied from the last joint to the first."""
    finding = Finding(
        "reversed_product",
        "The exponentials are multiplied in reverse order.",
        "Begin with that of joint 1, nearest to the base.",
    )
    amounts = product.amounts[::-1]
    return [
        (finding, product_in_space(product.space[::-1], amounts, product.home)),
        (finding, product_in_body(product.body[::-1], amounts, product.home)),
    ]


def moment_sign(product: Exponentials) -> list[Misconception]:
    """V was taken to be ω × q for every turning joint."""
    finding = Finding(
        "moment_sign",
        "This comes from screw axes with v = ω × q; the velocity of the point at the origin is "
        "−ω × q.",
    )
    found = []
    for axes, multiply in ((product.space, product_in_space), (product.body, product_in_body)):
        turns = np.abs(axes[..., :3]).max(axis=-1, keepdims=True) > 0.5
        signs = np.where(turns, [1, 1, 1, -1, -1, -1], 1)
        found.append((finding, multiply(axes * signs, product.amounts, product.home)))
    return found


MISCONCEPTIONS: tuple[Callable[[Exponentials], list[Misconception]], ...] = (
    home_on_the_wrong_side,
    missing_home,
    reversed_product,
    moment_sign,
)


def explain_product(case: MatrixCase, exercise: Exercise, samples: Samples) -> list[Explanation]:
    """What explains the whole of a wrong pose that is a product of exponentials."""
    if not isinstance(exercise.reference, ScrewRobot):
        return []
    product = Exponentials.of(exercise.reference, samples)
    for misconception in MISCONCEPTIONS:
        for finding, pose in misconception(product):
            entries = Samples.subset_of(np.moveaxis(pose, 0, -1), case.actual.shape[-1] // 2)
            if case.explained_by(entries).all():
                return [Explanation(finding, case.area((slice(None), slice(None))))]
    return []
