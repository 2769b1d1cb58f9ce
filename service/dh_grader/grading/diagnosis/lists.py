"""Slips in a list of values: coordinates, sums of angles, single angles, Euler angles.

This file knows slips of numbers in a list. Slips in the table that lead to wrong coordinates are
searched in ``upstream.py``, slips in the formula of a value in ``matrices.py``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, combinations, permutations, product

import numpy as np

from dh_grader.expressions.printing import PLAIN
from dh_grader.expressions.vocabulary import Call, Node
from dh_grader.grading.diagnosis.formulas import WrongEntry, nodes
from dh_grader.grading.diagnosis.matrices import ENTRY_WORK, diagnose
from dh_grader.grading.diagnosis.motions import Chain, GivenMotion, named, other_poses
from dh_grader.grading.diagnosis.products import Displacements
from dh_grader.grading.diagnosis.upstream import (
    AFTER_SIGNS,
    Requirements,
    SlippedAnswers,
    SlipSearch,
)
from dh_grader.grading.judging import ComparedValues, Grading
from dh_grader.grading.misconception import (
    UNEXPLAINED,
    UNIT_FACTORS,
    AnyHypothesis,
    Explained,
    Hypotheses,
    Mask,
    Repaired,
    Written,
    WrongNumbers,
    WrongValue,
    check,
    diagnosed,
    differs,
    explanation,
    finding_on,
    misconception,
    other_length_unit,
    says,
)
from dh_grader.grading.numbers import (
    CONSTANT,
    EXACT_VALUE,
    ROUNDED_VALUE,
    WHOLE_MULTIPLE,
    difference,
)
from dh_grader.grading.report import Finding
from dh_grader.kinematics import SEQUENCES, Matrices, Numbers, from_angles
from dh_grader.translations import Sentence, listed, say, say_count, template

# --- Slips in a list of values; each value is a length, an angle or a number


# The work of explaining a whole list of values, as the budget counts it.
SEARCH_WORK = 15.0


def search_of(
    answers: SlippedAnswers | None, compared: ComparedValues, wrong: Mask, grading: Grading
) -> SlipSearch | None:
    """Return a search for mistakes in the robot's table that explain the list, or None."""
    if answers is None:
        return None
    student = compared.student
    return SlipSearch(
        answers,
        grading.samples,
        student.values,
        compared.expected,
        wrong,
        scale=compared.scales(grading),
        angle=np.array([[quantity == "angle"] for quantity in student.quantities]),
        name=grading.symbol_names(student.entries),
        unwritten=grading.unwritten(student.entries),
    )


def slips_of(
    compared: ComparedValues,
    wrong: Mask,
    grading: Grading,
    answers: SlippedAnswers | None = None,
) -> dict[tuple[int, int], Finding]:
    """Return the findings on the wrong values of a list; the keys are ``(index, 0)``.

    The work budget limits the findings. ``answers`` tells on which symbols each correct value
    depends.
    """
    student, scales = compared.student, compared.scales(grading)
    requirements = answers and Requirements(
        answers, grading.exercise, grading.samples, compared.expected, scales
    )
    spelling = grading.spelling(student.entries) if wrong.any() else PLAIN
    slips: dict[tuple[int, int], Finding] = {}
    for i in np.flatnonzero(wrong).tolist():
        if (expression := student.entries[i].expression) is None or not grading.affords(ENTRY_WORK):
            continue
        angle = student.quantities[i] == "angle"
        case = WrongEntry(
            expression=expression,
            actual=student.values[i],
            expected=compared.expected[i],
            samples=grading.samples,
            scale=float(scales[i]),
            angle=angle,
            correction=compared.corrections[i],
            spelling=spelling,
            turning=grading.exercise.vocabulary.turning,
            corrects=grading.corrects,
        )
        required = requirements.of(i) if requirements else None
        slips[i, 0] = diagnose_angle(case) if angle else diagnose(case, required)
    return slips


# --- Slips in the coordinates of a point


