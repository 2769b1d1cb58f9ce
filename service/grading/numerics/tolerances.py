"""All tolerances of grading, with their reasons.

Unless stated otherwise, lengths are in units of the exercise's typical length, and angles are in
radians.
"""

# Tolerances of poses are in kinematics.

from typing import Final

# The difference of equal answers: far above the floating-point error of a formula with 200
# operations, far below any slip. Relative to the scale of the expected value, which does not depend
# on the draw.
EXACT_VALUE: Final = 1e-9
# The floating-point error of values far larger than their scale, relative to their size. It is so
# small that the draw, on which the size depends, does not matter.
FLOATING_POINT: Final = 1e-12
# The distance of the true number from a decimal, in units of its last place: half a unit in either
# direction if it was rounded, nearly one unit away from 0 if digits were cut off. 0.999 is not 1.
ROUNDED_UP: Final = 0.5 + 1e-6
CUT_OFF: Final = 1 - 1e-3
# The difference of two numbers with three figures, when slips are guessed. Relative to their size.
ROUNDED_VALUE: Final = 1e-3
# The difference of an angle from that of the intended triple: too small to fit both triples.
SAME_TRIPLE: Final = 1e-6

# The difference of a cell in the right answer from the lazy one, if their formulas are equal.
SAME_CONTENT: Final = 1e-9

# The difference of a change with the joints from the expected change.
SAME_MOTION: Final = 1e-6
# The least change between samples of a value that moves with the joints: the joints' ranges are far
# wider, and 1e-8 q is not a motion.
MOVES: Final = 0.01

# The variation of a constant over all samples.
CONSTANT: Final = 1e-9
# The variation of an entry that is printed as a number: practically none.
PRINTED_NUMBER: Final = 1e-12
# The difference of a number from a whole multiple of a letter or a fraction of π: larger, because
# the number is the remainder of a least-squares fit.
WHOLE_MULTIPLE: Final = 1e-6
# The difference of two terms (multiples of a letter, or numbers) when slips are compared.
SAME_TERM: Final = 1e-6
# The difference of a constant angle from a multiple of 15°.
MULTIPLE_OF_STEP: Final = 1e-9
# The difference of a factor between two units of length from a whole number.
SAME_FACTOR: Final = 1e-9

# The least difference from a cell of the reference at the first sample that rounding cannot
# explain, so that the table is not the reference's own.
PLAINLY_DIFFERENT: Final = 0.02
# A length is huge, and loses figures, if it is larger than the robot's lengths by this factor.
HUGE_LENGTH: Final = 100.0
# The largest error of a cell that the lost figures of a huge length can explain.
HUGE_CELL: Final = 1e-6

# The difference of a right cell from the intended table. INTENDED_CELL is for tables in the wrong
# convention or angle unit, for which both are computed from the same numbers.
UNCHANGED_CELL: Final = 1e-9
INTENDED_CELL: Final = 1e-6
# The difference of an intended table's pose from the reference's: products of rounded angles over a
# whole arm lose four figures. Relative to the arm's reach.
INTENDED_POSE: Final = 1e-2

# The difference of a matrix from the link transform of the row that was computed from it.
LINK_TRANSFORM: Final = 1e-6

# A student's arm that later parts follow from may have rounded numbers. These are the differences
# of its frames from rigid ones, and between the axes of one joint at two joint values.
NOT_RIGID: Final = 5e-3
SAME_AXIS: Final = 2e-2
# The singular value that counts as 0 for such an arm, relative to the largest one. Real arms have
# singular values of 1 %: a larger limit would refuse them at some samples and not at others.
NO_MOTION: Final = 1e-3
