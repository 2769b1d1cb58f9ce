"""Compare each robot's pose with a product of exponentials."""

# The screw axes and home poses below were written by hand from the words of the statements (where
# an axis passes, which way it points, where the tool is with all joint variables 0), not from the
# tables. T = e^{[S1] q1} … e^{[Sn] qn} M is equation 2.31 of the Robot kinematics lecture notes;
# the exponentials are SciPy's. The statements of real robots are read by `real.statements`.

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from dh_grader.catalogue import Exercise, Robot
from dh_grader.kinematics import pose as table_pose
from numpy.typing import NDArray
from scipy.linalg import expm

from tests.exercises.real.statements import home_of
from tests.shipped import REAL_ROBOTS, shipped_exercises

Vector = NDArray[np.float64]
Numbers = Mapping[str, float]

SAMPLES = 8
X, Y, Z = np.eye(3)
ORIGIN = np.zeros(3)


@dataclass(frozen=True)
class Axis:
    """The screw axis (ω; v) of a joint when all joint variables are 0."""

    turning: Vector
    velocity: Vector

    def matrix(self) -> Vector:
        (x, y, z), v = self.turning, self.velocity
        return np.array([[0, -z, y, v[0]], [z, 0, -x, v[1]], [-y, x, 0, v[2]], [0, 0, 0, 0]])


def turn(direction: Vector, through: Vector = ORIGIN) -> Axis:
    return Axis(direction, np.cross(through, direction))


def slide(direction: Vector) -> Axis:
    return Axis(ORIGIN, direction)


def frame(x: Vector, z: Vector, at: Vector) -> Vector:
    """Return a frame, given the directions of its x and z axes and its origin."""
    home = np.eye(4)
    home[:3] = np.column_stack([x, np.cross(z, x), z, at])
    return home


Chain = tuple[list[Axis], Vector]


def planar_rr(n: Numbers) -> Chain:
    tip = X * (n["a1"] + n["a2"])
    return [turn(Z), turn(Z, X * n["a1"])], frame(X, Z, tip)


def planar_rrr(n: Numbers) -> Chain:
    second = X * n["l1"]
    third = second + X * n["l2"]
    tip = third + X * n["l3"]
    return [turn(Z), turn(Z, second), turn(Z, third)], frame(X, Z, tip)


def planar_rpr(n: Numbers) -> Chain:
    third, tip = X * n["L1"], X * (n["L1"] + n["L2"])
    return [turn(Z), slide(X), turn(Z, third)], frame(X, Z, tip)


def rrrp(n: Numbers) -> Chain:
    elbow, wrist = X * n["l2"], X * (n["l2"] + n["l3"])
    tool = wrist + Z * (n["l1"] - n["l4"])
    return [turn(Z), turn(Z, elbow), turn(-Z, wrist), slide(-Z)], frame(X, -Z, tool)


def spatial_rrr(n: Numbers) -> Chain:
    second = X * n["R"]
    third = second + X * n["L1"]
    tip = third + X * n["L2"]
    return [turn(Z), turn(-Y, second), turn(-Y, third)], frame(X, -Y, tip)


def stanford(n: Numbers) -> Chain:
    shoulder = Z * n.get("d1", 0.0)
    boom = shoulder + Y * n["d2"]
    wrist = [turn(Z, boom), turn(Y, boom), turn(Z, boom)]
    return [turn(Z), turn(Y, shoulder), slide(Z), *wrist], frame(X, Z, boom + Z * n["d6"])


def scara(n: Numbers) -> Chain:
    elbow, wrist = X * n["a1"], X * (n["a1"] + n["a2"])
    tool = wrist - Z * n["d4"]
    return [turn(Z), turn(Z, elbow), slide(-Z), turn(-Z, wrist)], frame(X, -Z, tool)


def cylindrical(n: Numbers) -> Chain:
    return [turn(Z), slide(Z), slide(Y)], frame(X, Y, Z * n["d1"])


