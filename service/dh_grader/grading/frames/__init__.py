"""Tables in frames of the student's choice: their rows, the reference, and which tables are valid.

This file says whether a given table describes the robot. ``nearest.py`` searches for the nearest
table that does, and ``roles.py`` chooses the joint of each row; points and single cells are judged
in ``judging_table.py``.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, compress, product, zip_longest
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, Joint, ReferenceTable
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.catalogue.robot import at_home
from dh_grader.grading.misconception import Repaired, misconception, says
from dh_grader.grading.numbers import (
    HALF,
    MULTIPLE_OF_STEP,
    SAME_MOTION,
    SAMPLES,
    Samples,
    changes,
    difference,
    halves,
    joint_counts,
    moves_with,
    rounding_slack,
)
from dh_grader.grading.reading.table import IS_ANGLE, StudentRow, values_of
from dh_grader.grading.report import Finding, Severity
from dh_grader.kinematics import (
    COLUMNS,
    SAME_POSE,
    THETA,
    CellIndex,
    Convention,
    D,
    Integers,
    Matrices,
    Numbers,
    Table,
    axis_frames,
    inverse,
    pose,
    products,
    standard_link,
    z_links,
)
from dh_grader.kinematics.frame_choice import (
    RowConstants,
    Target,
    TargetKind,
    align_axes,
    match_tables,
)
from dh_grader.translations import Sentence, paragraph, say, template

# --- Pair the rows of a submitted table with joints
#
# Each pair of a row and its joint is called a role.


_NOTHING = np.full((len(COLUMNS), SAMPLES), np.nan)


@dataclass(frozen=True, slots=True)
class FrameFreedom:
    """What an exercise lets the student choose: base frame, tool frame, axis directions."""

    base: bool = False
    tool: bool = False
    directions: bool = False


def freedom_of(part: DhTableSpec) -> FrameFreedom:
    """Return which of base frame, tool frame and axis directions the student may choose."""
    return FrameFreedom(part.base == "free", part.tool == "free", part.directions == "free")


@dataclass(frozen=True, slots=True)
class Role:
    """A row of a submitted table, and the joint that it belongs to.

    ``joint`` is None for a row without a joint. ``row`` is None if the student left the row out.
    """

    row: StudentRow | None
    joint: Joint | None


def variable_column(joint: Joint) -> int:
    """Return the column of the joint's variable."""
    return D if joint.prismatic else THETA


def joint_cells(roles: Sequence[Role]) -> dict[CellIndex, Joint]:
    """Return the cells that should contain joint variables, with their joints."""
    return {
        (i, variable_column(role.joint)): role.joint for i, role in enumerate(roles) if role.joint
    }


def handed_in_values(roles: Sequence[Role]) -> Table:
    """Return the values of the rows, ``(rows, 4, SAMPLES)``, NaN for a missing row."""
    return np.array([role.row.values if role.row else _NOTHING for role in roles])


def variables_of(roles: Sequence[Role], samples: Samples) -> Table:
    """Return the joint variable that belongs in each cell, or 0: ``(rows, 4, samples)``."""
    return joint_variables([role.joint for role in roles], samples)


def joint_variables(joints: Sequence[Joint | None], samples: Samples) -> Table:
    """Return the joint variable that belongs in each cell, or 0. Do not modify the array.

    ``joints`` has the joint of each row, None for a row without a joint.
    """

    def compute() -> Table:
        variables = np.zeros((len(joints), len(COLUMNS), samples.count))
        for row, joint in zip(variables, joints, strict=True):
            if joint is not None:
                row[variable_column(joint)] = samples.values[joint.variable]
        return variables

    names = tuple(joint and joint.variable for joint in joints)
    return samples.cached(("variables", names), compute)


