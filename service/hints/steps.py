"""The three steps of a hint for a message of a report.

A hint is made from the message and its place, never from the correct answer. So it reveals no more
than the message.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Final

from service.catalogue import Exercise, PartSpec, Robot
from service.catalogue.parts.dh_row import DhRowSpec
from service.catalogue.parts.dh_table import DhTableSpec
from service.catalogue.parts.find_slip import FindSlipSpec
from service.catalogue.parts.frames import FramesSpec
from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.grading.kinds.find_slip import MARKED
from service.grading.misconception import all_records
from service.grading.report import (
    Feedback,
    PartReport,
    RuleName,
    Severity,
    Verdict,
    messages_of,
)
from service.hints.rules import OF_COLUMN, RULES, SCREENS
from service.kinematics.dh import Convention
from service.translations import Sentence, say

STEPS: Final = 3
# The codes of messages on mistakes that no record of a misconception has.
_WITHOUT_RECORD: Final = frozenset(
    {"frames_of_other_convention", "no_joint_variable", "slip_elsewhere"}
)
_IN_WORDS: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}
# The rule for a message whose code has no record of its own.
_OF_KIND: Final[Mapping[str, RuleName]] = {
    "dh_table": "of_column",
    "dh_row": "of_column",
    "position": "position_vector",
    "vector": "position_vector",
    "euler_angles": "euler_sequence",
    "screw_axes": "screw_axis",
}


@dataclass(frozen=True, slots=True)
class Topic:
    """The message of a report that a hint explains, by its code and one of its places."""

    part: str
    code: str
    row: str | None = None
    cell: str | None = None


@dataclass(frozen=True, slots=True)
class HintStep:
    """A step of a hint.

    ``rule`` is the rule whose picture is shown with the step, or None. ``screen`` is the page of
    *DH in ten minutes* that explains the rule, or "".
    """

    title: str
    text: str
    convention: Convention
    rule: RuleName | None = None
    screen: str = ""


def has_hints(message: Feedback, verdict: Verdict) -> bool:
    """True if a message is about a mistake, and not about an unreadable or empty cell."""
    unread = (Verdict.UNREADABLE, Verdict.MISSING)
    return message.severity is Severity.ERROR and verdict not in unread


def may_have_hints(topic: Topic, answers: Mapping[str, object]) -> bool:
    """True if the report on some answers to the same parts could have this message."""
    return answers.get(topic.part) is not None and topic.code in _codes()


@cache
def _codes() -> frozenset[str]:
    return _WITHOUT_RECORD.union(*(record.codes for record in all_records()))


def hint_step(
    exercise: Exercise,
    topic: Topic,
    step: int,
    answers: Mapping[str, object],
    told: PartReport | None,
) -> HintStep | None:
    """Return step 1, 2 or 3 of the hint for a message; None if the report has no such message.

    ``told`` is the report on the part of the topic.
    """
    part = exercise.part(topic.part)
    message = None if told is None else _message(told, topic)
    if part is None or told is None or message is None:
        return None
    if isinstance(part, FindSlipSpec):
        part = part.table
    convention = _convention(exercise, part, answers.get(part.id), told)
    name = _rule_name(message, topic, part)
    rule = RULES[name]
    if step == 2:
        pictured = name if rule.pictured else None
        screen = SCREENS.get(name, "")
        return HintStep(rule.title, rule.stated(convention), convention, pictured, screen)
    text = rule.look if step == 1 else rule.apply
    fields = _fields(topic, part, convention, told)
    return HintStep(rule.title, say(text, **fields), convention)


def _message(report: PartReport, topic: Topic) -> Feedback | None:
    for message, places, verdict in messages_of(report):
        at = {(place.row, place.cell) for place in places}
        is_there = (topic.row, topic.cell) in at if at else topic.row is None
        if message.code == topic.code and is_there:
            return message if has_hints(message, verdict) else None
    return None


def _rule_name(message: Feedback, topic: Topic, part: PartSpec) -> RuleName:
    rule = message.rule or _OF_KIND.get(part.kind, "product")
    if rule == "of_column":
        return OF_COLUMN.get(topic.cell or "", "convention")
    if rule == "joint_variable" and (not _has_axes(part) or topic.row is None):
        return "dependence"
    return rule


def _has_axes(part: PartSpec) -> bool:
    return isinstance(part, DhTableSpec | DhRowSpec)


def _convention(
    exercise: Exercise, part: PartSpec, answer: object, report: PartReport
) -> Convention:
    """Return the convention in which the answer was read."""
    # For a part without a convention, return the robot's convention. If the robot has no DH table,
    # return the standard convention.
    if isinstance(part, DhRowSpec | FramesSpec | LinkTransformsSpec):
        return part.convention
    if not isinstance(part, DhTableSpec):
        robot = exercise.reference
        return robot.convention if isinstance(robot, Robot) else Convention.STANDARD
    if isinstance(part.convention, Convention):
        return part.convention
    named = answer.get("convention") if isinstance(answer, dict) else None
    if named in (Convention.STANDARD, Convention.MODIFIED):
        return Convention(named)
    taken = (each.message for each in report.feedback if each.code == "convention_taken")
    said = next(taken, "")
    return Convention.MODIFIED if Convention.MODIFIED in said else Convention.STANDARD


def _fields(
    topic: Topic, part: PartSpec, convention: Convention, report: PartReport
) -> dict[str, str]:
    labels = [row.label for row in report.rows if row.label != MARKED]
    if isinstance(part, DhTableSpec) and topic.row in labels:
        index = labels.index(topic.row)
        before, here = (labels[index - 1] if index else "0"), topic.row
        x_before, x_here = _axis("x", before), _axis("x", here)
        z_before, z = _axis("z", before), _axis("z", here)
    else:
        x_before, z_before = (
            say("the {letter} axis of the frame before", letter=letter) for letter in "xz"
        )
        x_here, z = (say("the {letter} axis of this frame", letter=letter) for letter in "xz")
    is_modified = convention is Convention.MODIFIED
    return {
        "row": topic.row or "",
        "x_before": x_before,
        "x_here": x_here,
        "z_before": z_before,
        "z": z,
        "x": x_before if is_modified else x_here,
        "axis": z if is_modified else z_before,
        "entry": _entry(topic),
    }


def _axis(letter: str, label: str) -> str:
    """Return the name of an axis: z1, x_e, or "the z axis e2"."""
    if label.isdecimal():
        return f"{letter}{label}"
    if len(label) == 1:
        return f"{letter}_{label}"
    return say("the {letter} axis {label}", letter=letter, label=label)


def _entry(topic: Topic) -> Sentence:
    if topic.row is None:
        return say("the answer")
    if topic.cell is None:
        return say("row {row}", row=topic.row)
    if topic.cell in _IN_WORDS:
        return say("{symbol} in row {row}", symbol=_IN_WORDS[topic.cell], row=topic.row)
    return say("row {row}, column {column}", row=topic.row, column=topic.cell)