def cartesian(_: Numbers) -> Chain:
    return [slide(Z), slide(Y), slide(X)], frame(Z, X, ORIGIN)


def spherical_wrist(n: Numbers) -> Chain:
    return [turn(Z), turn(Y), turn(Z)], frame(X, Z, Z * n["d6"])


def baxter(_: Numbers) -> Chain:
    shoulder = X * 0.069 + Z * 0.27035
    elbow = shoulder + X * 0.36435 - Z * 0.069
    wrist = elbow + X * 0.37429 - Z * 0.010
    hand = wrist + X * 0.229525
    arm = [turn(Z), turn(Y, shoulder), turn(X, shoulder), turn(Y, elbow), turn(X, elbow)]
    return [*arm, turn(Y, wrist), turn(X, wrist)], frame(-Z, X, hand)


def xarm6(_: Numbers) -> Chain:
    towards = np.arctan2(569, 107)
    shoulder = 0.267 * Z
    elbow = shoulder + 0.28948866 * (np.cos(towards) * X + np.sin(towards) * Z)
    forearm = elbow + 0.0775 * X
    wrist = forearm - 0.3425 * Z
    hand = wrist + 0.076 * X
    arm = [turn(Z), turn(Y, shoulder), turn(Y, elbow), turn(-Z, forearm)]
    return [*arm, turn(Y, wrist), turn(-Z, hand)], frame(X, -Z, hand - 0.097 * Z)


def metres(name: str) -> list[float]:
    return [
        float(each) for each in re.findall(r"([\d.]+) m\b", shipped_exercises()[name].statement)
    ]


def first_arm(n: Numbers) -> Chain:
    elbow = Z * n["h"] + X * n["w"]
    return [turn(Z), turn(-Y, elbow)], frame(X, -Y, elbow + X * n["r"])


def planar_rr_numbers(_: Numbers) -> Chain:
    first, second = metres("planar-rr-numbers")
    return [turn(Z), turn(-Z, X * first)], frame(X, -Z, X * (first + second))


def elbow_directions(_: Numbers) -> Chain:
    height, upper, fore = metres("elbow-directions")
    shoulder = Z * height
    elbow = shoulder + X * upper
    crooked = np.cos(np.pi / 6) * Y + np.sin(np.pi / 6) * Z
    return [turn(Z), turn(Y, shoulder), turn(crooked, elbow)], frame(X, crooked, elbow + X * fore)


def vertical_axes(_: Numbers) -> Chain:
    first, second, third = metres("vertical-axes")
    tip = X * (first + second + third)
    return [turn(Z), slide(Z), turn(Z, X * (first + second))], frame(X, Z, tip)


def in_words(name: str) -> Callable[[Numbers], Chain]:
    # Return the chain that the statement of a real robot describes.
    #
    # If the student may choose directions or the tool, the reference's directions or tool are used.
    def chain(n: Numbers) -> Chain:
        exercise = shipped_exercises()[name]
        assert exercise.reference is not None
        lengths = {v.name: np.array([n[v.name]]) for v in exercise.variables}
        at_home = lengths | {joint.variable: np.zeros(1) for joint in exercise.joints}
        described = home_of(exercise, n)
        axes = []
        for axis, screw in zip(
            described.axes, exercise.reference.screws(at_home, 1)[:, 0], strict=True
        ):
            sign = 1.0 if axis.signed or screw[:3] @ axis.direction > 0 else -1.0
            along = sign * axis.direction
            axes.append(slide(along) if axis.point is None else turn(along, axis.point))
        if described.tool is None:
            return axes, exercise.reference.frame("tool", at_home, 1)[0]
        origin, x, z = described.tool
        return axes, frame(x, z, origin)

    return chain


