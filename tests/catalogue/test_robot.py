"""Test the checks of formulas in exercise files."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest
from dh_grader.catalogue import CatalogueError, Exercise, Robot, ScrewRobot
from dh_grader.kinematics import product_in_space, rot_z

from tests.grading.support.submitting import ANGLES, HEAD, SPATIAL_RRR, one_part
from tests.kinematics.constructions import trans
from tests.together import together

Make = Callable[[str], Exercise]

SCREWS = """
[robot]
structure = "RP"
joints = ["q1", "q2"]
home = [["1", "0", "0", "l"], ["0", "1", "0", "0"], ["0", "0", "1", "0"], ["0", "0", "0", "1"]]
screws = [["0", "0", "1", "0", "0", "0"], ["0", "0", "0", "1", "0", "0"]]
[symbols]
l = { kind = "length", description = "a length" }
"""
PART = '[[parts]]\nid = "it"\nkind = "transform"\ntitle = "It"\n'
IDENTITY = (
    '[["1", "0", "0", "0"], ["0", "1", "0", "0"], ["0", "0", "1", "0"], ["0", "0", "0", "1"]]'
)

# The text of a file, the expected field, and words of the expected reason.
FAULTS: dict[str, tuple[str, str, str]] = {
    "no robot and no answer": (one_part("rotation", ""), "parts[0].expected", "no robot"),
    "a table without a robot": (
        one_part("dh_table", 'convention = "standard"'),
        "parts[0].kind",
        "robot with a table",
    ),
    "a table of a robot without one": (
        HEAD + SCREWS + PART.replace("transform", "dh_table") + 'convention = "either"\n',
        "parts[0].kind",
        "robot with a table",
    ),
    "links without a robot": (
        one_part("link_transforms", 'convention = "standard"'),
        "parts[0].kind",
        "robot with a table",
    ),
    "no rotation": (
        one_part("rotation", 'expected = [["1", "0", "0"], ["0", "2", "0"], ["0", "0", "1"]]'),
        "parts[0].expected",
        "no rotation",
    ),
    "a left hand": (
        one_part("rotation", 'expected = [["1", "0", "0"], ["0", "0", "1"], ["0", "1", "0"]]'),
        "parts[0].expected",
        "left-handed",
    ),
    "two rows": (
        one_part("rotation", 'expected = [["1", "0", "0"], ["0", "1", "0"]]'),
        "parts[0].expected",
        "required",
    ),
    "another bottom row": (
        one_part("transform", f"expected = {IDENTITY}").replace('"0", "1"]]', '"1", "1"]]'),
        "parts[0].expected",
        "0, 0, 0, 1",
    ),
    "an unknown symbol": (
        one_part("position", 'expected = ["l", "m7", "0"]'),
        "parts[0].expected[1]",
        "m7",
    ),
    "an undefined entry": (
        one_part("position", 'expected = ["l", "sqrt(l - 9)", "0"]'),
        "parts[0].expected[1]",
        "no value",
    ),
    "two coordinates of three": (
        one_part("position", 'expected = ["l", "0"]'),
        "parts[0]",
        "one for each",
    ),
    "the answer twice": (
        one_part("rotation", 'to = 1\nsteps = [{ axis = "x", angle = "phi" }]', SPATIAL_RRR),
        "parts[0]",
        "leave to out",
    ),
    "a step about no axis": (
        one_part("rotation", 'steps = [{ axis = "w", angle = "phi" }]'),
        "parts[0].steps[0].axis",
        "'x'",
    ),
    "a step by no angle": (
        one_part("rotation", 'steps = [{ axis = "x", angle = "phi +" }]'),
        "parts[0].steps[0].angle",
        ".",
    ),
    "no such frame": (one_part("rotation", "to = 7", SPATIAL_RRR), "parts[0].to", "frame 7"),
    "no such first frame": (
        one_part("rotation", "from = 9", SPATIAL_RRR),
        "parts[0].from",
        "base, 1, 2, tool",
    ),
    "a frame by another name": (
        one_part("rotation", 'from = "elbow"', SPATIAL_RRR),
        "parts[0].from",
        "'base'",
    ),
    "a frame of a robot without frames": (
        HEAD + SCREWS + PART + "to = 1\n",
        "parts[0].to",
        "base, tool",
    ),
    "an unknown sequence": (
        one_part("euler_angles", 'sequence = "ZZX"', SPATIAL_RRR),
        "parts[0].sequence",
        "'ZYZ'",
    ),
    "RPY about fixed axes": (
        one_part("euler_angles", 'sequence = "RPY"\naxes = "fixed"', SPATIAL_RRR),
        "parts[0]",
        "XYZ",
    ),
    "no unit vector": (
        one_part("screw_axes", 'frame = "space"\nexpected = [["0", "0", "2", "0", "0", "0"]]'),
        "parts[0].expected[0]",
        "unit vector",
    ),
    "five numbers": (
        one_part("screw_axes", 'frame = "space"\nexpected = [["0", "0", "1", "0", "0"]]'),
        "parts[0].expected[0]",
        "required",
    ),
    "rows of two lengths": (
        one_part("matrix", 'expected = [["0", "0"], ["1"]]'),
        "parts[0]",
        "one length",
    ),
    "seven columns": (
        one_part("matrix", f"expected = [{['0'] * 7}]"),
        "parts[0].expected[0]",
        "at most 6",
    ),
    "a quantity too few": (
        one_part("matrix", 'expected = [["0", "0"]]\nquantity = ["length"]'),
        "parts[0]",
        "one for each column",
    ),
    "a component of nothing": (
        one_part("vector", 'components = [{ name = "x", quantity = "mass", expected = "0" }]'),
        "parts[0].components[0].quantity",
        "'angle'",
    ),
    "a component that cannot be read": (
        one_part("vector", 'components = [{ name = "x", quantity = "angle", expected = "(" }]'),
        "parts[0].components[0].expected",
        ".",
    ),
    "a row for some values only": (
        one_part(
            "dh_row",
            'transform = [["1", "0", "0", "l"], ["0", "1", "0", "abs(phi) - phi"], '
            '["0", "0", "1", "0"], ["0", "0", "0", "1"]]',
        ),
        "parts[0].transform",
        "for some values",
    ),
    "too few screws": (
        HEAD + SCREWS.replace(', ["0", "0", "0", "1", "0", "0"]]', "]") + PART,
        "robot",
        "one for each",
    ),
    "a robot's invalid screw": (
        HEAD + SCREWS.replace('"0", "1", "0", "0"]]', '"0", "0", "0", "0"]]') + PART,
        "robot.screws[1]",
        "unit vector",
    ),
    "a sliding joint that turns": (
        HEAD + SCREWS.replace('"RP"', '"RR"') + PART,
        "robot.screws[1]",
        "turns",
    ),
    "a home that is no pose": (
        HEAD
        + SCREWS.replace('"1", "0", "0"], ["0", "0", "1"', '"2", "0", "0"], ["0", "0", "1"')
        + PART,
        "robot.home",
        "no rotation",
    ),
    "a robot given both ways": (
        HEAD + SCREWS.replace("home =", "table = []\nhome =") + PART,
        "robot.table",
        "there is no key",
    ),
}


@together("name", FAULTS)
def test_a_fault_is_reported_with_its_field(name: str, make_exercise: Make) -> None:
    text, field, reason = FAULTS[name]
    with pytest.raises(CatalogueError) as caught:
        make_exercise(text)
    faults = caught.value.faults
    assert [
        fault for fault in faults if fault.field.startswith(field) and reason in fault.reason
    ], faults


def test_an_exercise_without_a_robot(make_exercise: Make) -> None:
    exercise = make_exercise(one_part("position", 'expected = ["l", "0", "k"]'))
    assert (exercise.reference, exercise.structure, exercise.joints) == (None, None, ())
    with pytest.raises(LookupError, match="no robot"):
        _ = exercise.robot


def test_the_pose_of_a_robot_given_by_screws(make_exercise: Make) -> None:
    # Joint 1 turns by q1, and joint 2 slides by q2: the tool is at (l + q2) c1, (l + q2) s1.
    exercise = make_exercise(HEAD + SCREWS + PART)
    robot = exercise.reference
    assert isinstance(robot, ScrewRobot)
    assert (exercise.structure, [joint.prismatic for joint in exercise.joints]) == (
        "RP",
        [False, True],
    )
    values = {"q1": np.array([0.3, 1.0]), "q2": np.array([0.2, 0.4]), "l": np.array([0.5, 0.6])}
    expected = rot_z(values["q1"]) @ trans(values["l"] + values["q2"], 0, 0)
    np.testing.assert_allclose(robot.frame("tool", values, 2), expected, atol=1e-14)
    np.testing.assert_allclose(robot.frame("base", values, 2), np.stack([np.eye(4)] * 2))


def test_the_frames_of_a_robot_given_by_a_table(make_exercise: Make) -> None:
    robot = make_exercise(one_part("transform", "", SPATIAL_RRR)).reference
    assert isinstance(robot, Robot)
    values = {name: np.array([0.4]) for name in ("theta1", "theta2", "theta3", "R", "L1", "L2")}
    assert robot.frames == ("base", 1, 2, "tool")
    for one, other in (("base", 0), ("tool", 3)):
        np.testing.assert_allclose(robot.frame(one, values, 1), robot.frame(other, values, 1))
    np.testing.assert_allclose(robot.frame("tool", values, 1), robot.pose(values, 1))
    shoulder = [0.4 * np.cos(0.4), 0.4 * np.sin(0.4), 0.0]
    np.testing.assert_allclose(robot.frame(1, values, 1)[0, :3, 3], shoulder, atol=1e-15)
    assert [robot.has_frame(name) for name in ("base", 0, 3, 4)] == [True, True, True, False]


@pytest.mark.parametrize("exercise_id", ["planar-rrr", "rrrp", "scara", "stanford-arm"])
def test_screws_and_table_give_the_same_pose(
    exercise_id: str, catalogue: Mapping[str, Exercise]
) -> None:
    # The product of exponentials of the table's screw axes equals the table's pose.
    exercise = catalogue[exercise_id]
    rng = np.random.default_rng(12)
    values = {v.name: rng.uniform(v.low, v.high, 5) for v in exercise.variables}
    home = values | {joint.variable: np.zeros(5) for joint in exercise.joints}
    amounts = np.array([values[joint.variable] for joint in exercise.joints])
    robot = exercise.robot
    product = product_in_space(robot.screws(values, 5), amounts, robot.pose(home, 5))
    np.testing.assert_allclose(product, robot.pose(values, 5), atol=1e-12)


def test_an_exercise_needs_no_symbols(make_exercise: Make) -> None:
    setting = ANGLES[: ANGLES.index("[symbols]")]
    assert make_exercise(one_part("position", "expected = [1, 2, 3]", setting)).variables == ()
