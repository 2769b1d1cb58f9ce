"""Slips in the joint variables or the quantity (length or angle) of a table cell."""

import re
from collections.abc import Callable

import numpy as np

from service.catalogue import Joint
from service.grading.diagnosis.formulas.quantity import quantity_of
from service.grading.diagnosis.wrong_value import WrongCell, finding_on
from service.grading.feedback import Finding
from service.grading.misconception import check
from service.grading.reading.absent_variables import joint_counted
from service.kinematics.transforms import Numbers
from service.translations import listed, say, template

CONVERTED = say(
    "The joint variable was converted between degrees and radians. Leave out the factor: a joint "
    "variable is already an angle."
)


@check(
    of=WrongCell,
    rank=2,
    code="unknown_symbol",
    rule="of_column",
    means=template(
        "the cell contains a length that the exercise does not have: d1 although joint 1 turns"
    ),
    example=("stanford-arm", "table", {"1/d": "d1"}),
    unlike={"6/d": "0"},
)
def unknown_length(case: WrongCell) -> Finding | None:
    """The cell contains a length that the exercise does not have."""
    name, joint = _absent(case)
    if joint is None or joint.prismatic:
        return None
    lengths = [name for name in case.samples.values if re.fullmatch(r"d_?\d+", name)]
    hint = say("This exercise has no {name}.", name=name)
    if lengths:
        hint = say(
            "This exercise has no {name}. It has {lengths}.", name=name, lengths=", ".join(lengths)
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=4,
    code="joint_variable_absent",
    rule="joint_variable",
    means=template(
        "the cell contains a joint variable that the robot does not have: θ0, or θ3 if "
        "joint 3 slides"
    ),
    example=("stanford-arm", "table", {"3/theta": "theta3"}),
    unlike={"3/theta": "d3"},
)
def joint_variable_absent(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that the robot does not have."""
    name, joint = _absent(case)
    if not name:
        return None
    if joint is None:
        indices = [each.index for each in case.joints]
        hint = say(
            "This robot has no {name}: its joints are {first} to {last}.",
            name=name,
            first=min(indices),
            last=max(indices),
        )
    else:
        # A turning joint has no variable d, which is a length that the exercise does not have.
        hint = say(
            "This robot has no {name}: joint {joint} slides along z, and its variable is "
            "{variable}.",
            name=name,
            joint=joint.index,
            variable=case.name(joint),
        )
    return finding_on(case, hint)


def _absent(case: WrongCell) -> tuple[str, Joint | None]:
    # A variable that the robot does not have ("" if there is none), and the joint with its number.
    absent = sorted(case.samples.absent_names([case.expression]))
    if not absent:
        return "", None
    index = joint_counted(absent[0])
    return absent[0], next((joint for joint in case.joints if joint.index == index), None)


@check(
    of=WrongCell,
    rank=20,
    code="joint_variable_missing",
    rule="joint_variable",
    means=template("the joint's variable is missing, so the table describes only the drawn pose"),
    example=("stanford-arm", "table", {"1/theta": "0"}),
    unlike={"1/theta": "-theta1"},
)
def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The joint variable is missing in the cell."""
    if case.joint is None or not case.required or case.contained != {}:
        return None
    joint = case.joint.index
    hint = say("Joint {joint} turns about z, so this cell must contain its variable.", joint=joint)
    if case.joint.prismatic:
        hint = say(
            "Joint {joint} slides along z, so this cell must contain its variable.", joint=joint
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=25,
    code="joint_variable_sign",
    rule="joint_variable",
    means=template("the joint variable has the wrong sign"),
    example=("stanford-arm", "table", {"3/d": "-d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_sign(case: WrongCell) -> Finding | None:
    """The joint variable has the wrong sign."""
    opposite = {joint: -count for joint, count in case.required.items()}
    if case.joint is None or not opposite or case.contained != opposite:
        return None
    hint = say(
        "The sign of the joint variable is wrong: check which way z points along this joint's "
        "axis, and in which sense the joint turns about z."
    )
    if case.joint.prismatic:
        hint = say(
            "The sign of the joint variable is wrong: check which way z points along this joint's "
            "axis, and in which sense the joint slides along z."
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=30,
    code="joint_variable_index",
    rule="joint_variable",
    means=template("the cell contains the variable of another joint"),
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
        say(
            "This is the row of joint {joint}, but the cell contains {variable}, the variable of "
            "joint {other}.",
            joint=case.joint.index,
            variable=case.name(other),
            other=other.index,
        ),
    )


@check(
    of=WrongCell,
    rank=35,
    code="joint_variable_doubled",
    rule="joint_variable",
    means=template("the joint variable counts more than once"),
    example=("three-link-cylindrical", "table", {"3/d": "2*d3"}),
    unlike={"1/d": "2*d1"},
)
def joint_variable_doubled(case: WrongCell) -> Finding | None:
    """The joint variable is counted more than once."""
    joint, count = case.contained_alone
    if joint is None or joint != case.joint or joint not in case.required or abs(count) < 2:
        return None
    hint = say(
        "The joint variable has a wrong factor: check how far the joint turns when the variable "
        "grows by 1."
    )
    if joint.prismatic:
        hint = say(
            "The joint variable has a wrong factor: check how far the joint slides when the "
            "variable grows by 1."
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=40,
    code="degrees_as_radians",
    rule="angle_unit",
    means=template("a number of degrees is read in radians, or a variable is multiplied by 180/π"),
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
    means=template("a number of radians is read in degrees, or a variable is multiplied by π/180"),
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
    means=template(
        "the joint variable is in a column that must be constant: θ if the joint slides"
    ),
    example=("stanford-arm", "table", {"3/theta": "d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_column(case: WrongCell) -> Finding | None:
    """The joint variable is in a column that must be constant."""
    joint, _ = case.contained_alone
    if joint is None or joint != case.joint or case.required:
        return None
    hint = say(
        "Joint {joint} turns, so its variable belongs in θ; {symbol} is constant here.",
        joint=joint.index,
        symbol=case.symbol,
    )
    if joint.prismatic:
        hint = say(
            "Joint {joint} slides, so its variable belongs in d; {symbol} is constant here.",
            joint=joint.index,
            symbol=case.symbol,
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=55,
    code="joint_variable_extra",
    rule="joint_variable",
    means=template("the cell contains a joint variable that it must not depend on"),
    example=("stanford-arm", "table", {"2/d": "d2 + d3"}),
    unlike={"2/d": "d6"},
)
def joint_variable_extra(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that should not be in the cell."""
    extra = [case.name(joint) for joint in case.contained or () if joint not in case.required]
    if not extra:
        return None
    hint = say(
        "The cell contains {variables}: check whether {symbol} changes with them.",
        variables=listed(extra),
        symbol=case.symbol,
    )
    if len(extra) == 1:
        hint = say(
            "The cell contains {variable}: check whether {symbol} changes with it.",
            variable=extra[0],
            symbol=case.symbol,
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=60,
    code="wrong_quantity",
    rule="of_column",
    means=template("the cell is an angle but must be a length, or a length but must be an angle"),
    example=("stanford-arm", "table", {"2/d": "90deg"}),
    unlike={"2/d": "d6"},
)
def wrong_quantity(case: WrongCell) -> Finding | None:
    """The cell is an angle instead of a length, or a length instead of an angle."""
    found = quantity_of(case.expression.tree)
    if found not in ("angle", "length") or (found == "angle") == case.angle:
        return None
    hint = say("{symbol} is a length, but an angle is written here.", symbol=case.symbol)
    if case.angle:
        hint = say("{symbol} is an angle, but a length is written here.", symbol=case.symbol)
    return finding_on(case, hint)