STATEMENTS: dict[str, Callable[[Numbers], Chain]] = {
    "baxter-left-arm": baxter,
    "elbow-directions": elbow_directions,
    "find-the-slip-scara": scara,
    "find-the-slip-stanford": stanford,
    "first-arm": first_arm,
    "first-arm-modified": first_arm,
    "planar-rpr-poe": planar_rpr,
    "planar-rr": planar_rr,
    "planar-rr-numbers": planar_rr_numbers,
    "planar-rrr": planar_rrr,
    "planar-rrr-drawn": planar_rrr,
    "planar-rrr-faded": planar_rrr,
    "planar-rrr-frames": planar_rrr,
    "planar-rrr-standard": planar_rrr,
    "rrrp": rrrp,
    "rrrp-drawn": rrrp,
    "rrrp-proximal": rrrp,
    "scara": scara,
    "scara-faded": scara,
    "spatial-rrr": spatial_rrr,
    "spatial-rrr-frames": spatial_rrr,
    "spherical-wrist": spherical_wrist,
    "stanford-arm": stanford,
    "stanford-arm-d1": stanford,
    "stanford-arm-drawn": stanford,
    "stanford-arm-frames": stanford,
    "three-link-cartesian": cartesian,
    "three-link-cylindrical": cylindrical,
    "vertical-axes": vertical_axes,
    **{name: in_words(name) for name in REAL_ROBOTS},
    "xarm6": xarm6,
}
# The maker of this robot rounds its angle to 1e-5 degrees, and its length to 1e-8 m.
ROUNDED = {"xarm6": 2e-7}


def drawn(exercise: Exercise) -> dict[str, Vector]:
    rng = np.random.default_rng(520)
    return {v.name: rng.uniform(v.low, v.high, SAMPLES) for v in exercise.variables}


def exponentials(exercise: Exercise, values: Mapping[str, Vector]) -> Vector:
    """Return the robot's poses at these joint values, as products of exponentials."""
    poses = np.empty((SAMPLES, 4, 4))
    for lane in range(SAMPLES):
        numbers = {name: float(drawn_values[lane]) for name, drawn_values in values.items()}
        axes, poses[lane] = STATEMENTS[exercise.id](numbers)
        for axis, joint in reversed(list(zip(axes, exercise.joints, strict=True))):
            poses[lane] = expm(axis.matrix() * numbers[joint.variable]) @ poses[lane]
    return poses


def test_every_robot_of_the_catalogue_is_tested(catalogue: Mapping[str, Exercise]) -> None:
    assert {name for name, exercise in catalogue.items() if exercise.reference} == set(STATEMENTS)


@pytest.mark.parametrize("exercise_id", STATEMENTS)
def test_the_forward_kinematics_agree_with_the_statement(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    assert exercise.reference is not None
    values = drawn(exercise)
    expected = exponentials(exercise, values)
    atol = ROUNDED.get(exercise_id, 1e-12)
    reached = exercise.reference.frame("tool", values, SAMPLES)
    np.testing.assert_allclose(reached, expected, rtol=0, atol=atol)
    if isinstance(exercise.reference, Robot):
        for table in exercise.reference.tables.values():
            reached = table_pose(table.values(values, SAMPLES), table.convention)
            np.testing.assert_allclose(reached, expected, rtol=0, atol=atol)


@pytest.mark.parametrize("exercise_id", STATEMENTS)
def test_the_screw_axes_agree_with_the_statement(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue[exercise_id]
    assert exercise.reference is not None
    values = drawn(exercise)
    screws = exercise.reference.screws(values, SAMPLES)
    for lane in range(SAMPLES):
        axes, _ = STATEMENTS[exercise_id]({name: float(v[lane]) for name, v in values.items()})
        expected = [np.concatenate([axis.turning, axis.velocity]) for axis in axes]
        atol = ROUNDED.get(exercise_id, 1e-12)
        np.testing.assert_allclose(screws[:, lane], expected, rtol=0, atol=atol)
