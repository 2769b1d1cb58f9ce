"""Every tolerance of the kinematics, each with its reason.

Poses are compared in a unit of length that suits the robot.
"""

# A product of twenty matrices in double precision has an error of about 1e-15; different choices of
# a student differ by at least about 1e-4.

from typing import Final

# Poses, relative poses and joint screws are equal if no entry differs by more.
SAME_POSE: Final = 1e-7
SAME_SCREW: Final = 1e-7

# Two axes are parallel if the norm of the cross product of their directions is smaller. Near 0 it
# equals the angle; with the cosine, axes 4 mrad apart would seem parallel. Parallel axes coincide
# if their distance is smaller.
PARALLEL: Final = 1e-7
# An axis that determines a basis must be clearly not parallel, because of a division by this sine.
CLEARLY_NOT_PARALLEL: Final = 100 * PARALLEL
# Parallel axes whose angles are rounded to three figures deviate from parallel by less than this.
NOT_PARALLEL_BY_ROUNDING: Final = 3e-2
# An x axis is along a common normal if the absolute value of the cosine differs less from 1.
ALONG_NORMAL: Final = 1e-6
# An x axis is along z if its projection on the plane perpendicular to z is shorter.
X_ALONG_Z: Final = 1e-9

# Frames of two hypotheses that would lead to the same table. It is wider than SAME_POSE: keeping a
# hypothesis twice wastes a place in the beam, and a dropped one has an equal one.
SAME_HYPOTHESIS: Final = 1e-6

# Smaller singular values, relative to the largest, are 0: it is far above rounding errors, and far
# below the values of any arm in a generic pose.
ZERO_SINGULAR_VALUE: Final = 1e-7

# Euler angles: the outer axes coincide if the sine (or cosine) of the middle angle is smaller.
OUTER_AXES_ALIGNED: Final = 1e-7

# A shorter ω is a rounding error, not an axis of rotation.
NO_ROTATION: Final = 1e-12

# The error of an exact table cell, as a multiple of its column's unit.
EXACT_CELL: Final = 1e-9
# The error of a rounded table cell, as a multiple of its column's unit.
ROUNDED_CELL: Final = 1e-3
# The largest numbers of the reference robot, as multiples of the column's unit: an angle is at most
# π, a length not much longer than the longest link.
LARGEST_ANGLE: Final = 4.0
LARGEST_LENGTH: Final = 1.5
