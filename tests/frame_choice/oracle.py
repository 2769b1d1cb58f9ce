"""Decide whether two tables describe the same robot, by comparing poses."""

# If the base or the end-effector frame is free, the tables may differ by a constant transform B or
# E: T_written(q) = B T_reference(σ q) E, with signs σ if the joints' directions are free. B and E
# may depend on the lengths. One free end is solved for at the first joint values and tested at the
# others. With two free ends, B must move the reference's joint screws onto the written ones,
# because in T(q) = exp(S_1 q_1) … exp(S_n q_n) M no S_i depends on E (Lynch and Park, Modern
# Robotics, section 4.1). With B known, E is solved for. The result is checked on the full pose.

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import product

import numpy as np

from tests.frame_choice.kinematics import Numbers, cell_values, forward, inverse
from tests.frame_choice.robots import Policy, Robot

LENGTHS = 2  # sets of lengths
JOINTS = 5  # sets of joint values for each
TOLERANCE = 1e-6
STEP = 1e-5

UNLIKE = 99.0

Values = Mapping[str, Numbers]
TableOf = Callable[[Values], Numbers]
Texts = Sequence[Sequence[str]]


@cache
def samples(robot: Robot) -> dict[str, Numbers]:
    rng = np.random.default_rng(len(robot.name) + 1000 * len(robot.joints))
    values = {}
    for name in robot.lengths:
        values[name] = np.repeat(rng.uniform(*robot.range(name), (LENGTHS, 1)), JOINTS, axis=1)
    for i, name in enumerate(robot.joints):
        low, high = (-np.pi, np.pi) if robot.structure[i] == "R" else (-1.0, 1.0)
        values[name] = rng.uniform(low, high, (LENGTHS, JOINTS))
    return values


@cache
def reference_poses(robot: Robot, signs: tuple[int, ...]) -> Numbers:
    values = dict(samples(robot))
    for name, sign in zip(robot.joints, signs, strict=True):
        values[name] = sign * values[name]
    return forward(cell_values(robot.rows, values), robot.convention)


def is_equivalent(robot: Robot, policy: Policy, texts: Texts, convention: str) -> bool:
    """True if the table is valid for the robot."""
    return mismatch(robot, policy, texts, convention) < TOLERANCE


def mismatch(robot: Robot, policy: Policy, texts: Texts, convention: str) -> float:
    """Return the largest difference between the table's pose and a valid pose."""
    error = difference(robot, policy, lambda values: cell_values(texts, values), convention)
    return float(np.abs(error).max())


def difference(robot: Robot, policy: Policy, table: TableOf, convention: str) -> Numbers:
    written = forward(table(samples(robot)), convention)
    needs_screws = policy.directions or (policy.base and policy.tool)
    own_screws = screws(robot, table, convention) if needs_screws else None
    best = np.full_like(written, UNLIKE)
    for signs in _signs(robot, policy, own_screws):
        fitted = _fitted(robot, policy, signs, written, own_screws)
        if np.abs(fitted - written).max() < np.abs(best).max():
            best = written - fitted
    return best


def _signs(robot: Robot, policy: Policy, written: Numbers | None) -> Iterator[tuple[int, ...]]:
    # Yield the possible signs of the joints' directions; `written` are the table's screws.
    n = len(robot.joints)
    if not policy.directions or written is None:
        yield (1,) * n
    elif policy.base:
        yield from product((1, -1), repeat=n)
    else:
        agree = (_screws_of_reference(robot)[0] * written[0]).sum(axis=1)
        yield tuple(-1 if along < 0 else 1 for along in agree)


def _fitted(
    robot: Robot,
    policy: Policy,
    signs: tuple[int, ...],
    written: Numbers,
    own_screws: Numbers | None,
) -> Numbers:
    # Return the reference's poses with the best transforms at the free ends.
    reference = reference_poses(robot, signs)
    if policy.base and policy.tool and own_screws is not None:
        reference = _base_from_screws(robot, signs, own_screws)[:, None] @ reference
    elif policy.base:
        reference = (written[:, :1] @ inverse(reference[:, :1])) @ reference
    if policy.tool:
        reference = reference @ (inverse(reference[:, :1]) @ written[:, :1])
    return reference


# Joint screws


def screws(robot: Robot, table: TableOf, convention: str) -> Numbers:
    # Return the joint screws (ω; v) in the base frame, all joints at 0, `(LENGTHS, n, 6)`.
    home = {name: value[:, 0] for name, value in samples(robot).items()}
    home |= {name: np.zeros(LENGTHS) for name in robot.joints}
    pose = forward(table(home), convention)
    found = np.empty((LENGTHS, len(robot.joints), 6))
    for i, name in enumerate(robot.joints):
        ahead = forward(table(home | {name: np.full(LENGTHS, STEP)}), convention)
        behind = forward(table(home | {name: np.full(LENGTHS, -STEP)}), convention)
        twist = (ahead - behind) @ inverse(pose) / (2 * STEP)
        found[:, i, :3] = np.stack([twist[:, 2, 1], twist[:, 0, 2], twist[:, 1, 0]], axis=1)
        found[:, i, 3:] = twist[:, :3, 3]
    return found


@cache
def _screws_of_reference(robot: Robot) -> Numbers:
    return screws(robot, lambda values: cell_values(robot.rows, values), robot.convention)


def _base_from_screws(robot: Robot, signs: tuple[int, ...], written: Numbers) -> Numbers:
    # Return the motions `(LENGTHS, 4, 4)` that move the reference's screws to `written`.
    reference = _screws_of_reference(robot) * np.array(signs)[:, None]
    return np.array([_align(*pair) for pair in zip(reference, written, strict=True)])


def _align(source: Numbers, target: Numbers) -> Numbers:
    # Return the rigid motion that moves the screws `source` `(n, 6)` closest to `target`.
    turning = np.linalg.norm(source[:, :3], axis=1) > 0.5
    directions = [np.where(turning[:, None], s[:, :3], s[:, 3:]) for s in (source, target)]
    u, sizes, vt = np.linalg.svd(directions[1].T @ directions[0])
    rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    if sizes[1] < 1e-6 and turning.any():
        rotation = _turn_in_plane(source[turning], target[turning], rotation) @ rotation
    moved = source.copy()
    moved[:, :3] = source[:, :3] @ rotation.T
    moved[:, 3:] = source[:, 3:] @ rotation.T
    shift = _translation(moved[turning], target[turning])
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = rotation, shift
    return base


def _turn_in_plane(source: Numbers, target: Numbers, rotation: Numbers) -> Numbers:
    # Return the rotation about the parallel axes `source` that moves them to `target`.
    axis = target[0, :3] / max(float(np.linalg.norm(target[0, :3])), 1e-12)
    moved = np.concatenate([source[:, :3] @ rotation.T, source[:, 3:] @ rotation.T], axis=1)
    points = [np.cross(s[:, :3], s[:, 3:]) for s in (moved, target)]
    one, other = (p - p.mean(axis=0) for p in points)
    angle = np.arctan2((np.cross(one, other) @ axis).sum(), (one * other).sum())
    cross = np.cross(np.eye(3), axis)
    turn: Numbers = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return turn


def _translation(source: Numbers, target: Numbers) -> Numbers:
    # Return the shortest t with v_target = v_source + t × ω.
    if not len(source):
        return np.zeros(3)
    # t × ω = −ω × t, row by row.
    left = np.concatenate([np.cross(np.eye(3), w).T for w in source[:, :3]])
    right = (target[:, 3:] - source[:, 3:]).ravel()
    shift: Numbers = np.linalg.lstsq(left, right, rcond=1e-9)[0]
    return shift
