"""Slips in the joints and lengths of a robot that is given by a table or by screws."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import combinations

import numpy as np

from service.catalogue import Exercise, Joint
from service.grading.diagnosis.upstream.slip import CellChange, Slip, SymbolChange
from service.grading.diagnosis.upstream.slip_kinds import (
    DISTANCE_LEFT_OUT,
    HALF_TURN,
    HOME_POSITION,
    JOINT_VARIABLE_DOUBLED,
    JOINT_VARIABLE_INDEX,
    JOINT_VARIABLE_MISSING,
    JOINT_VARIABLE_SIGN,
    LENGTHS_EXCHANGED,
    OTHER_LENGTH,
    QUARTER_TURN,
    SIGN,
)
from service.grading.misconception import Record
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.kinematics.transforms import Numbers

Axis = Callable[[Joint], str]
# Robots have a handful of lengths. With more, pairs are not tried.
MAX_LENGTHS = 12


def joint_slips(moved: Sequence[Joint], joints: Sequence[Joint], axis: Axis) -> Iterator[Slip]:
    """Yield the slips in the variables of the ``moved`` joints.

    ``joints`` are all joints. ``axis`` returns advice on the direction of a joint's axis.
    """
    for joint in moved:
        yield joint_variable_sign(joint, axis)
        yield joint_variable_missing(joint)
        similar = [each for each in joints if each.prismatic == joint.prismatic and each != joint]
        # The nearest joint first: its variable is the likeliest to be taken.
        for other in sorted(similar, key=lambda each: abs(each.index - joint.index)):
            yield _joint_variable_index(joint, other)
        yield _joint_variable_doubled(joint)
        if not joint.prismatic:
            yield from _zero_position(joint)


def joint_variable_sign(joint: Joint, axis: Axis, *cells: CellChange) -> Slip:
    """Return the slip: the joint moves in the negative sense of its axis."""
    verb = "slides" if joint.prismatic else "counts"
    return Slip(
        JOINT_VARIABLE_SIGN,
        f"joint {joint.index} {verb} the wrong way",
        f"check the sign of its variable. {axis(joint)}",
        f"Change the sign of {{{joint.variable}}} throughout.",
        symbols=(SymbolChange(joint.variable, joint.variable, -1.0),),
        cells=cells,
    )


def joint_variable_missing(joint: Joint, *cells: CellChange) -> Slip:
    """Return the slip: the joint's variable is left out, as if the joint could not move."""
    verb = "moves" if joint.prismatic else "turns"
    return Slip(
        JOINT_VARIABLE_MISSING,
        f"joint {joint.index} stands still",
        f"check what must change with {{{joint.variable}:its variable}}.",
        f"Joint {joint.index} {verb} with {{{joint.variable}}}.",
        symbols=(SymbolChange(joint.variable, joint.variable, 0.0),),
        cells=cells,
    )


def _joint_variable_index(joint: Joint, other: Joint) -> Slip:
    """Return the slip: the joint moves by the variable of another joint."""
    verb = "moves" if joint.prismatic else "turns"
    return Slip(
        JOINT_VARIABLE_INDEX,
        f"joint {joint.index} {verb} with {{{other.variable}:another variable}}",
        f"that is the variable of joint {other.index}.",
        f"Joint {joint.index} {verb} with {{{joint.variable}}}.",
        symbols=(SymbolChange(joint.variable, other.variable),),
    )


def _joint_variable_doubled(joint: Joint) -> Slip:
    """Return the slip: the joint variable is counted twice."""
    verb = "moves" if joint.prismatic else "turns"
    return Slip(
        JOINT_VARIABLE_DOUBLED,
        f"joint {joint.index} {verb} twice as far as {{{joint.variable}:its variable}}",
        "count each joint variable once.",
        f"Joint {joint.index} {verb} by {{{joint.variable}}}.",
        symbols=(SymbolChange(joint.variable, joint.variable, 2.0),),
    )


