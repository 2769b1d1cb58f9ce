"""Every tolerance of the kinematics, each with its reason.

Poses are compared in a unit of length that suits the robot, so that one number serves lengths and
direction cosines. Double precision leaves about 1e-15 after a product of twenty matrices; no two
choices that a student can make lie closer than about 1e-4.
"""

from typing import Final

# Poses, relative poses and joint screws: the largest difference between two entries.
SAME_POSE: Final = 1e-7
SAME_SCREW: Final = 1e-7

# Two axes: the norm of the cross product of their directions, which near 0 is the angle itself (a
# cosine near 1 would call axes parallel that are 4 mrad apart); and how far one passes the other.
PARALLEL: Final = 1e-7
# An axis that helps to fix a basis must be far from parallel, for it is divided by this sine.
CLEARLY_NOT_PARALLEL: Final = 100 * PARALLEL
# Two axes that are parallel but for angles with three figures are not farther from it.
NOT_PARALLEL_BY_ROUNDING: Final = 3e-2
# An x axis that lies along a common normal, one way or the other: its cosine, less 1.
ALONG_NORMAL: Final = 1e-6
# An x axis along z: the length of its projection on the plane across z.
X_ALONG_Z: Final = 1e-9

# Frames of two hypotheses that would lead to the same table. Wider than SAME_POSE: a hypothesis
# that is kept twice costs a place in the beam, one that is dropped has a twin.
SAME_HYPOTHESIS: Final = 1e-6

# A singular value, relative to the largest: far above rounding, far below any arm in generic pose.
ZERO_SINGULAR_VALUE: Final = 1e-7

# Euler angles: the sine (or cosine) of the middle angle where the outer axes are one line.
OUTER_AXES_ALIGNED: Final = 1e-7

# An ω this short is no axis of rotation, but what rounding has left.
NO_ROTATION: Final = 1e-12

# A cell of a table, as a multiple of the unit of its column: exact beyond all doubt.
EXACT_CELL: Final = 1e-9
# The same for a rounded cell of a table in which others are rounded, too.
ROUNDED_CELL: Final = 1e-3
# How many times its unit a number of the robot's own may be: an angle goes up to π, a length hardly
# beyond the longest link.
LARGEST_ANGLE: Final = 4.0
LARGEST_LENGTH: Final = 1.5