def roles_of(
    rows: Sequence[StudentRow],
    joints: tuple[Joint, ...],
    samples: Samples,
    expected_rows: int,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Return each row with its joint.

    If there are as many rows as joints, they are paired in order, unless ``in_order`` is false.
    Otherwise the pairing in order is taken in which most rows have their joint's variable; the
    remaining rows are fixed. If the variable of some joint is missing, and the number of rows is
    ``expected_rows``, that of the reference table, the joints' rows come first.
    """
    one_by_one = tuple(Role(row, joint) for row, joint in zip_longest(rows, joints))
    if len(rows) == len(joints) if in_order is None else in_order:
        return one_by_one
    values = values_of(rows).reshape(-1, SAMPLES)
    counts, _ = joint_counts(values, joints, samples, np.tile(IS_ANGLE, len(rows)))
    holds = np.abs(counts.reshape(len(rows), len(COLUMNS), len(joints))) > 0
    scores: Numbers = np.asarray(0.25 + holds.any(axis=1))
    for j, joint in enumerate(joints):
        scores[:, j] += holds[:, variable_column(joint), j]
    pairs = pair_in_order(scores)
    recognised = sum(scores[i, j] > 1 for i, j in pairs if i is not None and j is not None)
    if recognised < len(joints) and len(rows) == expected_rows:
        return one_by_one
    return tuple(
        Role(None if i is None else rows[i], None if j is None else joints[j]) for i, j in pairs
    )


def pair_in_order(scores: Numbers) -> list[tuple[int | None, int | None]]:
    """Pair submitted rows with expected rows, in order, so that the sum of scores is the largest.

    ``scores`` is ``(submitted, expected)``. (None, j) is a missing row, (i, None) an extra row. For
    equal sums, the last rows have no partner.
    """
    # The method is the weighted recurrence of the longest common subsequence.
    m, n = scores.shape
    best = np.zeros((m + 1, n + 1))
    for i in reversed(range(m)):
        for j in reversed(range(n)):
            best[i, j] = max(scores[i, j] + best[i + 1, j + 1], best[i + 1, j], best[i, j + 1])
    pairs: list[tuple[int | None, int | None]] = []
    i = j = 0
    while i < m or j < n:
        if i < m and j < n and best[i, j] == scores[i, j] + best[i + 1, j + 1]:
            pairs.append((i, j))
            i, j = i + 1, j + 1
        elif j < n and best[i, j] == best[i, j + 1]:
            pairs.append((None, j))
            j += 1
        else:
            pairs.append((i, None))
            i += 1
    return pairs


# --- Convert the reference table for comparisons with a student's table


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The constants of the reference robot at the first half of the samples (L of them).

    ``joints`` ``(n, L, 4, 4)`` are the poses of the joint frames, each in the frame of the previous
    joint. ``offsets`` ``(n, L, 4, 4)`` is, for each joint, the transform Z that consists of the
    constants in d and θ. ``fixed`` are the frames of the fixed rows and ``tool`` is the
    end-effector frame, ``(L, 4, 4)`` each, in the last joint's frame.
    """

    joints: Matrices
    offsets: Matrices
    fixed: list[Matrices]
    tool: Matrices


def mechanism_at(exercise: Exercise, samples: Samples) -> Mechanism:
    """Return the constants of the robot in the exercise's reference table."""
    return samples.cached("mechanism", lambda: _mechanism(exercise, samples))


def _mechanism(exercise: Exercise, samples: Samples) -> Mechanism:
    robot = exercise.robot
    reference = robot.tables[robot.convention]
    values = reference_values(reference, samples).copy()
    for i, joint in enumerate(reference.joints):
        values[i, variable_column(joint)] -= samples.values[joint.variable]
    cells = regrouped(halves(values)[0], reference.convention)
    links = standard_link(*cells.swapaxes(0, 1))
    n = len(reference.joints)
    fixed = list(accumulate(links[n:], np.matmul))
    return Mechanism(links[:n], z_links(cells[1 : n + 1]), fixed[:-1], fixed[-1])


_Cell = TypeVar("_Cell", bound=np.generic)


def regrouped(cells: NDArray[_Cell], convention: Convention) -> NDArray[_Cell]:
    """Regroup the cells of a table into rows that each lead from one joint axis to the next.

    ``(rows, 4, ...)`` becomes ``(rows + 1, 4, ...)``. Each new row is a product Z X: first the
    motion along z by d and θ, then the motion along x by a and α. Cells that the table lacks are 0.
    """
    none = np.zeros_like(cells[:1])
    z = np.concatenate([none, cells])
    x = z if convention is Convention.STANDARD else np.concatenate([cells, none])
    return np.concatenate([x[:, :2], z[:, 2:]], axis=1)


def as_table(links: Table, convention: Convention) -> Table:
    """Convert regrouped rows ``(rows + 1, 4, ...)`` to a table: the inverse of ``regrouped``."""
    x = links[1:] if convention is Convention.STANDARD else links[:-1]
    return np.concatenate([x[:, :2], links[1:, 2:]], axis=1)


def reference_values(reference: ReferenceTable, samples: Samples) -> Table:
    """Return the reference table in numbers, ``(rows, 4, samples)``. Do not modify it."""
    return samples.cached(
        reference.convention, lambda: reference.values(samples.values, samples.count)
    )


def reference_frames(exercise: Exercise, convention: Convention, samples: Samples) -> Matrices:
    """Return the reference solution's frames on the joint axes and its tool frame.

    The shape is ``(joints + 1, samples, 4, 4)``. The frames are those of a table in ``convention``,
    even if the robot has no such table.
    """

    def compute() -> Matrices:
        robot = exercise.robot
        table = robot.tables.get(convention) or robot.tables[robot.convention]
        reached = axis_frames(reference_values(table, samples), table.convention, convention)
        is_all = len(reached) == len(robot.joints) + 1
        return reached if is_all else reached[[*range(len(robot.joints)), -1]]

    return samples.cached(("frames", convention), compute)


def frames_on_axes(
    relative_poses: Matrices,
    links: Table,
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
) -> Matrices:
    """Return the student's frames on the joint axes, relative to the reference frames.

    The shape is ``(joints, ..., 4, 4)``. ``relative_poses`` ``(rows + 1, ..., 4, 4)`` compare the
    frames of both tables before the motion by d and θ. ``links`` ``(rows + 1, 4, ...)`` are the
    constants of the student's table, as ``regrouped`` returns them.
    """
    places = [i for i, _ in joint_cells(roles)]
    on_axes = relative_poses[places]
    if convention is Convention.STANDARD:
        return on_axes
    z = z_links(links[1:][places])
    between = (1,) * (z.ndim - mechanism.offsets.ndim)
    offsets = mechanism.offsets.reshape(len(places), *between, *mechanism.offsets.shape[1:])
    return np.asarray(inverse(offsets) @ on_axes @ z)


def tool_pose(exercise: Exercise, samples: Samples) -> Matrices:
    """Return the reference solution's end-effector frame in the base frame, ``(samples, 4, 4)``."""
    pose: Matrices = reference_frames(exercise, exercise.robot.convention, samples)[-1]
    return pose


# --- Split a table into constants and the motion by its joint variables


class Rereadable:
    """A table that may have been written in the other convention or in the other angle unit."""


@dataclass(frozen=True, slots=True)
class WrittenTable(Rereadable):
    """A student's table ``(rows, 4, samples)``, angles in radians, every cell with a value.

    Each value is the sum of ``constants`` and ``motion``, which depends on the joint variables.
    ``reference`` is the reference's table if both have equally many rows. ``exchanges`` lists pairs
    of lengths, each with the change of the table if the two are exchanged.
    """

    constants: Table
    motion: Table
    convention: Convention
    reference: Table | None = None
    exchanges: tuple[tuple[str, str, Table], ...] = ()

    @property
    def values(self) -> Table:
        """The table as it was submitted."""
        return self.constants + self.motion

    def subset(self, count: int) -> "WrittenTable":
        """Return the table at the first ``count`` samples of each half."""
        constants, motion = (
            Samples.subset_of(cells, count) for cells in (self.constants, self.motion)
        )
        reference = None if self.reference is None else Samples.subset_of(self.reference, count)
        exchanges = tuple(
            (one, other, Samples.subset_of(change, count)) for one, other, change in self.exchanges
        )
        return WrittenTable(constants, motion, self.convention, reference, exchanges)

    def changed(self, constants: Table, motion: Table | None = None) -> "WrittenTable":
        """Return a copy of the table with other constants or another motion."""
        # ``replace`` takes three times as long, and one diagnosis builds dozens of hypotheses.
        moves = self.motion if motion is None else motion
        return WrittenTable(constants, moves, self.convention, self.reference, self.exchanges)


RepairedTable = Repaired[WrittenTable]


def written_table(
    values: Table,
    convention: Convention,
    reference: Table | None,
    joints: tuple[Joint, ...],
    samples: Samples,
) -> WrittenTable:
    """Return the table, split into constants and the motion by its joint variables."""
    cells = values.reshape(-1, values.shape[-1])
    counts, _ = joint_counts(cells, joints, samples, np.tile(IS_ANGLE, len(values)))
    motion = counts @ np.array([samples.values[joint.variable] for joint in joints])
    motion = motion.reshape(values.shape)
    same_size = reference is not None and len(reference) == len(values)
    return WrittenTable(values - motion, motion, convention, reference if same_size else None)


def row_constants(
    roles: tuple[Role, ...], joints: tuple[Joint, ...], convention: Convention, samples: Samples
) -> list[RowConstants]:
    """Return the constants of a table, regrouped into rows between neighbouring joint axes.

    A cell that depends wrongly on the joint variables is wrong whatever frames are chosen.
    """
    cells = handed_in_values(roles)
    is_gradable = np.array(
        [[bool(role.row and role.row.entries[c].readable) for c in range(4)] for role in roles]
    )
    angle = np.tile(IS_ANGLE, len(roles))
    counts, linear = joint_counts(cells.reshape(-1, SAMPLES), joints, samples, angle)
    counts = counts.reshape(len(roles), len(COLUMNS), len(joints))
    linear = linear.reshape(is_gradable.shape)
    expected = np.zeros_like(counts)
    joint_signs = np.zeros(len(roles), dtype=np.int_)
    for (i, column), joint in joint_cells(roles).items():
        place = i, column, joints.index(joint)
        joint_signs[i] = counts[place] if abs(counts[place]) == 1 else 0
        expected[place] = joint_signs[i] or 1
    variables = np.array([samples.values[joint.variable] for joint in joints])
    constants = (cells - counts @ variables)[..., :HALF]
    written = np.where((is_gradable & linear)[..., None], constants, np.nan)
    wrong_regardless = is_gradable & ~(linear & (counts == expected).all(axis=-1))
    rows = zip(
        regrouped(written, convention),
        regrouped(is_gradable, convention),
        regrouped(wrong_regardless, convention),
        ~regrouped(np.ones_like(is_gradable), convention),
        regrouped(slack_of_cells(roles, samples), convention),
        [None, *(role.joint and variable_column(role.joint) for role in roles)],
        [0, *joint_signs.tolist()],
        strict=True,
    )
    return [RowConstants(*row) for row in rows]


def without_variables(
    tables: Numbers, roles: tuple[Role, ...], samples: Samples
) -> tuple[Numbers, NDArray[np.int_]]:
    """Return the constants of tables, and the signs of their joint variables.

    Tables are ``(T, rows, 4, samples)``, constants ``(T, rows, 4, samples / 2)``, signs ``(T,
    rows)``. A constant is NaN if its cell depends wrongly on the joint variables.
    """
    tables = tables.copy()
    signs = np.zeros(tables.shape[:2], dtype=np.int_)
    for (i, column), joint in joint_cells(roles).items():
        variable = samples.values[joint.variable]
        for sign in (1, -1):
            rest = tables[:, i, column] - sign * variable
            change = np.abs(difference(*halves(rest), IS_ANGLE[column])).max(axis=-1)
            signs[change < SAME_MOTION, i] = sign
        tables[:, i, column] -= signs[:, i, None] * variable
        tables[signs[:, i] == 0, i, column] = np.nan
    first, second = halves(tables)
    moves = np.abs(difference(first, second, IS_ANGLE[:, None])).max(axis=-1) >= SAME_MOTION
    return np.where(moves[..., None], np.nan, first), signs


# --- Test which of many tables describe the robot


def valid_tables(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    """Return a mask ``(T,)`` of the T tables that describe the robot in some allowed frames.

    ``tables`` is ``(T, rows, 4, samples)``; all have the same ``roles``. The base counts as given,
    even if it is free.
    """
    if not (freedom.tool or freedom.directions):
        return _valid_by_pose(tables, roles, convention, exercise, samples, tolerance)
    constants, signs = without_variables(tables, roles, samples)
    if freedom.directions:
        signs = np.zeros_like(signs)
    targets = targets_of(roles, convention, mechanism_at(exercise, samples), freedom)
    rows = np.moveaxis(regrouped(np.moveaxis(constants, 0, -1), convention), -1, 0)
    signs = np.pad(signs, ((0, 0), (1, 0)))
    return match_tables(rows, signs, targets, exercise.length_scale, tolerance)[0]


def _valid_by_pose(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    # Base, tool and directions are given. The tolerance is relative to the reach of the arm.
    moves = moves_with(tables, changes(variables_of(roles, samples)), IS_ANGLE[:, None])
    valid = np.asarray(moves.all(axis=(1, 2)))
    expected = reference_frames(exercise, convention, samples)[-1]
    reach = max(exercise.length_scale, float(np.abs(expected[:, :3, 3]).max()))
    # Most tables fail at the first sample.
    for chosen in (slice(0, 1), slice(None)):
        left = np.flatnonzero(valid)
        if left.size:
            reached = pose(np.moveaxis(tables[left][..., chosen], 0, 2), convention)
            error = np.abs(reached - expected[chosen])
            error[..., :3, 3] /= reach
            valid[left] = error.max(axis=(1, 2, 3)) <= tolerance
    return valid


def targets_of(
    roles: tuple[Role, ...], convention: Convention, mechanism: Mechanism, freedom: FrameFreedom
) -> list[Target]:
    """Return what each row must lead to: a joint axis, the frame of a fixed row, or the tool."""
    targets: list[Target] = []
    links, fixed = iter(mechanism.joints), iter(mechanism.fixed)
    last_joint = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    for i, role in enumerate(roles):
        kind, frame = TargetKind.FIXED, None
        if role.joint is not None:
            kind = TargetKind.PRISMATIC if role.joint.prismatic else TargetKind.REVOLUTE
            frame = next(links)
        elif i == len(roles) - 1 and convention is Convention.MODIFIED:
            # Only the Z of the last row leads from there to the tool, so z must lie on the tool's
            # z.
            frame = mechanism.tool
        elif i > last_joint:
            frame = next(fixed, None)
        targets.append(Target(kind, frame))
    tool = TargetKind.OPEN if freedom.tool else TargetKind.TOOL
    return [*targets, Target(tool, mechanism.tool)]


# --- Find the poses that frame 0 may have if the student chose it
#
# Poses are compared with all joint variables 0. The joint screws and the pose there determine a
# chain (Lynch and Park, *Modern Robotics*, section 4.1).


def possible_bases(
    links: Table,
    joint_signs: Integers,
    roles: tuple[Role, ...],
    mechanism: Mechanism,
    freedom: FrameFreedom,
) -> Iterator[Matrices | None]:
    """Yield the poses that the student's frame 0 may have in the reference frame 0.

    A pose is ``(L, 4, 4)`` for L samples; None means the identity. ``links`` ``(rows + 1, 4, L)``
    are the constants of the table, ``joint_signs`` ``(rows + 1,)`` the signs of its joint
    variables. A given tool frame allows one pose. Otherwise the joint axes must lie on those of the
    reference.
    """
    if not freedom.base:
        yield None
        return
    if np.isnan(links).any():
        return
    reached = products(standard_link(*links.swapaxes(0, 1)))
    axes = np.array(list(accumulate(mechanism.joints, np.matmul)))
    if not freedom.tool:
        yield axes[-1] @ mechanism.tool @ inverse(reached[-1])
        return
    starts = [i for i, role in enumerate(roles, start=1) if role.joint]
    sliding = np.array([role.joint.prismatic for role in roles if role.joint])
    either = [joint_signs[starts]]
    if freedom.directions:
        # The first axis and the next one that is not parallel to it fix the base's orientation.
        others = len(starts) - 1
        either = [np.array([z, *[x] * others]) for z, x in product((1, -1), repeat=2)]
    for signs in either:
        yield align_axes(directed(reached[starts], signs), axes, sliding)


def directed(frames: Matrices, signs: Integers) -> Matrices:
    """Return the frames, with the z axis reversed where the sign is −1."""
    directed = frames.copy()
    directed[signs < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return directed


# --- Replace angles that are rounded decimals, such as 1.57 for π/2, by the exact angles
#
# In a robot whose constant angles are multiples of 15°, a decimal means such a multiple if all its
# digits agree. So 2.094 means 2π/3, but 2.0951 does not. A pose computed from rounded angles is not
# exactly valid, so that the student's frames or missing cells could not be found.


STEP = np.pi / 12
EVERY_COLUMN = np.ones(len(COLUMNS), dtype=np.bool_)


def with_exact_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> tuple[Role, ...]:
    """Replace rounded angles in the rows of ``roles`` by the exact angles.

    A changed row keeps the student's numbers in ``as_written``.
    """
    slack = _slack_of_angles(roles, exercise, samples)
    if slack is None:
        return roles
    values = handed_in_values(roles)
    error = _rounding_errors(values, variables_of(roles, samples), slack)
    error = np.nan_to_num(error)
    exact = values - error[..., None]
    return tuple(
        replace(role, row=replace(role.row, values=exact[i], as_written=role.row.values))
        if role.row and error[i].any()
        else role
        for i, role in enumerate(roles)
    )


def known_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> NDArray[np.bool_]:
    """Return a mask ``(rows, 4)`` of the rounded angles whose exact values are known.

    These are all rounded angles if each of them agrees with a multiple of 15°, otherwise none: if
    one angle of a table is not a multiple, another angle may look like one by chance.
    """
    slack = _slack_of_angles(roles, exercise, samples)
    if slack is None:
        return np.zeros((len(roles), len(COLUMNS)), dtype=np.bool_)
    error = _rounding_errors(handed_in_values(roles), variables_of(roles, samples), slack)
    is_rounded = slack > 0
    return is_rounded & np.isfinite(error[is_rounded]).all()


def _slack_of_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> Numbers | None:
    # None if no angle is rounded, or if the robot has angles that are not multiples of 15°.
    if not any(role.row.has_decimal for role in roles if role.row):
        return None
    slack = slack_of_cells(roles, samples, IS_ANGLE)
    return slack if slack.any() and _turns_in_steps(exercise, samples) else None


def slack_of_cells(
    roles: tuple[Role, ...], samples: Samples, columns: NDArray[np.bool_] = EVERY_COLUMN
) -> Numbers:
    """Return the largest possible rounding error of each cell, 0 outside ``columns``."""
    slack = np.zeros((len(roles), len(COLUMNS)))
    for i, role in enumerate(roles):
        for column in np.flatnonzero(columns).tolist() if role.row else ():
            expression = role.row.entries[column].expression if role.row else None
            if expression is not None and expression.has_decimal:
                slack[i, column] = rounding_slack(expression, samples)
    return slack


def _rounding_errors(values: Numbers, variables: Numbers, slack: Numbers) -> Numbers:
    # NaN if the distance from a multiple of 15° is more than rounding can cause, or if the cell is
    # not a constant plus or minus its joint variable.
    signs = np.sign((changes(values) * changes(variables)).sum(axis=-1))
    constants = values - signs[..., None] * variables
    exact = STEP * np.round(constants[..., 0] / STEP)
    error = constants[..., 0] - exact
    is_rounded = (np.abs(error) <= slack) & (np.ptp(constants, axis=-1) < MULTIPLE_OF_STEP)
    return np.where(is_rounded, error, np.nan)


def _turns_in_steps(exercise: Exercise, samples: Samples) -> bool:
    def compute() -> bool:
        robot = exercise.robot
        values = at_home(robot.joints, samples.values, samples.count)
        table = robot.tables[robot.convention].values(values, samples.count)
        steps = table[:, IS_ANGLE] / STEP
        return bool(np.abs(steps - np.round(steps)).max() < MULTIPLE_OF_STEP)

    return samples.cached("turns in steps", compute)


# --- Slips in how a table was read: in the other convention, or in the other angle unit


@misconception(
    of=Rereadable,
    rank=10,
    code="other_convention",
    rule="convention",
    means=template(
        "the table follows the other convention: standard instead of modified, or modified "
        "instead of standard"
    ),
    example=("three-link-cartesian", "table", {"1/alpha": "0", "3/alpha": "-90deg"}, "degrees"),
    unlike={"3/d": "0", "3/theta": "d3"},
)
def other_convention(table: WrittenTable) -> Iterator[RepairedTable]:
    """The table follows the rules of the other convention."""
    if table.convention is Convention.STANDARD:
        finding = says(
            say(
                "The table is right in the modified (proximal) convention, but not in the "
                "standard (distal) one, which counts here: check which link's a and α belong in "
                "row i."
            ),
            say("In the standard (distal) convention a and α move by one row."),
        )
    else:
        finding = says(
            say(
                "The table is right in the standard (distal) convention, but not in the modified "
                "(proximal) one, which counts here: check which link's a and α belong in row i."
            ),
            say("In the modified (proximal) convention a and α move by one row."),
        )
    yield Repaired(replace(table, convention=table.convention.other), finding)


@misconception(
    of=Rereadable,
    rank=20,
    code="degrees_as_radians",
    rule="angle_unit",
    means=template("all angles are numbers of degrees, but were read in radians"),
    example=(
        "stanford-arm",
        "table",
        (
            "0, -90, 0, theta1 ↵ 0, 90, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, -90, 0, theta4 ↵ 0, 90, 0, "
            "theta5 ↵ 0, 0, d6, theta6"
        ),
    ),
    unlike="0, -pi/2, 0, 0 ↵ 0, pi/2, d2, 0 ↵ 0, 0, d3, 0 ↵ 0, -pi/2, 0, theta4 ↵ 0, pi/2, 0, "
    "theta5 ↵ 0, 0, d6, theta6",
)
def degrees_as_radians(table: WrittenTable) -> Iterator[RepairedTable]:
    """All angles were written in degrees, but are read in radians."""
    finding = says(
        say(
            "The angles were read in radians, but they fit in degrees: write the unit behind each "
            "(deg or °), or hand the table in with the angle unit degrees."
        ),
    )
    if np.abs(table.constants[:, IS_ANGLE]).max() > 2 * np.pi:
        yield Repaired(_rescaled(table, np.pi / 180), finding)


@misconception(
    of=Rereadable,
    rank=30,
    code="radians_as_degrees",
    rule="angle_unit",
    means=template("all angles are numbers of radians, but were read in degrees"),
    example=(
        "stanford-arm",
        "table",
        (
            "0, -1.5708, 0, theta1 ↵ 0, 1.5708, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, -1.5708, 0, theta4 ↵ "
            "0, 1.5708, 0, theta5 ↵ 0, 0, d6, theta6"
        ),
        "degrees",
    ),
    unlike={"3/theta": "d6", "6/d": "0"},
)
def radians_as_degrees(table: WrittenTable) -> Iterator[RepairedTable]:
    """All angles were written in radians, but are read in degrees."""
    finding = says(
        say(
            "The angles were read in degrees, but they fit in radians: write the unit behind each "
            "(rad), or hand the table in with the angle unit radians."
        ),
    )
    if np.abs(table.constants[:, IS_ANGLE]).max() <= np.radians(2 * np.pi):
        yield Repaired(_rescaled(table, 180 / np.pi), finding)


def _rescaled(table: WrittenTable, factor: float) -> WrittenTable:
    constants = table.constants.copy()
    constants[:, IS_ANGLE] *= factor
    return table.changed(constants)


# --- Remarks on frames that are valid but differ from the reference frames


OWN_FRAME_CHOICE: Final = "own_frame_choice"
_IDENTITY: Final = np.eye(4)


def remarks_on(
    relative_poses: Matrices,
    convention: Convention,
    exercise: Exercise,
    rows_right: NDArray[np.bool_] | None = None,
) -> tuple[Finding, ...]:
    """Return a finding (message) for each frame that differs from the reference frame.

    ``relative_poses`` ``(joints, samples, 4, 4)`` are the student's frames on the joint axes, as
    seen from the reference's frames. ``rows_right`` ``(joints, 2)`` says, for each axis, whether
    the rows before and after it are correct: a frame that differs because of a wrong row gets no
    finding.
    """
    error = np.abs(relative_poses - _IDENTITY)
    error[..., :3, 3] /= exercise.length_scale
    departs = error.reshape(len(error), -1).max(axis=1) > SAME_POSE
    if rows_right is not None:
        # A wrong row implies its own frames and those beside them, up to one of the reference's.
        runs = np.cumsum(~departs)
        implied = runs[departs & ~rows_right.all(axis=1)]
        departs &= ~np.isin(runs, implied)
    findings = []
    joints = compress(exercise.robot.joints, departs)
    for departed, joint in zip(relative_poses[departs], joints, strict=True):
        frame = joint.index - 1 if convention is Convention.STANDARD else joint.index
        departures = _departures(departed, frame, joint, exercise.length_scale)
        if departures:
            hint = paragraph(*departures)
            findings.append(Finding(OWN_FRAME_CHOICE, hint, severity=Severity.INFO))
    return tuple(findings)


def _departures(pose: Matrices, frame: int, joint: Joint, length_scale: float) -> list[Sentence]:
    departures = []
    x, z = f"x{frame}", f"z{frame}"
    rotation, origin = pose[:, :3, :3], pose[:, :3, 3]
    if (rotation[:, 2, 2] < 0).all():
        departures.append(
            say("You let {axis} point the opposite way; that is a valid choice.", axis=z)
        )
    if np.abs(rotation[:, 1, 0]).max() > SAME_POSE:
        departures.append(say("You turned {x} about {z}; that is a valid choice.", x=x, z=z))
    elif (rotation[:, 0, 0] < 0).all():
        departures.append(
            say("You let {axis} point the opposite way; that is a valid choice.", axis=x)
        )
    if np.abs(origin[:, :2]).max() > SAME_POSE * length_scale:
        departures.append(
            say(
                "You moved the axis of the sliding joint {joint} sideways; that is a valid choice.",
                joint=joint.index,
            )
        )
    elif np.abs(origin[:, 2]).max() > SAME_POSE * length_scale:
        departures.append(
            say(
                "You put origin {frame} elsewhere on {axis}; that is a valid choice.",
                frame=frame,
                axis=z,
            )
        )
    return departures