@dataclass(frozen=True)
class WrongPosition(WrongNumbers):
    """Wrong coordinates of a point: n values at each sample, ``(n, SAMPLES)``."""

    # The axes of the coordinates: 0, 1 or 2.
    axes: tuple[int, ...]
    # The links whose end is the point, if it is the end of a chain of links.
    chains: tuple[Chain, ...] = ()
    # Compares the point with the wrong answers that mistakes in the table lead to.
    slips: SlipSearch | None = None
    # The displacements in the formulas of the exercise.
    motion: GivenMotion | None = None

    @cached_property
    def slip(self) -> Explained | None:
        """The mistake in the table that explains all coordinates, or None."""
        every = np.ones(len(self.axes), dtype=np.bool_)
        return None if self.slips is None else self.slips.explanation(every)


@misconception(
    of=WrongPosition,
    rank=10,
    code="exchanged_coordinates",
    rule="position_vector",
    means="the coordinates are right, but in the wrong order",
    example=("planar-rr", "position", "[a1 s1 + a2 s12, a1 c1 + a2 c12]"),
    unlike="[a1 s1 - a2 s12, a1 c1 + a2 c12]",
)
def exchanged_coordinates(case: WrongPosition) -> Hypotheses:
    """The coordinates are correct, but in the wrong order."""
    names = ", ".join("xyz"[axis] for axis in case.axes)
    finding = says(
        say("These coordinates are in the wrong order: it must be {order}.", order=names)
    )
    for order in permutations(range(len(case.axes))):
        yield Written(case.expected[list(order)], finding)


@check(of=WrongPosition, rank=20)
def slip(case: WrongPosition) -> Explained | None:
    """A likely mistake in the table explains the position.

    It is likelier than a reversed position.
    """
    found = case.slip
    return None if found is None or found.findings[0].code in AFTER_SIGNS else found


@misconception(
    of=WrongPosition,
    rank=30,
    code="reversed_position",
    rule="position_vector",
    means="all signs are wrong: the vector leads from the point to the origin",
    example=("planar-rr", "position", "[-a1 c1 - a2 c12, -a1 s1 - a2 s12]"),
    unlike="[a1 c1 + a2 c12, -a1 s1 - a2 s12]",
)
def reversed_position(case: WrongPosition) -> Hypotheses:
    """All signs are wrong: the vector leads from the point to the origin."""
    finding = says(
        say("Every coordinate has the wrong sign: check where the vector must start and end."),
    )
    yield Written(-case.expected, finding)


@check(of=WrongPosition, rank=40)
def slip_after_signs(case: WrongPosition) -> Explained | None:
    """A less likely mistake in the table explains the position.

    It is less likely than a reversed position.
    """
    return case.slip


@misconception(
    of=WrongPosition,
    rank=45,
    code="other_length_unit",
    rule="position_vector",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=("planar-rr", "position", "[1000*(a1 c1 + a2 c12), 1000*(a1 s1 + a2 s12)]"),
    unlike="[1000*(a1 c1 - a2 c12), 1000*(a1 s1 - a2 s12)]",
)
def length_unit(case: WrongPosition) -> Hypotheses:
    """The coordinates are in a wrong unit of length."""
    for times in UNIT_FACTORS:
        yield Written(times * case.expected, other_length_unit(times))


@misconception(of=WrongPosition, rank=50)
def other_pose(case: WrongPosition) -> Hypotheses:
    """The position is that of a wrong pose, such as the pose of a wrong frame.

    A constant position, such as the origin itself, does not show which pose it belongs to.
    """
    for pose in other_poses(case.chains):
        position = np.moveaxis(pose.answer, 0, -1)[list(case.axes), 3]
        if np.ptp(position, axis=-1).max() > EXACT_VALUE:
            # Translators: {pose} is a name such as "the pose of frame {2}".
            found = named(pose, template("This position comes from {pose}. {advice}"))
            yield Written(position, found, record=pose.record)


@check(of=WrongPosition, rank=60)
def displacement(case: WrongPosition) -> Explained | None:
    """The correct position is a sum of displacements, and the student added them wrongly."""
    return None if case.motion is None else explanation(case, case.motion, Displacements)


# --- Slips in an angle that is a sum of joint angles


# An angle of more addends is not taken apart: ten addends have a thousand subsets.
MAX_ADDENDS = 6


