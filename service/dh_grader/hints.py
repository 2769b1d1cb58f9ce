"""Hints on demand: three steps for a message, the rules of DH, and their pictures.

The steps say more and more; only the third names the correct entry.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import islice
from typing import Final

import numpy as np

from dh_grader.catalogue import Exercise, FeedbackLevel, PartSpec, Robot
from dh_grader.catalogue.kinds import (
    DhRowSpec,
    DhTableSpec,
    FindSlipSpec,
    FramesSpec,
    LinkTransformsSpec,
)
from dh_grader.figures.drawing import Caption, Label, MotionArrow, Sheet, Theme, around, arrowhead
from dh_grader.figures.mechanism import View
from dh_grader.figures.solids import Camera, polyline
from dh_grader.grading import Submission, grade
from dh_grader.grading.kinds.tables import MARKED
from dh_grader.grading.misconception import all_records
from dh_grader.grading.report import Feedback, PartReport, RuleName, Severity, Verdict, messages_of
from dh_grader.kinematics import Convention, Numbers
from dh_grader.regex import regex
from dh_grader.translations import ENGLISH, Language, Sentence, say, template, told

# --- The three steps of a hint for a message of a report
#
# A hint is made from the message and its place, never from the correct answer. So it reveals no
# more than the message.


STEPS: Final = 3
# The codes of messages on mistakes that no record of a misconception has.
_WITHOUT_RECORD: Final = frozenset(
    {"frames_of_other_convention", "no_joint_variable", "slip_elsewhere"}
)
_PRINTED: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}
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
    if topic.cell in _PRINTED:
        return say("{symbol} in row {row}", symbol=_PRINTED[topic.cell], row=topic.row)
    return say("row {row}, column {column}", row=topic.row, column=topic.cell)


# --- The rules of DH and of kinematics that hints explain, each in three sentences
#
# A rule never contains a value of the answer. Its sentences ``look`` and ``apply`` may name rows,
# axes and frames of the exercise, by fields such as ``{row}`` and ``{z_before}``.
#
# The field ``rule`` in a record of a misconception names a rule. ``look`` and ``apply`` may have
# these fields: ``{row}``, the axes ``{z_before}`` and ``{z}``, ``{x_before}`` and ``{x_here}``, the
# axis ``{x}`` of the parameters a and α, the axis ``{axis}`` of d and θ, and ``{entry}``, the place
# in an answer that is not a table.


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: where to look, what the rule says, and how it applies to a row.

    ``modified`` is the statement in the modified convention if it differs from ``statement``.
    ``pictured`` are the parameters in the rule's picture; without them, there is no picture.
    """

    # ``look`` and ``apply`` are templates, the other texts are sentences.

    title: str
    look: str
    statement: str
    apply: str
    modified: str = ""
    pictured: tuple[str, ...] = ()

    def stated(self, convention: Convention) -> str:
        """Return what the rule says in a convention."""
        is_modified = convention is Convention.MODIFIED
        return self.modified if is_modified and self.modified else self.statement


# The screens of *DH in ten minutes* that explain a rule.
SCREENS: Final[Mapping[RuleName, str]] = {
    "link_length": "a",
    "link_twist": "alpha",
    "link_offset": "d",
    "joint_angle": "theta",
    "joint_variable": "theta",
    "rows": "table",
    "convention": "table",
    "frame_z": "frames",
    "frame_origin": "frames",
    "frame_x": "frames",
}

