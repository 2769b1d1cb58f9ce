"""Slips in a product of exponentials."""

from dataclasses import dataclass

import numpy as np

from service.catalogue import Exercise, ScrewRobot
from service.catalogue.robots.robot import at_home
from service.grading.diagnosis.matrices.matrix_case import Explanation, MatrixCase, as_explanations
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.misconception import Written, explanation, misconception, says
from service.grading.numerics.samples import Samples
from service.kinematics.screws import moved, product_in_body, product_in_space
from service.kinematics.transforms import Matrices, Numbers, inverse
from service.translations import say


@dataclass(frozen=True, slots=True)
class Exponentials:
    """The factors of a product of exponentials: screw axes, joint values and home pose."""

    # The screw axes in the space frame, (n, SAMPLES, 6).
    space: Numbers
    # The screw axes in the body frame, (n, SAMPLES, 6).
    body: Numbers
    amounts: Numbers
    home: Matrices

    @classmethod
    def of(cls, robot: ScrewRobot, samples: Samples) -> "Exponentials":
        """Return the factors for the exercise's robot."""
        values, count = samples.values, samples.count
        home = robot.frame("tool", at_home(robot.joints, values, count), count)
        space = robot.screws(values, count)
        amounts = np.array([values[joint.variable] for joint in robot.joints])
        return cls(space, moved(inverse(home), space), amounts, home)


def _pose(pose: Matrices, finding: Finding) -> Written[Numbers]:
    return Written(np.moveaxis(pose, 0, -1), finding)


@misconception(
    of=Exponentials,
    rank=10,
    code="home_on_wrong_side",
    rule="exponentials",
    means="M is on the wrong side of the exponentials: it comes after those of space axes and "
    "before those of body axes",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, L1 c1 - L1 c13 + L1 + L2 + theta2 c1; s13, c13, 0, L1 s1 - L1 s13 + "
            "theta2 s1; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def home_on_the_wrong_side(product: Exponentials) -> Hypotheses:
    """The home pose M is on the wrong side of the exponentials."""
    finding = says(
        say(
            "M stands on the wrong side of the exponentials: space axes are multiplied in front "
            "of M, body axes behind it."
        ),
        say("T = e^[S1]θ1 … e^[Sn]θn M = M e^[B1]θ1 … e^[Bn]θn."),
    )
    yield _pose(product_in_body(product.space, product.amounts, product.home), finding)
    yield _pose(product_in_space(product.body, product.amounts, product.home), finding)


@misconception(
    of=Exponentials,
    rank=20,
    code="missing_home",
    rule="exponentials",
    means="M is missing in the product of exponentials",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, c1 theta2 + L1 c1 - L1 c13; s13, c13, 0, s1 theta2 + L1 s1 - L1 s13; "
            "0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"2/1": "2*s13"},
)
def missing_home(product: Exponentials) -> Hypotheses:
    """The home pose M was left out."""
    finding = says(
        say("This is the product of the exponentials alone: the home pose M is missing."),
        say("Multiply M behind the space axes' exponentials."),
    )
    for axes in (product.space, product.body):
        yield _pose(product_in_space(axes, product.amounts, np.eye(4)), finding)


@misconception(
    of=Exponentials,
    rank=30,
    code="reversed_product",
    rule="exponentials",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, -L1 c3 + L1 c13 + L1 + L2 c13 + theta2 c3; s13, c13, 0, -L1 s3 + "
            "L1 s13 "
            " + L2 s13 + theta2 s3; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def reversed_product(product: Exponentials) -> Hypotheses:
    """The exponentials were multiplied from the last joint to the first."""
    finding = says(
        say("The exponentials are multiplied in reverse order: check which joint comes first."),
        say("Begin with that of joint 1, nearest to the base."),
    )
    amounts = product.amounts[::-1]
    yield _pose(product_in_space(product.space[::-1], amounts, product.home), finding)
    yield _pose(product_in_body(product.body[::-1], amounts, product.home), finding)


@misconception(
    of=Exponentials,
    rank=40,
    code="moment_sign",
    rule="exponentials",
    means="v is ω × q instead of −ω × q in the exponentials",
    example=(
        "planar-rpr-poe",
        "pose",
        (
            "[c13, -s13, 0, -L1 c1 + 2 L1 c13 + L2 c13 + theta2 c1; s13, c13, 0, -L1 s1 + 2 L1 s13 "
            "+ L2 s13 + theta2 s1; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"4/2": "1"},
)
def moment_sign(product: Exponentials) -> Hypotheses:
    """The student wrote v = ω × q instead of −ω × q for every turning joint."""
    finding = says(
        say(
            "v has the wrong sign in the screw axes behind this: check the order of ω and q in the "
            "cross product."
        ),
    )
    for axes, multiply in ((product.space, product_in_space), (product.body, product_in_body)):
        turns = np.abs(axes[..., :3]).max(axis=-1, keepdims=True) > 0.5
        signs = np.where(turns, [1, 1, 1, -1, -1, -1], 1)
        yield _pose(multiply(axes * signs, product.amounts, product.home), finding)


def explain_product(case: MatrixCase, exercise: Exercise, samples: Samples) -> list[Explanation]:
    """Return explanations of a wrong pose that should be a product of exponentials."""
    if not isinstance(exercise.reference, ScrewRobot):
        return []
    subset = samples.subset(case.actual.shape[-1] // 2)
    product = Exponentials.of(exercise.reference, subset)
    return as_explanations(case, explanation(case, product))