def addends(case: WrongValue) -> dict[str, int]:
    """Return the factor of each symbol in the correct angle: {"theta1": 1, "theta2": -1}.

    The result is empty if the correct angle is not a sum of angles.
    """
    names = list(case.samples.values)
    columns = [case.samples.values[name] for name in names]
    system = np.stack([*columns, np.ones_like(case.expected)], axis=1)
    found = np.linalg.lstsq(system, case.expected, rcond=None)[0]
    counts = np.round(found[:-1])
    is_sum = np.abs(found[:-1] - counts).max(initial=0.0) < WHOLE_MULTIPLE
    if is_sum and np.abs(system @ found - case.expected).max() < WHOLE_MULTIPLE:
        return {name: int(count) for name, count in zip(names, counts, strict=True) if count}
    return _computed(case, names)


def _computed(case: WrongValue, names: Sequence[str]) -> dict[str, int]:
    # A computed angle may differ from the sum of its symbols by whole turns.
    sums = [
        dict(zip(some, signs, strict=True))
        for count in (1, 2)
        for some in combinations(names, count)
        for signs in product((1, -1), repeat=count)
    ]
    rest = case.expected - np.array([_sum_of(case, counts) for counts in sums])
    off = np.abs(difference(rest, rest[:, :1], angle=True)).max(axis=1)
    return sums[int(off.argmin())] if off.min() < WHOLE_MULTIPLE else {}


def _sum_of(case: WrongValue, counts: Mapping[str, int]) -> Numbers:
    return np.asarray(sum(count * case.samples.values[name] for name, count in counts.items()))


@dataclass(frozen=True, slots=True)
class WrongSum:
    """A wrong angle whose correct value is a sum of angles."""

    case: WrongValue
    # The factor of each symbol in the correct angle.
    counts: Mapping[str, int]

    @classmethod
    def of(cls, case: WrongValue) -> "WrongSum":
        """Make a ``WrongSum`` from a wrong value."""
        return cls(case, addends(case))

    def named(self, names: Iterable[str]) -> str:
        """Return a phrase with the names of the symbols, as the student spells them."""
        return listed([self.case.spelling.names.get(name, name) for name in names])

    def subsets(self) -> Iterator[tuple[tuple[str, ...], Numbers]]:
        """Yield the names and the sum of each smaller set of the angles."""
        names = list(self.counts) if len(self.counts) <= MAX_ADDENDS else []
        for some in chain.from_iterable(combinations(names, k) for k in range(1, len(names))):
            yield some, _sum_of(self.case, {name: self.counts[name] for name in some})

    def others(self) -> Iterator[tuple[str, Numbers]]:
        """Yield the symbols that do not belong in the sum, with their values."""
        for name in sorted(self.case.expression.symbols) if self.counts else ():
            if name not in self.counts:
                yield name, self.case.samples.values[name]


