"""Slips in the joint variables of a robot that is given by a table or by screw axes."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache

import numpy as np

from service.catalogue import Exercise, Joint
from service.grading.diagnosis.upstream.slip import CellChange, Names, Slip, SlipWords, SymbolChange
from service.grading.diagnosis.upstream.slip_kinds import (
    HALF_TURN,
    HOME_POSITION,
    JOINT_VARIABLE_DOUBLED,
    JOINT_VARIABLE_INDEX,
    JOINT_VARIABLE_MISSING,
    JOINT_VARIABLE_SIGN,
    QUARTER_TURN,
)
from service.grading.misconception import Record
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.kinematics.transforms import Numbers
from service.translations import Sentence, paragraph, say

Axis = Callable[[Joint], Sentence]


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
    """Return the slip in which a joint variable has the wrong sign."""

    def words(names: Names) -> SlipWords:
        hint = say(
            "Joint {joint} moves the wrong way: check the sign of its variable.", joint=joint.index
        )
        return SlipWords(
            say("joint {joint} moves the wrong way", joint=joint.index),
            paragraph(hint, axis(joint)),
            say("Change the sign of {name} throughout.", name=names.name(joint.variable)),
        )

    symbols = (SymbolChange(joint.variable, joint.variable, -1.0),)
    return Slip(JOINT_VARIABLE_SIGN, words, symbols=symbols, cells=cells)


def joint_variable_missing(joint: Joint, *cells: CellChange) -> Slip:
    """Return the slip in which a joint variable is missing."""

    def words(names: Names) -> SlipWords:
        index, name = joint.index, names.shown(joint.variable)
        hint = say(
            "Joint {joint} stands still: check what must change with its variable.", joint=index
        )
        if name:
            hint = say(
                "Joint {joint} stands still: check what must change with {name}.",
                joint=index,
                name=name,
            )
        correction = _moves_with(joint, names.name(joint.variable))
        return SlipWords(say("joint {joint} stands still", joint=index), hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 0.0),)
    return Slip(JOINT_VARIABLE_MISSING, words, symbols=symbols, cells=cells)


def _moves_with(joint: Joint, name: str) -> Sentence:
    return say("Joint {joint} moves with {name}.", joint=joint.index, name=name)


def _joint_variable_index(joint: Joint, other: Joint) -> Slip:
    def words(names: Names) -> SlipWords:
        # The student wrote this variable, so its name gives nothing away.
        index, name = joint.index, names.name(other.variable)
        clause = say("joint {joint} moves with {name}", joint=index, name=name)
        hint = say(
            "Joint {joint} moves with {name}: that is the variable of joint {other}.",
            joint=index,
            name=name,
            other=other.index,
        )
        return SlipWords(clause, hint, _moves_with(joint, names.name(joint.variable)))

    symbols = (SymbolChange(joint.variable, other.variable),)
    return Slip(JOINT_VARIABLE_INDEX, words, symbols=symbols)


def _joint_variable_doubled(joint: Joint) -> Slip:
    def words(names: Names) -> SlipWords:
        index, name = joint.index, names.shown(joint.variable)
        clause = say("joint {joint} moves twice as far as its variable", joint=index)
        hint = say(
            "Joint {joint} moves twice as far as its variable: count each joint variable once.",
            joint=index,
        )
        if name:
            clause = say("joint {joint} moves twice as far as {name}", joint=index, name=name)
            hint = say(
                "Joint {joint} moves twice as far as {name}: count each joint variable once.",
                joint=index,
                name=name,
            )
        correction = say(
            "Joint {joint} moves by {name}.", joint=index, name=names.name(joint.variable)
        )
        return SlipWords(clause, hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 2.0),)
    return Slip(JOINT_VARIABLE_DOUBLED, words, symbols=symbols)


def _zero_position(joint: Joint) -> Iterator[Slip]:
    # The joint's angle is measured from another zero position.
    yield _turned_joint(joint, QUARTER_TURN, np.pi / 2)
    yield _turned_joint(joint, QUARTER_TURN, -np.pi / 2)
    yield _turned_joint(joint, HALF_TURN, np.pi)


def _turned_joint(joint: Joint, kind: Record, turn: float) -> Slip:
    def words(names: Names) -> SlipWords:
        hint = say(
            "Joint {joint} starts from another position: check how the link lies when its variable "
            "is 0.",
            joint=joint.index,
        )
        variable = names.name(joint.variable)
        correction = say("{name} is off by a quarter turn (90°).", name=variable)
        if kind is HALF_TURN:
            correction = say("{name} is off by half a turn (180°).", name=variable)
        clause = say("joint {joint} starts from another position", joint=joint.index)
        return SlipWords(clause, hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 1.0, turn),)
    return Slip(kind, words, symbols=symbols)


def home_slip(joints: Sequence[Joint]) -> Iterator[Slip]:
    """Yield the slip in which all joint variables are 0."""
    if len(joints) > 1:
        symbols = tuple(SymbolChange(each.variable, each.variable, 0.0) for each in joints)
        yield Slip(HOME_POSITION, _at_home, symbols=symbols)


def _at_home(_: Names) -> SlipWords:
    return SlipWords(
        say("all joints stand in their home position"),
        say("All joints stand in their home position: the answer must change with the joints."),
    )


def axis_direction(exercise: Exercise, samples: Samples) -> Axis:
    """Return a function that says in words which way the axis of a joint points."""

    # The axes are computed on the first call of the returned function.
    @cache
    def screws() -> Numbers:
        assert exercise.reference is not None
        return exercise.reference.screws(samples.values, samples.count)[:, 0]

    def direction(joint: Joint) -> Sentence:
        first = exercise.joints[0].index - 1
        at = exercise.joints.index(joint)
        cosine = screws()[at, 5 if joint.prismatic else 2]
        # Earlier joints turn the axis, unless they turn about an axis along z.
        turning = [not each.prismatic for each in exercise.joints[:at]]
        if (np.abs(screws()[:at][turning, 2]) < 1 - SAME_MOTION).any():
            cosine = 0.0
        if cosine < -1 + SAME_MOTION:
            return say("Its axis points opposite to {axis}.", axis=f"z{first}")
        if cosine > 1 - SAME_MOTION:
            return say("Its axis points along {axis}.", axis=f"z{first}")
        return say("Check which way its axis points.")

    return direction
