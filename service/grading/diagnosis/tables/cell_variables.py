"""Slips in the joint variables of a single table cell, or in its quantity."""

import re
from collections.abc import Callable

import numpy as np

from service.catalogue import Joint
from service.grading.diagnosis.formulas.quantity import quantity_of
from service.grading.diagnosis.wording import listed
from service.grading.diagnosis.wrong_value import WrongCell, finding_on
from service.grading.feedback import Finding
from service.grading.misconception import check
from service.grading.reading.absent_variables import absent_names, joint_counted
from service.kinematics.transforms import Numbers

CONVERTED = (
    "The joint variable was converted between degrees and radians. Leave out the factor: a joint "
    "variable is already an angle."
)


@check(
    of=WrongCell,
    rank=2,
    code="unknown_symbol",
    rule="of_column",
    means="the cell contains a length that the exercise does not have: d1 although joint 1 turns",
    example=("stanford-arm", "table", {"1/d": "d1"}),
    unlike={"6/d": "0"},
)
def unknown_length(case: WrongCell) -> Finding | None:
    """The cell contains a length that the exercise does not have: d1 where joint 1 turns."""
    name, joint = _absent(case)
    if joint is None or joint.prismatic:
        return None
    lengths = [name for name in case.samples.values if re.fullmatch(r"d_?\d+", name)]
    has = f" It has {', '.join(lengths)}." if lengths else ""
    return finding_on(case, f"This exercise has no {name}.{has}")