@misconception(
    of=WrongSum,
    rank=10,
    code="joint_variable_missing",
    rule="angle_sum",
    means="one or more angles are missing in a sum of angles",
    example=("planar-rrr-standard", "task-space", {"3/1": "q1"}),
    unlike={"3/1": "2*q1 + q2 + q3"},
)
def left_out(wrong: WrongSum) -> Hypotheses:
    """Some angles are missing in the sum."""
    for names, part in wrong.subsets():
        hint = say_count(
            "{angles} is missing from this angle. Check which angles add up to it.",
            "{angles} are missing from this angle. Check which angles add up to it.",
            count=len(names),
            angles=wrong.named(names),
        )
        yield Written(wrong.case.expected - part, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=60,
    code="joint_variable_missing",
    rule="angle_sum",
    means="one or more angles are missing in a sum of angles",
    example=("baxter-left-arm", "wrist", {"3/1": "0"}),
    unlike={"3/1": "theta7/2"},
)
def constant(wrong: WrongSum) -> Hypotheses:
    """The student wrote a constant instead of a sum of angles."""
    if wrong.counts and np.ptp(wrong.case.actual) < CONSTANT:
        hint = say(
            "This angle is constant, but it must not be: check which variables it depends on."
        )
        yield Written(wrong.case.actual, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=20,
    code="joint_variable_sign",
    rule="angle_sum",
    means="an angle in a sum of angles has the wrong sign",
    example=("planar-rr", "task-space", {"3/1": "q1 - q2"}),
    unlike={"3/1": "0"},
)
def reversed_addends(wrong: WrongSum) -> Hypotheses:
    """Some angles have the wrong sign in the sum."""
    for names, part in wrong.subsets():
        hint = say_count(
            "{angles} has the wrong sign in this angle: check which way this turn counts positive.",
            "{angles} have the wrong sign in this angle: check which way this turn counts "
            "positive.",
            count=len(names),
            angles=wrong.named(names),
        )
        yield Written(wrong.case.expected - 2 * part, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=30,
    code="joint_variable_doubled",
    rule="angle_sum",
    means="an angle in a sum of angles counts twice",
    example=("spherical-wrist", "zyz", {"1/1": "2*theta4"}),
    unlike={"1/1": "π/2"},
)
def counted_twice(wrong: WrongSum) -> Hypotheses:
    """An angle is counted twice in the sum."""
    for name, count in wrong.counts.items():
        hint = say(
            "{angle} counts twice in this angle. Check which angles add up to it.",
            angle=wrong.named([name]),
        )
        written = wrong.case.expected + count * wrong.case.samples.values[name]
        yield Written(written, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=40,
    code="joint_variable_extra",
    rule="angle_sum",
    means="a sum of angles contains one too many",
    example=("spherical-wrist", "zyz", "[theta4 + theta6, theta5, theta6]"),
    unlike={"1/1": "theta5"},
)
def added(wrong: WrongSum) -> Hypotheses:
    """The sum contains an angle that should not be in the sum."""
    for name, value in wrong.others():
        hint = say(
            "{angle} does not belong in this angle: check which two directions it is measured "
            "between.",
            angle=wrong.named([name]),
        )
        for sign in (1, -1):
            finding = finding_on(wrong.case, hint)
            yield Written(wrong.case.expected + sign * value, finding)


@misconception(
    of=WrongSum,
    rank=50,
    code="joint_variable_index",
    rule="angle_sum",
    means="a sum of angles contains the angle of another joint in place of the right one",
    example=("baxter-left-arm", "wrist", {"1/1": "theta4"}),
    unlike={"3/1": "0"},
)
def of_another_joint(wrong: WrongSum) -> Hypotheses:
    """The sum contains the angle of a wrong joint."""
    for other, value in wrong.others():
        for name, count in wrong.counts.items():
            hint = say(
                "{angle} stands in the place of another angle: check which two directions it is "
                "measured between.",
                angle=wrong.named([other]),
            )
            written = wrong.case.expected + count * (value - wrong.case.samples.values[name])
            yield Written(written, finding_on(wrong.case, hint))


# --- Slips in a single angle


WRONG_SIGN = say(
    "The sign of this angle is wrong: an angle counts positive by the right-hand rule about its "
    "axis."
)
FITS_IN_DEGREES = say(
    "This angle was read in radians, but it fits in degrees: write the unit behind it (deg or °)."
)
FITS_IN_RADIANS = say(
    "This angle was read in degrees, but it fits in radians: write the unit behind it (rad)."
)
CONVERTED = say(
    "This angle was converted between degrees and radians. Leave out the factor: a joint variable "
    "and a function such as atan2 already give the angle."
)
ARGUMENTS_SWAPPED = say(
    "The arguments of atan2 are exchanged: in atan2(y, x) the part of the sine comes first, that "
    "of the cosine second."
)
NOT_RIGHT = say("This angle is not right: check which two directions it is measured between.")


class WrongAngle(WrongValue):
    """A wrong angle; misconceptions about angles are registered under this class."""


def diagnose_angle(case: WrongValue) -> Finding:
    """Return the finding on a wrong angle."""
    finding = diagnosed(case, of=WrongAngle)
    assert finding is not None
    return finding


@misconception(
    of=WrongAngle,
    rank=100,
    code="sign",
    rule="elementary_turn",
    means="the sign of an angle is wrong",
    example=("spherical-wrist", "zyz", "[-theta4, theta5, theta6]"),
    unlike="[theta4, theta5, theta6 + 1]",
)
def sign(case: WrongValue) -> Hypotheses:
    """The angle has the wrong sign."""
    yield Written(-case.expected, finding_on(case, WRONG_SIGN))


