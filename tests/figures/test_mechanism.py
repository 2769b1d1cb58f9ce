"""The corners and joints in a figure move with the robot."""

from collections.abc import Mapping

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.robot import Robot, ScrewRobot
from dh_grader.figures.mechanism import drawing_numbers, mechanism_of
from dh_grader.kinematics import Convention, Numbers
from scipy.linalg import expm

from tests.shipped import shipped_exercises

# The drawing uses screw axes; the tests use the link transforms of the table, or SciPy's matrix
# exponential if a robot has no table.

POSES = 5
EXACT = 1e-9
SHIPPED = shipped_exercises()
ROBOTS = [name for name, exercise in SHIPPED.items() if exercise.reference is not None]


def link_transform(row: Numbers, convention: Convention) -> Numbers:
    """Return the transform of one row, as the product of its two screw motions."""
    a, alpha, d, theta = row
    turn_x, turn_z = np.eye(4), np.eye(4)
    turn_x[1:3, 1:3] = [[np.cos(alpha), -np.sin(alpha)], [np.sin(alpha), np.cos(alpha)]]
    turn_z[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
    turn_x[0, 3], turn_z[2, 3] = a, d
    return turn_z @ turn_x if convention is Convention.STANDARD else turn_x @ turn_z


def bodies(exercise: Exercise, values: Mapping[str, float]) -> tuple[list[Numbers], list[Numbers]]:
    reference = exercise.reference
    each = {name: np.array([value]) for name, value in values.items()}
    if isinstance(reference, Robot):
        table = reference.tables[reference.convention]
        reached = [np.eye(4)]
        for row in table.values(each, 1)[..., 0]:
            reached.append(reached[-1] @ link_transform(row, table.convention))
        count = len(reference.joints)
        on_axes = reached if table.convention is Convention.STANDARD else reached[1:]
        # A fixed last row belongs to the last body.
        return [*reached[:count], reached[-1]], on_axes[:count]
    assert isinstance(reference, ScrewRobot)
    reached = [np.eye(4)]
    for joint, (w, v) in zip(
        reference.joints, reference.screws(each, 1)[:, 0].reshape(-1, 2, 3), strict=True
    ):
        screw = np.array(
            [[0, -w[2], w[1], v[0]], [w[2], 0, -w[0], v[1]], [-w[1], w[0], 0, v[2]], [0] * 4]
        )
        reached.append(reached[-1] @ expm(screw * values[joint.variable]))
    home = reference.frame(
        "tool",
        dict.fromkeys(values, np.zeros(1))
        | {
            name: value
            for name, value in each.items()
            if name not in {j.variable for j in reference.joints}
        },
        1,
    )[0]
    return [*reached[:-1], reached[-1] @ home], []


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", ROBOTS)
def test_every_drawn_point_moves_with_its_link(name: str) -> None:
    exercise = SHIPPED[name]
    numbers = drawing_numbers(exercise.variables)
    assert exercise.reference is not None
    mechanism = mechanism_of(exercise.reference, numbers)
    amounts = np.random.default_rng(1).uniform(-2.0, 2.0, (POSES, len(exercise.joints)))
    rigid: list[list[Numbers]] = [[] for _ in range(len(exercise.joints) + 1)]
    for amount, shown in zip(amounts, mechanism.at(amounts), strict=True):
        values = numbers | {
            joint.variable: q for joint, q in zip(exercise.joints, amount, strict=True)
        }
        carried, on_axes = bodies(exercise, values)
        assert shown.tool == pytest.approx(carried[-1][:3, 3], abs=EXACT)
        for joint, frame, axis, centre in zip(
            exercise.joints, on_axes, shown.axes, shown.centres, strict=False
        ):
            assert axis == pytest.approx(frame[:3, 2], abs=EXACT)
            if not joint.prismatic:
                assert np.cross(centre - frame[:3, 3], frame[:3, 2]) == pytest.approx(0, abs=EXACT)
        for i, (body, line) in enumerate(zip(carried, shown.links, strict=True)):
            # The first point of a link is in the joint before it, along which the link may slide.
            points = line[1:] if i and exercise.joints[i - 1].prismatic else line
            rigid[i].append((points - body[:3, 3]) @ body[:3, :3])
    for seen in rigid:
        for points in seen[1:]:
            assert points == pytest.approx(seen[0], abs=EXACT)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", ROBOTS)
def test_links_lead_from_joint_to_joint_without_a_gap(name: str) -> None:
    exercise = SHIPPED[name]
    numbers = drawing_numbers(exercise.variables)
    assert exercise.reference is not None
    mechanism = mechanism_of(exercise.reference, numbers)
    [shown] = mechanism.at(np.full((1, len(exercise.joints)), 0.7))
    assert shown.links[0][0] == pytest.approx(shown.base)
    assert shown.links[-1][-1] == pytest.approx(shown.tool)
    for i, centre in enumerate(shown.centres):
        assert shown.links[i][-1] == pytest.approx(centre)
        assert shown.links[i + 1][0] == pytest.approx(centre)


def test_joints_whose_axes_meet_are_drawn_apart() -> None:
    # The axes meet in the wrist and in the shoulder of the Stanford arm.
    exercise = SHIPPED["stanford-arm"]
    numbers = drawing_numbers(exercise.variables)
    assert exercise.reference is not None
    mechanism = mechanism_of(exercise.reference, numbers)
    [shown] = mechanism.at(np.array([[numbers[joint.variable] for joint in exercise.joints]]))
    apart = np.linalg.norm(np.diff(shown.centres, axis=0), axis=1)
    assert apart.min() > 0.1 * mechanism.size
    # With d3 extended, joint 5 is at the wrist centre, above the box of joint 3.
    assert shown.centres[4] == pytest.approx([0, numbers["d2"], numbers["d3"]])