def _zero_position(joint: Joint) -> Iterator[Slip]:
    """Yield the slips: the joint's angle is measured from another zero position."""
    yield _turned_joint(joint, QUARTER_TURN, np.pi / 2, "a quarter turn (90°)")
    yield _turned_joint(joint, QUARTER_TURN, -np.pi / 2, "a quarter turn (90°)")
    yield _turned_joint(joint, HALF_TURN, np.pi, "half a turn (180°)")


def _turned_joint(joint: Joint, kind: Record, turn: float, error: str) -> Slip:
    return Slip(
        kind,
        f"joint {joint.index} starts from another position",
        f"check how the link lies when {{{joint.variable}:its variable}} is 0.",
        f"{{{joint.variable}}} is off by {error}.",
        symbols=(SymbolChange(joint.variable, joint.variable, 1.0, turn),),
    )


def home_slip(joints: Sequence[Joint]) -> Iterator[Slip]:
    """Yield the slip of an answer for the home position."""
    if len(joints) > 1:
        yield Slip(
            HOME_POSITION,
            "all joints stand in their home position",
            "the answer must change with the joints.",
            symbols=tuple(SymbolChange(each.variable, each.variable, 0.0) for each in joints),
        )


def length_slips(lengths: Sequence[str], alone: Iterable[str] = ()) -> Iterator[Slip]:
    """Yield the slips in these lengths.

    If a length is ``alone`` in its cell, its sign and its omission are slips of the cell.
    """
    in_cells = set(alone)
    for length in lengths:
        if length not in in_cells:
            yield _length_sign(length)
            yield _length_left_out(length)
    if len(lengths) <= MAX_LENGTHS:
        for one, other in combinations(lengths, 2):
            yield _exchanged(one, other)
            yield _other_length(one, other)
            yield _other_length(other, one)


def _length_sign(length: str) -> Slip:
    return Slip(
        SIGN,
        f"the length {{{length}:of one link}} has the wrong sign",
        "check along which axis it is measured, and which way.",
        f"Change the sign of {{{length}}} throughout.",
        symbols=(SymbolChange(length, length, -1.0),),
    )


def _length_left_out(length: str) -> Slip:
    return Slip(
        DISTANCE_LEFT_OUT,
        f"the length {{{length}:of one link}} is left out",
        "check which frames it lies between.",
        symbols=(SymbolChange(length, length, 0.0),),
    )


def _exchanged(one: str, other: str) -> Slip:
    return Slip(
        LENGTHS_EXCHANGED,
        f"the lengths {{{one}:of one link}} and {{{other}:of another}} are exchanged",
        "check which link each of them belongs to.",
        f"Write {{{one}}} for {{{other}}}, and {{{other}}} for {{{one}}}.",
        symbols=(SymbolChange(one, other), SymbolChange(other, one)),
    )


def _other_length(right: str, written: str) -> Slip:
    return Slip(
        OTHER_LENGTH,
        f"the length {{{written}:of one link}} stands where another length belongs",
        "check which link it belongs to.",
        f"It is {{{right}}}.",
        symbols=(SymbolChange(right, written),),
    )


def axis_direction(exercise: Exercise, samples: Samples) -> Axis:
    """Return a function that says how a joint's axis points at home; it computes on demand."""

    @cache
    def screws() -> Numbers:
        assert exercise.reference is not None
        return exercise.reference.screws(samples.values, samples.count)[:, 0]

    def direction(joint: Joint) -> str:
        first = exercise.joints[0].index - 1
        screw = screws()[exercise.joints.index(joint)]
        cosine = screw[5] if joint.prismatic else screw[2]
        if cosine < -1 + SAME_MOTION:
            return f"Its axis points opposite to z{first}."
        if cosine > 1 - SAME_MOTION:
            return f"Its axis points along z{first}."
        return "Check which way its axis points."

    return direction