@misconception(
    of=WrongAngle,
    rank=110,
    code="degrees_as_radians",
    rule="angle_unit",
    means="a number of degrees is read in radians, or a variable is multiplied by 180/π",
    example=("spherical-wrist", "zyz", "[180*theta4/pi, theta5]"),
    unlike={"2/1": "0"},
)
def degrees_as_radians(case: WrongValue) -> Hypotheses:
    """The angle was written in degrees, but is read in radians."""
    hint = FITS_IN_DEGREES if is_constant(case.actual) else CONVERTED
    yield Repaired(np.radians(case.actual), finding_on(case, hint))


@misconception(
    of=WrongAngle,
    rank=120,
    code="radians_as_degrees",
    rule="angle_unit",
    means="a number of radians is read in degrees, or a variable is multiplied by π/180",
    example=("spherical-wrist", "zyz", "[pi*theta4/180, theta5]"),
    unlike={"2/1": "0"},
)
def radians_as_degrees(case: WrongValue) -> Hypotheses:
    """The angle was written in radians, but is read in degrees."""
    hint = FITS_IN_RADIANS if is_constant(case.actual) else CONVERTED
    yield Repaired(np.degrees(case.actual), finding_on(case, hint))


def is_constant(angle: Numbers) -> bool:
    """True if an angle ``(SAMPLES,)`` is a constant."""
    return bool(np.ptp(angle) < CONSTANT)


@misconception(
    of=WrongAngle,
    rank=130,
    code="lost_quadrant",
    rule="atan2",
    means="atan, acos or asin is used for atan2, so the angle is right only for some joint values",
    example=("spherical-wrist", "zyz", "[atan(s4/c4), theta5, theta6]"),
    unlike={"3/1": "theta6/2"},
)
def lost_quadrant(case: WrongValue) -> Hypotheses:
    """The student used atan(y/x) instead of atan2(y, x)."""
    opposite = np.abs(difference(case.actual, case.expected, angle=True)) > np.pi / 2
    if opposite.any() and not opposite.all():
        finding = finding_on(
            case,
            say(
                "This angle is right for some joint values only: atan(y/x) gives one angle for two "
                "opposite directions. Use atan2(y, x)."
            ),
        )
        yield Written(case.expected + np.pi * opposite, finding, tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=140,
    code="lost_quadrant",
    rule="atan2",
    means="atan, acos or asin is used for atan2, so the angle is right only for some joint values",
    example=("several-kinds", "angle", "[asin(l*sin(phi)/sqrt(a^2 + l^2 + 2*a*l*cos(phi))), e1]"),
    unlike="[asind(e1), a]",
)
def lost_sign(case: WrongValue) -> Hypotheses:
    """The student used acos or asin instead of atan2."""
    names = {
        "acos": (
            -case.expected,
            say(
                "This angle is right for some joint values only: acos gives no negative angle. "
                "Use atan2(y, x)."
            ),
        ),
        "asin": (
            np.pi - case.expected,
            say(
                "This angle is right for some joint values only: asin gives no angle over 90°. "
                "Use atan2(y, x)."
            ),
        ),
    }
    for function, (other, hint) in names.items():
        if _calls(case.expression.tree, function):
            is_other = np.abs(difference(case.actual, other, angle=True)) < ROUNDED_VALUE
            written = np.where(is_other, other, case.expected)
            yield Written(written, finding_on(case, hint), tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=150,
    code="half_turn",
    rule="atan2",
    means="an angle is off by 180°",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + pi]"),
    unlike="[theta6, theta5, theta4]",
)
def half_turn(case: WrongValue) -> Hypotheses:
    """The angle differs by half a turn (180°) from the correct angle."""
    finding = finding_on(
        case,
        say(
            "This angle is off by half a turn: check its signs, and in atan2 those of both "
            "arguments."
        ),
        otherwise=say("It is off by half a turn (180°)."),
    )
    yield Written(case.expected + np.pi, finding, tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=160,
    code="swapped_atan2",
    rule="atan2",
    means="the arguments of atan2 are exchanged",
    example=("spherical-wrist", "zyz", "[atan2(c4, s4), theta5]"),
    unlike={"3/1": "theta6/2"},
)
def swapped_atan2(case: WrongValue) -> Hypotheses:
    """The arguments of atan2 were exchanged.

    If the angle is a constant and no arctangent, a wrong quarter turn is more likely.
    """
    if np.ptp(case.expected) > ROUNDED_VALUE or is_arctangent(case.expression.tree):
        yield Written(np.pi / 2 - case.expected, finding_on(case, ARGUMENTS_SWAPPED))