RULES: Final[Mapping[RuleName, Rule]] = {
    "link_length": Rule(
        say("Link length a"),
        template(
            "Look at {z_before} and {z}: a in row {row} is the distance between these two axes."
        ),
        say(
            "a_i is the distance from z_{{i-1}} to z_i, measured along x_i. x_i lies on the common "
            "normal of the two axes."
        ),
        template(
            "In row {row}, draw the shortest line from {z_before} to {z}: {x} lies along it. Go "
            "from {z_before} to {z}: a is this way, positive in the direction of {x}. If the axes "
            "intersect or are one line, there is no way to go."
        ),
        say(
            "a_{{i-1}} is the distance from z_{{i-1}} to z_i, measured along x_{{i-1}}. x_{{i-1}} "
            "lies on the common normal of the two axes. In this convention it is in row i."
        ),
        ("a",),
    ),
    "link_twist": Rule(
        say("Link twist α"),
        template("Look at {z_before} and {z}: α in row {row} is the angle between these two axes."),
        say("α_i is the angle from z_{{i-1}} to z_i about x_i, by the right-hand rule."),
        template(
            "In row {row}, point your right thumb along {x}. Turn {z_before} until it points as "
            "{z}: this angle is α. It is positive if you turn as your fingers curl, else "
            "negative. It is no angle at all if both axes already point the same way."
        ),
        say(
            "α_{{i-1}} is the angle from z_{{i-1}} to z_i about x_{{i-1}}, by the right-hand "
            "rule. In this convention it is in row i."
        ),
        ("alpha",),
    ),
    "link_offset": Rule(
        say("Link offset d"),
        template(
            "Look along {axis}: d in row {row} is the distance between {x_before} and {x_here}."
        ),
        say(
            "d_i is the distance from x_{{i-1}} to x_i, measured along z_{{i-1}}. The variable of "
            "a sliding joint is part of it."
        ),
        template(
            "In row {row}, go along {axis} from the point where it meets {x_before} to the point "
            "where it meets {x_here}. d is this way; it is positive in the direction of {axis}. "
            "If the joint slides, its variable is part of the way."
        ),
        say(
            "d_i is the distance from x_{{i-1}} to x_i, measured along z_i. The variable of a "
            "sliding joint is part of it."
        ),
        ("d",),
    ),
    "joint_angle": Rule(
        say("Joint angle θ"),
        template("Look down {axis}: θ in row {row} is the angle between {x_before} and {x_here}."),
        say(
            "θ_i is the angle from x_{{i-1}} to x_i about z_{{i-1}}, by the right-hand rule. The "
            "variable of a turning joint is part of it."
        ),
        template(
            "In row {row}, point your right thumb along {axis}. Turn {x_before} until it points "
            "as {x_here}: this angle is θ. If the joint turns, do this where its variable is "
            "zero; the angle that you find there is added to the variable."
        ),
        say(
            "θ_i is the angle from x_{{i-1}} to x_i about z_i, by the right-hand rule. The "
            "variable of a turning joint is part of it."
        ),
        ("theta",),
    ),
    "joint_variable": Rule(
        say("Joint variable"),
        template(
            "Look at the joint of row {row}: which way does it move, and along or about which axis?"
        ),
        say(
            "Each joint has its own variable, once and in its own row: in θ if the joint turns "
            "about z_{{i-1}}, in d if it slides along z_{{i-1}}. Everything else in the row is "
            "constant."
        ),
        template(
            "The joint of row {row} moves about or along {axis}. Let it move alone, in the "
            "positive direction of {axis}: its variable grows, and only θ or only d grows with "
            "it. Write the variable of this joint there and nowhere else."
        ),
        say(
            "Each joint has its own variable, once and in its own row: in θ if the joint turns "
            "about z_i, in d if it slides along z_i. Everything else in the row is constant."
        ),
        ("d", "theta"),
    ),
    "rows": Rule(
        say("Rows of the table"),
        template("Look at the frames, and count them from the base to the end effector."),
        say(
            "Row i leads from frame {{i-1}} to frame i. There is one row for each joint, in the "
            "order of the joints, and one more only if the end effector has a frame of its own."
        ),
        template(
            "Write the frames in order. For each row, say from which frame to which it leads: the "
            "next row must begin where this one ends, and the last one must end at the end "
            "effector."
        ),
        pictured=("theta", "d", "a", "alpha"),
    ),
    "convention": Rule(
        say("The four moves of a row"),
        template("Look at the order of the four moves in a row, and at the axis of each."),
        say(
            "Standard convention: turn by θ_i about z_{{i-1}}, go d_i along z_{{i-1}}, go a_i "
            "along x_i, turn by α_i about x_i. z_i is the axis of joint i+1."
        ),
        template(
            "Do the four moves of one row with your hand or with a paper frame. You begin at the "
            "frame before, and you must end at the frame of the row. Then compare: which of the "
            "four moves was not the one that you wrote?"
        ),
        say(
            "Modified convention: turn by α_{{i-1}} about x_{{i-1}}, go a_{{i-1}} along "
            "x_{{i-1}}, turn by θ_i about z_i, go d_i along z_i. z_i is the axis of joint i."
        ),
        ("theta", "d", "a", "alpha"),
    ),
    "angle_unit": Rule(
        say("Units of angles"),
        template("Look at the unit of the angle in {entry}."),
        say("A number without a unit is read in the unit of the form. A full turn is 360° or 2π."),
        template(
            "Say the angle of {entry} as a part of a full turn. Then write it with its unit, or "
            "choose the unit of the form."
        ),
    ),
    "product": Rule(
        say("The product of link transforms"),
        template(
            "Look at the table of the robot, and at the order in which the transforms follow."
        ),
        say(
            "The pose is the product of all link transforms, from the base on the left to the end "
            "effector on the right. Each one is computed from its own row only."
        ),
        template(
            "Set all joint variables to zero and draw the arm. Compare {entry} with the drawing. "
            "Then move one joint after the other, the last one first: with the first joint at "
            "which the drawing and {entry} disagree, begin to search."
        ),
    ),
    "rotation_columns": Rule(
        say("The columns of a rotation"),
        template("Look at the column of {entry}: it is one axis of the last frame."),
        say(
            "The columns of a rotation are the axes x, y and z of the last frame, each by its "
            "components along the axes of the first frame."
        ),
        template(
            "Find the axis that belongs to {entry} in the drawing. Say which way it points, in "
            "the frame of the base: each row of the column is its component along one axis of "
            "that frame."
        ),
    ),
    "position_vector": Rule(
        say("The position"),
        template("Look at the vector from the origin of the first frame to the point."),
        say(
            "The position is the vector from the origin of the first frame to the point, by its "
            "components along the axes of the first frame."
        ),
        template(
            "Go along the links from the origin to the point. Write down the part of each link "
            "along the axis of {entry}, with its sign, and add these parts."
        ),
    ),
    "frame_z": Rule(
        say("The axis z of a frame"),
        template("Look at the joint whose axis z of this frame lies along: {entry}."),
        say("z_i lies along the axis of joint i+1, in either direction."),
        template(
            "Draw the axes of all joints as long lines. Count along the arm which of them this "
            "frame needs, and put z of {entry} on that line. Both directions are right."
        ),
        say("z_i lies along the axis of joint i, in either direction."),
    ),
    "frame_origin": Rule(
        say("The origin of a frame"),
        template(
            "Look at the two neighbouring axes z at {entry}: do they meet, are they parallel, or "
            "neither?"
        ),
        say(
            "The origin of frame i lies on z_i, where the common normal of z_{{i-1}} and z_i "
            "meets it. If these axes intersect, it is the point where they do. If they are "
            "parallel, any point of z_i is right."
        ),
        template(
            "For {entry}, draw the shortest line between the two axes. The origin is the point "
            "where this line meets z of this frame."
        ),
        say(
            "The origin of frame i lies on z_i, where the common normal of z_i and z_{{i+1}} "
            "meets it. If these axes intersect, it is the point where they do. If they are "
            "parallel, any point of z_i is right."
        ),
    ),
    "frame_x": Rule(
        say("The axis x of a frame"),
        template("Look at x of {entry} and at the two neighbouring axes z."),
        say("x_i is at a right angle to z_{{i-1}} and to z_i, and crosses z_{{i-1}}."),
        template(
            "At {entry}, draw the shortest line between the two axes: x lies along it, in either "
            "direction. If the axes intersect, x is at a right angle to both."
        ),
        say("x_i is at a right angle to z_i and to z_{{i+1}}, and crosses z_{{i+1}}."),
    ),
    "inverse": Rule(
        say("The inverse of a transform"),
        template("Look at which frame is described in which."),
        say(
            "The inverse has the transposed rotation. Its position is the old one, turned by the "
            "transposed rotation and then reversed."
        ),
        template(
            "Imagine that you stand in the other frame. For {entry}, ask: where does the first "
            "origin lie, and which way do the first axes point, seen from there?"
        ),
    ),
    "sine_and_cosine": Rule(
        say("Sine and cosine"),
        template("Look at the angle of each term in {entry}: from which axis is it counted?"),
        say(
            "A link at an angle from an axis reaches its length times the cosine along this axis, "
            "and its length times the sine across it."
        ),
        template(
            "Draw each term of {entry} as a right triangle. The side next to the angle has the "
            "cosine, the side opposite the sine. The sign is that of the axis which the side runs "
            "along."
        ),
    ),
    "angle_sum": Rule(
        say("Sums of joint angles"),
        template("Look at the joints before each link in {entry}."),
        say(
            "The direction of a link is the sum of the angles of all joints before it with "
            "parallel axes. The sum is inside the sine and cosine."
        ),
        template(
            "For each term of {entry}, ask which joints turn this link if they move alone. The "
            "angles of these joints, and no others, are in its sum."
        ),
    ),
    "atan2": Rule(
        say("The two arguments of atan2"),
        template("Look at the quadrant of the angle in {entry}."),
        say(
            "atan2 takes the value that belongs to the sine first, and the one that belongs to the "
            "cosine second. The signs of both decide the quadrant."
        ),
        template(
            "For {entry}, name the sine and the cosine of the angle. Write them into atan2 in this "
            "order, and try an angle in each quadrant."
        ),
    ),
    "euler_sequence": Rule(
        say("The sequence of turns"),
        template("Look at the sequence of axes in the question, and whether the axes move."),
        say(
            "Turns about moving axes are multiplied from left to right, turns about fixed axes "
            "from right to left. Each angle belongs to its axis in the sequence."
        ),
        template(
            "Do the turns one after the other, with a book or your hand. For {entry}, say about "
            "which axis the turn is, and with which sign."
        ),
    ),
    "elementary_turn": Rule(
        say("A turn about one axis"),
        template("Look at the axis of the turn in {entry}, and at its direction."),
        say(
            "A positive turn follows the right-hand rule: the thumb points along the axis, and the "
            "fingers curl from x to y about z, from y to z about x, and from z to x about y."
        ),
        template(
            "For {entry}, point your right thumb along the axis of the turn. See where the other "
            "two axes go if you turn by a small angle: their signs are those of the sines."
        ),
    ),
    "screw_axis": Rule(
        say("The screw axis of a joint"),
        template(
            "Look at the axis of the joint in its home position: its direction and a point on it."
        ),
        say(
            "ω is the unit vector along the axis, and v = −ω × q with any point q on the axis. "
            "For a sliding joint, ω vanishes and v is its direction."
        ),
        template(
            "For {entry}, hold the arm at home. Name ω by the right-hand rule and choose a point "
            "q on the axis, both in the frame of the question. Then compute v from them."
        ),
    ),
    "exponentials": Rule(
        say("The product of exponentials"),
        template("Look at the order of the factors and at the side on which M is."),
        say(
            "With screw axes in the base frame, the exponentials follow from the first joint to "
            "the last, and M is on the right. With axes in the end-effector frame, M is on the "
            "left."
        ),
        template(
            "Set all joint variables to zero: {entry} must be that of M. Then move the last joint "
            "alone and compare again, then the one before."
        ),
    ),
    "dependence": Rule(
        say("What a formula depends on"),
        template("Look at which joints and lengths can change {entry} at all."),
        say(
            "A formula contains exactly those joint variables and lengths that change its value. A "
            "length has the unit of a length in each of its terms; an angle has none."
        ),
        template(
            "Move each joint alone in your mind, then make each link longer. Whatever changes "
            "{entry} must be in its formula, and nothing else."
        ),
    ),
}

