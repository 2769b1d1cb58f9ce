"""Generate valid tables of a robot, with frames as a student might choose them."""

# The generator starts at the base. At each joint it puts the student's frame on the joint's axis.
# The directions of z and x are random. If the next axis is parallel, the origin and x are random as
# well; the axis of a prismatic joint may be anywhere. Each row is computed from the common normal
# between two z axes, at K values of the lengths at once. In the end the numbers are written as
# formulas.
#
# `pose` is always the transform `(K, 4, 4)` from the reference's frame to the student's frame at
# the same joint.

from dataclasses import dataclass, replace

import numpy as np

from tests.frame_choice.cells import Cell, NotExpressibleError, Term, angle_cell, length_cell
from tests.frame_choice.kinematics import Numbers, cell_values, inverse, screw_x, screw_z
from tests.frame_choice.robots import STANDARD, Policy, Robot

K = 12
SMALL = 1e-9
BOLDNESS = (0.15, 0.5, 0.85)

CellRow = tuple[Cell, Cell, Cell, Cell]
Constants = tuple[Numbers, Numbers]


@dataclass(frozen=True)
class Table:
    """A table as a student submits it: cells in the order a, α, d, θ."""

    robot: Robot
    policy: Policy
    convention: str
    rows: tuple[CellRow, ...]

    @property
    def texts(self) -> list[list[str]]:
        return [[cell.text for cell in row] for row in self.rows]

    def edited(self, row: int, column: int, cell: Cell) -> "Table":
        """Return the table with one cell replaced."""
        rows = [list(cells) for cells in self.rows]
        rows[row][column] = cell
        return replace(self, rows=tuple((a, b, c, d) for a, b, c, d in rows))


class _UnreachableError(Exception):
    """No table row leads from the last frame to the end-effector frame."""


def reassignment(
    robot: Robot,
    policy: Policy,
    convention: str,
    rng: np.random.Generator,
    boldness: float | None = None,
) -> tuple[Table, int]:
    """Return a random valid table, and the number of failed attempts."""
    # `boldness` is the share of choices that differ from the reference's frames, random if None.
    for failed in range(200):
        try:
            return _Reassignment(robot, policy, convention, rng, boldness).table(), failed
        except (NotExpressibleError, _UnreachableError):
            continue
    raise RuntimeError(f"no table of {robot.name} can be drawn")


