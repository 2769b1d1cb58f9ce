"""Split a student's table into constants and motion, and find a misread convention or unit."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from service.catalogue import Joint
from service.grading.misconception import Repaired, misconception, says
from service.grading.numerics.joint_motion import joint_counts
from service.grading.numerics.samples import Samples
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.translations import say, template


class Rereadable:
    """A table that may have been written in the other convention or in the other angle unit."""


@dataclass(frozen=True, slots=True)
class WrittenTable(Rereadable):
    """A student's table ``(rows, 4, samples)``, angles in radians, every cell with a value.

    Each value is the sum of ``constants`` and ``motion``, which depends on the joint variables.
    """

    # ``reference`` is the reference's table if both have equally many rows. ``exchanges`` lists
    # pairs of lengths, each with the change of the table if the two are exchanged.
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
        """Return the table at a subset of the samples."""
        # The first ``count`` samples of each half.
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