def is_arctangent(tree: Node) -> bool:
    """True if the formula is an arctangent, not only contains one."""
    return isinstance(tree, Call) and tree.function in ("atan2", "atan")


def _calls(tree: Node, *functions: str) -> bool:
    return any(isinstance(node, Call) and node.function in functions for node in nodes(tree))


@misconception(
    of=WrongAngle,
    rank=170,
    code="quarter_turn",
    rule="elementary_turn",
    means="an angle is off by 90°",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + pi/2]"),
    unlike="[theta4, theta5, theta6 + pi]",
)
def quarter_turn(case: WrongValue) -> Hypotheses:
    """The angle differs by 90° from the correct angle."""
    finding = finding_on(case, NOT_RIGHT, otherwise=say("It is off by a quarter turn (90°)."))
    error = difference(case.actual, case.expected, angle=True)
    yield Written(case.expected + np.copysign(np.pi / 2, error), finding, tolerance=ROUNDED_VALUE)


@check(of=WrongAngle, rank=200)
def of_sum(case: WrongValue) -> Explained | None:
    """The correct angle is a sum, and the student made a mistake in this sum."""
    return explanation(case, WrongSum.of(case))


@check(
    of=WrongAngle,
    rank=300,
    code=UNEXPLAINED,
    rule="euler_sequence",
    means="the value is wrong, and no other code explains it",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + 1]"),
    unlike="[theta4, theta5, theta6 + pi]",
)
def unexplained(case: WrongValue) -> Finding:
    """No misconception explains the angle."""
    return differs(case, NOT_RIGHT)


# --- Slips in the three Euler angles of a rotation


