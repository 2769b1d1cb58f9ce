"""Every tolerance of grading, each with its reason; those of poses are in kinematics.

Lengths are measured in the exercise's typical length, angles in radians, unless it is said
otherwise.
"""

from typing import Final

# Two answers: far above what floating point does to a formula of 200 operations, far below any
# slip. Relative to the scale of the expected value, which is the same in every draw.
EXACT_VALUE: Final = 1e-9
# What floating point does to values far larger than their scale, relative to their size: so little
# that the draw, on which the size depends, decides nothing.
FLOATING_POINT: Final = 1e-12
# How far the true number may lie from a decimal, in units of its last place: half a unit either way
# if it was rounded, nearly a whole one further from 0 if digits were cut off. 0.999 is not 1.
ROUNDED_UP: Final = 0.5 + 1e-6
CUT_OFF: Final = 1 - 1e-3
# Two numbers with three figures, in guesses which slip explains another. Relative to their size.
ROUNDED_VALUE: Final = 1e-3
# An angle, and that of a triple: which one a student took. So narrow that no angle is in both.
SAME_TRIPLE: Final = 1e-6

# A cell of the right answer, and of the lazy one: formulas of the same value.
SAME_CONTENT: Final = 1e-9

# By how much a value changes with the joints, and by how much it should.
SAME_MOTION: Final = 1e-6
# By how much a value must change from sample to sample to move with the joints at all: joints are
# drawn from ranges far wider, and 1e-8 q is no motion.
MOVES: Final = 0.01

# A value, and the same at all samples: then it is a constant.
CONSTANT: Final = 1e-9
# An entry that is printed as a number must not vary at all.
PRINTED_NUMBER: Final = 1e-12
# A number, and a whole multiple of a letter or a fraction of π: looser, since what is left over
# after a least-squares fit is compared.
WHOLE_MULTIPLE: Final = 1e-6
# Two constants in the comparison of slips, letters and numbers apart.
SAME_TERM: Final = 1e-6
# A constant angle, and a multiple of 15°.
MULTIPLE_OF_STEP: Final = 1e-9
# A factor between two units of length, and the whole number that it stands for.
SAME_FACTOR: Final = 1e-9

# A cell, and the reference's, at the first sample: beyond what rounding does, so that the table is
# certainly not the reference's own.
PLAINLY_DIFFERENT: Final = 0.02
# A length so many times the robot's own loses figures; but no cell so many that it is this far off.
HUGE_LENGTH: Final = 100.0
HUGE_CELL: Final = 1e-6

# A cell as written, and in the intended table: if they differ, the cell is wrong. Where the
# convention or the unit of all angles was mistaken, both are computed from the same numbers.
UNCHANGED_CELL: Final = 1e-9
INTENDED_CELL: Final = 1e-6
# The pose of an intended table, and the reference's: rounded angles that are multiplied over a
# whole arm lose four figures. Relative to the arm's reach.
INTENDED_POSE: Final = 1e-2

# A matrix, and the link transform of the row that was computed from it.
LINK_TRANSFORM: Final = 1e-6

# A student's arm that later parts follow from may hold rounded numbers: its frames and a rigid one,
# the axis of a joint at two places of the joint, lengths in the exercise's typical length.
NOT_RIGID: Final = 5e-3
SAME_AXIS: Final = 2e-2
# The singular value, relative to the largest, that counts as 0 for such an arm.
NO_MOTION: Final = 1e-2