class _Reassignment:
    def __init__(
        self,
        robot: Robot,
        policy: Policy,
        convention: str,
        rng: np.random.Generator,
        boldness: float | None,
    ) -> None:
        self.robot, self.policy, self.convention, self.rng = robot, policy, convention, rng
        self.boldness = rng.choice(BOLDNESS) if boldness is None else boldness
        self.letters = {name: rng.uniform(*robot.range(name), K) for name in robot.lengths}
        self.roots: list[Term] = []
        self.arcs: list[Term] = []
        self.x: list[Constants] = []
        self.z: list[Constants] = []
        self.joint_signs: list[int] = []
        self._read_reference()

    def _read_reference(self) -> None:
        # Read the reference as a product X_0 (Z_1 X_1) … (Z_n X_n) Z_e of screw motions.
        #
        # `first` is X_0, `links` are the products Z_i X_i without the last one, and `tool` is Z_n
        # X_n Z_e.
        home = {name: np.zeros(K) for name in self.robot.joints}
        cells = cell_values(self.robot.rows, home | self.letters)
        none = np.zeros((1, 2, K))
        x, z = cells[:, :2], cells[:, 2:]
        joints = len(self.robot.joints)
        if self.robot.convention == STANDARD:
            x, z = np.concatenate([none, x]), np.concatenate([z, none])
        else:
            x, z = np.concatenate([x, none]), np.concatenate([z, none])
        links = [screw_z(*z[i]) @ screw_x(*x[i + 1]) for i in range(joints)]
        self.first = screw_x(*x[0])
        self.links = links[:-1]
        self.tool = links[-1] @ screw_z(*z[joints])

    def table(self) -> Table:
        pose = self._first_frame()
        for joint, link in enumerate(self.links):
            self._note_sense(pose)
            pose = self._next_frame(pose, link, joint + 1)
        self._note_sense(pose)
        self._last_frame(pose)
        return Table(self.robot, self.policy, self.convention, self._rows())

    # Choices

    def _bold(self) -> bool:
        return bool(self.rng.random() < self.boldness)

    def _sign(self) -> int:
        return -1 if self._bold() else 1

    def _length(self) -> Numbers:
        number = np.full(K, round(self.rng.uniform(0.1, 0.8), 2) * self.rng.choice([-1, 1]))
        if not self.letters or self.rng.random() < 0.5:
            return number
        letter = self.letters[self.robot.lengths[self.rng.integers(len(self.letters))]]
        letter = letter * self.rng.choice([-1, 1])
        shift: Numbers = letter if self.rng.random() < 0.7 else letter + number
        return shift

    def _shift(self) -> Numbers:
        return self._length() if self._bold() else np.zeros(K)

    def _turn(self) -> Numbers:
        if not self._bold():
            return np.zeros(K)
        usual = (90, -90, 180, int(self.rng.integers(-179, 180)))
        degrees = usual[self.rng.integers(len(usual))]
        return np.full(K, np.radians(degrees))

    def _sideways(self) -> Numbers:
        # Return a random displacement for the axis of a prismatic joint, `(K, 4, 4)`.
        move = np.tile(np.eye(4), (K, 1, 1))
        move[:, 0, 3], move[:, 1, 3] = self._shift(), self._shift()
        return move

    def _slides(self, joint: int) -> bool:
        return self.robot.structure[joint] == "P"

    def _note_sense(self, pose: Numbers) -> None:
        sign = 1 if pose[0, 2, 2] > 0 else -1
        if self.policy.directions and self.rng.random() < 0.5:
            sign = -sign
        self.joint_signs.append(sign)

    # Frames

    def _anywhere_on_axis(self, joint: int) -> Numbers:
        # Return a random frame on the axis of a joint, for a free base or end effector.
        on_axis = screw_x(0.0, 0.0 if self._sign() > 0 else np.pi)
        on_axis = screw_z(self._shift(), self._turn()) @ on_axis
        return self._sideways() @ on_axis if self._slides(joint) else on_axis

    def _first_frame(self) -> Numbers:
        none = np.zeros(K)
        if self.convention == STANDARD:
            self.x.append((none, none))
            if self.policy.base:
                return self._anywhere_on_axis(0)
            return np.tile(np.eye(4), (K, 1, 1))
        reference = _read_x(self.first)
        a = reference[0]
        if self.policy.base:
            pose = self._anywhere_on_axis(0)
            first = (a + self._shift(), reference[1] + self._turn())
        else:
            if self._slides(0):
                a = a + self._shift()
            first = (a, reference[1] + (0.0 if self._sign() > 0 else np.pi))
            pose = inverse(self.first) @ screw_x(*first)
        self.x.append(first)
        return pose

    def _next_frame(self, pose: Numbers, link: Numbers, joint: int) -> Numbers:
        moved = link @ self._sideways() if self._slides(joint) else link
        z, x = self._row_to_axis(pose, moved, self._sign())
        self.z.append(z)
        self.x.append(x)
        return inverse(link) @ pose @ screw_z(*z) @ screw_x(*x)

    def _last_frame(self, pose: Numbers) -> None:
        target = inverse(pose) @ self.tool
        if self.policy.tool:
            self._open_end(target)
            return
        if self.convention != STANDARD and self.rng.random() < 0.4:
            self._end_on_tool_axis(pose)
            return
        if self._slides(len(self.links)) and self.rng.random() < 0.7:
            # The axis was displaced at random; move it back to meet the end effector's x axis.
            self._aligned_with_tool(pose)
            return
        self._end_directly(target)

    def _end_directly(self, target: Numbers) -> None:
        # Append the last row, which ends in the tool frame; raise an error if no row does.
        theta = np.arctan2(target[:, 1, 0], target[:, 0, 0])
        alpha = np.arctan2(target[:, 2, 1], target[:, 2, 2])
        a = target[:, 0, 3] * np.cos(theta) + target[:, 1, 3] * np.sin(theta)
        z, x = (target[:, 2, 3], theta), (a, alpha)
        if np.abs(screw_z(*z) @ screw_x(*x) - target).max() > SMALL:
            raise _UnreachableError
        self.z.append(z)
        self.x.append(x)

    def _aligned_with_tool(self, pose: Numbers) -> None:
        # Move the last (prismatic) axis until it meets the tool's x axis; append the last row.
        if not self.links:
            raise _UnreachableError
        link = self.links[-1]
        before = link @ pose @ inverse(screw_z(*self.z.pop()) @ screw_x(*self.x.pop()))
        along = self.tool[:, :3, 0]
        slide = np.tile(np.eye(4), (K, 1, 1))
        slide[:, :3, 3] = along * self._shift()[:, None]
        z, x = self._row_to_axis(before, link @ slide, 1 if pose[0, 2, 2] > 0 else -1)
        self.z.append(z)
        self.x.append(x)
        pose = inverse(link) @ before @ screw_z(*z) @ screw_x(*x)
        self._end_directly(inverse(pose) @ self.tool)

    def _end_on_tool_axis(self, pose: Numbers) -> None:
        # Append the row that leads to the end effector's z axis, and the fixed row e along it.
        z, x = self._row_to_axis(pose, self.tool, 1)
        rest = inverse(pose @ screw_z(*z) @ screw_x(*x)) @ self.tool
        self.z.append(z)
        self.x.append(x)
        self.z.append((rest[:, 2, 3], np.arctan2(rest[:, 1, 0], rest[:, 0, 0])))

    def _open_end(self, target: Numbers) -> None:
        # Append a random last row, for a free end effector.
        angles = (target[:, 1, 0], target[:, 0, 0]), (target[:, 2, 1], target[:, 2, 2])
        theta, alpha = (
            np.arctan2(*angle) * self.rng.integers(2) + self._turn() for angle in angles
        )
        self.z.append((self._length() * self.rng.integers(2), theta))
        self.x.append((self._length() * self.rng.integers(2), alpha))
        if self.convention != STANDARD and self.rng.random() < 0.5:
            if self.rng.random() < 0.5:
                self.x[-1] = (np.zeros(K), np.zeros(K))
            else:
                self.z.append((self._shift(), self._turn()))

    def _row_to_axis(
        self, pose: Numbers, link: Numbers, z_sign: int
    ) -> tuple[Constants, Constants]:
        # Return (d, θ) and (a, α) of a row from frame `pose` to the z axis of frame `link`.
        target = inverse(pose) @ link
        axis, point = z_sign * target[:, :3, 2], target[:, :3, 3]
        if np.hypot(axis[:, 0], axis[:, 1]).max() > SMALL:
            return self._common_normal(target, axis, point)
        alpha = np.where(axis[:, 2] > 0, 0.0, np.pi)
        d = point[:, 2] + self._shift()
        if np.hypot(point[:, 0], point[:, 1]).max() < SMALL:
            theta = np.arctan2(target[:, 1, 0], target[:, 0, 0]) + self._turn()
            return (d, theta), (np.zeros(K), alpha)
        a, theta = self._across(pose, link, point)
        return (d, theta), (a, alpha)

    def _common_normal(
        self, target: Numbers, axis: Numbers, point: Numbers
    ) -> tuple[Constants, Constants]:
        # Return (d, θ) and (a, α) of a row from z to the line `axis` through `point`.
        z = np.tile([0.0, 0.0, 1.0], (K, 1))
        x = np.cross(z, axis)
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        if (x[0] @ target[0, :3, 0] < -SMALL) != self._bold():
            x = -x
        d, a, _ = np.linalg.solve(np.stack([z, x, -axis], axis=2), point[..., None])[..., 0].T
        sine = (np.cross(z, axis) * x).sum(axis=1)
        return (d, np.arctan2(x[:, 1], x[:, 0])), (a, np.arctan2(sine, axis[:, 2]))

    def _across(self, pose: Numbers, link: Numbers, point: Numbers) -> Constants:
        # Return a and θ of a row from the z axis to the parallel axis through `point`.
        sign = self._sign()
        across = point[:, :2]
        _, sizes, directions = np.linalg.svd(across, full_matrices=False)
        if sizes[1] < SMALL:  # the same direction for all lengths
            x = directions[0] * np.sign(directions[0] @ across[0])
            return sign * across @ x, np.full(K, np.arctan2(sign * x[1], sign * x[0]))
        # In the reference's frame, the vector between the axes is a sum of letters.
        way = link[:, :3, 3] - pose[:, :3, 3]
        texts = [length_cell(way[:, i], self.letters, ()).text for i in range(2)]
        arc = Term(f"atan2({texts[1]}, {texts[0]})", np.arctan2(way[:, 1], way[:, 0]))
        size = np.hypot(way[:, 0], way[:, 1])
        self.arcs.append(arc)
        self.roots.append(Term(f"sqrt(({texts[0]})^2 + ({texts[1]})^2)", size))
        return sign * size, np.arctan2(sign * across[:, 1], sign * across[:, 0])

    # Writing down

    def _rows(self) -> tuple[CellRow, ...]:
        none = (np.zeros(K), np.zeros(K))
        if self.convention == STANDARD:
            pairs = list(zip(self.x[1:], self.z, strict=True))
        else:
            z = [*self.z, *[none] * (len(self.x) - len(self.z))]
            pairs = list(zip(self.x, z, strict=True))
        rows = [self._row(i, x, z) for i, (x, z) in enumerate(pairs)]
        while len(rows) > len(self.robot.joints) and all(cell.is_zero for cell in rows[-1]):
            rows.pop()
        return tuple(rows)

    def _row(self, i: int, x: Constants, z: Constants) -> CellRow:
        (a, alpha), (d, theta) = x, z
        row = [
            length_cell(a, self.letters, self.roots),
            angle_cell(alpha, ()),
            length_cell(d, self.letters, ()),
            angle_cell(theta, self.arcs),
        ]
        if i < len(self.robot.joints):
            column = self.robot.column(i)
            row[column] = replace(
                row[column], variables={self.robot.joints[i]: self.joint_signs[i]}
            )
        return row[0], row[1], row[2], row[3]


def _read_x(screw: Numbers) -> Constants:
    # Return a and α of the transforms X = Rot_x(α) Trans_x(a).
    return screw[:, 0, 3], np.arctan2(screw[:, 2, 1], screw[:, 2, 2])