@dataclass(frozen=True)
class WrongTriple:
    """Three angles that do not describe the correct rotation."""

    # (3, SAMPLES), with a value everywhere.
    angles: Numbers
    # The correct rotation, (SAMPLES, 3, 3).
    rotation: Matrices
    # The names of the axes, such as ZYZ.
    sequence: str
    # True for fixed axes, False for moving axes.
    fixed: bool
    # Which angles were written with an arctangent.
    arctangents: Sequence[bool] = (False, False, False)

    @property
    def is_right(self) -> bool:
        """True if the angles describe the correct rotation."""
        described = from_angles(self.sequence, self.angles.T, fixed=self.fixed)
        return bool(np.abs(described - self.rotation).max() < ROUNDED_VALUE)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Yield the misconceptions that explain the three angles."""
        return (hypothesis for hypothesis in hypotheses if hypothesis.answer.is_right)


RepairedTriple = Repaired[WrongTriple]


def explain_triple(case: WrongTriple) -> Explained | None:
    """Return the misconception that explains the three angles, or None.

    The entries of the result are the angles that have the slip.
    """
    return None if case.is_right else explanation(case)


@misconception(
    of=WrongTriple,
    rank=10,
    code=("sign", "degrees_as_radians", "radians_as_degrees", "swapped_atan2"),
    rule="euler_sequence",
    means=(
        "one or more angles have the wrong sign",
        "one or more angles are in degrees, but are read in radians",
        "one or more angles are in radians, but are read in degrees",
        "the arguments of atan2 are exchanged in one or more angles",
    ),
    example=("spherical-wrist", "zyz", "[atan2(c4, s4), theta5, theta6]"),
    unlike="[theta4, theta5, theta6 + 1]",
)
def some_angles(case: WrongTriple) -> Iterator[RepairedTriple]:
    """One or more of the three angles have the same mistake."""
    angles = case.angles
    repairs = (
        (-angles, Finding("sign", WRONG_SIGN, say("Change its sign."))),
        (np.radians(angles), Finding("degrees_as_radians", FITS_IN_DEGREES)),
        (np.degrees(angles), Finding("radians_as_degrees", FITS_IN_RADIANS)),
        (
            np.pi / 2 - angles,
            Finding("swapped_atan2", ARGUMENTS_SWAPPED, say("Exchange them.")),
        ),
    )
    may_be_swapped = (np.ptp(angles, axis=1) > ROUNDED_VALUE) | np.array(case.arctangents)
    for count in (1, 2, 3):
        for repaired, finding in repairs:
            for subset in combinations(range(3), count):
                slipped = np.isin(np.arange(3), subset)
                if finding.code == "swapped_atan2" and not may_be_swapped[slipped].all():
                    continue
                mixed = np.where(slipped[:, None], repaired, angles)
                worded = _on_angles(finding, angles[slipped])
                yield Repaired(replace(case, angles=mixed), worded, slipped)


def _on_angles(finding: Finding, angles: Numbers) -> Finding:
    # A hint on the unit of angles that vary is reworded.
    is_of_unit = finding.hint in (FITS_IN_DEGREES, FITS_IN_RADIANS)
    if is_of_unit and not all(map(is_constant, angles)):
        return replace(finding, hint=CONVERTED)
    return finding


@misconception(
    of=WrongTriple,
    rank=20,
    code="angle_order",
    rule="euler_sequence",
    means="the angles are right, but in the wrong order",
    example=("spherical-wrist", "zyz", "[theta6, theta5, theta4]"),
    unlike={"1/1": "theta5"},
)
def other_order(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles are correct, but in the wrong order."""
    finding = says(
        say(
            "These angles are right, but in another order: the first angle is that of the first "
            "axis of the sequence."
        ),
        say("The order here is that of the axes {sequence}.", sequence=case.sequence),
    )
    for order in ([2, 1, 0], [1, 0, 2], [0, 2, 1], [1, 2, 0], [2, 0, 1]):
        yield Repaired(replace(case, angles=case.angles[order]), finding)


@misconception(
    of=WrongTriple,
    rank=30,
    code="inverse_rotation",
    rule="inverse",
    means="the angles describe the inverse rotation",
    example=("spherical-wrist", "zyz", "[-theta6, -theta5, -theta4]"),
    unlike={"1/1": "theta5"},
)
def inverse_rotation(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles describe the inverse rotation."""
    finding = says(
        say("These angles describe the inverse rotation: the first frame as seen from the last."),
        say("Take them from the matrix whose columns are the axes of the last frame."),
    )
    yield Repaired(replace(case, rotation=np.swapaxes(case.rotation, 1, 2)), finding)


@misconception(
    of=WrongTriple,
    rank=40,
    code="other_euler_sequence",
    rule="euler_sequence",
    means="the angles belong to another sequence of axes, or to fixed instead of moving axes",
    example=("spherical-wrist", "zyz", "[theta4 + pi/2, theta5, theta6 - pi/2]"),
    unlike={"3/1": "theta6/2"},
)
def other_sequence(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles belong to another sequence of axes, or to fixed instead of moving axes."""
    others = sorted(
        ((sequence, fixed) for sequence in SEQUENCES for fixed in (False, True)),
        key=lambda other: (other[0] != case.sequence, other[1] != case.fixed),
    )
    asked = _asked_for(case.sequence, fixed=case.fixed)
    for sequence, fixed in others:
        finding = says(
            _of_another_sequence(sequence, fixed=fixed),
            asked,
        )
        yield Repaired(replace(case, sequence=sequence, fixed=fixed), finding)


def _of_another_sequence(sequence: str, *, fixed: bool) -> Sentence:
    if fixed:
        return say(
            "These are the right angles of another sequence: {sequence} about fixed axes.",
            sequence=sequence,
        )
    return say(
        "These are the right angles of another sequence: {sequence} about moving axes.",
        sequence=sequence,
    )


def _asked_for(sequence: str, *, fixed: bool) -> Sentence:
    if fixed:
        return say("Asked for are those of {sequence} about fixed axes.", sequence=sequence)
    return say("Asked for are those of {sequence} about moving axes.", sequence=sequence)