# The rule of each column of a DH table.
OF_COLUMN: Final[Mapping[str, RuleName]] = {
    "a": "link_length",
    "alpha": "link_twist",
    "d": "link_offset",
    "theta": "joint_angle",
}


# --- The pictures of the four DH parameters: two frames, and the lengths and angles between them


# The drawn parameters; pixels for each unit of length.
_LENGTH, _TWIST, _OFFSET, _ANGLE = 1.6, np.radians(40), 1.0, np.radians(55)
_SCALE: Final = 92.0
_ARROW: Final = 0.85
_VIEW: Final = View(-62.0, 22.0)


@dataclass(frozen=True, slots=True)
class _Scene:
    # Two frames, the corner of the path between them, and the indices of the parameters.
    # The columns of ``before`` and ``after`` are x, z and the origin. The path has two straight
    # pieces, a and d, which meet at the corner.
    before: Numbers
    after: Numbers
    corner: Numbers
    indices: dict[str, str]

    @property
    def x(self) -> Numbers:
        """The x axis, along which a is measured, and about which α is measured."""
        return (self.after if self.is_standard else self.before)[:, 0]

    @property
    def is_standard(self) -> bool:
        return self.indices["a"] == "i"

    def length(self, name: str) -> Numbers:
        """Return the two end points of the length a or d, as an array ``(2, 3)``."""
        ends = [self.before[:, 2], self.corner, self.after[:, 2]]
        first = (name == "d") == self.is_standard
        return np.array(ends[:2] if first else ends[1:])

    def angle(self, name: str) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Return the arc of the angle α or θ: centre, axis, first direction and last direction."""
        column = 0 if name == "theta" else 1
        axis = (
            self.x if name == "alpha" else (self.before if self.is_standard else self.after)[:, 1]
        )
        centre = self.corner
        if name == "alpha" and self.is_standard:
            centre = self.after[:, 2]
        return centre, axis, self.before[:, column], self.after[:, column]


@cache
def rule_picture(
    name: RuleName, convention: Convention, theme: Theme, language: Language = ENGLISH
) -> str:
    """Return the picture of a rule as SVG, with a text alternative.

    Raises KeyError if the rule has no picture.
    """
    rule = RULES[name]
    if not rule.pictured:
        raise KeyError(name)
    scene = _scene(convention)
    camera = Camera.of(_VIEW, _SCALE)
    sheet = Sheet(camera, 1.0)
    _axes(sheet, scene)
    for parameter in rule.pictured:
        _parameter(sheet, scene, parameter)
    _names(sheet, scene, rule.pictured)
    title, description = (
        told(text, language.translation) for text in (rule.title, rule.stated(convention))
    )
    caption = Caption(f"rule-{name}", title, description)
    return sheet.svg((), caption, theme)


def _scene(convention: Convention) -> _Scene:
    x, z, origin = np.eye(3)[0], np.eye(3)[2], np.zeros(3)
    before = np.stack([x, z, origin], axis=1)
    if convention is Convention.STANDARD:
        corner = _OFFSET * z
        x_after = _turned(x, z, _ANGLE)
        z_after = _turned(z, x_after, _TWIST)
        end = corner + _LENGTH * x_after
        indices = dict.fromkeys(_PRINTED, "i")
    else:
        corner = _LENGTH * x
        z_after = _turned(z, x, _TWIST)
        x_after = _turned(x, z_after, _ANGLE)
        end = corner + _OFFSET * z_after
        indices = {"a": "i−1", "alpha": "i−1", "d": "i", "theta": "i"}
    return _Scene(before, np.stack([x_after, z_after, end], axis=1), corner, indices)


def _turned(vector: Numbers, axis: Numbers, angle: float | Numbers) -> Numbers:
    across = np.cross(axis, vector)
    return np.asarray(
        np.multiply.outer(np.cos(angle), vector) + np.multiply.outer(np.sin(angle), across)
    )


def _axes(sheet: Sheet, scene: _Scene) -> None:
    for frame in (scene.before, scene.after):
        ends = np.array([scene.corner, frame[:, 2]])
        along = (ends - frame[:, 2]) @ frame[:, 1]
        reach = np.array([[along.min() - 0.5], [along.max() + 1.25]])
        line = sheet.camera.seen(frame[:, 2] + reach * frame[:, 1])
        sheet.take(line, 1.0, 0.5)
        sheet.below.append(polyline(line, "axis"))
    way = sheet.camera.seen(np.array([scene.before[:, 2], scene.corner, scene.after[:, 2]]))
    sheet.below.append(polyline(way, "dimension"))
    for frame in (scene.before, scene.after):
        for letter, column in (("z", 1), ("x", 0)):
            line = _arrow(sheet.camera, frame, column)
            sheet.take(line, 2.5)
            sheet.below += [polyline(line, f"frame frame-{letter}"), _head(line, f"head-{letter}")]


def _arrow(camera: Camera, frame: Numbers, column: int) -> Numbers:
    return camera.seen(np.array([frame[:, 2], frame[:, 2] + _ARROW * frame[:, column]]))


def _head(line: Numbers, kind: str) -> str:
    ahead = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    return arrowhead(line[1] + 4 * ahead, ahead, kind, 8.0)


def _parameter(sheet: Sheet, scene: _Scene, name: str) -> None:
    if name in ("a", "d"):
        first, last = scene.length(name)
        line = sheet.camera.seen(np.linspace(first, last, 9))
    else:
        centre, axis, first, last = scene.angle(name)
        size = _ANGLE if name == "theta" else _TWIST
        radius = 0.62 if name == "theta" else 0.7
        line = sheet.camera.seen(centre + radius * _turned(first, axis, np.linspace(0, size, 24)))
        for direction in (first, last):
            leg = sheet.camera.seen(np.array([centre, centre + 1.15 * radius * direction]))
            sheet.take(leg, 1.0, 0.4)
            sheet.below.append(polyline(leg, "witness"))
    sheet.take(line, 3.0)
    sheet.above += MotionArrow(line, both=False).svg()


def _names(sheet: Sheet, scene: _Scene, pictured: Sequence[str]) -> None:
    for name, kind, wanted, line in _labels(sheet.camera, scene, pictured):
        place = sheet.room.place(name, wanted, line)
        sheet.above.append(name.svg(place.x, place.y, kind))


def _labels(
    camera: Camera, scene: _Scene, pictured: Sequence[str]
) -> Iterator[tuple[Label, str, list[Numbers], Numbers]]:
    for frame, index in ((scene.before, "i−1"), (scene.after, "i")):
        for letter, column in (("z", 1), ("x", 0)):
            line = _arrow(camera, frame, column)
            label = Label(((letter, index),))
            yield label, f"name-{letter}", list(around(line[1], 17.0)), line[1:]
    for name in pictured:
        if name in ("a", "d"):
            middle = camera.seen(scene.length(name).mean(axis=0))
        else:
            centre, axis, first, _ = scene.angle(name)
            half = (_ANGLE if name == "theta" else _TWIST) / 2
            middle = camera.seen(centre + 0.85 * _turned(first, axis, half))
        label = Label(((_PRINTED[name], scene.indices[name]),))
        yield label, "variable", list(around(middle, 15.0)), middle[None]


# --- Alternatives to a correct table: valid tables with one frame chosen differently
#
# The x or z axis of a frame may point the other way. If the next axis is parallel, the frame may
# slide along its z axis. The grader decides which of these changes the exercise allows.


MOST: Final = 3
# Each is graded.
MOST_TRIED: Final = 12
_SIMPLE: Final = regex(r"-?[^\s+\-*/()]+")
_HALF_TURNS: Final = ("180°", "-180°", "180deg", "-180deg", "pi", "-pi", "π", "-π")

# A row: a, alpha, d and theta as texts.
Cells = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class FrameChoice:
    """An alternative to a correct table, and how the two tables differ."""

    change: str
    rows: tuple[Cells, ...]


def other_choices(
    exercise: Exercise, part: DhTableSpec, rows: Sequence[Cells], submission: Submission
) -> list[FrameChoice]:
    """Return at most three alternatives to the correct table ``rows``; none if it is wrong."""
    convention = part.convention
    if not isinstance(convention, Convention) or part.frames != "free":
        return []

    def is_right(table: Sequence[Cells]) -> bool:
        answers = {part.id: {"rows": [dict(row) for row in table]}}
        sent = Submission(answers, submission.angle_unit, FeedbackLevel.SCORE)
        report = next(each for each in grade(exercise, sent).parts if each.part == part.id)
        return report.verdict is Verdict.CORRECT

    if not is_right(rows):
        return []
    lengths = [
        each.name for each in exercise.variables if each.joint is None and each.kind == "length"
    ]
    tried = islice(_changed(rows, convention, lengths), MOST_TRIED)
    found = (each for each in tried if is_right(each.rows))
    return list(islice(found, MOST))


def _changed(
    rows: Sequence[Cells], convention: Convention, lengths: Sequence[str]
) -> Iterator[FrameChoice]:
    """Yield tables in which one frame between two rows is chosen differently."""
    # The first tables differ in as many ways as possible.
    ways: list[Callable[[list[Cells], int, Convention], FrameChoice]]
    ways = [_reversed_x, _reversed_z, *(partial(_slid, length=length) for length in lengths[:1])]
    inner = len(rows) - 1
    for i in range(inner):
        for k, way in enumerate(ways):
            yield way(list(rows), (i + k) % inner, convention)


# The frame after row i moves by M. So row i becomes A_i M, and the next row M⁻¹ A_{i+1}; both are
# written as rows again.


def _reversed_x(rows: list[Cells], i: int, convention: Convention) -> FrameChoice:
    """Turn the frame by a half turn about its z axis, so that x points the other way."""
    for k in (i, i + 1):
        rows[k] = {**rows[k], "theta": _plus_half_turn(rows[k]["theta"])}
    reverse = i if convention is Convention.STANDARD else i + 1
    rows[reverse] = {**rows[reverse], **_negated(rows[reverse], "a", "alpha")}
    return FrameChoice(say("{axis} points the other way.", axis=f"x{i + 1}"), tuple(rows))


def _reversed_z(rows: list[Cells], i: int, convention: Convention) -> FrameChoice:
    """Turn the frame by a half turn about its x axis, so that z points the other way."""
    for k in (i, i + 1):
        rows[k] = {**rows[k], "alpha": _plus_half_turn(rows[k]["alpha"])}
    reverse = i + 1 if convention is Convention.STANDARD else i
    rows[reverse] = {**rows[reverse], **_negated(rows[reverse], "d", "theta")}
    return FrameChoice(say("{axis} points the other way.", axis=f"z{i + 1}"), tuple(rows))


def _slid(rows: list[Cells], i: int, convention: Convention, length: str) -> FrameChoice:
    """Slide the frame along its z axis, which is parallel to the next or the previous z axis."""
    between = rows[i if convention is Convention.STANDARD else i + 1]["alpha"]
    is_opposite, is_standard = between in _HALF_TURNS, convention is Convention.STANDARD
    here, after = rows[i]["d"], rows[i + 1]["d"]
    here = _sum(here, length, is_minus=is_standard and is_opposite)
    after = _sum(after, length, is_minus=is_standard or not is_opposite)
    rows[i], rows[i + 1] = {**rows[i], "d": here}, {**rows[i + 1], "d": after}
    text = say(
        "The origin of frame {frame} lies farther along {axis}.",
        frame=f"{{{i + 1}}}",
        axis=f"z{i + 1}",
    )
    return FrameChoice(text, tuple(rows))


def _negated(row: Cells, *columns: str) -> dict[str, str]:
    return {column: _minus(row[column]) for column in columns}


def _minus(text: str) -> str:
    if not _SIMPLE.fullmatch(text):
        return f"-({text})"
    if text in ("0", *_HALF_TURNS):
        return text
    return text[1:] if text.startswith("-") else f"-{text}"


def _plus_half_turn(text: str) -> str:
    if text in _HALF_TURNS:
        return "0"
    return "180°" if text == "0" else f"{text} + 180°"


def _sum(text: str, length: str, *, is_minus: bool) -> str:
    sign = "-" if is_minus else "+"
    if text == "0":
        return f"-{length}" if is_minus else length
    return f"{text} {sign} {length}"