@check(
    of=WrongCell,
    rank=4,
    code="joint_variable_absent",
    rule="joint_variable",
    means="the cell contains a joint variable that the robot does not have: θ0, or θ3 if "
    "joint 3 slides",
    example=("stanford-arm", "table", {"3/theta": "theta3"}),
    unlike={"3/theta": "d3"},
)
def joint_variable_absent(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that the robot does not have."""
    name, joint = _absent(case)
    if not name:
        return None
    indices = [each.index for each in case.joints]
    why = f"its joints are {min(indices)} to {max(indices)}"
    if joint is not None:
        why = f"joint {joint.index} {_motion(joint)}, and its variable is {case.name(joint)}"
    return finding_on(case, f"This robot has no {name}: {why}.")


def _absent(case: WrongCell) -> tuple[str, Joint | None]:
    """Return a name in the cell that the robot does not have, and the joint with its number.

    The name is "" if the robot has all names; the joint is None if no joint has the number.
    """
    absent = sorted(absent_names([case.expression], case.samples))
    if not absent:
        return "", None
    index = joint_counted(absent[0])
    return absent[0], next((joint for joint in case.joints if joint.index == index), None)


@check(
    of=WrongCell,
    rank=20,
    code="joint_variable_missing",
    rule="joint_variable",
    means="the joint's variable is missing, so the table describes only the drawn pose",
    example=("stanford-arm", "table", {"1/theta": "0"}),
    unlike={"1/theta": "-theta1"},
)
def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The joint variable is missing, as if the table described the drawn pose."""
    if case.joint is None or not case.required or case.contained != {}:
        return None
    return finding_on(
        case,
        f"Joint {case.joint.index} {_motion(case.joint)}, so this cell must contain its variable.",
    )


def _motion(joint: Joint) -> str:
    return "slides along z" if joint.prismatic else "turns about z"


@check(
    of=WrongCell,
    rank=25,
    code="joint_variable_sign",
    rule="joint_variable",
    means="the joint variable has the wrong sign",
    example=("stanford-arm", "table", {"3/d": "-d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_sign(case: WrongCell) -> Finding | None:
    """The joint moves in the negative sense of its axis."""
    opposite = {joint: -count for joint, count in case.required.items()}
    if case.joint is None or not opposite or case.contained != opposite:
        return None
    return finding_on(
        case,
        f"The sign of the joint variable is wrong: check which way z points along this joint's "
        f"axis, and in which sense the joint {_motion(case.joint)}.",
    )


@check(
    of=WrongCell,
    rank=30,
    code="joint_variable_index",
    rule="joint_variable",
    means="the cell contains the variable of another joint",
    example=("stanford-arm", "table", {"2/theta": "theta1"}),
    unlike={"2/theta": "2*theta2"},
)
def joint_variable_index(case: WrongCell) -> Finding | None:
    """The cell contains the variable of a neighbouring joint."""
    other, count = case.contained_alone
    if not (case.joint and other and case.required) or other == case.joint or abs(count) != 1:
        return None
    return finding_on(
        case,
        f"This is the row of joint {case.joint.index}, but the cell contains {case.name(other)}, "
        f"the variable of joint {other.index}.",
    )


@check(
    of=WrongCell,
    rank=35,
    code="joint_variable_doubled",
    rule="joint_variable",
    means="the joint variable counts more than once",
    example=("three-link-cylindrical", "table", {"3/d": "2*d3"}),
    unlike={"1/d": "2*d1"},
)
def joint_variable_doubled(case: WrongCell) -> Finding | None:
    """The joint variable is counted more than once."""
    joint, count = case.contained_alone
    if joint is None or joint != case.joint or joint not in case.required or abs(count) < 2:
        return None
    return finding_on(
        case,
        f"The joint variable has a wrong factor: check how far the joint "
        f"{'slides' if joint.prismatic else 'turns'} when the variable grows by 1.",
    )


@check(
    of=WrongCell,
    rank=40,
    code="degrees_as_radians",
    rule="angle_unit",
    means="a number of degrees is read in radians, or a variable is multiplied by 180/π",
    example=("planar-rr", "table", {"1/theta": "180*theta1/pi"}),
    unlike={"1/d": "1"},
)
def cell_in_degrees(case: WrongCell) -> Finding | None:
    """The joint variable, or the whole cell, was multiplied by 180/π."""
    return finding_on(case, CONVERTED) if _is_converted(case, np.degrees) else None


@check(
    of=WrongCell,
    rank=45,
    code="radians_as_degrees",
    rule="angle_unit",
    means="a number of radians is read in degrees, or a variable is multiplied by π/180",
    example=("planar-rr", "table", {"1/theta": "pi*theta1/180"}),
    unlike={"1/d": "1"},
)
def cell_in_radians(case: WrongCell) -> Finding | None:
    """The joint variable, or the whole cell, was multiplied by π/180."""
    return finding_on(case, CONVERTED) if _is_converted(case, np.radians) else None


def _is_converted(case: WrongCell, convert: Callable[[Numbers], Numbers]) -> bool:
    if not case.angle or not case.required or case.contained is not None:
        return False
    constant = case.constants[1]
    moved, motion = case.actual - constant, case.expected - constant
    return case.equal(moved, convert(motion)) or case.equal(case.actual, convert(case.expected))


@check(
    of=WrongCell,
    rank=50,
    code="joint_variable_column",
    rule="joint_variable",
    means="the joint variable is in a column that must be constant: θ if the joint slides",
    example=("stanford-arm", "table", {"3/theta": "d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_column(case: WrongCell) -> Finding | None:
    """The joint variable is in the column that is constant for this kind of joint."""
    joint, _ = case.contained_alone
    if joint is None or joint != case.joint or case.required:
        return None
    moves, column = ("slides", "d") if joint.prismatic else ("turns", "θ")
    return finding_on(
        case,
        f"Joint {joint.index} {moves}, so its variable belongs in {column}; {case.symbol} is "
        f"constant here.",
    )


@check(
    of=WrongCell,
    rank=55,
    code="joint_variable_extra",
    rule="joint_variable",
    means="the cell contains a joint variable that it must not depend on",
    example=("stanford-arm", "table", {"2/d": "d2 + d3"}),
    unlike={"2/d": "d6"},
)
def joint_variable_extra(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that must not change it."""
    extra = [case.name(joint) for joint in case.contained or () if joint not in case.required]
    if not extra:
        return None
    return finding_on(
        case,
        f"The cell contains {listed(extra)}: check whether {case.symbol} changes with "
        f"{'it' if len(extra) == 1 else 'them'}.",
    )


@check(
    of=WrongCell,
    rank=60,
    code="wrong_quantity",
    rule="of_column",
    means="the cell is an angle but must be a length, or a length but must be an angle",
    example=("stanford-arm", "table", {"2/d": "90deg"}),
    unlike={"2/d": "d6"},
)
def wrong_quantity(case: WrongCell) -> Finding | None:
    """The cell is an angle instead of a length, or a length instead of an angle."""
    found = quantity_of(case.expression.tree)
    if found not in ("angle", "length") or (found == "angle") == case.angle:
        return None
    asked, written = ("an angle", "a length") if case.angle else ("a length", "an angle")
    return finding_on(case, f"{case.symbol} is {asked}, but {written} is written here.")
